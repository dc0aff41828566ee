#pragma once

#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Which coordinates a motion must give: all of them, or the actuated ones, from which the closures
/// determine the others.
class GivenJoints {
 public:
  GivenJoints(const Mechanism& mechanism, const Dynamics& dynamics);

  /// What is wrong with a motion that gives these coordinates, in one line without a line end, or
  /// nothing.
  std::optional<std::string> problem(const std::vector<bool>& given) const;
  /// Whether one of the given coordinates is passive.
  bool givesPassive(const std::vector<bool>& given) const;

 private:
  std::vector<std::string> names_;
  std::vector<bool> actuated_;
  bool closures_determine_;
};

}  // namespace virtual_work_dynamics
