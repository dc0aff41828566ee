#include "dynamics/given_joints.h"

#include "base/printable.h"

namespace virtual_work_dynamics {

namespace {

// Lists names like "'a', 'b' and 3 more", as an error is one line.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) {
    text += (i == 0 ? "" : ", ") + inQuotes(names[i]);
  }
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

}  // namespace

GivenJoints::GivenJoints(const Mechanism& mechanism, const Dynamics& dynamics)
    : names_(mechanism.coordinateNames()),
      actuated_(dynamics.actuated()),
      closures_determine_(dynamics.closuresDetermine()) {}

std::optional<std::string> GivenJoints::problem(const std::vector<bool>& given) const {
  std::vector<std::string> actuated_missing, passive_given, passive_missing;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!actuated_[i]) (given[i] ? passive_given : passive_missing).push_back(names_[i]);
    if (actuated_[i] && !given[i]) actuated_missing.push_back(names_[i]);
  }
  if (!actuated_missing.empty()) return "the joints " + listed(actuated_missing) + " are missing";
  if (passive_missing.empty()) return std::nullopt;
  if (!closures_determine_) {
    return "the passive joints " + listed(passive_missing) +
           " are missing: where a closure is actuated, all joints must be given";
  }
  if (passive_given.empty()) return std::nullopt;
  return "the passive joints " + listed(passive_given) + " are given, but not " +
         listed(passive_missing) + ": give all joints, or the actuated ones only";
}

bool GivenJoints::givesPassive(const std::vector<bool>& given) const {
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] && !actuated_[i]) return true;
  }
  return false;
}

}  // namespace virtual_work_dynamics
