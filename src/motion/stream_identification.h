#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "motion/simplex_search.h"
#include "motion/stream_filter.h"
#include "motion/stream_model.h"

namespace virtual_work_dynamics {

/// Mean of one or more samples that follow each other.
struct StreamBlock {
  double time;      ///< s
  double position;  ///< rad or m
  double velocity;  ///< rad/s or m/s; NaN: none
  /// Whether nothing is assumed of the motion from the block before to this one.
  bool begins = false;
};

/// How models are judged, and how long the best one is looked for. The defaults are those of a
/// real-time path, which has some seconds of samples and little time.
struct IdentificationRules {
  /// Whether the first blocks of a stretch are judged as well. The start of a filter is fitted to
  /// them, so that it foresees them the better the higher its order is, and of a slow motion it
  /// stays in what is foreseen for long.
  bool judge_start = true;
  /// Whether the search starts again from where it ended, as long as that finds better models: the
  /// corners of a simplex may come to lie in a plane.
  bool search_again = false;

  /// What models of recordings deserve, whose samples are all there.
  static IdentificationRules ofRecordings() { return {false, true}; }
};

/// What of a model is known beforehand. Negative: to be found.
struct StreamKnowledge {
  int order = 4;               ///< derivative that is white noise, 3 … kHighestOrder
  double least_position = 0;   ///< standard deviation that no sample can be better than, rad or m
  double position_noise = -1;  ///< standard deviation of a sample, rad or m
  double velocity_noise = -1;  ///< rad/s or m/s
  double stamp_noise = -1;     ///< s
  double time_constant = -1;   ///< s
  double longest_time = 3;     ///< s, that the time constant may be, or eight blocks
  bool use_velocities = true;  ///< where blocks carry them
  double longest_gap = 0.25;   ///< s between blocks, across which nothing is assumed
  IdentificationRules rules;
};

/// Finds the model under which blocks of samples are most likely: noise of positions, velocities
/// and stamps, and density of the motion (likelihood of the innovations of a Kalman filter,
/// Schweppe 1965). Works in slices, so that a real-time path can spread it over many samples; does
/// not allocate once reserve() has been called.
class StreamIdentification {
 public:
  /// Fewest blocks that something can be learnt from.
  static constexpr std::size_t kFewest = 24;

  void reserve(std::size_t blocks) { blocks_.reserve(blocks); }
  std::vector<StreamBlock>& blocks() { return blocks_; }

  /// Begins with what blocks() holds, times increasing, at least kFewest of them.
  /// @param interval mean time from block to block, s.   @param samples samples in each block.
  /// @param guess the model to start from; null: from scratch.
  void start(const StreamKnowledge& knowledge, double interval, int samples,
             const StreamModel* guess);

  bool running() const { return running_; }
  void stop() { running_ = false; }
  /// Goes over `steps` blocks; returns true in the slice that finishes.
  bool advance(int steps);
  /// To the end.
  void finish();

  /// The model of single samples, once finished.
  const StreamModel& model() const { return model_; }
  /// Minus twice the logarithm of the likelihood, without constants, once finished.
  double value() const { return value_; }

 private:
  enum Parameter { kTime, kPosition, kVelocity, kStamp };

  SimplexSearch::Point firstGuess(const StreamModel* guess) const;
  double noiseFromDifferences(double StreamBlock::*part) const;
  double speed() const;
  double fixedValue(int parameter) const;
  double longestTime() const;
  void beginCandidate();
  int startingBlocks() const;
  bool begins(std::size_t block) const;
  std::size_t firstJudged() const;
  double step();
  template <int N>
  double stepOf(StreamState<N>& state);
  void endCandidate();
  StreamModel modelAt(const SimplexSearch::Point& point) const;
  double penalty(const SimplexSearch::Point& point) const;
  SimplexSearch::Point whole(const SimplexSearch::Point& searched) const;
  void beginSearch(const SimplexSearch::Point& from);

  std::vector<StreamBlock> blocks_;
  StreamKnowledge knowledge_;
  double interval_ = 1;
  double shown_noise_ = 0;  // of a block, that differences show
  double least_stamp_ = 0;  // noise, s
  int samples_ = 1;
  bool running_ = false;
  bool searching_ = false;       // else still looking at time constants on a grid
  SimplexSearch::Point grid_{};  // the next of these
  SimplexSearch::Point best_{};  // logarithms of the four parameters
  double best_value_ = 0;
  SimplexSearch search_;
  double searched_value_ = 0;      // that the search before this one found
  std::array<int, 4> searched_{};  // parameter of each dimension of the search
  int dimensions_ = 0;

  // The candidate that is being judged, and how far it is.
  SimplexSearch::Point candidate_{};
  StreamModel candidate_model_;
  StreamState<3> state3_;
  StreamState<4> state4_;
  StreamState<5> state5_;
  StreamState<6> state6_;
  std::size_t next_ = 0;
  std::size_t judged_from_ = 0;  // block of the stretch
  double sum_ = 0;

  StreamModel model_;
  double value_ = 0;
};

}  // namespace virtual_work_dynamics
