#pragma once

#include <functional>
#include <vector>

#include "described_robot.h"
#include "dirty_descriptions.h"

namespace virtual_work_dynamics {
namespace dirty {

/// Spoils a robot in one way.
struct NamedFault {
  const char* name;
  Verdict verdict;  ///< on a robot that is spoilt in this way only
  std::function<void(Robot&, Dice&)> apply;
};

const std::vector<NamedFault>& inertialFaults();
const std::vector<NamedFault>& jointFaults();
const std::vector<NamedFault>& textFaults();

}  // namespace dirty
}  // namespace virtual_work_dynamics
