#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "loops/condition.h"

namespace virtual_work_dynamics {

// Kinds of conditions that are none of a closure, made through ConditionSet alone.

/// q_i = ratio q_j + constant, i > j: its multiplier is what the gear exerts on coordinate i.
class Gear : public ConditionSet {
 public:
  Gear(const Mechanism& mechanism, int i, int j, double ratio, double constant)
      : Gear(mechanism, i, j, ratio, constant, false) {}
  /// The constant is that of the assembly.
  Gear(const Mechanism& mechanism, int i, int j, double ratio)
      : Gear(mechanism, i, j, ratio, 0, true) {}

  void setPosition(const LoopState& state, ConditionRows rows) const override {
    rows.phi(0) = state.q[i_] - ratio_ * state.q[j_] - constant_;
    rows.A(0, i_) = 1;
    rows.A(0, j_) = -ratio_;
  }
  void setMotion(const LoopState&, ConditionRows) const override {}

 private:
  Gear(const Mechanism& mechanism, int i, int j, double ratio, double constant, bool adopts)
      : ConditionSet("gears: 'gear'", {{"gear", mechanism.unitOf(i), true, adopts, false}}, {j, i}),
        i_(i),
        j_(j),
        ratio_(ratio),
        constant_(constant) {}

  int i_, j_;
  double ratio_, constant_;
};

/// A function of time with its derivatives.
struct Law {
  std::function<double(double)> f, fd, fdd;
};

/// q_i = f(t).
class Drive : public ConditionSet {
 public:
  Drive(const Mechanism& mechanism, int i, Law law)
      : ConditionSet("drives: 'drive'", {{"drive", mechanism.unitOf(i), true, false, true}}, {i}),
        i_(i),
        law_(std::move(law)) {}

  void setPosition(const LoopState& state, ConditionRows rows) const override {
    rows.phi(0) = state.q[i_] - law_.f(state.time);
    rows.A(0, i_) = 1;
  }
  void setMotion(const LoopState& state, ConditionRows rows) const override {
    rows.b(0) = -law_.fd(state.time);
    rows.bd(0) = -law_.fdd(state.time);
  }

 private:
  int i_;
  Law law_;
};

/// A blade at the angle q_2 on a plane with coordinates q_0, q_1, which moves sideways at a speed
/// that is given, u(t) = f(t): -sin(q_2) qd_0 + cos(q_2) qd_1 = u. No Phi has that derivative.
class Blade : public ConditionSet {
 public:
  explicit Blade(Law speed)
      : ConditionSet("blades: 'blade'", {{"blade", Unit::kMetre, false, false, true}}, {0, 1, 2}),
        speed_(std::move(speed)) {}

  void setPosition(const LoopState& state, ConditionRows rows) const override {
    rows.A(0, 0) = -std::sin(state.q[2]);
    rows.A(0, 1) = std::cos(state.q[2]);
  }
  void setMotion(const LoopState& state, ConditionRows rows) const override {
    const double s = std::sin(state.q[2]), c = std::cos(state.q[2]);
    rows.b(0) = -speed_.f(state.time);
    rows.bd(0) = -speed_.fd(state.time);
    rows.turning(0) = -state.qd[2] * (c * state.qd[0] + s * state.qd[1]);
  }

 private:
  Law speed_;
};

}  // namespace virtual_work_dynamics
