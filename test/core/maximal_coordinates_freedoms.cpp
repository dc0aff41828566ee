#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "maximal_coordinates_oracle.h"
#include "tooth_geometry.h"
#include "touch_geometry.h"

// What the closures, joints and couplings of MaximalCoordinates let free.

namespace virtual_work_dynamics {

template <typename Real>
void MaximalCoordinates<Real>::addFree(std::size_t cut, bool moment, const Vector3l& direction) {
  Vector row = Vector::Zero(G_.cols());
  row.template segment<3>(at(cut) + (moment ? 3 : 0)) = direction.template cast<Real>();
  addRow(row, 0);
}

template <typename Real>
bool MaximalCoordinates<Real>::actuated(const std::string& name) const {
  if (!scene_.actuated) return mechanism_.jointIndex(name) >= 0;
  return std::count(scene_.actuated->begin(), scene_.actuated->end(), name) > 0;
}

template <typename Real>
void MaximalCoordinates<Real>::addFreeDirections(std::size_t c) {
  using Type = ClosureType;
  const Closure& closure = scene_.closures[c];
  const bool cylinder = closure.type == Type::kCylinder;
  if (isMesh(closure)) return addTeeth(c);
  if (actuated(closure.name) && !cylinder) return;  // one free direction carries the effort
  const std::size_t cut = mechanism_.joints().size() + 1 + c;
  const PlacedFrame parent(mechanism_, bodies_, closure.parent);
  const Matrix3l& R = cuts_[cut].R;
  const auto slide = [&](const Vector3l& direction) { addFree(cut, false, direction); };
  const auto turn = [&](const Vector3l& direction) { addFree(cut, true, direction); };
  const Type type = closure.type;
  if (type == Type::kRevolute || type == Type::kCylindrical || type == Type::kPlanar) {
    turn(R.col(2));
  }
  if (type == Type::kPrismatic || type == Type::kCylindrical) slide(R.col(2));
  if (type == Type::kPlanar) {
    slide(R.col(0));
    slide(R.col(1));
  }
  if (type == Type::kUniversal) {
    turn(parent.R.col(2));
    turn(R.col(0));
  }
  const bool touch = isTouch(closure);
  if (type == Type::kSpherical || type == Type::kDistance || cylinder || touch) {
    for (int i = 0; i < 3; ++i) turn(Vector3l::Unit(i));
  }
  if (touch) {
    for (const Vector3l& free : PlacedTouch(mechanism_, bodies_, closure).free) slide(free);
  }
  if (type == Type::kDistance || cylinder) {
    const Vector3l rod = (cuts_[cut].o - parent.o).normalized();
    const Vector3l across = rod.unitOrthogonal();
    slide(across);
    slide(rod.cross(across));
  }
}

// At the pitch point there is no moment, and no force across the line of action.
template <typename Real>
void MaximalCoordinates<Real>::addTeeth(std::size_t c) {
  const std::size_t cut = mechanism_.joints().size() + 1 + c;
  for (int i = 0; i < 3; ++i) addFree(cut, true, Vector3l::Unit(i));
  const Vector3l line = PlacedTeeth(mechanism_, bodies_, scene_.closures[c]).line(other_flank_[c]);
  const Vector3l across = line.unitOrthogonal();
  addFree(cut, false, across);
  addFree(cut, false, line.cross(across));
}

template <typename Real>
long double MaximalCoordinates<Real>::unitOf(std::size_t coupling) const {
  const std::string& first = scene_.couplings[coupling].terms.front().name;
  const Joint& joint = mechanism_.joint(mechanism_.jointIndex(first));
  return joint.type == JointType::kPrismatic ? 1 : length_;
}

template <typename Real>
typename MaximalCoordinates<Real>::Vector MaximalCoordinates<Real>::effortRow(
    int coordinate) const {
  Vector row = Vector::Zero(G_.cols());
  for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
    const Joint& joint = mechanism_.joints()[k];
    if (joint.coordinate != coordinate) continue;
    const Vector3l axis = cuts_[k].R * joint.axis_K;
    const bool slides = joint.type == JointType::kPrismatic;
    row.template segment<3>(at(k) + (slides ? 0 : 3)) =
        (joint.multiplier * axis * (slides ? 1 : length_)).template cast<Real>();
  }
  for (std::size_t c = 0; c < scene_.couplings.size(); ++c) {
    for (const NamedNumber& term : scene_.couplings[c].terms) {
      const Joint& joint = mechanism_.joint(mechanism_.jointIndex(term.name));
      if (joint.coordinate != coordinate) continue;
      row[columnOf(c)] -= static_cast<Real>(joint.multiplier * term.value * unitOf(c));
    }
  }
  return row;
}

template <typename Real>
void MaximalCoordinates<Real>::addPassiveCoordinates(const Motion& motion) {
  terms_.assign(mechanism_.coordinates().size(), 0);
  for (const JointTerms& terms : scene_.joints) {
    const Joint& joint = mechanism_.joints()[mechanism_.jointIndex(terms.joint)];
    const long double m = joint.multiplier;
    const long double q = m * motion.q[joint.coordinate] + joint.offset;
    const long double rate = scene_.static_motion ? 0 : motion.qd[joint.coordinate];
    const long double acceleration = scene_.static_motion ? 0 : motion.qdd[joint.coordinate];
    const long double s = std::clamp(m * rate / terms.coulomb_velocity, -1.0L, 1.0L);
    terms_[joint.coordinate] +=
        m * (terms.stiffness * (q - terms.rest) + terms.damping.value_or(0) * m * rate +
             terms.coulomb.value_or(0) * s * (3 - s * s) / 2 +
             terms.rotor_inertia * m * acceleration + terms.offset);
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (actuated(mechanism_.coordinateNames()[i])) continue;
    const Vector row = effortRow(static_cast<int>(i));
    const bool turns = mechanism_.unitOf(static_cast<int>(i)) == Unit::kRadian;
    const Real unit = turns ? static_cast<Real>(length_) : Real(1);
    addRow(row / unit, static_cast<Real>(-terms_[i]) / unit);
  }
}

template class MaximalCoordinates<double>;
template class MaximalCoordinates<long double>;

}  // namespace virtual_work_dynamics
