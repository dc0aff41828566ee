#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Which of several values, by joint, stay beyond their thresholds. One thread records and another
/// one takes reports; the recording one neither waits nor allocates.
class ThresholdRecord {
 public:
  /// @param thresholds of magnitudes, by name; infinite: none
  /// @param hold s that a value must stay beyond its threshold before it counts
  /// @param max_gap s between two instants; what is beyond after a longer time begins anew
  ThresholdRecord(std::vector<std::string> names, std::vector<double> thresholds, double hold,
                  double max_gap);

  /// Records the values of an instant, NaN where they are not known. An instant that comes while a
  /// report is taken is left out.
  void record(std::int64_t stamp_ns, const std::vector<double>& values);

  /// A value that was beyond its threshold for longer than the hold time.
  struct Excess {
    std::string name;
    double threshold = 0;
    double peak = 0;     ///< the value whose magnitude was largest
    double seconds = 0;  ///< that it has lasted, or did
  };
  /// What counts since the call before.
  std::vector<Excess> take();

 private:
  struct State {
    std::int64_t since_ns = 0;
    bool beyond = false, counts = false;
    double peak = 0;
    std::int64_t latest_ns = 0;
  };

  const std::vector<std::string> names_;
  const std::vector<double> thresholds_;
  const std::int64_t hold_ns_, max_gap_ns_;
  std::mutex mutex_;
  std::vector<State> states_;
};

}  // namespace virtual_work_dynamics
