#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Computed and measured efforts of a joint at the same instants, row by row in the order of time.
struct ComparedEfforts {
  std::string joint;
  std::string unit;           ///< N m or N
  std::vector<double> times;  ///< s
  std::vector<double> computed, measured;
  std::vector<double> velocities;  ///< rad/s or m/s
};

/// How measured efforts differ from computed ones.
struct EffortComparison {
  std::size_t rows = 0;
  /// 1 - var(measured - computed) / var(measured); none where the measured effort does not vary.
  std::optional<double> vaf;
  double rms = 0;   ///< of computed - measured
  double bias = 0;  ///< mean of computed - measured
  /// s, by which the measured effort comes later than the computed one. None where the motion does
  /// not show it.
  std::optional<double> lag;
  double lag_deviation = 0;  ///< its standard deviation by what is left of the measured effort, s
};

/// Compares. The lag is found by scan: the one at which least is left of the measured effort when a
/// share of the computed one, viscous and Coulomb friction and an offset are fitted to it, so that
/// friction, which the description may lack, is not taken for a lag.
EffortComparison compare(const ComparedEfforts& efforts);

/// A table of several joints, line by line.
std::string comparisonTable(const std::vector<ComparedEfforts>& joints);

}  // namespace virtual_work_dynamics
