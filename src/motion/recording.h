#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "motion/far_positions.h"
#include "motion/stream_identification.h"
#include "motion/stream_smoother.h"
#include "virtual_work_dynamics/motion_completion.h"

namespace virtual_work_dynamics {

/// One coordinate of a recording: its samples, and the model that was found for them.
struct RecordedStream {
  std::vector<double> positions;      ///< unwrapped, rad or m
  std::vector<double> velocities;     ///< rad/s or m/s; empty: not given
  bool still = false;                 ///< whether all positions are the same
  double velocity_ratio = 1;          ///< not 1: velocities contradict the positions
  std::vector<std::size_t> jumps;     ///< rows at which another motion begins
  std::vector<std::size_t> left_out;  ///< rows whose positions stand alone, far from the others
  StreamKnowledge knowledge;
  StreamModel model;
};

/// The streams of a recording with the clock that they share: finds models, then smooths.
class Recording {
 public:
  /// @param times s, increasing.   @param streams as many samples each.
  Recording(std::vector<double> times, std::vector<RecordedStream> streams,
            const CompletionSettings& settings);

  /// Models of each stream that identify() finds, at most.
  static constexpr std::size_t kModels = 6;

  /// Finds clock, orders and noises. @param found is told how many more models are found or not
  /// needed, kModels for each stream in the end.
  void identify(const std::function<void(std::size_t models)>& found);
  void smooth(std::size_t stream, bool covariance,
              const std::function<void(std::size_t row, const SmoothedSample&)>& take) const;

  bool evenClock() const { return even_clock_; }
  double interval() const { return interval_; }
  double longestGap() const { return longest_gap_; }
  const std::vector<double>& times() const { return times_; }
  StreamQuality quality(std::size_t stream) const;
  const RecordedStream& stream(std::size_t stream) const { return streams_[stream]; }

 private:
  std::vector<StreamBlock> samples(const RecordedStream& stream,
                                   const std::vector<double>& times) const;
  void prepare(RecordedStream& stream) const;
  void findFarPositions(RecordedStream& stream) const;
  FarFinding judge(const RecordedStream& stream, std::size_t begin, std::size_t row) const;
  void leaveOut(RecordedStream& stream, std::size_t begin, std::size_t row, int count) const;
  double identify(RecordedStream& stream, const std::vector<double>& times, bool even) const;
  void chooseClock(const std::function<void(std::size_t models)>& found);
  void chooseOrder(RecordedStream& stream) const;

  std::vector<double> times_;
  std::vector<RecordedStream> streams_;
  const CompletionSettings settings_;
  double interval_;
  double longest_gap_;
  int block_;  // samples averaged to a block that models are found from
  bool even_clock_ = false;
  double jitter_ = 0;  // of the stamps about an even clock, s
};

}  // namespace virtual_work_dynamics
