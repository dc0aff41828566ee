#include "ros/sample_times.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

SampleTimes::SampleTimes(double duration, double rate)
    : duration_(duration),
      rate_(rate),
      duration_ns_(std::llround(duration * 1e9L)),
      step_ns_(std::llround(1e9L / rate)),
      last_(duration > 0 ? std::max(1LL, std::llround(duration * static_cast<long double>(rate)))
                         : 0) {}

std::int64_t SampleTimes::offset(std::int64_t k) const {
  return k == last_ ? duration_ns_ : std::llround(static_cast<long double>(k) * 1e9L / rate_);
}

double SampleTimes::time(std::int64_t k) const {
  // The duration rounded to nanoseconds must not lead beyond the end of the motion, where it is at
  // rest.
  return std::min(static_cast<double>(offset(k)) / 1e9, duration_);
}

}  // namespace virtual_work_dynamics
