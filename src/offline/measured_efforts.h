#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "offline/motion_file.h"

namespace virtual_work_dynamics {

/// What of a joint was measured, at instants of its own.
class MeasuredEffort {
 public:
  explicit MeasuredEffort(std::string joint) : joint_(std::move(joint)) {}

  const std::string& joint() const { return joint_; }
  std::size_t size() const { return stamps_ns_.size(); }
  /// Adds a measurement, in any order of their stamps. @param effort N m or N
  void add(std::int64_t stamp_ns, double effort);
  /// Puts the measurements in order; of those with one stamp, the first that came stays. Before
  /// any is read.
  void sort();

  /// The effort at an instant, between the measurement before and the one after it on a straight
  /// line, as live wrenches are read. NaN before the first and after the last one, and between two
  /// that are further apart than `max_gap_ns`.
  double at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const;

  std::int64_t firstNs() const { return stamps_ns_.front(); }
  std::int64_t lastNs() const { return stamps_ns_.back(); }

 private:
  std::string joint_;
  std::vector<std::int64_t> stamps_ns_;
  std::vector<double> values_;
};

/// Measured efforts by joint, in the order in which the joints came.
using MeasuredEfforts = std::vector<MeasuredEffort>;

/// The instant of a row, ns: its recorded stamp, or its time where the file has no stamps.
std::int64_t instantNs(const MotionFile& file, std::size_t row);

/// Time in s as ns. @throws FileError beginning with `where` when it is beyond any recording's.
std::int64_t nanosecondsOf(double time, const std::string& where);

}  // namespace virtual_work_dynamics
