#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/given.h"

namespace virtual_work_dynamics {

/// Follows the joints that motions do not give, usually the passive ones, from one position to the
/// next, on the branch of the closed loops that they are on. An open chain has no passive joints,
/// and its motions stay as they are. Does not allocate after construction.
class PassiveJoints {
 public:
  /// Starts at the assembly. The motions to come give what the scene says, usually the actuated
  /// coordinates.
  PassiveJoints(const Mechanism& mechanism, const Dynamics& dynamics);
  /// Starts at the assembly. The motions to come give that.
  /// @throws SceneError when no joint moves a link whose pose is given.
  PassiveJoints(const Mechanism& mechanism, const Dynamics& dynamics, const Given& given);
  ~PassiveJoints();
  PassiveJoints(PassiveJoints&&) noexcept;
  PassiveJoints& operator=(PassiveJoints&&) noexcept;

  const Given& given() const { return given_; }

  /// Completes a motion that gives coordinates only; `workspace` is then at its position. Returns
  /// false, and stays at the position before, when the loops cannot be closed or do not
  /// determine how the passive joints move; `motion` is then the last one tried. Makes at most
  /// kMostSearches searches, each of a bounded number of steps.
  bool complete(Motion& motion, const Dynamics& dynamics, Dynamics::Workspace& workspace);
  /// Completes a motion that gives driven numbers, too. Angles of closures may be off by whole
  /// turns, and quaternions may be reversed.
  /// @param driven their values, velocities and accelerations, in the order of Given
  /// @throws MotionError when a vector has the wrong length.
  bool complete(Motion& motion, const Motion& driven, const Dynamics& dynamics,
                Dynamics::Workspace& workspace);
  /// Why the latest motion could not be completed, in one line. Allocates.
  std::string whyOpen(const Dynamics& dynamics, Dynamics::Workspace& workspace) const;

  /// The most searches that one complete() makes.
  static constexpr int kMostSearches = 256;
  /// Number of searches that the last complete() made.
  int searches() const { return searches_; }

  /// The position that was found last.
  const Eigen::VectorXd& position() const { return position_; }
  /// Of each joint that turns freely: what its angles in position() turn on from, where its
  /// orientation is found.
  const std::vector<Eigen::Quaterniond>& references() const { return references_; }
  /// Continues from a position that was found elsewhere.
  /// @param references what the angles turn on from; empty: as before
  void moveTo(const Eigen::VectorXd& position,
              const std::vector<Eigen::Quaterniond>& references = {});

 private:
  static constexpr int kHalvings = 8;

  void setNearest(const Motion& motion, const Motion& driven);
  bool follow(const Motion& motion, int halvings, const Dynamics& dynamics,
              Dynamics::Workspace& workspace);
  bool search(const Motion& motion, const Eigen::VectorXd& target, const Dynamics& dynamics,
              Dynamics::Workspace& workspace);
  bool predict(const Eigen::VectorXd& target);
  bool searchFound(const Motion& motion, const Eigen::VectorXd& target, const Dynamics& dynamics,
                   Dynamics::Workspace& workspace);
  bool searchFrom(double further, const Motion& motion, const Eigen::VectorXd& target,
                  const Dynamics& dynamics, Dynamics::Workspace& workspace);
  void foldTurns();
  bool givenUp() const;
  bool turnsFar(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

  Given given_;
  std::unique_ptr<GivenLoops> driven_loops_;  // null where coordinates only are given
  Eigen::Index coordinates_;
  // Places are vectors of all coordinates, then the driven numbers.
  std::vector<Eigen::Index> fixed_;  // entries of a place that are given
  std::vector<bool> wraps_;          // by fixed_: whether whole turns make no difference
  std::vector<Eigen::Index> turning_;
  int searches_ = 0, failures_ = 0;
  Motion completed_, driven_;
  /// A joint that turns freely and is not given: its orientation is found, too.
  struct FoundTurn {
    std::size_t orientation;
    Eigen::Index angles;  ///< the first of three coordinates
  };
  std::vector<FoundTurn> found_turns_;
  std::vector<Eigen::Quaterniond> references_;  // by orientation
  Eigen::VectorXd position_;                    // found last
  Eigen::VectorXd before_, closed_;
  Eigen::VectorXd previous_;                            // before closed_ on the way
  Eigen::VectorXd rates_, accelerations_;               // at closed_; zero where not known
  Eigen::VectorXd found_;                               // where the latest search ended
  Eigen::VectorXd missed_;                              // position of a search that failed
  std::array<Eigen::VectorXd, kHalvings + 1> targets_;  // by the halvings that are left
};

}  // namespace virtual_work_dynamics
