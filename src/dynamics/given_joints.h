#pragma once

#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// What a motion must give: all coordinates, the actuated ones, or others from which the closures
/// determine the rest, and no more than these.
class GivenJoints {
 public:
  /// @param dynamics must outlive it
  GivenJoints(const Mechanism& mechanism, const Dynamics& dynamics);

  /// What is wrong with a motion that gives that, in one line without a line end, or nothing.
  /// Allocates.
  std::optional<std::string> problem(const Given& given) const;
  /// Whether all coordinates are given.
  static bool givesAll(const Given& given);
  /// The coordinates that a trajectory may leave out because they rest then: those that motions
  /// give, or the actuated ones where motions give all.
  static std::vector<bool> resting(const Dynamics& dynamics);

 private:
  std::string orGiveAll(const Given& given) const;
  bool needsPositionOf(const std::string& name, Given given) const;
  std::string tooLittle(const ClosedLoopDynamics::GivenFinding& finding, const Given& given) const;

  const Dynamics& dynamics_;
  std::vector<std::string> names_;  // of coordinates
  std::vector<bool> added_;         // whether the description does not have the coordinate
};

}  // namespace virtual_work_dynamics
