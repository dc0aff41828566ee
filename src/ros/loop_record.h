#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/fit_summary.h"
#include "ros/active_plan.h"
#include "ros/counters.h"
#include "ros/loop_limits.h"

namespace virtual_work_dynamics {

/// Residuals, conditions and missing results of samples with closed loops since the last report.
/// One thread records and another one takes reports; neither waits for the other, and recording
/// does not allocate.
class LoopRecord {
 public:
  static constexpr std::size_t kLevels = 3;  // positions, velocities, accelerations
  static constexpr std::size_t kHolds = 6;   // values of Hold
  /// One value for each level.
  using Levels = std::array<double, kLevels>;

  /// @param dynamics of the mechanism and the scene; for an open chain nothing is recorded
  /// @param reactions number of reactions that the scene asks for
  LoopRecord(const Dynamics& dynamics, std::size_t reactions, const LoopLimits& limits);

  /// Records what became of a motion that was fitted to the loops. Does not allocate.
  void recordFit(const MotionFit::Outcome& outcome);
  const LoopLimits& limits() const { return limits_; }
  /// Records a sample. Does not allocate.
  void record(const Results& results, const ActivePlan& plan);
  /// Whether the positions of passive joints come with the joint states.
  void setPassiveGiven(bool given) { passive_given_ = given; }

  struct Report {
    bool news = false;               ///< whether samples were computed since the last report
    std::vector<Levels> residuals;   ///< largest of each closure, m or rad, per s, per s^2
    std::vector<Levels> relative;    ///< largest of each closure, without units
    std::vector<double> conditions;  ///< largest of each closure, without singular positions
    std::vector<std::size_t> efforts, reactions;  ///< indices of those left out
    std::uint64_t singular = 0;                   ///< samples, ever
    std::uint64_t undirected = 0;                 ///< samples, ever, in which a spring's ends meet
    std::uint64_t violations = 0;                 ///< samples, ever
    std::uint64_t close_to_singular = 0;          ///< samples, ever, without singular ones
    /// By Dynamics::oneSided(): how many samples were found to be so, by Hold.
    std::vector<std::array<std::uint64_t, kHolds>> holds;
    Determinacy determinacy;  ///< of the latest sample
    FitSummary fit;           ///< of samples since the last report
    bool passive_given = false;
  };
  /// What was recorded since the call before. Allocates.
  Report take();

 private:
  struct OfClosure {
    std::array<std::atomic<double>, kLevels> largest{}, relative{};
    std::atomic<double> condition{0};
  };

  void recordResiduals(const Results& results);
  void recordLeftOut(const Results& results, const ActivePlan& plan);

  const bool closed_;
  const LoopLimits limits_;
  std::vector<OfClosure> closures_;
  std::vector<std::array<std::atomic<std::uint64_t>, kHolds>> holds_;
  std::vector<std::atomic<bool>> efforts_;    // left out
  std::vector<std::atomic<bool>> reactions_;  // left out
  std::atomic<int> rank_{0}, redundant_constraints_{0}, redundancy_{0}, free_motions_{0};
  std::atomic<double> gap_{0}, condition_{0};
  std::atomic<bool> passive_given_{false};
  std::atomic<std::uint64_t> fitted_{0}, open_fits_{0}, unexplained_{0};
  std::atomic<double> fit_position_squares_{0}, fit_velocity_squares_{0};
  std::atomic<double> fit_deviations_{0}, fit_amount_{0};
  std::atomic<int> fit_coordinate_{-1}, fit_level_{0};
  std::atomic<bool> fit_wheels_{false};
  Counter samples_, singular_, undirected_, violations_, close_to_singular_;
  std::uint64_t reported_ = 0;  // samples; only the taking thread uses it
};

}  // namespace virtual_work_dynamics
