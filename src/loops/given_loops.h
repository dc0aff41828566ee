#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "loops/completion.h"
#include "loops/kinematics.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// Why a motion cannot be completed although its loops are closed, in one line.
constexpr char kSingularPosition[] =
    "the position is singular: the closures do not determine how the other joints move; give the "
    "motion of all joints";
constexpr char kContradiction[] =
    "the velocities or accelerations that are given contradict the closures";

/// The conditions of a mechanism's loops together with those that drive what a motion gives besides
/// coordinates. They find motions and bear no forces. Serves one thread.
class GivenLoops {
 public:
  /// @param loops conditions of the mechanism, at the assembly; copied
  /// @param closure_names by closure
  /// @param length of the loops, m
  /// @throws SceneError when no joint moves a link whose pose is given.
  GivenLoops(const Mechanism& mechanism, const LoopKinematics& loops,
             const std::vector<std::string>& closure_names, const Given& given,
             double rank_tolerance, double length);

  /// Completes a motion as LoopCompletion::complete(), from a position close by. Does not allocate.
  /// @param driven the driven numbers of the motion with their rates
  bool complete(Motion& motion, const Motion& driven);

  /// Whether the position `q` determines, as complete() demands it, what is not given; a singular
  /// one does not.
  bool determine(const Eigen::VectorXd& q);
  /// How many more coordinates would have to be given at a regular position `q` where those of
  /// `given` are.
  Eigen::Index freedom(const Eigen::VectorXd& q, const std::vector<bool>& given);
  /// How many more rates would have to be given there.
  Eigen::Index freedomOfRates(const Eigen::VectorXd& q, const std::vector<bool>& given);
  /// Coordinates that are not given and that neither closures nor what is given determine, at a
  /// regular position `q`.
  std::vector<std::size_t> undetermined(const Eigen::VectorXd& q);

  /// Sets `numbers` to the driven numbers at a position, angles within half a turn.
  void getDriven(const Eigen::VectorXd& q, Eigen::Ref<Eigen::VectorXd> numbers);
  /// Whether the driven number of a closure is an angle.
  bool turns(std::size_t number) const {
    return kinematics_.closure(given_.closures[number]).freeUnit() == Unit::kRadian;
  }

  /// The conditions, and what makes lengths comparable with angles, m.
  const LoopKinematics& kinematics() const { return kinematics_; }
  double length() const { return completion_.length(); }

  /// Why complete() failed, in one line. Allocates.
  /// @param q the position where it ended
  std::string whyOpen(const Eigen::VectorXd& q);

 private:
  static ConditionSets setsOf(const Mechanism& mechanism, const LoopKinematics& loops,
                              const std::vector<std::string>& closure_names, const Given& given);
  // The conditions at the position of `loops`.
  static LoopKinematics placed(const Mechanism& mechanism, const LoopKinematics& loops,
                               const std::vector<std::string>& closure_names, const Given& given);

  const std::vector<std::string> closure_names_;
  const Given given_;
  LoopKinematics kinematics_;
  LoopCompletion completion_;
};

}  // namespace virtual_work_dynamics
