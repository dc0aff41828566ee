#pragma once

#include "reference_113.h"

#ifdef VWD_HAS_REAL113

#include <string>
#include <vector>

#include "virtual_work_dynamics/error_bound.h"

namespace virtual_work_dynamics {

/// A number of 113 bits as the sum of two of long double, with which computing is faster.
struct ExactNumber {
  long double high = 0, low = 0;

  ExactNumber() = default;
  explicit ExactNumber(Real113 value)
      : high(static_cast<long double>(value)),
        low(static_cast<long double>(value - static_cast<Real113>(high))) {}
};

/// Results of one sample, computed in any precision: efforts, and reactions of ground and then of
/// every joint, fx fy fz tx ty tz each.
struct StateResults {
  std::vector<long double> efforts, child_axes, root_axes;
};

/// Precision and range of a number type.
struct PrecisionLimits {
  long double eps = 0;      ///< distance from 1 to the next number
  double least = 0;         ///< least normal number as a double, which is zero for long double
  long double largest = 0;  ///< largest finite number
};

/// How far results of one sample, or of many, are from the exact ones.
struct Errors {
  double over_bound = 0;  ///< largest error over its bound; infinite where a result is not finite
  /// Largest error over a narrower bound, whose L does not count the joints before the result's
  /// own.
  double over_subtree_bound = 0;
  double relative = 0;  ///< largest error over the largest number of its kind in the state
  std::string worst;    ///< name of the result with the largest error over its bound

  void include(const Errors& other);
};

/// The exact efforts and reactions of a state, and how far from them results may be.
///
/// Efforts in N m are of one kind with the moments, efforts in N with the forces. Where all numbers
/// of a kind are zero, there is no relative error.
class ExactResults {
 public:
  /// Computes the exact results.
  /// @param bound the bound after bound.compute(motion).
  ExactResults(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
               const ErrorBound& bound);

  /// Errors of results over the bound 4 L eps S. Results beyond the largest number of the precision
  /// are left out.
  /// @param bound the bound after bound.compute(motion, limits.least).
  Errors errorsOf(const StateResults& results, const PrecisionLimits& limits,
                  const ErrorBound& bound) const;

  /// Errors of efforts alone, in double, over the bound 4 L eps S.
  /// @param bound the bound after bound.compute(motion, limits.least).
  Errors errorsOfEfforts(const std::vector<double>& efforts, const PrecisionLimits& limits,
                         const ErrorBound& bound) const;

  /// Largest difference between these results and those of another state, relative to the largest
  /// number of the kind in these.
  double relativeDifference(const ExactResults& other) const;

 private:
  struct Wrench {
    ExactNumber force[3], moment[3];
  };
  static Wrench split(const Reference113::Wrench& wrench);
  void countSubtrees(const ErrorBound& bound);
  void noteLargest(const ErrorBound& bound);
  bool turns(std::size_t coordinate) const;
  void judgeEfforts(const std::vector<long double>& results, const PrecisionLimits& limits,
                    const ErrorBound& bound, Errors& errors) const;
  void judgeWrenches(const std::vector<Wrench>& exact, const std::vector<long double>& results,
                     const PrecisionLimits& limits, const ErrorBound& bound, const char* axes,
                     Errors& errors) const;

  const Mechanism& mechanism_;
  std::vector<ExactNumber> efforts_;
  std::vector<Wrench> child_axes_, root_axes_;
  std::vector<int> subtree_depths_,
      effort_subtree_depths_;  // as ErrorBound's without joints before
  long double largest_force_ = 0, largest_moment_ = 0;
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
