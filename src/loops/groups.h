#pragma once

#include <vector>

#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Loops and other conditions that share coordinates, and so must be solved together.
struct LoopGroup {
  std::vector<int> coordinates;
  std::vector<std::size_t> sets;        ///< of conditions; those of closures are the first
  std::vector<std::size_t> closures;    ///< the closures of these sets
  std::vector<std::vector<int>> moved;  ///< by set: which of `coordinates` its rows concern
  /// How the wrench of a closure passes through a joint between the closure's links.
  struct Passage {
    std::size_t closure;  ///< index into `closures`
    double sign;          ///< PathStep::sign
  };
  struct CrossedJoint {
    int joint;
    bool moves;
    std::vector<Passage> passages;
  };
  std::vector<CrossedJoint> joints;
};

/// Divides conditions into groups; a coordinate without a condition is in none. Groups do not
/// affect each other, so the cost of many small ones grows with their number and not with its cube.
std::vector<LoopGroup> loopGroups(const Mechanism& mechanism, const LoopKinematics& kinematics);

/// A characteristic size, m: the largest distance between two origins of joints and closure frames
/// that lie on a loop, at the present position; where it is less than 1e-4 of their distance from
/// the root, that distance, as rounding errors of positions are no size; 1 where all are at the
/// root's origin, or there are none.
/// Of what touches, only origins of joints that turn and the point of contact count, with its foot
/// on the plane, and the length is at least 1e-4 of that distance: joints that slide only carry it.
double loopLength(const std::vector<LoopGroup>& groups, const LoopKinematics& kinematics);

}  // namespace virtual_work_dynamics
