#pragma once

#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace virtual_work_dynamics {

/// Names of joints in a motion as the description has them.
class JointRenaming {
 public:
  /// Adds a rule `PATTERN=NAME`: a name that the regular expression (ECMAScript) matches as a whole
  /// becomes NAME, in which \1 to \9 stand for what its groups match. The first rule that matches
  /// counts. @throws UsageError for a text that is not such a rule.
  void add(const std::string& rule);

  bool empty() const { return rules_.empty(); }
  std::string operator()(const std::string& name) const;

 private:
  std::vector<std::pair<std::regex, std::string>> rules_;
};

}  // namespace virtual_work_dynamics
