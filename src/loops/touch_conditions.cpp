#include "loops/touch_conditions.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <utility>

#include "scene/touch_rows.h"

namespace virtual_work_dynamics {

namespace {

using Vector3 = Eigen::Vector3d;

// Sine of an angle below which directions are parallel.
constexpr double kLeastSine = 1e-9;
// Of a wheel's size, how far from its plane its point may be: heights in descriptions are rounded.
constexpr double kLargestGap = 0.1;

std::vector<Condition> conditionsOf(const Closure& closure) {
  std::vector<Condition> conditions;
  for (const TouchRow& row : touchRows(closure)) {
    Condition condition;
    condition.name = closure.name + "." + row.name;
    condition.has_position = row.has_position;
    condition.adopts_constant = row.adopts_constant;
    conditions.push_back(condition);
  }
  return conditions;
}

// Whether a wheel's axle matters.
bool hasAxle(const Touch& touch) {
  const bool alike = touch.slip == Slip::kNone || touch.slip == Slip::kAll;
  return touch.radius > 0 || touch.roller_angle || !alike;
}

// As kernels see it. Where no axle matters, the axes are those of the plane.
TouchShape touchShapeOf(const Closure& closure) {
  TouchShape shape{};
  using Axes = TouchShape::Axes;
  if (closure.type == ClosureType::kRolling) {
    shape.axes = hasAxle(closure.touch) ? Axes::kOfWheel : Axes::kOfPlane;
    shape.radius = closure.touch.radius;
    shape.tube_radius = closure.touch.tube_radius;
  } else {
    shape.axes = closure.type == ClosureType::kContact ? Axes::kOfPlane : Axes::kOfBlade;
  }
  std::size_t i = 0;
  for (const TouchRow& row : touchRows(closure)) {
    Eigen::Map<Vector3>{shape.directions[i]} = row.direction;
    shape.has_position[i++] = row.has_position;
  }
  return shape;
}

}  // namespace

TouchConditions::TouchConditions(const Mechanism& mechanism, const Closure& closure,
                                 const Frame& parent, const Frame& child,
                                 std::vector<PathStep> path, std::vector<int> coordinates)
    : ClosureConditions(mechanism, closure, conditionsOf(closure), parent, child, std::move(path),
                        std::move(coordinates)),
      touch_(touchShapeOf(closure)),
      has_normal_(closure.touch.normal) {
  setShape(touch_);
}

TouchConditions::Contact TouchConditions::contactOf(const LinkKinematics& links,
                                                    const Vector3& w) const {
  Contact contact;
  static_assert(sizeof(Contact) == kContactNumbers * sizeof(double), "plain numbers");
  kernel().findContact(shape(), links.numbers(), w.data(), contact.R.data());
  return contact;
}

const char* TouchConditions::fault(const LinkKinematics& links, double /*least*/) const {
  if (conditions().empty()) return nullptr;  // it is lifted
  const Vector3 normal = links.axisOf(parent(), 2);
  const bool wheel = type() == ClosureType::kRolling;
  if (touch_.axes == TouchShape::Axes::kOfWheel &&
      links.axisOf(child(), 2).cross(normal).norm() <= kLeastSine) {
    return "its axle is parallel to the plane's normal";
  }
  if (wheel && !has_normal_) {
    const Contact contact = contactOf(links, Vector3::Zero());
    const Vector3 from_plane = links.originOf(child()) + contact.lever - links.originOf(parent());
    if (std::abs(normal.dot(from_plane)) > kLargestGap * (touch_.radius + touch_.tube_radius)) {
      return "it does not touch its plane, and with normal: false nothing moves it there";
    }
  }
  if (type() == ClosureType::kKnifeEdge &&
      links.axisOf(child(), 0).cross(normal).norm() <= kLeastSine) {
    return "its direction is parallel to the plane's normal";
  }
  return nullptr;
}

// The force turns about the normal alone, and its line goes with the point of contact.
LinkKinematics::Displacement TouchConditions::displacedBy(const LinkKinematics& links,
                                                          const FramePair& frames,
                                                          const PathStep& step,
                                                          double length) const {
  const Vector3 centre = links.originOf(child());
  LinkKinematics::Displacement moves = links.displacementBy(step, centre, length);
  const Contact contact = contactOf(links, moves.turn);
  moves.origin += contact.leverd;
  moves.turn = frames.R_C.col(0).cross(contact.Rd.col(0));
  return moves;
}

}  // namespace virtual_work_dynamics
