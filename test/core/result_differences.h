#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// The numbers of results, bit for bit.
class Bits {
 public:
  Bits& add(double number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof(number));
    return *this;
  }
  template <typename Derived>
  Bits& add(const Eigen::MatrixBase<Derived>& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) add(numbers(i));
    return *this;
  }
  Bits& add(const Wrench& wrench) { return add(wrench.force).add(wrench.torque); }
  Bits& add(const Pose& pose) { return add(pose.position).add(pose.orientation.coeffs()); }
  Bits& add(const Twist& twist) { return add(twist.linear).add(twist.angular); }
  Bits& add(const ClosureResidual& residual) {
    return add(residual.position).add(residual.velocity).add(residual.acceleration);
  }
  Bits& add(const Determinacy& determinacy) {
    for (const int count : {determinacy.rank, determinacy.redundant_constraints,
                            determinacy.redundancy, determinacy.free_motions}) {
      add(static_cast<double>(count));
    }
    return add(determinacy.gap).add(determinacy.condition);
  }
  template <typename Item>
  Bits& add(const std::vector<Item>& items) {
    add(static_cast<double>(items.size()));
    for (const Item& item : items) add(item);
    return *this;
  }

  bool operator!=(const Bits& other) const { return bytes_ != other.bytes_; }

 private:
  std::string bytes_;
};

/// Names of the results of a sample that differ in any bit; empty: none does.
inline std::string differences(const Results& a, const Results& b) {
  std::string names;
  const auto compare = [&](const char* name, const auto& of_a, const auto& of_b) {
    if (of_a.size() != of_b.size() || Bits().add(of_a) != Bits().add(of_b)) {
      names += std::string(" ") + name;
    }
  };
  const auto compareFlags = [&](const char* name, const auto& of_a, const auto& of_b) {
    if (of_a != of_b) names += std::string(" ") + name;
  };
  compare("effort", a.effort, b.effort);
  compare("child_axes", a.child_axes, b.child_axes);
  compare("root_axes", a.root_axes, b.root_axes);
  compare("poses", a.poses, b.poses);
  compare("twists", a.twists, b.twists);
  const LoopResults &loops = a.loops, &others = b.loops;
  if (Bits().add(loops.determinacy) != Bits().add(others.determinacy)) names += " determinacy";
  compareFlags("effort_determined", loops.effort_determined, others.effort_determined);
  compareFlags("child_axes_determined", loops.child_axes_determined, others.child_axes_determined);
  compareFlags("root_axes_determined", loops.root_axes_determined, others.root_axes_determined);
  compareFlags("effort_exists", loops.effort_exists, others.effort_exists);
  compareFlags("child_axes_exist", loops.child_axes_exist, others.child_axes_exist);
  compareFlags("root_axes_exist", loops.root_axes_exist, others.root_axes_exist);
  compare("closure_conditions", loops.closure_conditions, others.closure_conditions);
  compare("residuals", loops.residuals, others.residuals);
  compare("relative_residuals", loops.relative_residuals, others.relative_residuals);
  compare("actuated_positions", loops.actuated_positions, others.actuated_positions);
  compare("actuated_velocities", loops.actuated_velocities, others.actuated_velocities);
  compareFlags("holds", loops.holds, others.holds);
  compare("tree_wrenches", loops.tree_wrenches, others.tree_wrenches);
  return names;
}

}  // namespace virtual_work_dynamics
