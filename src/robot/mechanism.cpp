#include "virtual_work_dynamics/mechanism.h"

#include <algorithm>
#include <utility>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

template <typename Named>
int indexOf(const std::vector<Named>& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& item) { return item.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

}  // namespace

const char* symbolOf(Unit unit) {
  return unit == Unit::kMetre ? "m" : "rad";
}

Unit unitOf(const Joint& joint) {
  return joint.type == JointType::kPrismatic ? Unit::kMetre : Unit::kRadian;
}

Mechanism::Mechanism(std::string name, std::vector<Link> links, std::vector<Joint> joints,
                     std::vector<Doubt> doubts)
    : name_(std::move(name)),
      links_(std::move(links)),
      joints_(std::move(joints)),
      doubts_(std::move(doubts)) {
  if (links_.size() != joints_.size() + 1) {
    throw UrdfError("mechanism " + inQuotes(name_) + ": a tree has one link more than joints");
  }
  for (int k = 0; k < static_cast<int>(joints_.size()); ++k) {
    const Joint& joint = joints_[k];
    if (joint.child_link != k + 1 || joint.parent_link < 0 || joint.parent_link > k ||
        links_[k + 1].parent_joint != k) {
      throw UrdfError("joint " + inQuotes(joint.name) + ": not in depth-first order");
    }
    if (joint.coordinate >= 0 && !joint.mimics) {
      if (joint.coordinate != static_cast<int>(coordinates_.size())) {
        throw UrdfError("joint " + inQuotes(joint.name) + ": coordinates are not in joint order");
      }
      coordinates_.push_back(k);
      coordinate_names_.push_back(joint.name);
    }
  }
  for (const Joint& joint : joints_) {
    if (joint.coordinate >= static_cast<int>(coordinates_.size())) {
      throw UrdfError("joint " + inQuotes(joint.name) + ": mimics no generalized coordinate");
    }
  }
}

int Mechanism::jointIndex(const std::string& name) const {
  return indexOf(joints_, name);
}

int Mechanism::linkIndex(const std::string& name) const {
  return indexOf(links_, name);
}

}  // namespace virtual_work_dynamics
