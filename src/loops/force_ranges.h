#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "algebra/cone_program.h"
#include "loops/forces.h"
#include "loops/holds.h"
#include "loops/reactions.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// What forces can be that rigid-body mechanics does not determine, while what presses presses
/// inside its friction cone, and cables pull: whether there are such forces, and in which intervals
/// results then are. All forces B x = load (3.1), (3.2) are a solution and any sum of the changes
/// that mechanics leaves open; see ConeProgram. Serves one thread; nothing after construction
/// allocates.
class ForceRanges {
 public:
  /// @param closures their names   @param couplings their number
  /// @param results that intervals are of, as they are sized; `holds` must outlive it
  /// @throws SceneError when intervals are asked for that nothing bounds, or that teeth share loops
  ///   with.
  ForceRanges(const Request& request, const std::vector<std::string>& closures,
              std::size_t couplings, const LoopHolds& holds, const LoopKinematics& kinematics,
              const std::vector<LoopForces>& forces, Results& results);

  /// Which results are open.
  struct Flags {
    const std::vector<bool>& effort;
    const std::vector<Determined>&child_axes, &root_axes;
  };
  /// Judges what is not decidable; sets the intervals, if they are asked for, of open results.
  /// @param flags and reactions are those of intervals only
  void find(const LoopKinematics& kinematics, std::vector<LoopForces>& forces,
            LoopReactions& child_axes, LoopReactions& root_axes, const Flags& flags,
            Results& results);
  /// Leaves out the intervals of results that do not exist.
  static void leaveOut(Results& results);

 private:
  /// A component of a result that is open.
  struct Open {
    double value;
    double *least, *most;  // of the results
  };
  void collect(const Flags& flags, Results& results);
  void addOpen(std::size_t place, double value, double& least, double& most);
  bool anyOpen(std::size_t group, const std::vector<Hold>& holds);
  void setCones(LoopForces& forces);
  void setCone(const LoopForces& forces, const LoopHolds::Item& item, Eigen::Index column,
               const Eigen::VectorXd& x, Eigen::Index& row);
  void setChange(const LoopKinematics& kinematics, std::size_t group, LoopForces& forces,
                 LoopReactions& child_axes, LoopReactions& root_axes, Eigen::Index i);
  void setOpen(std::size_t place, Eigen::Index column, double value);
  void takeRanges(ConeProgram::Found found, double scale, double least_change);

  const LoopHolds& holds_;
  const bool intervals_;
  std::size_t closures_, efforts_, couplings_, child_axes_;
  ConeProgram program_;
  std::vector<std::size_t> items_;  // of holds_: those of the group at hand that are not decidable
  Eigen::Index cone_functions_ = 0;
  std::vector<Open> open_;
  std::vector<int> open_places_;  // by effort, then by component of reactions; -1: not open
  std::vector<LoopReactions::Changed> changed_;
};

}  // namespace virtual_work_dynamics
