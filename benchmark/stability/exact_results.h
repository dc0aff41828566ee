#pragma once

#include "reference_113.h"

#ifdef VWD_HAS_REAL113

#include <string>
#include <vector>

#include "virtual_work_dynamics/error_bound.h"

namespace virtual_work_dynamics {

/// A number of 113 bits as the sum of two, with which computing is faster.
struct ExactNumber {
  long double high = 0, low = 0;

  ExactNumber() = default;
  explicit ExactNumber(Real113 value)
      : high(static_cast<long double>(value)),
        low(static_cast<long double>(value - static_cast<Real113>(high))) {}
};

/// Results of one sample, of whatever precision: efforts, then reactions of ground and of every
/// joint, fx fy fz tx ty tz each.
struct StateResults {
  std::vector<long double> efforts, child_axes, root_axes;
};

/// What a number type can do.
struct PrecisionLimits {
  long double eps = 0;  ///< distance from 1 to the next number
  double least = 0;     ///< normal number; as a double: zero for long double
  long double largest = 0;
};

/// How far results of one sample, or of many, are from the exact ones.
struct Errors {
  double over_bound = 0;  ///< largest error over its bound; infinite where a result is not finite
  /// The same of a narrower bound, whose L counts no joints before the one whose result it is.
  double over_subtree_bound = 0;
  double relative = 0;  ///< largest error over the largest number of its kind in the state
  std::string worst;    ///< the result that is closest to its bound, or beyond it

  void include(const Errors& other);
};

/// What the efforts and reactions of a state are, and how far from them results may be.
///
/// An effort in N m is of one kind with the moments, one in N with the forces. Where all that is of
/// a kind is zero, there is no relative error.
class ExactResults {
 public:
  /// @param bound after bound.compute(motion).
  ExactResults(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
               const ErrorBound& bound);

  /// Errors over 4 L eps S. Whatever is beyond the largest number of the precision is left out.
  /// @param bound after bound.compute(motion, limits.least).
  Errors errorsOf(const StateResults& results, const PrecisionLimits& limits,
                  const ErrorBound& bound) const;

  /// Of efforts alone, in double.
  /// @param bound after bound.compute(motion, limits.least).
  Errors errorsOfEfforts(const std::vector<double>& efforts, const PrecisionLimits& limits,
                         const ErrorBound& bound) const;

  /// Largest difference between these results and another state's, relative to the largest of the
  /// kind in this one.
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
