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

RootAxes readRootAxes(PrivateParameters& parameters, RootSource source) {
  constexpr std::pair<const char*, RootAxes> kAxes[] = {
      {"root", RootAxes::kRoot}, {"inertial", RootAxes::kInertial}, {"both", RootAxes::kBoth}};
  const std::string text = parameters.text("root/axes", "root");
  for (const auto& [name, axes] : kAxes) {
    if (text != name) continue;
    if (axes == RootAxes::kRoot) return axes;
    if (source == RootSource::kNone)
      throw parameterError("root/axes", inQuotes(text) + ": the root link rests");
    return axes;
  }
  throw parameterError("root/axes", inQuotes(text) + " is none of root, inertial and both");
}

}  // namespace virtual_work_dynamics
