#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// A wrench that was measured in the frame of a link of the robot, or in the inertial one.
struct MeasuredWrench {
  /// In place of a link: the frame that a root link moves against.
  static constexpr int kInertial = -1;

  std::int64_t stamp_ns = 0;
  int frame = 0;  ///< link whose axes `value` and `at` have, or kInertial
  Wrench value;   ///< N, and N m about the point `at`
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< from the origin of the frame, m
};

/// The latest measurements of one wrench, by their stamps. Does not allocate after construction.
class WrenchHistory {
 public:
  /// Measurements that are kept at most.
  static constexpr std::size_t kMost = 4096;

  /// @param timeout_ns longest time that a measurement stands for, and longest one between two that
  ///   are interpolated
  explicit WrenchHistory(std::int64_t timeout_ns) : timeout_ns_(timeout_ns), ring_(kMost) {}

  enum class Verdict {
    kTaken,
    kEqualStamp,  ///< not taken
    kTooLate      ///< not taken: it is older than the newest, by no more than the timeout
  };
  /// Takes a measurement. One that is older than the newest by more than the timeout forgets all
  /// others: time went back.
  Verdict push(const MeasuredWrench& wrench);

  /// What is known of an instant.
  struct Reading {
    const MeasuredWrench* before = nullptr;  ///< the newest that is not later; null: not known
    const MeasuredWrench* after = nullptr;   ///< the one after it; null: `before` stands alone
    double share = 0;                        ///< of `after`, from 0 to below 1
    /// Whether `before` stands for a later instant.
    bool held = false;
  };
  /// Reads an instant; valid until the next push().
  Reading read(std::int64_t stamp_ns) const;

  std::size_t size() const { return size_; }
  /// The i-th measurement that is kept, oldest first.
  const MeasuredWrench& at(std::size_t i) const { return ring_[(first_ + i) % kMost]; }

 private:
  const std::int64_t timeout_ns_;
  std::vector<MeasuredWrench> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace virtual_work_dynamics
