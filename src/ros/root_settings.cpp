#include "ros/root_settings.h"

#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"

namespace virtual_work_dynamics {

RootSource readRootSource(PrivateParameters& parameters) {
  constexpr std::pair<const char*, RootSource> kSources[] = {
      {"", RootSource::kNone},
      {"odometry", RootSource::kOdometry},
      {"trajectory", RootSource::kTrajectory},
      {"states", RootSource::kStates},
      {"tf", RootSource::kTf},
      {"imu", RootSource::kImu}};
  const std::string source = parameters.text("root/source", "");
  for (const auto& [name, value] : kSources) {
    if (source == name) return value;
  }
  throw parameterError("root/source",
                       inQuotes(source) + " is none of odometry, trajectory, states, tf and imu");
}

}  // namespace virtual_work_dynamics
