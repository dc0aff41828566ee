#pragma once

#include "reference_113.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <limits>
#include <ostream>
#include <utility>
#include <vector>

#include "plain_results.h"

namespace virtual_work_dynamics {

/// Relative errors of results: of an effort over the largest effort of the motion, of a reaction's
/// force over the largest force, of its moment over the largest moment. An error is infinite when a
/// result is not finite.
struct ResultErrors {
  double effort = 0, force = 0, moment = 0;

  void include(const ResultErrors& other) {
    effort = std::max(effort, other.effort);
    force = std::max(force, other.force);
    moment = std::max(moment, other.moment);
  }
  double largest() const { return std::max({effort, force, moment}); }
};

inline std::ostream& operator<<(std::ostream& stream, const ResultErrors& errors) {
  return stream << "efforts " << errors.effort << ", forces " << errors.force << ", moments "
                << errors.moment;
}

/// The results that a request should have along a motion, in 113 bits.
class ExpectedResults {
 public:
  ExpectedResults(const Mechanism& mechanism, const Scene& scene, const Request& request,
                  const std::vector<Motion>& motions) {
    for (const Motion& motion : motions) {
      const Reference113 reference(mechanism, scene, motion);
      Sample sample;
      if (request.efforts) sample.effort = reference.efforts();
      for (const std::string& name : request.child_axes) {
        sample.child_axes.push_back(reference.childAxes(mechanism.jointIndex(name)));
      }
      for (const std::string& name : request.root_axes) {
        sample.root_axes.push_back(reference.rootAxes(mechanism.jointIndex(name)));
      }
      noteLargest(sample);
      samples_.push_back(std::move(sample));
    }
  }

  /// The largest errors of all samples.
  template <typename Real>
  ResultErrors errorsOf(const std::vector<PlainResults<Real>>& results) const {
    ResultErrors errors;
    EXPECT_EQ(results.size(), samples_.size());
    for (std::size_t n = 0; n < results.size(); ++n) include(samples_[n], results[n], errors);
    return errors;
  }

  /// The largest errors of samples that InverseDynamics computes one by one.
  ResultErrors errorsOf(const InverseDynamics& dynamics, const std::vector<Motion>& motions) const {
    std::vector<PlainResults<double>> results;
    Workspace workspace = dynamics.makeWorkspace();
    for (const Motion& motion : motions) {
      dynamics.compute(motion, workspace);
      results.push_back(singleResults(workspace));
    }
    return errorsOf(results);
  }

 private:
  struct Sample {
    std::vector<Real113> effort;
    std::vector<Reference113::Wrench> child_axes, root_axes;
  };

  void noteLargest(const Sample& sample) {
    for (const Real113 effort : sample.effort) {
      largest_effort_ = std::max(largest_effort_, magnitude(effort));
    }
    for (const auto* wrenches : {&sample.child_axes, &sample.root_axes}) {
      for (const Reference113::Wrench& wrench : *wrenches) {
        largest_force_ = std::max(largest_force_, norm(wrench.force));
        largest_moment_ = std::max(largest_moment_, norm(wrench.torque));
      }
    }
  }

  template <typename Real>
  void include(const Sample& sample, const PlainResults<Real>& results,
               ResultErrors& errors) const {
    EXPECT_EQ(results.effort.size(), sample.effort.size());
    for (std::size_t i = 0; i < sample.effort.size(); ++i) {
      take(magnitude(results.effort[i] - sample.effort[i]), largest_effort_, errors.effort);
    }
    include(sample.child_axes, results.child_axes, errors);
    include(sample.root_axes, results.root_axes, errors);
  }

  template <typename Real>
  void include(const std::vector<Reference113::Wrench>& expected, const std::vector<Real>& numbers,
               ResultErrors& errors) const {
    ASSERT_EQ(numbers.size(), 6 * expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Real* const wrench = &numbers[6 * i];
      const Vector113 force{wrench[0], wrench[1], wrench[2]};
      const Vector113 moment{wrench[3], wrench[4], wrench[5]};
      take(norm(force - expected[i].force), largest_force_, errors.force);
      take(norm(moment - expected[i].torque), largest_moment_, errors.moment);
    }
  }

  static void take(Real113 error, Real113 largest, double& relative) {
    const double value = error == 0 ? 0 : static_cast<double>(error / largest);
    relative =
        std::isfinite(value) ? std::max(relative, value) : std::numeric_limits<double>::infinity();
  }

  std::vector<Sample> samples_;
  Real113 largest_effort_ = 0, largest_force_ = 0, largest_moment_ = 0;
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
