#pragma once

#include <array>

#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {

/// What the positions of one coordinate show of their noise before a model is found from them: the
/// step that an encoder rounds them to, and the noise that is left of differences which cancel the
/// motion. Does not allocate.
class ShownNoise {
 public:
  ShownNoise();

  /// Forgets the differences, which do not go across the beginning of a stretch. The step of an
  /// encoder stays known.
  void restart();

  /// Takes three positions that follow each other without a turn left out, rad or m, of which two
  /// were taken before.
  void takeStep(double oldest, double middle, double newest);

  /// Takes the latest positions, newest first, of which all except for the newest were taken
  /// before.
  /// @param times s   @param positions rad or m; both may be relative to any sample.
  void takeDifference(const std::array<double, kDifferenced>& times,
                      const std::array<double, kDifferenced>& positions);

  /// Standard deviation that no position can be better than, rad or m. Positive.
  double least() const { return least_; }

  /// Standard deviation of a position that the differences show, rad or m; zero where there are
  /// too few of them. Where the motion does more between samples than any model could follow, this
  /// is what it does.
  double deviation() const;

  /// Whether the differences show the motion rather than noise, or are too few to tell.
  bool ofMotion() const;

 private:
  StepFinder steps_;
  double least_;
  int count_ = 0;        // of differences of fourth order
  double latest_ = 0;    // of them
  double squares_ = 0;   // mean of their squares
  double products_ = 0;  // mean of the products of those that follow each other
};

}  // namespace virtual_work_dynamics
