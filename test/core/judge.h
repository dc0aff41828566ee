#pragma once

#include "plain_results.h"
#include "stability/exact_results.h"

#ifdef VWD_HAS_REAL113

#include <limits>

namespace virtual_work_dynamics {

/// Compares results of one mechanism and scene with those in 113 bits and with ErrorBound.
class Judge {
 public:
  Judge(const Mechanism& mechanism, const Scene& scene)
      : mechanism_(mechanism), scene_(scene), bound_(mechanism, scene) {}

  /// The errors of results over their bounds.
  /// @param results the results of requestEveryJoint().
  Errors errorsOf(const PlainResults<double>& results, const Motion& motion) {
    using Limits = std::numeric_limits<double>;
    bound_.compute(motion, Limits::min());
    const ExactResults exact(mechanism_, scene_, motion, bound_);
    return exact.errorsOf(
        {widened(results.effort), widened(results.child_axes), widened(results.root_axes)},
        {Limits::epsilon(), Limits::min(), Limits::max()}, bound_);
  }

 private:
  static std::vector<long double> widened(const std::vector<double>& numbers) {
    return {numbers.begin(), numbers.end()};
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  ErrorBound bound_;
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
