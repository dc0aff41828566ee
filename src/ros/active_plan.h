#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/sample_rows.h"
#include "ros/cross_check.h"
#include "ros/outputs.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/motion_fit.h"

namespace virtual_work_dynamics {

/// How the samples of a plan are checked.
struct PlanChecks {
  bool cross_check = false;
  bool certificates = false;
  double loop_tolerance = 0;  ///< of moves that need no explanation, see MotionFit
};

/// An output that somebody listens to.
struct ActiveOutput {
  std::size_t index;  ///< among all outputs
  bool of_trajectories;
  std::unique_ptr<OutputMessage> message;
};

/// The compiled plan of an audience, with the memory and the messages that belong to it, so that
/// whatever is published from it is complete.
struct ActivePlan {
  /// Compiles what the audience needs. Where nothing is requested, nothing is checked.
  /// @param reactions all that the scene asks for
  ActivePlan(const Mechanism& mechanism, const Scene& scene, const Outputs& all,
             const std::vector<std::string>& reactions, Audience who, PlanChecks checks);

  /// Points of a trajectory that are computed at once.
  static constexpr std::size_t kPointsAtOnce = 64;

  bool wantsSamples() const { return wants_samples; }
  /// Whether points of trajectories are wanted, each by itself or for a message of the whole
  /// trajectory.
  bool wantsPoints() const { return !outputs.empty(); }
  bool wantsTrajectories() const { return wants_trajectories; }
  /// Whether an output needs the covariance of the motion.
  bool wantsCovariance() const { return wants_covariance; }

  const Audience audience;
  const Dynamics dynamics;
  Dynamics::Workspace workspace;
  SampleRows points;  ///< of trajectories
  MotionFit fit;      ///< of joint states that give all joints
  std::vector<ActiveOutput> outputs;
  bool wants_samples = false, wants_trajectories = false, wants_covariance = false;
  std::shared_ptr<CrossCheckSlot> cross_check;  ///< null when off
  std::optional<Certifier> certifier;           ///< empty when off
  std::size_t ground = 0;  ///< with a certifier: place of ground's reaction in Results::child_axes
  Load tree_load;          ///< with a certifier: load of the sample that is certified
  /// Indices into the scene's reactions of the first results; the results after these are for
  /// checks.
  std::vector<std::size_t> root_reactions, child_reactions;
};

/// Says in one line for the user what is computed.
std::string describe(const ActivePlan& plan);

/// Says in one line for the user what a sample costs. Empty when nothing is computed, and with
/// closed loops, whose operations depend on the position.
std::string operationsOf(const ActivePlan& plan);

}  // namespace virtual_work_dynamics
