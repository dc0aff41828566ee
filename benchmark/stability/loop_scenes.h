#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "stability/loop_judge.h"

#ifdef VWD_HAS_REAL113

#include "stability/mixed_loops.h"

namespace virtual_work_dynamics {

/// What became of one scene of StructuredLoops, or the sum of many.
struct SceneVerdict {
  int scenes = 0;
  int refused = 0;   ///< of scenes with too few actuated joints in the assembly, as they must be
  int small = 0;     ///< not judged, as all loops are below 1e-4 of the mechanism's size
  int free = 0;      ///< with residuals, as too few joints are actuated and free_motion is true
  int singular = 0;  ///< computed in a singular position
  int unborne = 0;   ///< of these, those whose load nothing bears: only counts and flags are judged
  int unclear = 0;   ///< of these the rank is too close to its tolerance to say what is right
  int components = 0;              ///< number of efforts and components of reactions
  int open = 0;                    ///< of these, flagged as not determined
  int holds = 0;                   ///< forces that can act one way only
  double over_bound = 0;           ///< largest error of what is determined, over its bound
  double condition = 0;            ///< largest
  std::vector<std::string> wrong;  ///< a line for each scene that is not right

  void include(const SceneVerdict& other);
};

/// Makes and judges a scene: efforts, reactions, rank and flags of ClosedLoopDynamics against the
/// equations of all joints (MaximalCoordinates, LoopJudge). A scene may be refused only where the
/// exact system has free motions.
SceneVerdict judgeScene(std::uint32_t seed, std::size_t index);

/// The scene itself.
ClosedCase structuredScene(std::uint32_t seed, std::size_t index);

/// Makes and judges a scene of MixedLoops in the same way. Where motions may be free, there must be
/// as many residuals as the exact system has free motions, less those of a singular position.
SceneVerdict judgeMixedScene(std::uint32_t seed, std::size_t index);
ClosedCase mixedScene(std::uint32_t seed, std::size_t index);

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
