#pragma once

#include <cstddef>
#include <vector>

#include "dynamics/shifted_samples.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// What the tolerances of masses and inertias make of efforts and reactions. As these are linear in
/// both, each link's mass, and each link's inertia, has a plan in which it is alone; plans leave
/// everything else out.
class DescriptionShares {
 public:
  DescriptionShares(const Mechanism& mechanism, const Scene& scene, const Request& request);

  /// Workspaces of all plans.
  std::vector<Dynamics::Workspace> makeWorkspaces() const;
  /// Adds the variances of all ResultNumbers. Does not allocate.
  /// @param known receives which numbers are determined; see markKnown()
  void addVariances(const Motion& motion, std::vector<Dynamics::Workspace>& workspaces,
                    std::vector<double>& variances, std::vector<bool>& known) const;

 private:
  struct Share {
    Dynamics plan;
    double tolerance;
  };
  std::vector<Share> shares_;
};

}  // namespace virtual_work_dynamics
