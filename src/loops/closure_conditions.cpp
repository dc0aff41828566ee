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

// Finds the coordinates that move the links relative to each other, ascending.
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
      length_(closure.length.value_or(0)) {}

void ClosureConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics& links = state.links;
  const Eigen::Vector3d Co = links.originOf(child_), r = Co - links.originOf(parent_);  // (2.1)
  for (int i = 0; i < traits_.conditions; ++i) {
    const ClosureDemand& demand = traits_.demands[static_cast<std::size_t>(i)];
    ClosureWrench& wrench = rows.unitWrench(i);
    if (demand.kind == Kind::kDistance) {
      const double distance = r.norm();
      rows.phi(i) = distance - length_;  // (3.3)
      wrench.force = r.normalized();
      continue;
    }
    const Eigen::Vector3d a = links.axisOf(parent_, demand.a);
    if (demand.kind == Kind::kAlong) {
      rows.phi(i) = a.dot(r);  // (3.3)
      wrench.force = a;
    } else {
      const Eigen::Vector3d b = links.axisOf(child_, demand.b);
      rows.phi(i) = a.dot(b);  // (3.3)
      wrench.moment = b.cross(a);
    }
  }
  // A row of A is the generalized force of the wrench that a multiplier of one exerts.
  for (const int coordinate : coordinates()) {
    for (int i = 0; i < traits_.conditions; ++i) rows.A(i, coordinate) = 0;
  }
  for (const PathStep& step : path_) {
    const int coordinate = links.coordinateOf(step);
    if (coordinate < 0) continue;
    for (int i = 0; i < traits_.conditions; ++i) {
      rows.A(i, coordinate) += links.workOf(step, Co, rows.unitWrench(i));  // (3.3), dPhi/dq
    }
  }
}

void ClosureConditions::setMotion(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics& links = state.links;
  const LinkKinematics::Point P = links.pointOf(parent_), C = links.pointOf(child_);
  const Eigen::Vector3d r = C.o - P.o, v = C.v - P.v, acceleration = C.a - P.a;
  for (int i = 0; i < traits_.conditions; ++i) {
    const ClosureDemand& demand = traits_.demands[static_cast<std::size_t>(i)];
    double& rate = rows.rate(i);
    double& second = rows.acceleration(i);
    if (demand.kind == Kind::kDistance) {
      const double distance = r.norm();
      rate = distance > 0 ? r.dot(v) / distance : 0;  // (3.2)
      second = distance > 0 ? (v.dot(v) + r.dot(acceleration) - rate * rate) / distance : 0;
      continue;
    }
    const Eigen::Vector3d a = links.axisOf(parent_, demand.a);
    const Eigen::Vector3d ad = P.w.cross(a), add = P.alpha.cross(a) + P.w.cross(ad);
    if (demand.kind == Kind::kAlong) {
      rate = ad.dot(r) + a.dot(v);  // (3.2)
      second = add.dot(r) + 2 * ad.dot(v) + a.dot(acceleration);
    } else {
      const Eigen::Vector3d b = links.axisOf(child_, demand.b);
      const Eigen::Vector3d bd = C.w.cross(b), bdd = C.alpha.cross(b) + C.w.cross(bd);
      rate = ad.dot(b) + a.dot(bd);  // (3.2)
      second = add.dot(b) + 2 * ad.dot(bd) + a.dot(bdd);
    }
  }
}

double ClosureConditions::freePosition(const LinkKinematics& links) const {
  if (freeUnit() == Unit::kMetre) {
    return freeAxis(links).dot(links.originOf(child_) - links.originOf(parent_));
  }
  const Eigen::Vector3d x = links.axisOf(child_, 0);
  return std::atan2(links.axisOf(parent_, 1).dot(x), links.axisOf(parent_, 0).dot(x));
}

double ClosureConditions::freeVelocity(const LinkKinematics& links) const {
  const LinkKinematics::Point P = links.pointOf(parent_), C = links.pointOf(child_);
  if (freeUnit() == Unit::kRadian) return freeAxis(links).dot(C.w - P.w);
  return freeAxis(links).dot(C.v - P.v - P.w.cross(C.o - P.o));
}

bool ClosureConditions::reversed(const LinkKinematics& links) const {
  if (traits_.canTurn()) return false;
  return links.axisOf(parent_, 0).dot(links.axisOf(child_, 0)) < 0 ||
         links.axisOf(parent_, 2).dot(links.axisOf(child_, 2)) < 0;
}

ConditionSets closureConditions(const Mechanism& mechanism, const Scene& scene) {
  ConditionSets sets;
  for (const Closure& closure : scene.closures) {
    sets.push_back(makeSet(mechanism, closure));
  }
  return sets;
}

}  // namespace virtual_work_dynamics
