#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/active_plan.h"
#include "ros/counters.h"
#include "ros/loop_limits.h"

namespace virtual_work_dynamics {

/// What the samples of a mechanism with closed loops were like since they were last asked for. One
/// thread records, another one takes; neither waits for the other nor allocates to record.
class LoopRecord {
 public:
  static constexpr std::size_t kLevels = 3;  // positions, velocities, accelerations
  /// By level.
  using Levels = std::array<double, kLevels>;

  /// @param dynamics of the mechanism and the scene; of an open chain nothing is recorded
  /// @param reactions how many the scene asks for
  LoopRecord(const Dynamics& dynamics, std::size_t reactions, const LoopLimits& limits);

  void record(const Results& results, const ActivePlan& plan);
  /// Whether the positions of passive joints come with the joint states.
  void setPassiveGiven(bool given) { passive_given_ = given; }

  struct Report {
    bool news = false;               ///< samples were computed since the report before
    std::vector<Levels> residuals;   ///< largest of each closure, m or rad, per s, per s^2
    std::vector<Levels> relative;    ///< the same without units
    std::vector<double> conditions;  ///< largest of each closure, out of singular positions
    std::vector<std::size_t> efforts, reactions;  ///< left out
    std::uint64_t singular = 0;                   ///< samples, ever
    std::uint64_t violations = 0;                 ///< samples, ever
    std::uint64_t close_to_singular = 0;          ///< samples, ever; none that are singular
    Determinacy determinacy;                      ///< of the latest sample
    bool passive_given = false;
  };
  Report take();

 private:
  struct OfClosure {
    std::array<std::atomic<double>, kLevels> largest{}, relative{};
    std::atomic<double> condition{0};
  };

  void recordResiduals(const Results& results);
  void recordSingular(const Results& results, const ActivePlan& plan);

  const bool closed_;
  const LoopLimits limits_;
  std::vector<OfClosure> closures_;
  std::vector<std::atomic<bool>> efforts_;    // left out
  std::vector<std::atomic<bool>> reactions_;  // left out
  std::atomic<int> rank_{0}, redundant_constraints_{0}, redundancy_{0}, free_motions_{0};
  std::atomic<double> gap_{0}, condition_{0};
  std::atomic<bool> passive_given_{false};
  Counter samples_, singular_, violations_, close_to_singular_;
  std::uint64_t reported_ = 0;  // samples, the taking thread's
};

}  // namespace virtual_work_dynamics
