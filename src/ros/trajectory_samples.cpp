#include "ros/trajectory_samples.h"

#include <utility>

namespace virtual_work_dynamics {

TrajectorySamples::TrajectorySamples(TrajectoryCurve curve, double rate, std::int64_t first_ns)
    : curve_(std::move(curve)), times_(curve_.endTime(), rate), first_ns_(first_ns) {}

}  // namespace virtual_work_dynamics
