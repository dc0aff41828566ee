#include "dynamics/given_joints.h"

#include <algorithm>

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
    : dynamics_(dynamics), names_(mechanism.coordinateNames()) {
  for (const int k : mechanism.coordinates()) {
    const Link& link = mechanism.link(mechanism.joint(k).child_link);
    added_.push_back(link.mass == 0 && link.name == mechanism.joint(k).name);
  }
}

bool GivenJoints::givesAll(const Given& given) {
  return std::count(given.coordinates.begin(), given.coordinates.end(), false) == 0;
}

std::vector<bool> GivenJoints::resting(const Dynamics& dynamics) {
  return givesAll(dynamics.given()) ? dynamics.actuated() : dynamics.given().coordinates;
}

std::optional<std::string> GivenJoints::problem(const Given& given) const {
  const bool drives = given.drivenNumbers() > 0;
  if (givesAll(given) && !drives) return std::nullopt;
  // More actuators than degrees of freedom are no mistake.
  if (dynamics_.closuresDetermine() && given.coordinates == dynamics_.actuated() && !drives) {
    return std::nullopt;
  }
  const ClosedLoopDynamics::GivenFinding finding = dynamics_.judge(given);
  if (finding.freedom > 0) return tooLittle(finding, given);
  if (finding.follow.empty()) return std::nullopt;
  if (needsPositionOf(finding.follow.front(), given)) {
    return "too much is given: rates of " + listed(finding.follow) +
           " follow from each other, though their positions do not; " + orGiveAll(given);
  }
  if (finding.follow.size() == 1) {
    return "too much is given: " + listed(finding.follow) +
           " follows from the rest; leave it out, or " + orGiveAll(given);
  }
  return "too much is given: each of " + listed(finding.follow) +
         " follows from the rest; leave one out, or " + orGiveAll(given);
}

// Motors and axes of closures are joints, too, which who gives all joints may not think of.
std::string GivenJoints::orGiveAll(const Given& given) const {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (added_[i] && !given.coordinates[i]) missing.push_back(names_[i]);
  }
  return "give all joints" + (missing.empty() ? "" : ", with " + listed(missing) + ",") +
         " and nothing else";
}

// Whether the position of a coordinate does not follow from what is given besides it.
bool GivenJoints::needsPositionOf(const std::string& name, Given given) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] != name || !given.coordinates[i]) continue;
    given.coordinates[i] = false;
    return dynamics_.judge(given).freedom > 0;
  }
  return false;
}

std::string GivenJoints::tooLittle(const ClosedLoopDynamics::GivenFinding& finding,
                                   const Given& given) const {
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const bool open = std::find(finding.undetermined.begin(), finding.undetermined.end(),
                                names_[i]) != finding.undetermined.end();
    if (open && dynamics_.actuated()[i] && !given.coordinates[i]) missing.push_back(names_[i]);
  }
  return "too little is given: the motion of " + listed(finding.undetermined) +
         " does not follow from it; " + std::to_string(finding.freedom) +
         (finding.freedom == 1 ? " more is" : " more are") + " needed" +
         (missing.empty() ? "" : ", such as the actuated " + listed(missing));
}

}  // namespace virtual_work_dynamics
