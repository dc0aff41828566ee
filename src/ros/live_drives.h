#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The drives of a scene on the clock of stamps. Serves one thread.
class LiveDrives {
 public:
  /// @param given what motions give, drives included
  /// @param start stamp at which the drives' time is zero, s; 0: the first one
  LiveDrives(const Mechanism& mechanism, const Scene& scene, const Given& given, double start);

  bool any() const { return !drives_.empty(); }
  /// Whether each generalized coordinate is driven.
  const std::vector<bool>& coordinates() const { return drives_.coordinates(); }

  /// Joint states have a result at this stamp: the drives' time is zero there unless an earlier
  /// call, or the start, says otherwise.
  void begin(std::int64_t stamp_ns);
  /// Whether there is nothing left to begin().
  bool begunByJointStates() const { return !any() || by_joint_states_; }
  /// Time of joint states went back: that of the drives begins anew with the next begin(), unless
  /// the start says when.
  void beginAnew();
  /// A trajectory begins at this stamp: as begin(), and where there were trajectories alone, time
  /// begins anew with one that begins before its zero.
  void beginTrajectory(std::int64_t stamp_ns);

  /// Sets what is driven at a stamp. Returns false when a drive has no motion there; see problem().
  bool set(std::int64_t stamp_ns, Motion& motion);
  /// The driven numbers as set last.
  const Motion& numbers() const { return numbers_; }
  /// Whether the latest set() failed.
  bool failed() const { return none_.has_value(); }
  /// Why it failed. Allocates.
  std::string problem() const { return drives_.whyNone(*none_, time_); }

 private:
  Drives drives_;
  const Given given_;
  const bool starts_at_stamp_;
  bool begun_;
  bool by_joint_states_ = false;
  std::int64_t start_ns_;
  Motion numbers_;
  double time_ = 0;
  std::optional<std::size_t> none_;
};

}  // namespace virtual_work_dynamics
