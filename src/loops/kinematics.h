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

/// The conditions of a mechanism at one position and motion: A qd + b = 0 (3.2) and, where there is
/// a position level, Phi(q, t) = 0 (3.3). They come in sets, those of closures first. Everything is
/// in root axes. Nothing after construction allocates; copies share the sets.
class LoopKinematics {
 public:
  /// Makes all conditions of the scene.
  /// @throws SceneError naming what is wrong with a closure.
  LoopKinematics(const Mechanism& mechanism, const Scene& scene);
  /// Takes the sets as they are; those of closures must come first.
  LoopKinematics(const Mechanism& mechanism, ConditionSets sets);

  const ConditionSets& conditionSets() const { return sets_; }
  std::size_t sets() const { return sets_.size(); }
  std::size_t closures() const { return closures_.size(); }
  const ConditionSet& set(std::size_t set) const { return *sets_[set]; }
  const ClosureConditions& closure(std::size_t closure) const { return *closures_[closure]; }
  /// The closures that touch: their child origins are not fixed on the child's link.
  const std::vector<std::size_t>& touching() const { return touching_; }

  /// The closures of teeth that mesh.
  const std::vector<std::size_t>& meshing() const { return meshing_; }

  /// Number of conditions in all sets.
  Eigen::Index conditions() const { return values_.phi.size(); }
  const Condition& condition(Eigen::Index i) const {
    return *conditions_[static_cast<std::size_t>(i)];
  }
  /// The rows of a set as kernels see them, and their entries.
  const RowsShape& rowsOf(std::size_t set) const { return rows_[set]; }
  const RowsShape* shapesOfRows() const { return rows_.data(); }  ///< by set
  const double* entriesOf(std::size_t set) const { return values_.A.data() + first_[set]; }
  /// Conditions [firstOf(s), firstOf(s + 1)) are those of set s.
  Eigen::Index firstOf(std::size_t set) const { return first_[set]; }

  /// Sets the time of conditions that depend on it, s; 0 at first. Holds from the next position on.
  void setTime(double time) {
    placed_ = placed_ && state_.time == time;
    state_.time = time;
  }
  /// The numbers that conditions drive by, to be set. They hold from the next position on.
  Motion& driven() {
    placed_ = false;
    return state_.driven;
  }
  /// Sets the orientations of joints that turn freely, see LinkKinematics.
  void setOrientations(const std::vector<Eigen::Quaterniond>& orientations) {
    if (state_.links.setOrientations(orientations)) placed_ = false;
  }
  /// Computes poses of links, conditions and their Jacobian at a position. Costs nothing when they
  /// are at that position already.
  void setPosition(const Eigen::VectorXd& q);
  const Eigen::VectorXd& position() const { return state_.q; }
  const Eigen::VectorXd& phi() const { return values_.phi; }  ///< m or rad; 0 where there is none
  const Eigen::MatrixXd& jacobian() const { return values_.A; }  ///< conditions x coordinates
  /// Makes the present position meet the conditions that adopt their constant from the assembly;
  /// before this call they demand nothing.
  void adoptConstants();

  /// A condition that adopts its constant, and that constant.
  struct Adopted {
    Eigen::Index condition;
    double constant;
  };
  std::size_t adopting() const { return adopting_.size(); }
  Adopted adopted(std::size_t i) const {
    return {adopting_[i], constants_[static_cast<Eigen::Index>(i)]};
  }

  /// Computes what follows from positions and velocities alone.
  void setVelocity(const Eigen::VectorXd& qd);
  const Eigen::VectorXd& turning() const { return values_.turning; }  ///< Ad qd
  /// Computes velocities of the conditions at the present position.
  void setRates(const Eigen::VectorXd& qd);
  const Eigen::VectorXd& rates() const { return rates_; }  ///< A qd + b
  /// Computes velocities and accelerations of the conditions at the present position.
  void setMotion(const Motion& motion);
  /// A qdd + Ad qd + bd
  const Eigen::VectorXd& accelerations() const { return accelerations_; }
  /// Whether rows depend on a coordinate that are not the same in every position: it must go to
  /// where they are met in short steps.
  bool bends(int coordinate) const { return bends_[static_cast<std::size_t>(coordinate)]; }
  /// The largest of these entries of a vector by coordinate, each over its scale.
  double largestBent(const Eigen::VectorXd& way, const std::vector<double>& scales) const;
  /// Whether b and its derivative bd can differ from zero.
  bool drives() const { return drives_; }
  const Eigen::VectorXd& b() const { return values_.b; }
  const Eigen::VectorXd& bd() const { return values_.bd; }
  /// Norms of a set's entries in phi(), rates() or accelerations(), with lengths and directions
  /// apart.
  struct Norms {
    double lengths, directions;
  };
  Norms normsOf(std::size_t set, const Eigen::VectorXd& conditions) const;

  /// Wrench of a multiplier of one; zero where the condition is not a closure's.
  const ClosureWrench& unitWrench(Eigen::Index condition) const {
    return values_.unit_wrenches[static_cast<std::size_t>(condition)];
  }
  /// The numbers of these wrenches from one on; there need not be one.
  const double* unitWrenches(Eigen::Index condition) const {
    return reinterpret_cast<const double*>(values_.unit_wrenches.data() + condition);
  }
  /// Wrench of a unit effort about or along the free axis of a revolute or prismatic closure.
  ClosureWrench unitEffort(std::size_t closure) const;
  /// Adds the generalized force of a wrench on the child and its opposite on the parent.
  template <typename Vector>
  void addGeneralizedForce(std::size_t closure, const ClosureWrench& wrench, Vector&& force) const {
    for (const PathStep& step : closures_[closure]->path()) {
      const int coordinate = links().coordinateOf(step);
      if (coordinate < 0) continue;
      const LinkKinematics::Displacement moved = links().movedBy(step, childOrigin(closure));
      force[coordinate] += moved.origin.dot(wrench.force) + moved.turn.dot(wrench.moment);
    }
  }

  /// Adds what a closure's wrench on its child, and its opposite on the parent, change of the
  /// wrench of a joint on the closure's path, about `origin`: a closure that bears a link relieves
  /// the joints that carry that link.
  /// @param sign PathStep::sign of the joint
  void addRelief(std::size_t closure, double sign, const ClosureWrench& wrench,
                 const Eigen::Vector3d& origin, ClosureWrench& sum) const {
    const Eigen::Vector3d lever = childOrigin(closure) - origin;
    sum.force -= sign * wrench.force;
    sum.moment -= sign * (wrench.moment + lever.cross(wrench.force));
  }

  /// How many of a set's conditions, its first, are lengths.
  int lengthsOf(std::size_t set) const { return lengths_[set]; }
  /// A sample among those of a pack, of which `width` neighbouring numbers belong together.
  struct PackedSample {
    const double *links, *wrenches, *frames;
    std::size_t width, sample;
  };
  /// Takes over the frames of closures.
  /// @param whole links and wrenches of unit multipliers, too
  void takeSample(const PackedSample& packed, bool whole);

  const LinkKinematics& links() const { return state_.links; }
  const Eigen::Matrix3d& axesOf(int link) const { return links().axesOf(link); }
  const Eigen::Vector3d& originOf(int link) const { return links().originOf(link); }
  /// Axis of a joint; zero for fixed ones.
  const Eigen::Vector3d& axisOf(int joint) const { return links().axisOf(joint); }

  /// The frames of all sets, see FrameNumber; null where there are none.
  const double* frameNumbers() const {
    return values_.frames.empty() ? nullptr : values_.frames.front().R_P.data();
  }
  /// The frames that closure c joins. For this and what follows see ClosureConditions.
  const FramePair& frames(std::size_t c) const { return values_.frames[c]; }
  /// Axis z of the parent frame, that of the one free motion of closures that have one.
  Eigen::Vector3d freeAxis(std::size_t c) const { return frames(c).R_P.col(2); }
  double freePosition(std::size_t c) const { return closures_[c]->freePosition(frames(c)); }
  /// Needs setMotion().
  double freeVelocity(std::size_t c) const {
    return closures_[c]->freeVelocity(links(), frames(c));
  }
  bool reversed(std::size_t c) const { return closures_[c]->reversed(frames(c)); }
  const std::vector<PathStep>& path(std::size_t c) const { return closures_[c]->path(); }
  const Eigen::Vector3d& parentOrigin(std::size_t c) const { return frames(c).Po; }
  const Eigen::Vector3d& childOrigin(std::size_t c) const { return frames(c).Co; }
  const Eigen::Matrix3d& childAxes(std::size_t c) const { return frames(c).R_C; }
  /// The parent's origin as far as it is an end of the loop: of a plane, whose origin is any of its
  /// points, the foot of the perpendicular from the child's origin.
  Eigen::Vector3d parentEnd(std::size_t c) const {
    if (!closure(c).traits().touches()) return parentOrigin(c);
    const Eigen::Vector3d normal = freeAxis(c);
    return childOrigin(c) - normal * normal.dot(childOrigin(c) - parentOrigin(c));
  }
  /// Whether the origin of a joint on the path of a closure has a part in the loop's size: not that
  /// of a joint that only carries what touches.
  bool sizes(std::size_t c, int joint) const {
    if (!closure(c).traits().touches()) return true;
    return links().coordinateOf({joint, 1}) >= 0 && links().unitOf(joint) == Unit::kRadian;
  }
  /// Needs setMotion().
  Twist childTwist(std::size_t c) const;

 private:
  ConditionRows valuesOf(std::size_t set) { return {values_, set, first_[set]}; }
  void subtractConstants();

  const LoopFunctions* kernel_;
  ConditionSets sets_;
  std::vector<const ClosureConditions*> closures_;  // the first of sets_
  std::vector<std::size_t> touching_, meshing_;
  std::vector<const Condition*> conditions_;
  std::vector<Eigen::Index> first_;
  std::vector<RowsShape> rows_;  // by set; they point to coordinates of sets_
  std::vector<int> lengths_;     // by set: how many of its conditions, the first, are lengths
  std::vector<bool> bends_;      // by coordinate
  bool drives_ = false;
  std::vector<Eigen::Index> adopting_;  // conditions that adopt a constant
  bool adopted_ = false;
  bool placed_ = false;        // whether values_ are at state_.q
  bool moving_ = false;        // whether they are those of state_.qd
  Eigen::VectorXd constants_;  // by adopting_; of the present position until adopted
  LoopState state_;
  ConditionValues values_;
  Eigen::VectorXd rates_, accelerations_;
};

}  // namespace virtual_work_dynamics
