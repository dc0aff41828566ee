#pragma once

#include <vector>

#include "loops/groups.h"
#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The lengths that rows of the conditions' Jacobian would have without cancellation, for one group
/// of loops, with lengths divided by a length: what a unit wrench of a closure does on the joints
/// of its loop when it misses none of their axes, with the extent of the loop as lever. Ranks are
/// decided against them, because the entries of a row that has lost its rank are rounding errors,
/// whatever they are compared with among each other. They do not depend on units, on other loops,
/// or on which joint of a loop is cut.
class ConditionSizes {
 public:
  /// Takes the extents of loops at the present position of `kinematics`.
  /// @param length of all loops, m
  /// @param tolerance of the rank. Origins within the tolerance times the length of each other are
  ///   one point, as closing and rounding leave them apart: a loop of one point has no extent, and
  ///   the length is its lever.
  ConditionSizes(const Mechanism& mechanism, const LoopKinematics& kinematics,
                 const LoopGroup& group, double length, double tolerance);

  /// Size of a row of one of the group's sets. Zero when the set has no levers: its rows have the
  /// size that their entries show.
  /// @param local index into LoopGroup::sets
  /// @param unit of the condition, or of the motion that an effort works on
  double ofRow(std::size_t local, Unit unit) const;

 private:
  struct Sizes {
    double force, moment;  // of a unit force; of a unit moment over the length, times the length
  };
  // `lever` over the length
  static Sizes sizesOf(const Mechanism& mechanism, const std::vector<PathStep>& path, double lever,
                       double length);
  std::vector<Sizes> sizes_;  // by set of the group; its closures are the first
};

}  // namespace virtual_work_dynamics
