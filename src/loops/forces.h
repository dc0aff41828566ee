#pragma once

#include <Eigen/Core>
#include <vector>

#include "algebra/least_norms.h"
#include "algebra/multifrontal_qr.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "loops/rank.h"
#include "loops/unknowns.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Solves for the efforts and closures' wrenches of one group of loops, (3.1) with (3.2): S^T tau +
/// A^T lambda = tau_tree, in units of force B x = load, where x holds the efforts of actuated
/// coordinates, those of actuated closures, and the multipliers of all conditions, with or without
/// a wrench. A length turns everything into forces, so that rank and least norms do not depend on
/// units. Far from singular positions B is factorised loop by loop, at a cost that grows with their
/// number; where the condition number leaves the rank in doubt, it is factorised as a whole.
/// Nothing after construction allocates.
class LoopForces {
 public:
  /// All arguments must outlive it.
  LoopForces(const Mechanism& mechanism, const LoopKinematics& kinematics, const LoopScene& scene,
             const LoopGroup& group, double length);

  /// Finds rank and null space at the position of the kinematics.
  void setPosition();
  /// Solves for the efforts of the tree, joint terms included. What rigid-body mechanics leaves
  /// open follows the scene's policy: first the efforts of least weighted norm, then the reactions.
  /// @param tree_reactions by joint, without the closures, root axes; the policy kStiffness needs
  ///   those of the group's joints.
  void solve(const Eigen::VectorXd& tree_effort, const std::vector<Wrench>& tree_reactions);

  const LoopGroup& group() const { return group_; }
  Eigen::Index coordinates() const { return qr_.columns(); }
  Eigen::Index unknowns() const { return qr_.rows(); }
  Eigen::Index rank() const { return sound_ ? coordinates() : rank_.rank(); }
  double gap() const;
  /// Of B where the rank is full, with the sizes of ConditionSizes in place of what cancels; else
  /// of the part that counts for the rank.
  double condition() const;
  /// Dimension of the space of multipliers that load no coordinate. Known after solve().
  Eigen::Index redundantConstraints() const { return redundant_constraints_; }
  /// Whether a coordinate of the group takes part in a motion that nothing holds.
  bool isFree(Eigen::Index local) const;
  /// How large a part it takes in such motions, as the norm of its entries in their orthonormal
  /// basis.
  double partInFreeMotions(Eigen::Index local) const;
  /// Whether a solution exists: what solve() was given loads no free motion. Known after solve().
  bool bears() const { return bears_; }

  /// The solution, or a change of it that mechanics leaves open.
  struct State {
    Eigen::VectorXd x;
    std::vector<ClosureWrench> closures;
    /// Indices of the group's closures and of efforts() that the state changes; the others are
    /// zero.
    std::vector<std::size_t> touched_closures, touched_efforts;
    std::vector<std::size_t> touched_others;  ///< sets without a wrench
    /// Moment by which the wrench of one closure is shifted on the joints that it passes through.
    std::size_t shifted = 0;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  };
  const State& solution() const { return solution_; }
  /// Number of unit vectors that span the changes, with moments divided by the length. In a
  /// singular position that cannot bear the load, they include every change that shifting the load
  /// between the freely moving coordinates would make, and what the unlimited wrenches that would
  /// bear it beside the position change when they turn with its joints.
  Eigen::Index directions() const { return direction_count_; }
  /// One of these unit vectors; valid until the next call.
  const State& direction(Eigen::Index i);
  double length() const { return length_; }
  /// Whether an unknown is the same in all solutions.
  bool isDetermined(Eigen::Index unknown);
  /// A component is determined when no direction changes it by more than this. Near a singular
  /// position directions, like results, are known only to rounding errors times the condition.
  double leastChange() const;

  const std::vector<LoopUnknowns::Effort>& efforts() const { return unknowns_.efforts; }

  // For samples side by side; see SamplePack.
  const MultifrontalQr& factorization() const { return qr_; }
  double largestSize() const { return rank_.largestSize(); }
  double sureCondition() const { return MultifrontalQr::sureCondition(rank_tolerance_); }
  /// Whether efforts are the same in all solutions by the pattern of B alone: where the rank is
  /// full, its null space is that of conditions that load nothing.
  bool effortsFollow() const { return efforts_follow_; }
  /// Number of blocks of the factorization before those of the sets.
  std::size_t effortBlocks() const { return unknowns_.effort_rows.size(); }
  double rowUnit(std::size_t row) const { return unknowns_.row_units[row]; }
  /// Of a set: how its rows become those of its block, the units of its unknowns, and the first.
  ScaledColumns columnsOf(std::size_t local) const {
    const std::vector<ScaledColumn>& columns = entries_[local].columns;
    return {columns.data(), static_cast<int>(columns.size()),
            static_cast<int>(entries_[local].units.size())};
  }
  const double* unitsOf(std::size_t local) const { return entries_[local].units.data(); }
  Eigen::Index firstUnknownOf(std::size_t local) const { return unknowns_.of_sets[local].first; }
  /// Whether an effort with this part in the null space is the same in all solutions.
  static bool isUnique(double null_square);
  /// The largest for which it is: of an effort in a change, a unit vector, that is rounding.
  static constexpr double kLargestUnique = 1e-10 * 1e-10;
  /// A solution among those of a pack, of which `width` neighbouring numbers belong together.
  struct PackedSolution {
    const double *x, *closures, *condition, *numbers;
    const FrontState* states;
    const int* stairs;
    std::size_t width, sample;
    bool chosen;  ///< whether efforts were chosen along the one change that was open
  };
  /// Takes over a solution that leaves no other choice.
  /// @param whole the factorization, too, which direction() needs
  void takeSample(const PackedSolution& packed, bool whole);

  /// What a state adds to the wrench of a crossed joint, about the joint's origin, in root axes.
  ClosureWrench jointWrench(const LoopGroup::CrossedJoint& joint, const State& state) const;

 private:
  void addCosts(const LoopScene& scene);
  void setEntries();
  bool isClosure(std::size_t local) const { return local < group_.closures.size(); }
  void gatherForce(const LoopUnknowns::OfSet& own, const ClosureWrench& wrench);
  void bearLoad();
  void solveWhole(Eigen::Ref<Eigen::VectorXd> x) const;
  void choose(const std::vector<Wrench>& tree_reactions);
  void chooseAlong();
  bool chooseOnFlanks(const std::vector<Wrench>& tree_reactions);
  bool effortsAreUnique();
  void startNorms();
  void addOpenLoads();
  void addTurns();
  void addTurn(std::size_t local, const PathStep& step);
  void putCosts(const State& state, const std::vector<Wrench>* tree_reactions,
                Eigen::Ref<Eigen::VectorXd> costs) const;
  void touchAll(State& state) const;
  void setClosures(State& state) const;
  void setTeeth(State& state) const;
  bool turnsFlank(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const;

  const LoopKinematics& kinematics_;
  LoopGroup group_;
  LoopUnknowns unknowns_;
  double rank_tolerance_, length_;
  // Factors of reactions whose squares the policy keeps small; zero for those that it ignores.
  std::vector<double> closure_costs_, joint_costs_;
  Eigen::Index cost_rows_ = 0;

  MultifrontalQr qr_;  // of the transpose of B
  LoopRank rank_;
  // Whether qr_ holds a factorization; otherwise rank_ does.
  bool sound_ = true;
  const std::vector<bool> all_;  // coordinates
  bool efforts_follow_;
  LeastNorms norms_;
  Eigen::VectorXd load_, gathered_;
  /// How the rows of a set become those of qr_.
  struct Entries {
    std::vector<ScaledColumn> columns;
    std::vector<double> units;  // of its multipliers
  };
  std::vector<Entries> entries_;  // by set
  const LoopFunctions* kernel_;
  bool bears_ = true;  // whether the load is in the range of B
  Eigen::Index redundant_constraints_ = 0;
  Eigen::Index direction_count_ = 0;
  Eigen::MatrixXd directions_;
  /// What a change adds to the wrench of a closure besides its multipliers.
  struct Turn {
    std::size_t local;
    ClosureWrench wrench;
    Eigen::Vector3d shift;
  };
  std::vector<Turn> turns_;  // of the last directions
  State solution_, change_;
};

}  // namespace virtual_work_dynamics
