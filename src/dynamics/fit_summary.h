#pragma once

#include <cstdint>
#include <string>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_fit.h"

namespace virtual_work_dynamics {

/// What MotionFit did to many motions.
struct FitSummary {
  std::uint64_t fitted = 0;       ///< motions
  std::uint64_t open = 0;         ///< those of them whose positions are too far from closed
  std::uint64_t unexplained = 0;  ///< those of them whose moves noise does not explain
  /// Sums of the squares of position_rms and velocity_rms of MotionFit::Outcome.
  double position_squares = 0, velocity_squares = 0;
  MotionFit::Farthest farthest;
  bool wheels = false;  ///< MotionFit::Outcome::wheels

  void add(const MotionFit::Outcome& outcome);
  /// Whether moves are larger than noise makes them, all in all.
  bool systematic() const;
  bool doubtful() const { return open > 0 || unexplained > 0 || systematic(); }

  /// How many motions were moved, how far, and what is wrong if they are doubtful(), in one line
  /// without a line end. Allocates.
  /// @param one, many what the motions are called: "row", "rows"
  std::string text(const Mechanism& mechanism, const char* one, const char* many) const;
};

}  // namespace virtual_work_dynamics
