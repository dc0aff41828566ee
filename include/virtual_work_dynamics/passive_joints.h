#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Follows the passive joints of a mechanism from one position to the next, on the branch of its
/// closed loops that they are on. An open chain has no passive joints, and its motions stay as they
/// are. Does not allocate after construction.
class PassiveJoints {
 public:
  /// Starts at the assembly. The motions to come give the actuated coordinates.
  PassiveJoints(const Mechanism& mechanism, const Dynamics& dynamics);

  /// Completes a motion that gives the actuated coordinates; `workspace` is then at its position.
  /// Returns false, and stays at the position before, when the loops cannot be closed or do not
  /// determine how the passive joints move; `motion` is then the last one tried. Makes at most
  /// kMostSearches searches, each of a bounded number of steps.
  bool complete(Motion& motion, const Dynamics& dynamics, Dynamics::Workspace& workspace);

  /// The most searches that one complete() makes.
  static constexpr int kMostSearches = 256;
  /// Number of searches that the last complete() made.
  int searches() const { return searches_; }

  /// The position that was found last.
  const Eigen::VectorXd& position() const { return closed_; }
  /// Continues from a position that was found elsewhere.
  void moveTo(const Eigen::VectorXd& position) { previous_ = closed_ = position; }

 private:
  static constexpr int kHalvings = 8;

  bool search(const Motion& motion, const Eigen::VectorXd& target, const Dynamics& dynamics,
              Dynamics::Workspace& workspace);
  void start(const Motion& motion, const Eigen::VectorXd& target, double further);
  bool givenUp() const;
  void setNearest(const Motion& motion);
  bool follow(const Motion& motion, int halvings, const Dynamics& dynamics,
              Dynamics::Workspace& workspace);
  bool turnsFar(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

  std::vector<Eigen::Index> given_;
  std::vector<bool> wraps_;  // by given_: whether whole turns make no difference
  std::vector<Eigen::Index> turning_;
  int searches_ = 0, failures_ = 0;
  Motion completed_;
  Eigen::VectorXd before_, closed_;
  Eigen::VectorXd previous_;                            // before closed_ on the way
  Eigen::VectorXd missed_;                              // where a search ended that failed
  std::array<Eigen::VectorXd, kHalvings + 1> targets_;  // by the halvings that are left
};

}  // namespace virtual_work_dynamics
