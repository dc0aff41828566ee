#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "algebra/elimination_order.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The unknowns x of B x = load, (3.1), for one group of loops, in units that make all of them
/// forces: efforts of actuated coordinates, then for each set of conditions its multipliers and,
/// for that of an actuated closure, its effort.
struct LoopUnknowns {
  LoopUnknowns(const Mechanism& mechanism, const LoopKinematics& kinematics, const LoopScene& scene,
               const LoopGroup& group, double length);

  /// An effort: first those of actuated coordinates, one unknown each, then those of actuated
  /// closures.
  struct Effort {
    std::size_t index;     ///< into ClosedLoopDynamics::effort()
    double unit;           ///< N m or N for an entry of x equal to one
    Eigen::Index unknown;  ///< index of that entry
  };
  struct Column {
    Eigen::Index condition;  ///< -1 for the effort along the free axis
    double unit;             ///< multiplier or effort for an entry of x equal to one
  };
  struct OfSet {
    std::size_t set;
    Eigen::Index first;            ///< of its unknowns
    std::vector<Column> columns;   ///< of its unknowns
    int effort = -1;               ///< into efforts; -1 when it is not actuated
    std::vector<int> coordinates;  ///< which its rows concern, as the group counts them

    /// Number of its conditions, whose multipliers are the first of its unknowns.
    Eigen::Index multipliers() const {
      return static_cast<Eigen::Index>(columns.size()) - (effort >= 0 ? 1 : 0);
    }
  };

  Eigen::Index count = 0;
  std::vector<Effort> efforts;
  std::vector<int> effort_rows;   ///< of actuated coordinates, as the group counts them
  std::vector<OfSet> of_sets;     ///< as the group counts them
  std::vector<double> row_units;  ///< N m or N for an entry of the load equal to one

  /// Blocks of the transpose of B: one of a single entry for each actuated coordinate, then one for
  /// each set.
  std::vector<RowBlock> rowBlocks(const Mechanism& mechanism,
                                  const LoopKinematics& kinematics) const;
};

}  // namespace virtual_work_dynamics
