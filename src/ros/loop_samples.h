#pragma once

#include "ros/determinacy_message.h"
#include "ros/loop_completer.h"
#include "ros/loop_record.h"

namespace virtual_work_dynamics {

/// What the samples of a mechanism with closed loops need beside their plans. The receiving
/// thread's, but for the record.
struct LoopSamples {
  /// @param reactions that the scene asks for.
  /// @throws SceneError as ClosedLoopDynamics does.
  LoopSamples(const Mechanism& mechanism, const Scene& scene,
              const std::vector<std::string>& reactions, const LoopLimits& within);

  const LoopLimits limits;
  LoopCompleter completer;
  LoopRecord record;
  DeterminacyMessage determinacy;
};

}  // namespace virtual_work_dynamics
