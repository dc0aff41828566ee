#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Which links the joints of a description join.
class UrdfTree {
 public:
  void addLink(const std::string& name) { links_.push_back(name); }
  void addJoint(const std::string& name, const std::string& parent, const std::string& child) {
    joints_.push_back({name, parent, child});
  }

  /// Checks that the links hang on one root, each on one joint. What hangs on no root, beside a
  /// part that does, is found by who walks along the tree.
  /// @throws UrdfError naming joint or link: an unknown link, two parents, no root or several.
  void check() const;

 private:
  struct Joint {
    std::string name, parent, child;
  };

  std::vector<std::string> links_;
  std::vector<Joint> joints_;
};

}  // namespace virtual_work_dynamics
