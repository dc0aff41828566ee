#include "offline/joint_renaming.h"

#include "base/printable.h"
#include "offline/arguments.h"

namespace virtual_work_dynamics {
namespace {

// Longer names are no joint's, and would take std::regex too deep.
constexpr std::size_t kLongestName = 1000;

}  // namespace

void JointRenaming::add(const std::string& rule) {
  const std::size_t equals = rule.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == rule.size()) {
    throw UsageError("--rename: " + inQuotes(rule) + " is not PATTERN=NAME");
  }
  try {
    rules_.emplace_back(std::regex(rule.substr(0, equals)), rule.substr(equals + 1));
  } catch (const std::regex_error&) {
    throw UsageError("--rename: " + inQuotes(rule.substr(0, equals)) +
                     " is not a regular expression");
  }
}

std::string JointRenaming::operator()(const std::string& name) const {
  if (name.size() > kLongestName) return name;
  std::smatch match;
  for (const auto& [pattern, replacement] : rules_) {
    if (std::regex_match(name, match, pattern)) {
      return match.format(replacement, std::regex_constants::format_sed);
    }
  }
  return name;
}

}  // namespace virtual_work_dynamics
