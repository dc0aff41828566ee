#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dynamics/shifted_samples.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// What the tolerances of masses and inertias make of efforts and reactions. As these are linear in
/// both, each link's mass, and each link's inertia, has a plan in which it is alone; plans leave
/// everything else out. Where teeth press, plans have everything else, and a mass or an inertia
/// that is larger by its tolerance: what differs from the plan in which none is larger. Live
/// wrenches, which shares do not know, may turn over the flank that bears, and what they may so
/// change is not known.
class DescriptionShares {
 public:
  DescriptionShares(const Mechanism& mechanism, const Scene& scene, const Request& request);

  /// Workspaces of all plans, first that of nominal_.
  std::vector<Dynamics::Workspace> makeWorkspaces() const;
  /// Adds the variances of all ResultNumbers. Does not allocate.
  /// @param known receives which numbers are determined; see markKnown()
  void addVariances(const Motion& motion, std::vector<Dynamics::Workspace>& workspaces,
                    std::vector<double>& variances, std::vector<bool>& known) const;

 private:
  struct Share {
    Dynamics plan;
    double factor;  // of its results
  };
  std::vector<Share> shares_;
  std::optional<Dynamics> nominal_;  // what results are to be compared with
  std::vector<bool> unknown_;        // by number; empty: none
};

}  // namespace virtual_work_dynamics
