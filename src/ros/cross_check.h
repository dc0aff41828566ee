#pragma once

#include <Eigen/Core>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {

/// Holds a sample of one plan that the computing thread leaves for the checking thread: one of all
/// samples offered since the check before, each with equal probability. Always taking the first or
/// the last one would see trajectories at rest, where many errors do not show. The computing side
/// neither waits, locks nor allocates; samples offered during a check are ignored.
class CrossCheckSlot {
 public:
  /// The largest difference between results and Lagrange's equations.
  struct Finding {
    double largest = 0;  ///< difference over the sum of magnitudes; infinity when not comparable
    std::string where;   ///< "effort of elbow", "moment at wrist"
  };

  /// For a mechanism with closed loops Lagrange's equations see its tree, with the wrenches found
  /// for the loops applied to it. Reactions of closures, which are these wrenches, are not
  /// compared. All efforts are: those of passive joints vanish when the wrenches are a solution.
  /// @param plan the plan whose samples will be offered; need not outlive this
  CrossCheckSlot(const Mechanism& mechanism, const Dynamics& plan);

  /// For the computing thread: copies the sample over the one before if it is drawn, and returns
  /// whether it is. Motion, load and results are the plan's.
  bool offer(const Motion& motion, const Load& load, const Results& results);

  /// For any thread: true while a sample waits to be checked.
  bool full() const { return state_.load(std::memory_order_acquire) == State::kFull; }
  /// For the checking thread: computes the sample by Lagrange's equations, compares, and makes room
  /// for the next one. Returns nothing when there is no sample. Allocates only for Finding::where.
  std::optional<Finding> check();

 private:
  enum class State { kEmpty, kWriting, kFull, kChecking };

  // A reaction of the request that Lagrange's equations give as well.
  struct Compared {
    std::size_t result = 0;     // place in the request
    std::size_t magnitude = 0;  // place in ErrorBound::wrenches()
  };

  static std::vector<Compared> comparedOf(const Mechanism& mechanism,
                                          const std::vector<std::string>& joints);
  void compareEfforts(Finding& finding) const;
  void compareWrenches(const std::vector<Wrench>& results, const std::vector<Wrench>& others,
                       const std::vector<std::string>& joints,
                       const std::vector<Compared>& compared, Finding& finding) const;

  const std::vector<std::string> coordinates_;
  // By the reactions of lagrange_.request(), in its order.
  const std::vector<Compared> child_compared_, root_compared_;
  const bool closed_;
  LagrangeDynamics<long double> lagrange_;
  ErrorBound bound_;

  std::atomic<State> state_{State::kEmpty};
  std::uint64_t offered_ = 0;  // since the check before
  std::minstd_rand random_;
  // Used by the computing thread while writing, by the checking thread while checking.
  Motion motion_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> child_axes_;
  std::vector<Wrench> root_axes_;
  Load load_;  // of the tree
};

/// Checks a sample of the plan in use now and then by the paper's other formalism. This has a
/// thread of its own, as Lagrange's equations of a large robot take seconds; neither computing nor
/// reporting waits for it.
class CrossCheck {
 public:
  struct Report {
    std::uint64_t done = 0;           ///< checks in all
    bool news = false;                ///< whether there are any since the last report
    CrossCheckSlot::Finding finding;  ///< the largest of the new ones
  };

  /// @param rate the most checks a second, 0.001 to 1000.
  explicit CrossCheck(double rate);
  /// Waits for the check under way, if any.
  ~CrossCheck();
  CrossCheck(const CrossCheck&) = delete;
  CrossCheck& operator=(const CrossCheck&) = delete;

  /// From now on checks only the samples of this slot, or none when it is null.
  void watch(std::shared_ptr<CrossCheckSlot> slot);

  /// What was found since the call before. Does not wait for a check.
  Report takeReport();

 private:
  using Clock = std::chrono::steady_clock;

  void run();

  const Clock::duration period_;
  std::mutex mutex_;  // guards all members below except the thread
  std::condition_variable changed_;
  std::shared_ptr<CrossCheckSlot> slot_;
  Report report_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace virtual_work_dynamics
