#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A planar four-bar linkage A-B-C-D with revolute joints in space: crank AB and rocker DC turn on
/// ground, and the coupler BC joins them. Its plane lies obliquely in the root link. Any of the
/// four joints can be the one that is cut; the linkage is always driven at A.
class FourBar {
 public:
  using Real = long double;
  using Vector2 = Eigen::Matrix<Real, 2, 1>;
  enum Body { kCrank, kCoupler, kRocker };

  struct Turning {
    Real angle, rate, acceleration;  ///< of a body's x axis, from its first pivot to its second
  };
  using Turnings = std::array<Turning, 3>;

  /// Makes the linkage; `unit` scales all lengths, as a change of the unit of length does.
  explicit FourBar(Real unit = 1);

  /// Lengths of crank, coupler, rocker, and ground from A to D.
  std::array<Real, 4> lengths = {0.25L, 0.7L, 0.55L, 0.8L};
  struct Inertia {
    Real mass;
    Vector3l centre;  ///< centre of mass from the body's first pivot, in its axes
    Real moment;      ///< moment of inertia about the centre, normal to the plane
  };
  std::array<Inertia, 3> bodies;
  Eigen::Vector3d gravity;                          ///< gravity in axes of the plane
  const Eigen::Vector3d plane_rpy{0.4, -0.9, 1.3};  ///< orientation of the plane in the root link

  Matrix3l planeAxes() const;

  /// Computes the turnings of all bodies from that of the crank: the intersection of two circles,
  /// elbow up, and its derivatives.
  Turnings turnings(Real angle, Real rate, Real acceleration) const;

  /// The linkage cut at a pivot, 'A' to 'D': a tree with joints named after the other pivots and a
  /// closure named after this one, and how the bodies hang.
  struct Cut {
    Mechanism mechanism;
    Scene scene;
    struct Hanging {
      char pivot;
      int body, parent;  ///< of FourBar::Body; -1: ground
    };
    std::vector<Hanging> joints;  ///< in the mechanism's order
    Hanging closure;
    /// The motion of the tree's joints.
    Motion motion(const Turnings& turnings) const;
  };
  Cut cut(char pivot) const;

  /// Forces at the pivots and torque of ground on the crank, in the plane, by free-body diagrams.
  struct Forces {
    std::map<char, Vector2> on_body;  ///< A: on crank, B: on coupler, C, D: on rocker; plane axes
    Real torque;
  };
  Forces freeBodies(const Turnings& turnings) const;

  static Vector2 along(Real angle) { return {std::cos(angle), std::sin(angle)}; }
  static Vector2 normal(Real angle) { return {-std::sin(angle), std::cos(angle)}; }

 private:
  static Vector2 turned(const Vector3l& v, Real angle);
  template <typename System>
  static void addMoment(System& equations, int row, int pivot, const Vector2& at, Real sign) {
    equations(row, 2 * pivot) = -sign * at.y();
    equations(row, 2 * pivot + 1) = sign * at.x();
  }
  // The acceleration of the body's first pivot.
  Vector2 pivotAcceleration(int body, const Turnings& turnings) const;
  // The place of a pivot, from the body's first one.
  Vector3l place(int body, char pivot) const;

  Cut cut(const std::vector<Cut::Hanging>& joints, const Cut::Hanging& closure) const;
};

}  // namespace virtual_work_dynamics
