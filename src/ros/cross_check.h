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

/// Where the thread that computes leaves a sample of one plan for the thread that checks it: of all
/// those offered since the check before, each with the same probability. Always the first one, or
/// the last one, would see trajectories at rest, where many errors do not show. The computing side
/// neither waits, locks nor allocates: samples that come during a check pass by.
class CrossCheckSlot {
 public:
  /// How far results are from Lagrange's.
  struct Finding {
    double largest = 0;  ///< difference over the sum of magnitudes; infinity: not comparable
    std::string where;   ///< "effort of elbow", "moment at wrist"
  };

  /// Of a mechanism with closed loops Lagrange's equations see its tree, with the wrenches that the
  /// loops were solved for applied to it. Reactions of closures, which are these wrenches, are not
  /// compared; all efforts are: that those of passive joints vanish says that the wrenches are a
  /// solution.
  /// @param plan whose samples will be offered; need not outlive it
  CrossCheckSlot(const Mechanism& mechanism, const Dynamics& plan);

  /// Computing thread: copies the sample in place of the one before if its turn has come, and says
  /// whether it has. Motion and results are the plan's.
  bool offer(const Motion& motion, const Results& results);

  /// Any thread: true while a sample waits to be checked.
  bool full() const { return state_.load(std::memory_order_acquire) == State::kFull; }
  /// Checking thread: computes the sample by Lagrange's equations, compares, and makes room for the
  /// next one; nothing when there is none. Allocates only for the name of the culprit.
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
  // In the order of Lagrange's equations' request.
  const std::vector<Compared> child_compared_, root_compared_;
  const bool closed_;
  LagrangeDynamics<long double> lagrange_;
  ErrorBound bound_;

  std::atomic<State> state_{State::kEmpty};
  std::uint64_t offered_ = 0;  // since the check before
  std::minstd_rand random_;
  // The computing thread's while writing, the checking thread's while checking.
  Motion motion_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> child_axes_;
  std::vector<Wrench> root_axes_;
  Load load_;  // of the tree
};

/// Checks now and then a sample of the plan in use against the paper's other formalism, in a thread
/// of its own, as Lagrange's equations of a large robot take seconds: neither what computes nor
/// what reports waits for it.
class CrossCheck {
 public:
  struct Report {
    std::uint64_t done = 0;           ///< checks in all
    bool news = false;                ///< any since the report before
    CrossCheckSlot::Finding finding;  ///< the largest of these
  };

  /// @param rate the most checks a second, 0.001 to 1000.
  explicit CrossCheck(double rate);
  /// Waits for the check under way, if any.
  ~CrossCheck();
  CrossCheck(const CrossCheck&) = delete;
  CrossCheck& operator=(const CrossCheck&) = delete;

  /// Checks the samples of this slot from now on, and no others; null: none.
  void watch(std::shared_ptr<CrossCheckSlot> slot);

  /// What was found since the call before. Waits for no check.
  Report takeReport();

 private:
  using Clock = std::chrono::steady_clock;

  void run();

  const Clock::duration period_;
  std::mutex mutex_;  // of all below but the thread
  std::condition_variable changed_;
  std::shared_ptr<CrossCheckSlot> slot_;
  Report report_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace virtual_work_dynamics
