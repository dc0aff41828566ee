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

// A unit vector along v, and how it changes with v.
struct Direction {
  Vector3 u, ud;
};
Direction along(const Vector3& v, const Vector3& vd) {
  const double length = v.norm();
  if (!(length > 0)) return {Vector3::Zero(), Vector3::Zero()};
  const Vector3 u = v / length;
  return {u, (vd - u.dot(vd) * u) / length};
}

}  // namespace

TouchConditions::TouchConditions(const Mechanism& mechanism, const Closure& closure,
                                 const Frame& parent, const Frame& child,
                                 std::vector<PathStep> path, std::vector<int> coordinates)
    : ClosureConditions(mechanism, closure, conditionsOf(closure), parent, child, std::move(path),
                        std::move(coordinates)),
      radius_(closure.touch.radius),
      tube_radius_(closure.touch.tube_radius),
      has_axle_(hasAxle(closure.touch)),
      has_normal_(closure.touch.normal) {
  for (const TouchRow& row : touchRows(closure)) directions_.push_back(row.direction);
}

// The lowest point of a torus: from its centre against m, the normal less its part along the axle,
// to the middle of the tube, and from there against the normal.
TouchConditions::Contact TouchConditions::wheelOn(const Vector3& normal, const Vector3& axle,
                                                  const Vector3& w) const {
  const Vector3 axled = w.cross(axle);
  const double lean = normal.dot(axle), leand = normal.dot(axled);
  const Direction m = along(normal - lean * axle, -leand * axle - lean * axled);
  const Direction x = along(axle.cross(normal), axled.cross(normal));
  Contact contact;
  contact.R << x.u, normal.cross(x.u), normal;
  contact.Rd << x.ud, normal.cross(x.ud), Vector3::Zero();
  contact.lever = -radius_ * m.u - tube_radius_ * normal;
  contact.leverd = -radius_ * m.ud;
  return contact;
}

TouchConditions::Contact TouchConditions::contactOf(const LinkKinematics& links,
                                                    const Eigen::Matrix3d& R_P,
                                                    const Vector3& w) const {
  const Vector3 normal = R_P.col(2);
  const bool wheel = type() == ClosureType::kRolling;
  if (wheel && has_axle_) return wheelOn(normal, links.axisOf(child(), 2), w);
  Contact contact;
  contact.R = R_P;
  if (wheel) contact.lever = -tube_radius_ * normal;
  if (wheel || type() == ClosureType::kContact) return contact;
  const Vector3 blade = links.axisOf(child(), 0), bladed = w.cross(blade);
  const Direction x =
      along(blade - normal.dot(blade) * normal, bladed - normal.dot(bladed) * normal);
  contact.R << x.u, normal.cross(x.u), normal;
  contact.Rd << x.ud, normal.cross(x.ud), Vector3::Zero();
  return contact;
}

void TouchConditions::setPosition(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics& links = state.links;
  FramePair& frames = rows.frames();
  frames.R_P = links.axesOf(parent());
  frames.Po = links.originOf(parent());
  const Contact contact = contactOf(links, frames.R_P, Vector3::Zero());
  frames.R_C = contact.R;
  frames.Co = links.originOf(child()) + contact.lever;
  const auto count = static_cast<Eigen::Index>(directions_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector3 direction = contact.R * directions_[static_cast<std::size_t>(i)];
    rows.unitWrench(i).force = direction;
    const bool placed = conditions()[static_cast<std::size_t>(i)].has_position;
    rows.phi(i) = placed ? direction.dot(frames.Co - frames.Po) : 0;  // (3.3)
    for (const int coordinate : coordinates()) rows.A(i, coordinate) = 0;
  }
  for (const PathStep& step : path()) {
    const int coordinate = links.coordinateOf(step);
    if (coordinate < 0) continue;
    const Vector3 moved = links.movedBy(step, frames.Co).origin;
    for (Eigen::Index i = 0; i < count; ++i) {
      rows.A(i, coordinate) += rows.unitWrench(i).force.dot(moved);  // (3.2)
    }
  }
}

// The derivative, as P sees it, of the velocity along each direction, for qdd = 0. The point of
// contact moves on the child.
void TouchConditions::setMotion(const LoopState& state, ConditionRows rows) const {
  const LinkKinematics& links = state.links;
  const FramePair& frames = rows.frames();
  const Vector3 centre = links.originOf(child()), r = centre - frames.Po;
  const LinkKinematics::PointMotion P = links.motionAt(parent().link, frames.Po);
  const LinkKinematics::PointMotion C = links.motionAt(child().link, centre);
  const Vector3 carried = P.w.cross(r), v = C.v - P.v - carried, w = C.w - P.w;
  const Vector3 a = C.a - P.a - P.alpha.cross(r) - P.w.cross(carried + 2 * v);
  const Vector3 alpha = C.alpha - P.alpha - P.w.cross(C.w);
  const Contact contact = contactOf(links, frames.R_P, w);
  const Vector3 velocity = v + w.cross(contact.lever);
  const Vector3 acceleration = a + alpha.cross(contact.lever) + w.cross(contact.leverd);
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const Vector3 direction = contact.R * directions_[i], turned = contact.Rd * directions_[i];
    rows.turning(static_cast<Eigen::Index>(i)) = direction.dot(acceleration) + turned.dot(velocity);
  }
}

const char* TouchConditions::fault(const LinkKinematics& links, double /*least*/) const {
  if (directions_.empty()) return nullptr;  // it is lifted
  const Vector3 normal = links.axisOf(parent(), 2);
  const bool wheel = type() == ClosureType::kRolling;
  if (wheel && has_axle_ && links.axisOf(child(), 2).cross(normal).norm() <= kLeastSine) {
    return "its axle is parallel to the plane's normal";
  }
  if (wheel && !has_normal_) {
    const Contact contact = contactOf(links, links.axesOf(parent()), Vector3::Zero());
    const Vector3 from_plane = links.originOf(child()) + contact.lever - links.originOf(parent());
    if (std::abs(normal.dot(from_plane)) > kLargestGap * (radius_ + tube_radius_)) {
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
  const Contact contact = contactOf(links, frames.R_P, moves.turn);
  moves.origin += contact.leverd;
  moves.turn = frames.R_C.col(0).cross(contact.Rd.col(0));
  return moves;
}

}  // namespace virtual_work_dynamics
