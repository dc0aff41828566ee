#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros/cross_check.h"
#include "ros/output_messages.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/sample_block.h"

namespace virtual_work_dynamics {

/// Which outputs of the node somebody listens to.
struct Audience {
  bool effort = false;
  bool reactions = false;
  bool trajectory = false;
  std::vector<std::size_t> wrenches;  ///< indices of the ~reaction/<joint> topics, ascending

  bool wantsSamples() const { return effort || reactions || !wrenches.empty(); }
  bool wantsPoints() const { return wantsSamples() || trajectory; }
  bool operator==(const Audience& other) const {
    return effort == other.effort && reactions == other.reactions &&
           trajectory == other.trajectory && wrenches == other.wrenches;
  }
};

/// What the audience makes necessary, and no more.
/// @param joints whose reactions the scene asks for.
Request requestFor(const Audience& audience, const std::vector<std::string>& joints, bool twist);

/// One line for the user: what a sample costs. Empty when nothing is computed.
std::string operationsOf(const InverseDynamics& dynamics);

/// How the samples of a plan are checked.
struct PlanChecks {
  bool cross_check = false;
  bool certificates = false;
};

/// An audience compiled: plan, memory and messages that belong together, so that whatever is
/// published from one of these is complete.
struct ActivePlan {
  /// The outputs' messages hold every result of `request`. Where nothing is requested, nothing is
  /// checked.
  ActivePlan(const Mechanism& mechanism, const Scene& scene, const Request& request, Audience who,
             const std::string& frame_prefix, PlanChecks checks);

  Audience audience;
  InverseDynamics dynamics;
  Workspace results;
  SampleBlock points;  ///< of trajectories
  OutputMessages messages;
  std::shared_ptr<CrossCheckSlot> cross_check;  ///< null: off
  std::optional<Certifier> certifier;           ///< none: off
  std::size_t ground = 0;  ///< with a certifier: where childAxes() has the reaction of ground
};

/// One line for the user: what is computed.
std::string describe(const ActivePlan& plan);

}  // namespace virtual_work_dynamics
