#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ros/joint_state_conversion.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Asks once of each joint about positions so far beyond its limits that they are hardly rad or m.
class PositionWatch {
 public:
  explicit PositionWatch(const Mechanism& mechanism);

  /// @returns what is to be asked. Allocates only then.
  std::optional<std::string> take(const JointSample& sample);

 private:
  const Mechanism& mechanism_;
  std::vector<double> largest_;  // of each coordinate; infinite without limits, and once asked
};

}  // namespace virtual_work_dynamics
