#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/least_norms.h"
#include "core/loop_groups.h"
#include "core/loop_kinematics.h"
#include "core/loop_scene.h"
#include "core/rank_factorization.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Efforts and closures' wrenches of one group of loops, (3.1)-(3.4): S^T tau + A^T lambda =
/// tau_tree, G x = b, with x the efforts of actuated coordinates, those of actuated closures, and
/// the multipliers. Everything is made a force by a length, so that rank and least norms do not
/// depend on units. Nothing after construction allocates.
class LoopForces {
 public:
  /// All must outlive it.
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
  Eigen::Index coordinates() const { return G_.rows(); }
  Eigen::Index unknowns() const { return G_.cols(); }
  Eigen::Index rank() const { return factorization_.rank(); }
  double gap() const { return factorization_.gap(); }
  double condition() const { return factorization_.condition(); }
  /// Dimension of the multipliers that load no coordinate. Known after solve().
  Eigen::Index redundantConstraints() const { return redundant_constraints_; }
  /// Whether a coordinate of the group takes part in a motion that nothing holds.
  bool isFree(Eigen::Index local) const;

  /// The solution, or a change of it that mechanics leaves open.
  struct State {
    Eigen::VectorXd x;
    std::vector<ClosureWrench> closures;
  };
  const State& solution() const { return solution_; }
  /// Unit vectors that span the changes, all moments over the length. In a singular position that
  /// cannot bear the load, these include all that shifting the load between the coordinates that
  /// move freely would change.
  Eigen::Index directions() const { return direction_count_; }
  const State& direction(Eigen::Index i);
  double length() const { return length_; }

  /// Efforts of a state: actuated coordinates of the group, then its actuated closures.
  struct Effort {
    std::size_t index;  ///< into ClosedLoopDynamics::effort()
    double unit;        ///< N m or N for an entry of x of one
  };
  const std::vector<Effort>& efforts() const { return efforts_; }

  /// What a state adds to the wrench of a crossed joint, about the joint's origin. Root axes.
  ClosureWrench jointWrench(const LoopGroup::CrossedJoint& joint, const State& state) const;

 private:
  struct Column {
    std::size_t closure;     // index into the group's
    Eigen::Index condition;  // -1: the effort along its free axis
    double unit;
  };
  void addColumns(const Mechanism& mechanism, const LoopScene& scene);
  void addCosts(const LoopScene& scene);
  void bearLoad();
  void choose(const std::vector<Wrench>& tree_reactions);
  void addOpenLoads();
  void putCosts(const State& state, const std::vector<Wrench>* tree_reactions,
                Eigen::Ref<Eigen::VectorXd> costs) const;
  void setClosures(State& state) const;

  const LoopKinematics& kinematics_;
  LoopGroup group_;
  double rank_tolerance_, length_;
  std::vector<double> row_units_;
  std::vector<Effort> efforts_;
  std::vector<Eigen::Index> effort_rows_;  // of actuated coordinates
  std::vector<Column> columns_;            // behind those of actuated coordinates
  std::vector<ClosureWrench> unit_wrenches_;
  // Factors of reactions whose squares the policy keeps small; zero where it does not care.
  std::vector<double> closure_costs_, joint_costs_;
  Eigen::Index cost_rows_ = 0;

  Eigen::MatrixXd G_, G_transposed_;
  RankFactorization factorization_, transposed_;
  LeastNorms norms_;
  Eigen::VectorXd load_, gathered_;
  bool bears_ = true;  // whether the load is in the range of G
  Eigen::Index redundant_constraints_ = 0;
  Eigen::Index direction_count_ = 0;
  Eigen::MatrixXd directions_;
  State solution_, change_;
};

}  // namespace virtual_work_dynamics
