#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace virtual_work_dynamics {

/// Force and moment that the parent exerts on the child; the moment is about the joint origin O_k,
/// or about the point that Scene::moments_about gives.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m
};

/// Pose of a joint frame (the child link's frame) in the root link. Its position is the point that
/// the moment of the reaction is about.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_0K
};

/// Velocity of a joint frame in root axes.
struct Twist {
  /// Velocity of the child link at the point that the moment of the reaction is about, O_k as a
  /// rule, m/s.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Six flags of a wrench: fx fy fz tx ty tz.
using Determined = std::array<bool, 6>;
constexpr Determined kAllComponents{{true, true, true, true, true, true}};

/// How far a motion violates the conditions of one closure: the larger of two norms, that of the
/// conditions that are lengths and that of those that are directions.
struct ClosureResidual {
  double position = 0;      ///< m or rad
  double velocity = 0;      ///< m/s or rad/s
  double acceleration = 0;  ///< m/s^2 or rad/s^2
};

/// How much rigid-body mechanics determines at one position, by the null space of [S^T A^T].
struct Determinacy {
  int rank = 0;                   ///< rank of [S^T A^T]
  int redundant_constraints = 0;  ///< number of conditions less the rank of A
  int redundancy = 0;             ///< unknowns less rank: redundant constraints and over-actuation
  int free_motions = 0;           ///< motions that no actuated joint and no closure holds
  double gap = 0;                 ///< least entry counted for the rank, over the largest other
  double condition = 0;           ///< estimated condition of the determined part
};

/// Condition above which a position counts as close to singular: an error of 1e-4 rad may then
/// change a force by 100 %.
constexpr double kCloseToSingular = 1e4;

/// Whether a force acts as that can which makes it: see ClosedLoopDynamics::oneSided().
enum class Hold {
  kHolds,
  kWrongWay,      ///< a contact would have to pull, or a cable to push
  kOutsideCone,   ///< more would have to act along the plane than friction allows
  kNotDecidable,  ///< rigid-body mechanics does not determine the force
  kCanHold,       ///< nor does it, but what it leaves open can be chosen so that all forces hold
  kCannotHold     ///< nor does it, and no choice of what it leaves open makes all forces hold
};

/// A bound of each result of one sample, in the order of Results; see LoopResults::least.
struct ForceBounds {
  Eigen::VectorXd effort;
  std::vector<Wrench> child_axes, root_axes;
};

/// What closed loops add to the results of one sample; empty in an open chain.
struct LoopResults {
  Determinacy determinacy;
  /// Which results rigid-body mechanics determines, in the order of Results; empty unless
  /// Request::determinacy. Results that redundant constraints leave open have the value that the
  /// scene's policy chooses.
  std::vector<bool> effort_determined;
  std::vector<Determined> child_axes_determined, root_axes_determined;
  /// Which results have a value at all. In singular positions: what is determined, and reactions of
  /// which no more is open than in regular positions; see doc/closed_loops.md. Elsewhere: all.
  std::vector<bool> effort_exists;
  std::vector<Determined> child_axes_exist, root_axes_exist;

  /// By spring of the scene: whether its force has a direction. Not where its ends meet while it is
  /// longer at rest; what the force reaches then has no value.
  std::vector<bool> springs_directed;

  /// By what ClosedLoopDynamics::oneSided() names; the last two of Hold are for Request::can_hold.
  std::vector<Hold> holds;

  /// The least and the most that each result can be while contacts press inside their friction
  /// cones and cables pull, with this motion; empty unless Request::intervals. Both are the result
  /// where it is determined. Infinite where nothing bounds it; NaN where it does not exist, and
  /// where no forces hold. Never too narrow: friction cones count as up to 1e-4 wider than they
  /// are.
  ForceBounds least, most;

  /// By closure, then by coupling: Determinacy::condition of the loops that are solved together
  /// with its own.
  std::vector<double> closure_conditions;
  /// By closure, then by coupling: how far the motion violates it. These two are empty unless
  /// Request::residuals.
  std::vector<ClosureResidual> residuals;
  /// Residuals without units, to be compared with a tolerance: lengths over the size of the loops,
  /// velocities also over the largest rate of the motion, accelerations over its largest
  /// acceleration or the square of that rate. A largest rate below 1/s counts as 1/s, a largest
  /// acceleration below 1/s^2 as 1/s^2.
  std::vector<ClosureResidual> relative_residuals;
  /// How far each actuated closure has turned, within half a turn, or slid, in rad or m, and how
  /// fast, in rad/s or m/s; then the sum of each coupling, and its rate.
  Eigen::VectorXd actuated_positions, actuated_velocities;
  /// By coordinate: what actuators and couplings exert together, N m or N, which the tree that is
  /// left when closures, springs and couplings are cut needs to move so. Empty without couplings.
  Eigen::VectorXd tree_effort;
  /// Wrenches on the tree that is left when closures and springs are cut: the scene's own, then
  /// those of springs and closures, in root axes.
  std::vector<Wrench> tree_wrenches;
};

/// Results of one sample, in the order of the Request.
struct Results {
  /// Efforts, N m or N: one for each generalized coordinate, zero where it is passive, then one for
  /// each actuated closure, then one for each coupling. Empty when the request of an open chain
  /// leaves efforts out.
  Eigen::VectorXd effort;
  std::vector<Wrench> child_axes;  ///< of Request::child_axes
  std::vector<Wrench> root_axes;   ///< of Request::root_axes
  std::vector<Pose> poses;         ///< of Request::root_axes, if requested
  std::vector<Twist> twists;       ///< of Request::root_axes, if requested
  LoopResults loops;

  /// False when any result overflowed to infinity or NaN, as huge inputs can.
  bool finite() const;

  /// The efforts of the coordinates of Dynamics::tree(), which are those of actuators and
  /// couplings.
  Eigen::VectorXd::ConstSegmentReturnType treeEffort(Eigen::Index coordinates) const {
    return (loops.tree_effort.size() > 0 ? loops.tree_effort : effort).head(coordinates);
  }

  /// Whether actuated joints and closures do not hold the mechanism in its position.
  bool singular() const { return loops.determinacy.free_motions > 0; }
  /// Whether the force of a spring has no direction in the position.
  bool undirected() const {
    const std::vector<bool>& directed = loops.springs_directed;
    return std::find(directed.begin(), directed.end(), false) != directed.end();
  }
  /// Whether an effort has a value.
  bool effortExists(std::size_t i) const {
    return loops.effort_exists.empty() || loops.effort_exists[i];
  }
  /// Which components of a reaction in child axes have a value.
  Determined childAxesExist(std::size_t i) const {
    return loops.child_axes_exist.empty() ? kAllComponents : loops.child_axes_exist[i];
  }
  /// Which components of a reaction in root axes have a value.
  Determined rootAxesExist(std::size_t i) const {
    return loops.root_axes_exist.empty() ? kAllComponents : loops.root_axes_exist[i];
  }
};

}  // namespace virtual_work_dynamics
