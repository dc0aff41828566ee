#pragma once

#include <limits>
#include <memory>
#include <string>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The function of time of a drive.
class TimeFunction {
 public:
  virtual ~TimeFunction() = default;
  /// Sets position, velocity and acceleration at a time from begin() to end(). Does not allocate.
  /// @param motion of one coordinate
  virtual void evaluate(double t, Motion& motion) const = 0;
  virtual double begin() const { return -std::numeric_limits<double>::infinity(); }  ///< s
  virtual double end() const { return std::numeric_limits<double>::infinity(); }     ///< s
};

/// @param place how messages begin
/// @throws SceneError as Drives.
std::unique_ptr<const TimeFunction> timeFunction(const DriveLaw& law, const std::string& place);

}  // namespace virtual_work_dynamics
