#include "loops/closure_conditions.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "base/printable.h"
#include "loops/cylinder_conditions.h"
#include "loops/gear_conditions.h"
#include "loops/touch_conditions.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

std::vector<int> coordinatesOn(const Mechanism& mechanism, const std::vector<PathStep>& path) {
  std::vector<int> coordinates;
  for (const PathStep& step : path) {
    const int coordinate = mechanism.joint(step.joint).coordinate;
    if (coordinate >= 0) coordinates.push_back(coordinate);
  }
  std::sort(coordinates.begin(), coordinates.end());
  coordinates.erase(std::unique(coordinates.begin(), coordinates.end()), coordinates.end());
  return coordinates;
}

namespace {

using Kind = ClosureDemand::Kind;
using Frame = LinkKinematics::Frame;

std::string placeOf(const Closure& closure) {
  return std::string(traitsOf(closure.type).list) + ": " + inQuotes(closure.name);
}

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& rpy) {
  using Turn = Eigen::AngleAxisd;
  return (Turn(rpy.z(), Eigen::Vector3d::UnitZ()) * Turn(rpy.y(), Eigen::Vector3d::UnitY()) *
          Turn(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

// The keys by which a scene names the links of the parent and the child frame.
std::pair<std::string, std::string> linkKeysOf(const Closure& closure) {
  if (traitsOf(closure.type).touches()) return {"plane.link", "link"};
  if (closure.type == ClosureType::kCylinder) return {"link_a", "link_b"};
  return {"parent.link", "child.link"};
}

Frame frameOf(const Mechanism& mechanism, const LinkFrame& from, const std::string& key) {
  Frame frame;
  frame.link = linkNamed(mechanism, from.link, key);
  frame.R_LF = rotationOf(from.rpy);
  frame.p_LoFo_L = from.xyz;
  return frame;
}

std::vector<Condition> rowsOf(const Closure& closure) {
  const ClosureTypeTraits& traits = traitsOf(closure.type);
  const std::string axes = "xyz";
  const auto axis = [&](int i) { return axes[static_cast<std::size_t>(i)]; };
  std::vector<Condition> rows;
  for (int i = 0; i < traits.conditions; ++i) {
    const ClosureDemand& demand = traits.demands[static_cast<std::size_t>(i)];
    Condition row;
    row.name = closure.name + ".";
    if (demand.kind == Kind::kDistance) {
      row.name += "distance";
      row.adopts_constant = !closure.length;
    } else {
      row.name += axis(demand.a);
      if (demand.kind == Kind::kNormal) {
        row.name += axis(demand.b);
        row.unit = Unit::kRadian;
      }
    }
    rows.push_back(row);
  }
  return rows;
}

std::shared_ptr<const ConditionSet> makeSet(const Mechanism& mechanism, const Closure& closure) {
  const auto [parent_key, child_key] = linkKeysOf(closure);
  const std::string place = placeOf(closure) + ": ";
  const Frame parent = frameOf(mechanism, closure.parent, place + parent_key);
  const Frame child = frameOf(mechanism, closure.child, place + child_key);
  if (parent.link == child.link) {
    throw SceneError(placeOf(closure) + ": both frames are on link " +
                     inQuotes(closure.parent.link));
  }
  const std::vector<PathStep> path = pathBetween(mechanism, parent.link, child.link);
  const std::vector<int> coordinates = coordinatesOn(mechanism, path);
  if (coordinates.empty()) {
    throw SceneError(placeOf(closure) + ": no joint moves " + inQuotes(closure.child.link) +
                     " relative to " + inQuotes(closure.parent.link));
  }
  if (traitsOf(closure.type).touches()) {
    return std::make_shared<TouchConditions>(mechanism, closure, parent, child, path, coordinates);
  }
  if (closure.type == ClosureType::kCylinder) {
    return std::make_shared<CylinderConditions>(mechanism, closure, parent, child, path,
                                                coordinates);
  }
  if (traitsOf(closure.type).meshes()) {
    return std::make_shared<GearConditions>(mechanism, closure, parent, child, path, coordinates);
  }
  return std::make_shared<ClosureConditions>(mechanism, closure, rowsOf(closure), parent, child,
                                             path, coordinates);
}

FrameShape shapeOf(const Frame& frame) {
  FrameShape shape{};
  shape.link = frame.link;
  shape.parallel = frame.R_LF == Eigen::Matrix3d::Identity();
  Eigen::Map<Eigen::Matrix3d>{shape.R_LF} = frame.R_LF;
  Eigen::Map<Eigen::Vector3d>{shape.p_LoFo_L} = frame.p_LoFo_L;
  return shape;
}

// See ClosureShape::along.
int alongOf(const ClosureShape& shape) {
  const DemandShape* const end = shape.demands + shape.demand_count;
  const auto is = [](DemandShape::Kind kind) {
    return [kind](const DemandShape& demand) { return demand.kind == kind; };
  };
  const DemandShape* const others =
      std::find_if_not(shape.demands, end, is(DemandShape::Kind::kAlong));
  return std::all_of(others, end, is(DemandShape::Kind::kNormal))
             ? static_cast<int>(others - shape.demands)
             : -1;
}

DemandShape shapeOf(const ClosureDemand& demand) {
  const DemandShape::Kind kind = demand.kind == Kind::kDistance ? DemandShape::Kind::kDistance
                                 : demand.kind == Kind::kNormal ? DemandShape::Kind::kNormal
                                                                : DemandShape::Kind::kAlong;
  return {kind, demand.a, demand.b};
}

std::vector<StepShape> stepsOf(const Mechanism& mechanism, const std::vector<PathStep>& path) {
  std::vector<StepShape> steps;
  for (const PathStep& step : path) {
    const Joint& joint = mechanism.joint(step.joint);
    if (joint.coordinate < 0) continue;
    const bool starts = std::none_of(steps.begin(), steps.end(), [&](const StepShape& before) {
      return before.coordinate == joint.coordinate;
    });
    steps.push_back({step.joint + 1, joint.coordinate, unitOf(joint) == Unit::kMetre, starts,
                     step.sign * static_cast<double>(joint.multiplier)});
  }
  return steps;
}

}  // namespace

ClosureConditions::ClosureConditions(const Mechanism& mechanism, const Closure& closure,
                                     std::vector<Condition> rows, const Frame& parent,
                                     const Frame& child, std::vector<PathStep> path,
                                     std::vector<int> coordinates)
    : ConditionSet(placeOf(closure), std::move(rows), std::move(coordinates)),
      traits_(traitsOf(closure.type)),
      kernel_(&loopKernelFor(chosenInstructionSet()).one),
      parent_(parent),
      child_(child),
      path_(std::move(path)),
      given_length_(closure.length),
      steps_(stepsOf(mechanism, path_)),
      shape_{shapeOf(parent),
             shapeOf(child),
             steps_.data(),
             static_cast<int>(steps_.size()),
             static_cast<int>(conditions().size()),
             {},
             closure.length.value_or(0),
             -1,
             nullptr,
             nullptr} {
  std::transform(traits_.demands.begin(), traits_.demands.end(), shape_.demands,
                 [](const ClosureDemand& demand) { return shapeOf(demand); });
  shape_.along = alongOf(shape_);
}

void ClosureConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  kernel_->placeClosure(shape_, state.links.numbers(), rows.numbers());
}

void ClosureConditions::setMotion(const LoopState& state, ConditionRows rows) const {
  kernel_->moveClosure(shape_, state.links.numbers(), rows.numbers());
}

double ClosureConditions::freePosition(const FramePair& frames) const {
  if (freeUnit() == Unit::kMetre) return frames.R_P.col(2).dot(frames.Co - frames.Po);
  const auto x = frames.R_C.col(0);
  return std::atan2(frames.R_P.col(1).dot(x), frames.R_P.col(0).dot(x));
}

double ClosureConditions::freeVelocity(const LinkKinematics& links, const FramePair& frames) const {
  const LinkKinematics::PointMotion P = links.motionAt(parent_.link, frames.Po);
  const LinkKinematics::PointMotion C = links.motionAt(child_.link, frames.Co);
  const auto axis = frames.R_P.col(2);
  if (freeUnit() == Unit::kRadian) return axis.dot(C.w - P.w);
  return axis.dot(C.v - P.v - P.w.cross(frames.Co - frames.Po));
}

FramePair ClosureConditions::framesAt(const LinkKinematics& links) const {
  return {links.axesOf(parent_), links.axesOf(child_), links.originOf(parent_),
          links.originOf(child_)};
}

// What moves freely moves along or about the axis itself, so that a turn of the axis adds nothing.
double ClosureConditions::freeAcceleration(const LinkKinematics& links,
                                           const FramePair& frames) const {
  const LinkKinematics::PointMotion P = links.motionAt(parent_.link, frames.Po);
  const LinkKinematics::PointMotion C = links.motionAt(child_.link, frames.Co);
  const auto axis = frames.R_P.col(2);
  if (freeUnit() == Unit::kRadian) return axis.dot(C.alpha - P.alpha);
  return axis.dot(C.a - P.a - P.alpha.cross(frames.Co - frames.Po) - P.w.cross(C.v - P.v));
}

LinkKinematics::Displacement ClosureConditions::displacedBy(const LinkKinematics& links,
                                                            const FramePair& frames,
                                                            const PathStep& step,
                                                            double length) const {
  LinkKinematics::Displacement moves = links.displacementBy(step, frames.Co, length);
  if (!traits_.hasLength()) return moves;
  const Eigen::Vector3d r = frames.Co - frames.Po;
  const double square = r.squaredNorm();
  if (square > 0) moves.turn = r.cross(moves.origin) / square;  // a rod's, which joins the origins
  return moves;
}

bool ClosureConditions::reversed(const FramePair& frames) const {
  if (traits_.canTurn()) return false;
  return frames.R_P.col(0).dot(frames.R_C.col(0)) < 0 ||
         frames.R_P.col(2).dot(frames.R_C.col(2)) < 0;
}

ConditionSets closureConditions(const Mechanism& mechanism, const Scene& scene) {
  ConditionSets sets;
  for (const Closure& closure : scene.closures) {
    sets.push_back(makeSet(mechanism, closure));
  }
  return sets;
}

}  // namespace virtual_work_dynamics
