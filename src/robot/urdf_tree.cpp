#include "robot/urdf_tree.h"

#include <unordered_map>
#include <unordered_set>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

void UrdfTree::check() const {
  const std::unordered_set<std::string> known(links_.begin(), links_.end());
  std::unordered_map<std::string, const Joint*> joint_of;  // by child link
  for (const Joint& joint : joints_) {
    for (const std::string* link : {&joint.parent, &joint.child}) {
      if (known.count(*link) > 0) continue;
      throw UrdfError("joint " + inQuotes(joint.name) + ": no link " + inQuotes(*link) +
                      nameHelp(*link, links_));
    }
    const auto [other, is_new] = joint_of.emplace(joint.child, &joint);
    if (!is_new) {
      throw UrdfError("link " + inQuotes(joint.child) + ": is the child of two joints, " +
                      inQuotes(other->second->name) + " and " + inQuotes(joint.name));
    }
  }
  std::vector<std::string> roots;
  for (const std::string& link : links_) {
    if (joint_of.count(link) == 0) roots.push_back(link);
  }
  if (roots.empty()) {
    throw UrdfError("link " + inQuotes(links_.front()) +
                    ": its parents form a loop, and no link is the root");
  }
  if (roots.size() > 1) {
    throw UrdfError("links " + namesInQuotes(roots) +
                    " are all roots: a robot is one tree, so joints have to connect them");
  }
}

}  // namespace virtual_work_dynamics
