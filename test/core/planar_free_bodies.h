#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "exact_derivatives.h"

namespace virtual_work_dynamics {

/// Computes forces of a mechanism in the plane by free-body diagrams: for each body two balances of
/// force and one of moment. The unknowns are the two components of force in each pin, the couples
/// of motors, and force and couple of guides. A mechanism is written by hand, with the places of
/// centres of mass and pins as functions of time in closed form; accelerations are their
/// differences. All this is independent of the package's descriptions and of everything that it
/// computes.
class PlanarFreeBodies {
 public:
  using Vector2l = Eigen::Matrix<long double, 2, 1>;
  using Vector3l = Eigen::Matrix<long double, 3, 1>;
  using Place = std::function<Vector3l(long double)>;  ///< x, y, angle
  using Point = std::function<Vector2l(long double)>;
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

  static constexpr int kBase = -1;

  PlanarFreeBodies(long double t, const Vector2l& gravity) : t_(t), gravity_(gravity) {}

  /// Adds a body by the place of its centre of mass; `inertia` is the moment of inertia about that.
  /// @returns its index.
  int body(long double mass, long double inertia, const Place& place) {
    const auto exact = withDerivatives(place, t_);
    Vector3l demand = mass * exact.acceleration;
    demand.head<2>() -= mass * gravity_;
    demand.z() = inertia * exact.acceleration.z();
    centres_.push_back(exact.value.head<2>());
    demands_.push_back(demand);
    return static_cast<int>(centres_.size()) - 1;
  }

  /// Adds a pin. @returns the index in the solution of the force, x then y, that body a exerts on
  /// body b in it.
  int pin(int a, int b, const Point& point) {
    const int index = static_cast<int>(unknowns_.size());
    for (const Vector2l& direction : {Vector2l(1, 0), Vector2l(0, 1)}) {
      unknowns_.push_back({a, b, point(t_), direction, 0});
    }
    return index;
  }
  /// Adds a motor. @returns the index in the solution of the couple that body a exerts on body b.
  int motor(int a, int b) {
    unknowns_.push_back({a, b, Vector2l::Zero(), Vector2l::Zero(), 1});
    return static_cast<int>(unknowns_.size()) - 1;
  }

  Vector solve() const {
    const Eigen::Index equations = 3 * static_cast<Eigen::Index>(centres_.size());
    Matrix G = Matrix::Zero(equations, static_cast<Eigen::Index>(unknowns_.size()));
    Vector b(equations);
    for (std::size_t i = 0; i < demands_.size(); ++i) {
      b.segment<3>(3 * static_cast<Eigen::Index>(i)) = demands_[i];
    }
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      const Unknown& unknown = unknowns_[u];
      for (const int sign : {1, -1}) {
        const int body = sign > 0 ? unknown.on : unknown.by;
        if (body == kBase) continue;
        const Vector2l r = unknown.point - centres_[static_cast<std::size_t>(body)];
        const Vector2l& f = unknown.direction;
        G.col(static_cast<Eigen::Index>(u)).segment<3>(3 * body) +=
            sign * Vector3l(f.x(), f.y(), r.x() * f.y() - r.y() * f.x() + unknown.couple);
      }
    }
    return G.fullPivLu().solve(b);
  }

 private:
  struct Unknown {
    int by, on;
    Vector2l point, direction;
    long double couple;
  };

  long double t_;
  Vector2l gravity_;
  std::vector<Vector2l> centres_;
  std::vector<Vector3l> demands_;
  std::vector<Unknown> unknowns_;
};

}  // namespace virtual_work_dynamics
