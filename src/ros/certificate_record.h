#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "virtual_work_dynamics/certificates.h"

namespace virtual_work_dynamics {

/// The largest certificates since the last report. One thread records and another one takes
/// reports; neither waits for the other nor allocates.
class CertificateRecord {
 public:
  /// Records the certificates of a sample; NaN counts as infinity.
  void record(const Certificates& certificates) {
    raise(power_, certificates.power);
    raise(ground_force_, certificates.ground_force);
    raise(ground_moment_, certificates.ground_moment);
  }

  /// The largest of each kind since the call before; nothing when none was recorded. When a sample
  /// is recorded meanwhile, some of its kinds may belong to the next interval.
  std::optional<Certificates> take() {
    const double power = power_.exchange(kNone, std::memory_order_relaxed);
    const double force = ground_force_.exchange(kNone, std::memory_order_relaxed);
    const double moment = ground_moment_.exchange(kNone, std::memory_order_relaxed);
    if (power == kNone && force == kNone && moment == kNone) return std::nullopt;
    Certificates largest;
    largest.power = std::max(power, 0.0);
    largest.ground_force = std::max(force, 0.0);
    largest.ground_moment = std::max(moment, 0.0);
    return largest;
  }

 private:
  static constexpr double kNone = -1;

  static void raise(std::atomic<double>& largest, double value) {
    if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
    // If take() runs between the two lines, the larger value belongs to the next interval.
    if (value > largest.load(std::memory_order_relaxed)) {
      largest.store(value, std::memory_order_relaxed);
    }
  }

  std::atomic<double> power_{kNone};
  std::atomic<double> ground_force_{kNone};
  std::atomic<double> ground_moment_{kNone};
};

}  // namespace virtual_work_dynamics
