#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "random_cases.h"
#include "scene_writer.h"
#include "tested_build.h"
#include "urdf_writer.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

// Fewer cases run with sanitizers, which take ten times as long.
inline unsigned casesPerProperty() {
  return kSanitized ? 500 : 4000;
}

// The error that results may have, in roundings of double: 4 for every joint on the way, which is
// the package's contract, and 2 for the numbers that a transformed case rounds anew: its constants,
// its gravity and its wrenches.
constexpr long double kEps = std::numeric_limits<double>::epsilon();
constexpr long double kRoundingsPerJoint = 4;
constexpr long double kRoundingsOfInput = 2;

/// A number and the error that it may have.
struct Measured {
  long double value = 0;
  long double error = 0;
};

inline Measured operator+(const Measured& a, const Measured& b) {
  return {a.value + b.value, a.error + b.error};
}
inline Measured operator*(long double factor, const Measured& a) {
  return {factor * a.value, std::abs(factor) * a.error};
}

/// A wrench and the errors that its force and its moment may have.
struct LongWrench {
  Vector3l force = Vector3l::Zero(), torque = Vector3l::Zero();
  long double force_error = 0, torque_error = 0;

  LongWrench turned(const Matrix3l& R) const {
    return {R * force, R * torque, force_error, torque_error};
  }
  /// The wrench about a point that lies `d` from the present one.
  LongWrench about(const Vector3l& d) const {
    return {force, torque - d.cross(force), force_error, torque_error + d.norm() * force_error};
  }
};

inline LongWrench operator+(const LongWrench& a, const LongWrench& b) {
  return {a.force + b.force, a.torque + b.torque, a.force_error + b.force_error,
          a.torque_error + b.torque_error};
}
inline LongWrench operator*(long double factor, const LongWrench& a) {
  const long double size = std::abs(factor);
  return {factor * a.force, factor * a.torque, size * a.force_error, size * a.torque_error};
}
inline LongWrench operator-(const LongWrench& a, const LongWrench& b) {
  return a + (-1) * b;
}

/// The error that a result may have which is `depth` joints away from the leaves.
inline long double allowedError(int depth, double magnitude) {
  return (kRoundingsPerJoint * std::max(depth, 1) + kRoundingsOfInput) * kEps * magnitude;
}

/// Results of a case by name, each with the error that it may have.
class Outcome {
 public:
  explicit Outcome(const Case& made)
      : mechanism_(made.mechanism),
        dynamics_(made.mechanism, made.scene),
        workspace_(dynamics_.makeWorkspace()),
        bound_(made.mechanism, made.scene) {
    dynamics_.compute(made.motion, workspace_);
    bound_.compute(made.motion);
  }

  const std::vector<std::string>& coordinates() const { return mechanism_.coordinateNames(); }
  const Request& request() const { return dynamics_.request(); }
  /// The joints that have reactions.
  const std::vector<std::string>& reactions() const { return dynamics_.request().child_axes; }

  Measured effort(const std::string& joint) const {
    const std::size_t i = indexIn(coordinates(), joint);
    return {workspace_.effort()[static_cast<Eigen::Index>(i)],
            allowedError(bound_.effortDepths()[i], bound_.efforts()[i])};
  }
  LongWrench child(const std::string& joint) const {
    return measured(workspace_.childAxes()[indexIn(reactions(), joint)], joint);
  }
  LongWrench root(const std::string& joint) const {
    return measured(workspace_.rootAxes()[indexIn(reactions(), joint)], joint);
  }

 private:
  static std::size_t indexIn(const std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::out_of_range("no result of '" + name + "'");
    return static_cast<std::size_t>(found - names.begin());
  }

  LongWrench measured(const Wrench& wrench, const std::string& joint) const {
    const std::size_t k = static_cast<std::size_t>(mechanism_.jointIndex(joint) + 1);
    const WrenchMagnitude& magnitude = bound_.wrenches()[k];
    const int depth = bound_.depths()[k];
    return {wrench.force.cast<long double>(), wrench.torque.cast<long double>(),
            allowedError(depth, magnitude.force), allowedError(depth, magnitude.moment)};
  }

  Mechanism mechanism_;
  InverseDynamics dynamics_;
  Workspace workspace_;
  ErrorBound bound_;
};

/// Compares results, and remembers the largest difference relative to the allowed one.
class Agreement {
 public:
  /// Begins a comparison of results of these cases, which the text of a failure repeats.
  void begin(std::vector<Case> cases) { cases_ = std::move(cases); }

  void compare(const std::string& what, const Measured& a, const Measured& b) {
    judge(what, std::abs(a.value - b.value), a.error + b.error);
  }
  void compare(const std::string& what, const LongWrench& a, const LongWrench& b) {
    judge(what + ", force", (a.force - b.force).norm(), a.force_error + b.force_error);
    judge(what + ", moment", (a.torque - b.torque).norm(), a.torque_error + b.torque_error);
  }

  void fail(const std::string& what) {
    if (failure_.empty()) failure_ = what;
  }

  const std::string& failure() const { return failure_; }
  long double worst() const { return worst_; }
  long long comparisons() const { return comparisons_; }

  /// The compared cases as the contents of files that repeat them.
  std::string replay() const {
    std::string text;
    for (const Case& made : cases_) {
      text += "--- description\n" + urdfText(made.mechanism) + "--- scene\n" +
              yamlText(made.scene) + "--- motion\n" + csvText(made.mechanism, made.motion);
    }
    return text;
  }

 private:
  void judge(const std::string& what, long double difference, long double allowed) {
    ++comparisons_;
    const long double ratio = difference == 0 ? 0 : difference / allowed;
    if (!(ratio <= 1)) {
      fail(what + ": differ by " + numberText(static_cast<double>(difference)) + ", allowed are " +
           numberText(static_cast<double>(allowed)));
    }
    worst_ = std::max(worst_, ratio);
  }

  std::vector<Case> cases_;
  std::string failure_;
  long double worst_ = 0;
  long long comparisons_ = 0;
};

/// Checks a property on many random cases by check(RandomCases&, Agreement&), and stops at the
/// first case that fails.
template <typename Check>
void checkProperty(unsigned first_seed, Check check, unsigned cases = casesPerProperty()) {
  Agreement agreement;
  for (unsigned seed = first_seed; seed < first_seed + cases; ++seed) {
    RandomCases random(seed);
    try {
      check(random, agreement);
    } catch (const std::exception& error) {
      agreement.fail(error.what());
    }
    ASSERT_EQ(agreement.failure(), "") << "seed " << seed << "\n" << agreement.replay();
  }
  EXPECT_GT(agreement.comparisons(), cases);
  std::cout << "  " << cases << " cases, " << agreement.comparisons()
            << " comparisons, largest difference over what is allowed: "
            << static_cast<double>(agreement.worst()) << "\n";
}

/// Reorders a motion for a mechanism that has the same joints in another order.
inline Motion reordered(const Mechanism& from, const Motion& motion, const Mechanism& to) {
  Motion result(motion.q.size());
  for (Eigen::Index i = 0; i < result.q.size(); ++i) {
    const auto& names = from.coordinateNames();
    const auto found = std::find(names.begin(), names.end(), to.coordinateNames()[i]);
    const Eigen::Index place = found - names.begin();
    result.q[i] = motion.q[place];
    result.qd[i] = motion.qd[place];
    result.qdd[i] = motion.qdd[place];
  }
  return result;
}

}  // namespace virtual_work_dynamics
