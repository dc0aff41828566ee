#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "loops/closure_wrench.h"
#include "loops/kernel/loop_kernel.h"
#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
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
  Eigen::VectorXd q, qd;
  double time = 0;  ///< s
  Motion driven;    ///< numbers that conditions drive by, see Given; empty where none does
};

/// The frames that a closure joins, in root axes; in the order of FrameNumber.
struct FramePair {
  Eigen::Matrix3d R_P = Eigen::Matrix3d::Identity(), R_C = R_P;
  Eigen::Vector3d Po = Eigen::Vector3d::Zero(), Co = Po;  ///< m
};

static_assert(sizeof(FramePair) == kFrameNumbers * sizeof(double), "plain numbers");
static_assert(sizeof(ClosureWrench) == kWrenchNumbers * sizeof(double), "plain numbers");

/// Values of all conditions; each set writes its own entries.
struct ConditionValues {
  ConditionValues(Eigen::Index conditions, Eigen::Index coordinates, std::size_t sets);
  Eigen::VectorXd phi;
  Eigen::MatrixXd A;        ///< conditions x coordinates
  Eigen::VectorXd turning;  ///< Ad qd
  Eigen::VectorXd b, bd;    ///< zero where a condition does not drive
  /// Roundings of Phi; where Phi adopts its constant, what is less is none. Zero where it is not
  /// said.
  Eigen::VectorXd roundings;
  std::vector<ClosureWrench> unit_wrenches;  ///< of a multiplier of one; zero without a wrench
  std::vector<FramePair> frames;             ///< by set; those of a closure
};

/// The values of one set, counted from its first condition.
class ConditionRows {
 public:
  ConditionRows(ConditionValues& values, std::size_t set, Eigen::Index first)
      : values_(values), set_(set), first_(first) {}

  double& phi(Eigen::Index i) { return values_.phi[first_ + i]; }
  double& rounding(Eigen::Index i) { return values_.roundings[first_ + i]; }
  double& A(Eigen::Index i, int coordinate) { return values_.A(first_ + i, coordinate); }
  /// The entries of the set's rows for a coordinate.
  double* column(int coordinate) { return values_.A.col(coordinate).data() + first_; }
  double& turning(Eigen::Index i) { return values_.turning[first_ + i]; }
  double& b(Eigen::Index i) { return values_.b[first_ + i]; }
  double& bd(Eigen::Index i) { return values_.bd[first_ + i]; }
  ClosureWrench& unitWrench(Eigen::Index i) {
    return values_.unit_wrenches[static_cast<std::size_t>(first_ + i)];
  }
  FramePair& frames() { return values_.frames[set_]; }
  /// All of them for a kernel.
  ClosureNumbers numbers() {
    return {values_.phi.data() + first_,
            values_.A.data() + first_,
            static_cast<std::size_t>(values_.A.rows()),
            reinterpret_cast<double*>(values_.unit_wrenches.data() + first_),
            frames().R_P.data(),
            values_.turning.data() + first_};
  }

 private:
  ConditionValues& values_;
  std::size_t set_;
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

  /// The joints whose levers tell how large its rows are where nothing cancels; null: its entries
  /// tell.
  virtual const std::vector<PathStep>* levers() const { return nullptr; }

  /// Whether its rows are the same in every position, so that no step to where they are met is too
  /// long.
  virtual bool isLinear() const { return false; }

  /// Sets phi where there is one, A, and the frames and unit wrenches of a closure, from q and
  /// time. Does not allocate.
  virtual void setPosition(const LoopState& state, ConditionRows rows) const = 0;
  /// Sets Ad qd from q, qd and time, and for conditions that drive b and bd. Does not allocate.
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
