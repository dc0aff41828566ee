#include "robot/added_joints.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace virtual_work_dynamics {

namespace {

// A joint of the new mechanism: an old one, or one that is added.
struct Branch {
  int joint = -1;
  const Joint* added = nullptr;
};

// By old link, the joints that hang on it, in their new order.
std::vector<std::vector<Branch>> branchesOf(const Mechanism& mechanism,
                                            const std::vector<Joint>& added) {
  std::vector<std::vector<Branch>> branches(mechanism.links().size());
  for (int k = 0; k < static_cast<int>(mechanism.joints().size()); ++k) {
    branches[static_cast<std::size_t>(mechanism.joint(k).parent_link)].push_back({k, nullptr});
  }
  for (const Joint& joint : added) {
    std::vector<Branch>& list = branches[static_cast<std::size_t>(joint.parent_link)];
    const auto comes_after = [&](const Branch& branch) {
      const std::string& name =
          branch.added ? branch.added->name : mechanism.reactionName(branch.joint);
      return name > joint.name;
    };
    list.insert(std::find_if(list.begin(), list.end(), comes_after), {-1, &joint});
  }
  return branches;
}

class Planter {
 public:
  explicit Planter(const Mechanism& from)
      : from_(from), joint_of_(from.joints().size()), coordinate_of_(from.coordinates().size()) {}

  void plant(const std::vector<Joint>& added) {
    const std::vector<std::vector<Branch>> branches = branchesOf(from_, added);
    std::vector<std::pair<Branch, int>> pending;  // with the new link that it hangs on
    const auto hang = [&](int old_link, int link) {
      const std::vector<Branch>& list = branches[static_cast<std::size_t>(old_link)];
      for (auto it = list.rbegin(); it != list.rend(); ++it) pending.emplace_back(*it, link);
    };
    links_.push_back(from_.link(0));
    hang(0, 0);
    while (!pending.empty()) {
      const auto [branch, parent] = pending.back();
      pending.pop_back();
      add(branch, parent);
      if (!branch.added) hang(branch.joint + 1, static_cast<int>(links_.size()) - 1);
    }
    for (Joint& joint : joints_) {
      if (joint.mimics) {
        joint.coordinate = coordinate_of_[static_cast<std::size_t>(joint.coordinate)];
      }
    }
  }

  Mechanism result(std::vector<Doubt> doubts, std::vector<Transmission> transmissions) {
    std::vector<CompoundJoint> compounds = from_.compounds();
    for (CompoundJoint& compound : compounds) {
      compound.first = joint_of_[static_cast<std::size_t>(compound.first)];
      compound.last = joint_of_[static_cast<std::size_t>(compound.last)];
    }
    return Mechanism(from_.name(), std::move(links_), std::move(joints_), std::move(doubts),
                     std::move(compounds), std::move(transmissions));
  }

 private:
  void add(const Branch& branch, int parent) {
    const int index = static_cast<int>(joints_.size());
    Joint joint;
    Link link;
    if (branch.added) {
      joint = *branch.added;
      joint.coordinate = coordinates_++;
      link.name = joint.name;
    } else {
      joint = from_.joint(branch.joint);
      link = from_.link(branch.joint + 1);
      joint_of_[static_cast<std::size_t>(branch.joint)] = index;
      if (joint.coordinate >= 0 && !joint.mimics) {
        int& coordinate = coordinate_of_[static_cast<std::size_t>(joint.coordinate)];
        joint.coordinate = coordinate = coordinates_++;
      }
    }
    joint.parent_link = parent;
    joint.child_link = index + 1;
    link.parent_joint = index;
    joints_.push_back(joint);
    links_.push_back(link);
  }

  const Mechanism& from_;
  std::vector<int> joint_of_, coordinate_of_;  // the new index of each old one
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  int coordinates_ = 0;
};

}  // namespace

Mechanism withAddedJoints(const Mechanism& mechanism, const std::vector<Joint>& added,
                          std::vector<Doubt> doubts, std::vector<Transmission> transmissions) {
  Planter planter(mechanism);
  planter.plant(added);
  return planter.result(std::move(doubts), std::move(transmissions));
}

}  // namespace virtual_work_dynamics
