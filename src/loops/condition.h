#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "loops/closure_wrench.h"
#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A condition on the motion of a mechanism: a row of A qd + b = 0 (3.2). Its multiplier is the
/// effort of what enforces it, and A^T maps it to generalized forces.
struct Condition {
  std::string name;
  /// Unit of Phi, or of the row's integral where there is no Phi. The row's values are in this unit
  /// per second, its multiplier in the matching effort, N m or N.
  Unit unit = Unit::kMetre;
  /// Whether the row is the derivative of a Phi(q, t) = 0 (3.3). Otherwise it restricts velocities
  /// and accelerations, but not positions.
  bool has_position = true;
  /// Whether the value of Phi in the assembly is subtracted from Phi; until then the condition
  /// demands nothing.
  bool adopts_constant = false;
  /// Whether b, or its derivative, can differ from zero: the condition moves by itself.
  bool drives = false;
};

/// Position and motion of a mechanism.
struct LoopState {
  explicit LoopState(const Mechanism& mechanism);
  LinkKinematics links;
  Eigen::VectorXd q, qd, qdd;
  double time = 0;  ///< s
};

/// Values of all conditions; each set writes its own entries.
struct ConditionValues {
  ConditionValues(Eigen::Index conditions, Eigen::Index coordinates);
  Eigen::VectorXd phi;
  Eigen::MatrixXd A;                         ///< conditions x coordinates
  Eigen::VectorXd rates;                     ///< A qd + b
  Eigen::VectorXd accelerations;             ///< A qdd + Ad qd + bd
  Eigen::VectorXd b, bd;                     ///< zero where a condition does not drive
  std::vector<ClosureWrench> unit_wrenches;  ///< of a multiplier of one; zero without a wrench
};

/// The values of one set, counted from its first condition.
class ConditionRows {
 public:
  ConditionRows(ConditionValues& values, Eigen::Index first) : values_(values), first_(first) {}

  double& phi(Eigen::Index i) { return values_.phi[first_ + i]; }
  double& A(Eigen::Index i, int coordinate) { return values_.A(first_ + i, coordinate); }
  double& rate(Eigen::Index i) { return values_.rates[first_ + i]; }
  double& acceleration(Eigen::Index i) { return values_.accelerations[first_ + i]; }
  double& b(Eigen::Index i) { return values_.b[first_ + i]; }
  double& bd(Eigen::Index i) { return values_.bd[first_ + i]; }
  ClosureWrench& unitWrench(Eigen::Index i) {
    return values_.unit_wrenches[static_cast<std::size_t>(first_ + i)];
  }

 private:
  ConditionValues& values_;
  Eigen::Index first_;
};

/// The conditions of one closure, gear or drive. A set is immutable, so that threads can share it.
class ConditionSet {
 public:
  /// @param place how messages about it begin: "closures: 'pin'"
  /// @param coordinates those that its rows have entries for, ascending
  ConditionSet(std::string place, std::vector<Condition> conditions, std::vector<int> coordinates)
      : place_(std::move(place)),
        conditions_(std::move(conditions)),
        coordinates_(std::move(coordinates)) {}
  virtual ~ConditionSet() = default;

  const std::string& place() const { return place_; }
  const std::vector<Condition>& conditions() const { return conditions_; }
  const std::vector<int>& coordinates() const { return coordinates_; }

  /// Sets phi where there is one, A, and the unit wrenches of a closure, from q and time. Does not
  /// allocate.
  virtual void setPosition(const LoopState& state, ConditionRows rows) const = 0;
  /// Sets rates and accelerations, and for conditions that drive b and bd. Does not allocate.
  virtual void setMotion(const LoopState& state, ConditionRows rows) const = 0;

 private:
  std::string place_;
  std::vector<Condition> conditions_;
  std::vector<int> coordinates_;
};

using ConditionSets = std::vector<std::shared_ptr<const ConditionSet>>;

/// Makes all conditions of a scene: those of closures first, in the scene's order.
/// @throws SceneError naming what is wrong with a closure.
ConditionSets makeConditions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
