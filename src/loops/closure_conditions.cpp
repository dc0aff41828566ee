#include "loops/closure_conditions.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "base/printable.h"
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
  return "closures: " + inQuotes(closure.name);
}

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& rpy) {
  using Turn = Eigen::AngleAxisd;
  return (Turn(rpy.z(), Eigen::Vector3d::UnitZ()) * Turn(rpy.y(), Eigen::Vector3d::UnitY()) *
          Turn(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Frame frameOf(const Mechanism& mechanism, const LinkFrame& from, const std::string& place) {
  Frame frame;
  frame.link = linkNamed(mechanism, from.link, place + ".link");
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
  const Frame parent = frameOf(mechanism, closure.parent, placeOf(closure) + ": parent");
  const Frame child = frameOf(mechanism, closure.child, placeOf(closure) + ": child");
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
  return std::make_shared<ClosureConditions>(closure, parent, child, path, coordinates);
}

}  // namespace

ClosureConditions::ClosureConditions(const Closure& closure, const Frame& parent,
                                     const Frame& child, std::vector<PathStep> path,
                                     std::vector<int> coordinates)
    : ConditionSet(placeOf(closure), rowsOf(closure), std::move(coordinates)),
      traits_(traitsOf(closure.type)),
      parent_(parent),
      child_(child),
      path_(std::move(path)),
      given_length_(closure.length),
      length_(closure.length.value_or(0)) {}

void ClosureConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  FramePair& frames = rows.frames();
  frames.R_P.noalias() = state.links.axesOf(parent_.link) * parent_.R_LF;
  frames.R_C.noalias() = state.links.axesOf(child_.link) * child_.R_LF;
  frames.Po = state.links.originOf(parent_);
  frames.Co = state.links.originOf(child_);
  setValues(frames, rows);
  setJacobian(state.links, frames.Co, rows);
}

// Sets conditions and the wrenches of unit multipliers.
void ClosureConditions::setValues(const FramePair& frames, ConditionRows& rows) const {
  const Eigen::Vector3d r = frames.Co - frames.Po;  // (2.1)
  const ClosureDemand* demands = traits_.demands.data();
  ClosureWrench* wrenches = &rows.unitWrench(0);
  for (int i = 0; i < traits_.conditions; ++i) {
    const ClosureDemand& demand = demands[i];
    ClosureWrench& wrench = wrenches[i];
    if (demand.kind == Kind::kDistance) {
      const double distance = r.norm();
      rows.phi(i) = distance - length_;  // (3.3)
      wrench.force = distance > 0 ? (r / distance).eval() : r;
    } else if (demand.kind == Kind::kAlong) {
      wrench.force = frames.R_P.col(demand.a);
      rows.phi(i) = wrench.force.dot(r);  // (3.3)
    } else {
      const auto a = frames.R_P.col(demand.a), b = frames.R_C.col(demand.b);
      rows.phi(i) = a.dot(b);  // (3.3)
      wrench.moment = b.cross(a);
    }
  }
}

// A row of A is the generalized force of the wrench that a multiplier of one exerts: (3.3),
// dPhi/dq.
void ClosureConditions::setJacobian(const LinkKinematics& links, const Eigen::Vector3d& Co,
                                    ConditionRows& rows) const {
  for (const int coordinate : coordinates()) {
    std::fill_n(rows.column(coordinate), traits_.conditions, 0.0);
  }
  const ClosureDemand* demands = traits_.demands.data();
  const ClosureWrench* wrenches = &rows.unitWrench(0);
  for (const PathStep& step : path_) {
    const int coordinate = links.coordinateOf(step);
    if (coordinate < 0) continue;
    const LinkKinematics::Displacement moved = links.movedBy(step, Co);
    double* column = rows.column(coordinate);
    for (int i = 0; i < traits_.conditions; ++i) {
      column[i] += demands[i].kind == Kind::kNormal ? wrenches[i].moment.dot(moved.turn)
                                                    : wrenches[i].force.dot(moved.origin);
    }
  }
}

// The second derivatives are those that an observer on P sees, who moves with the parent's link.
void ClosureConditions::setMotion(const LoopState& state, ConditionRows rows) const {
  const FramePair& frames = rows.frames();
  const LinkKinematics::PointMotion P = state.links.motionAt(parent_.link, frames.Po);
  const LinkKinematics::PointMotion C = state.links.motionAt(child_.link, frames.Co);
  const Eigen::Vector3d r = frames.Co - frames.Po, carried = P.w.cross(r);
  const Eigen::Vector3d v = C.v - P.v - carried;  // seen from P
  const Eigen::Vector3d a = C.a - P.a - P.alpha.cross(r) - P.w.cross(carried) - 2 * P.w.cross(v);
  const Eigen::Vector3d w = C.w - P.w, alpha = C.alpha - P.alpha - P.w.cross(C.w);
  const ClosureWrench* wrenches = &rows.unitWrench(0);
  for (int i = 0; i < traits_.conditions; ++i) {
    const ClosureDemand& demand = traits_.demands[static_cast<std::size_t>(i)];
    const ClosureWrench& wrench = wrenches[i];
    if (demand.kind == Kind::kDistance) {
      const double distance = r.norm(), rate = wrench.force.dot(v);
      rows.turning(i) =
          distance > 0 ? (v.dot(v) - rate * rate) / distance + wrench.force.dot(a) : 0;
    } else if (demand.kind == Kind::kAlong) {
      rows.turning(i) = wrench.force.dot(a);
    } else {
      const auto normal = frames.R_P.col(demand.a), other = frames.R_C.col(demand.b);
      rows.turning(i) =
          wrench.moment.dot(alpha) + w.dot(normal) * w.dot(other) - w.dot(w) * normal.dot(other);
    }
  }
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
