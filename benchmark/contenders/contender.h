#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contenders/robots.h"

namespace virtual_work_dynamics {

constexpr char kEfforts[] = "efforts";
constexpr char kEffortsAndReactions[] = "efforts+reactions";
constexpr char kCompletedMotion[] = "motion";  // of passive joints, from that of actuated ones

/// Says what is timed, in the words of the result table.
struct Label {
  std::string method;     ///< "virtual_work", "kdl_chain", ...
  std::string precision;  ///< "double", "float", "long_double"
  /// "single" or "block_<layout>_<instruction set>"; for closed loops also "completed", which
  /// starts from the motion of the actuated joints, and "completion", which computes that of the
  /// others.
  std::string mode;
  std::string outputs;  ///< kEfforts, kEffortsAndReactions or kCompletedMotion
  int threads = 1;
};

/// Results of one sample, for comparison with the reference: numbers of the contender's precision.
struct SampleResults {
  std::vector<long double> efforts;  ///< one for each generalized coordinate, N m or N
  /// Components fx fy fz tx ty tz of each movable joint in the axes of its child link, then of each
  /// closure in those of its child frame; empty unless asked for.
  std::vector<long double> reactions;
  std::vector<long double> motion = {};  ///< q, qd, qdd; the only results of kCompletedMotion
};

/// One way of computing the inverse dynamics of a scene, set up and ready to run.
class Contender {
 public:
  virtual ~Contender() = default;

  /// Number of samples that one call computes, a divisor or a multiple of kStates.
  virtual std::size_t samplesPerCall() const { return 1; }
  /// Computes the next `calls` * samplesPerCall() samples: the scene's states in order, again and
  /// again. The loop is inside, so that no virtual call is timed.
  virtual void run(std::size_t calls) = 0;
  /// The results of the given sample of the last call. Not timed.
  virtual SampleResults results(std::size_t sample) const = 0;
};

/// A contender that can be set up. The scene must outlive it.
struct Offer {
  Label label;
  std::function<std::unique_ptr<Contender>()> make;
};

/// All contenders that can compute the scene, in the order of the report.
std::vector<Offer> offersFor(const BenchmarkScene& scene);

/// Goes through the states of a scene again and again.
class StateCycle {
 public:
  std::size_t next() {
    const std::size_t state = state_;
    state_ = (state_ + 1) % kStates;
    return state;
  }

 private:
  std::size_t state_ = 0;
};

}  // namespace virtual_work_dynamics
