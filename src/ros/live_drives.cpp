#include "ros/live_drives.h"

#include <cmath>

namespace virtual_work_dynamics {

LiveDrives::LiveDrives(const Mechanism& mechanism, const Scene& scene, const Given& given,
                       double start)
    : drives_(mechanism, scene),
      given_(given),
      starts_at_stamp_(start != 0),
      begun_(starts_at_stamp_),
      start_ns_(std::llround(start * 1e9)),
      numbers_(static_cast<Eigen::Index>(given.drivenNumbers())) {}

void LiveDrives::begin(std::int64_t stamp_ns) {
  by_joint_states_ = true;
  if (begun_) return;
  begun_ = true;
  start_ns_ = stamp_ns;
}

void LiveDrives::beginTrajectory(std::int64_t stamp_ns) {
  if (begun_ && (starts_at_stamp_ || by_joint_states_ || stamp_ns >= start_ns_)) return;
  begun_ = true;
  start_ns_ = stamp_ns;
}

void LiveDrives::beginAnew() {
  begun_ = starts_at_stamp_;
  by_joint_states_ = false;
}

bool LiveDrives::set(std::int64_t stamp_ns, Motion& motion) {
  if (!any()) return true;
  if (!begun_) begin(stamp_ns);
  // Of whole nanoseconds, as stamps of today are too long for a double.
  time_ = static_cast<double>(stamp_ns - start_ns_) / 1e9;
  none_ = drives_.evaluate(time_, given_, motion, numbers_);
  return !failed();
}

}  // namespace virtual_work_dynamics
