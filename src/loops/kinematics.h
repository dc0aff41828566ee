#pragma once

#include <Eigen/Core>
#include <vector>

#include "loops/closure_conditions.h"
#include "loops/condition.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The conditions of a mechanism, A qd + b = 0 (3.2) and, of those that have it, Phi(q, t) = 0
/// (3.3), at one position and motion: sets of conditions, of which the first are those of closures.
/// Everything in root axes. Nothing after construction allocates; copies share the sets.
class LoopKinematics {
 public:
  /// All conditions of the scene. @throws SceneError naming what is wrong with a closure.
  LoopKinematics(const Mechanism& mechanism, const Scene& scene);
  /// Sets of closures stand before others.
  LoopKinematics(const Mechanism& mechanism, ConditionSets sets);

  std::size_t sets() const { return sets_.size(); }
  std::size_t closures() const { return closures_.size(); }
  const ConditionSet& set(std::size_t set) const { return *sets_[set]; }
  const ClosureConditions& closure(std::size_t closure) const { return *closures_[closure]; }

  /// Number of conditions, of all sets.
  Eigen::Index conditions() const { return values_.phi.size(); }
  const Condition& condition(Eigen::Index i) const {
    return *conditions_[static_cast<std::size_t>(i)];
  }
  /// Conditions [firstOf(s), firstOf(s + 1)) are those of set s.
  Eigen::Index firstOf(std::size_t set) const { return first_[set]; }

  /// Of conditions that depend on time, s; 0 at first. Holds from the next position on.
  void setTime(double time) {
    placed_ = placed_ && state_.time == time;
    state_.time = time;
  }
  /// Poses of links, conditions and their Jacobian at a position. Costs nothing where they are at
  /// that position already.
  void setPosition(const Eigen::VectorXd& q);
  const Eigen::VectorXd& phi() const { return values_.phi; }  ///< m or rad; 0 where there is none
  const Eigen::MatrixXd& jacobian() const { return values_.A; }  ///< conditions x coordinates
  /// Conditions that adopt their constant from the assembly are met at the present position from
  /// now on; until then they demand nothing.
  void adoptConstants();

  /// Velocities and accelerations of the conditions at the present position.
  void setMotion(const Motion& motion);
  const Eigen::VectorXd& rates() const { return values_.rates; }  ///< A qd + b
  /// A qdd + Ad qd + bd
  const Eigen::VectorXd& accelerations() const { return values_.accelerations; }
  /// Whether b and its derivative bd can differ from zero, and what they are.
  bool drives() const { return drives_; }
  const Eigen::VectorXd& b() const { return values_.b; }
  const Eigen::VectorXd& bd() const { return values_.bd; }
  /// Norms of what of phi(), rates() or accelerations() are a set's lengths and directions.
  struct Norms {
    double lengths, directions;
  };
  Norms normsOf(std::size_t set, const Eigen::VectorXd& conditions) const;

  /// Of a multiplier of one; zero where that is no closure's.
  const ClosureWrench& unitWrench(Eigen::Index condition) const {
    return values_.unit_wrenches[static_cast<std::size_t>(condition)];
  }
  /// Of a unit effort about or along the free axis of a revolute or prismatic closure.
  ClosureWrench unitEffort(std::size_t closure) const;
  /// Adds the generalized force of such a wrench on the child and its opposite on the parent.
  template <typename Vector>
  void addGeneralizedForce(std::size_t closure, const ClosureWrench& wrench, Vector&& force) const {
    const Eigen::Vector3d at = childOrigin(closure);
    for (const PathStep& step : closures_[closure]->path()) {
      const int coordinate = links().coordinateOf(step);
      if (coordinate >= 0) force[coordinate] += links().workOf(step, at, wrench);
    }
  }

  const LinkKinematics& links() const { return state_.links; }
  const Eigen::Matrix3d& axesOf(int link) const { return links().axesOf(link); }
  const Eigen::Vector3d& originOf(int link) const { return links().originOf(link); }
  /// Axis of a joint; zero for fixed ones.
  const Eigen::Vector3d& axisOf(int joint) const { return links().axisOf(joint); }

  /// Of closures; see ClosureConditions.
  Eigen::Vector3d freeAxis(std::size_t c) const { return closures_[c]->freeAxis(links()); }
  double freePosition(std::size_t c) const { return closures_[c]->freePosition(links()); }
  double freeVelocity(std::size_t c) const { return closures_[c]->freeVelocity(links()); }
  bool reversed(std::size_t c) const { return closures_[c]->reversed(links()); }
  const std::vector<PathStep>& path(std::size_t c) const { return closures_[c]->path(); }
  Eigen::Vector3d parentOrigin(std::size_t c) const {
    return links().originOf(closures_[c]->parent());
  }
  Eigen::Vector3d childOrigin(std::size_t c) const {
    return links().originOf(closures_[c]->child());
  }
  Eigen::Matrix3d childAxes(std::size_t c) const { return links().axesOf(closures_[c]->child()); }
  Twist childTwist(std::size_t c) const;

 private:
  ConditionRows rowsOf(std::size_t set) { return {values_, first_[set]}; }
  void subtractConstants();

  ConditionSets sets_;
  std::vector<const ClosureConditions*> closures_;  // the first of these
  std::vector<const Condition*> conditions_;
  std::vector<Eigen::Index> first_;
  bool drives_ = false;
  std::vector<Eigen::Index> adopting_;  // conditions
  bool adopted_ = false;
  bool placed_ = false;        // at the position of the state
  Eigen::VectorXd constants_;  // of these; of the present position until they are adopted
  LoopState state_;
  ConditionValues values_;
};

}  // namespace virtual_work_dynamics
