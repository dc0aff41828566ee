#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros/cross_check.h"
#include "ros/loop_plan.h"
#include "ros/output_messages.h"
#include "tree/sample_block.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// Which outputs of the node somebody listens to.
struct Audience {
  bool effort = false;
  bool reactions = false;
  bool trajectory = false;
  bool determinacy = false;
  std::vector<std::size_t> wrenches;  ///< indices of the ~reaction/<joint> topics, ascending

  bool wantsSamples() const { return effort || reactions || determinacy || !wrenches.empty(); }
  bool wantsPoints() const { return wantsSamples() || trajectory; }
  bool operator==(const Audience& other) const {
    return effort == other.effort && reactions == other.reactions &&
           trajectory == other.trajectory && determinacy == other.determinacy &&
           wrenches == other.wrenches;
  }
};

/// What is published to the audience, and no more.
/// @param joints whose reactions the scene asks for.
Request requestFor(const Audience& audience, const std::vector<std::string>& joints, bool twist);

/// How the samples of a plan are checked.
struct PlanChecks {
  bool cross_check = false;
  bool certificates = false;
};

/// An open chain compiled.
struct ChainPlan {
  ChainPlan(const Mechanism& mechanism, const Scene& scene, const Request& request);

  InverseDynamics dynamics;
  Workspace results;
  SampleBlock points;  ///< of trajectories
};

/// An audience compiled: plan, memory and messages that belong together, so that whatever is
/// published from one of these is complete.
struct ActivePlan {
  /// The outputs' messages hold every result of `request`. Where nothing is requested, nothing is
  /// checked.
  ActivePlan(const Mechanism& mechanism, const Scene& scene, const Request& request, Audience who,
             const std::string& frame_prefix, PlanChecks checks);

  /// What is computed, for outputs and checks.
  const Request& request() const;
  const Eigen::VectorXd& effort() const;

  Audience audience;
  std::optional<ChainPlan> chain;   ///< of an open chain; none:
  std::unique_ptr<LoopPlan> loops;  ///< of a mechanism with closed loops; null: an open chain
  OutputMessages messages;
  std::shared_ptr<CrossCheckSlot> cross_check;  ///< null: off
  std::optional<Certifier> certifier;           ///< none: off
  std::size_t ground = 0;  ///< with a certifier: where childAxes() has the reaction of ground
};

/// One line for the user: what is computed.
std::string describe(const ActivePlan& plan);

/// One line for the user: what a sample costs. Empty when nothing is computed, and with closed
/// loops, whose operations depend on the position.
std::string operationsOf(const ActivePlan& plan);

}  // namespace virtual_work_dynamics
