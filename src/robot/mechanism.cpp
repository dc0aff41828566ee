#include "virtual_work_dynamics/mechanism.h"

#include <utility>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// The index of each name; the first one where several are equal.
template <typename Named>
std::unordered_map<std::string, int> indicesOf(const std::vector<Named>& list) {
  std::unordered_map<std::string, int> indices;
  indices.reserve(list.size());
  for (const Named& item : list) indices.emplace(item.name, static_cast<int>(&item - &list[0]));
  return indices;
}

int indexIn(const std::unordered_map<std::string, int>& indices, const std::string& name) {
  const auto found = indices.find(name);
  return found == indices.end() ? -1 : found->second;
}

}  // namespace

const char* symbolOf(Unit unit) {
  return unit == Unit::kMetre ? "m" : "rad";
}

Unit unitOf(const Joint& joint) {
  return joint.type == JointType::kPrismatic ? Unit::kMetre : Unit::kRadian;
}

Mechanism::Mechanism(std::string name, std::vector<Link> links, std::vector<Joint> joints,
                     std::vector<Doubt> doubts, std::vector<CompoundJoint> compounds,
                     std::vector<Transmission> transmissions)
    : name_(std::move(name)),
      links_(std::move(links)),
      joints_(std::move(joints)),
      doubts_(std::move(doubts)),
      compounds_(std::move(compounds)),
      transmissions_(std::move(transmissions)) {
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
  index_of_joint_ = indicesOf(joints_);
  index_of_link_ = indicesOf(links_);
  index_of_compound_ = indicesOf(compounds_);
  if (!compounds_.empty()) compound_of_.assign(joints_.size(), -1);
  for (std::size_t i = 0; i < compounds_.size(); ++i) {
    const CompoundJoint& compound = compounds_[i];
    if (compound.first < 0 || compound.last >= static_cast<int>(joints_.size())) {
      throw UrdfError("joint " + inQuotes(compound.name) + ": its parts are no joints");
    }
    for (int k = compound.first; k <= compound.last; ++k) {
      compound_of_[static_cast<std::size_t>(k)] = static_cast<int>(i);
    }
    if (compound.turnsFreely()) free_joints_.push_back(i);
  }
}

int Mechanism::jointIndex(const std::string& name) const {
  return indexIn(index_of_joint_, name);
}

int Mechanism::linkIndex(const std::string& name) const {
  return indexIn(index_of_link_, name);
}

int Mechanism::coordinateIndex(const std::string& name) const {
  const int index = jointIndex(name);
  return index < 0 || joint(index).mimics ? -1 : joint(index).coordinate;
}

const CompoundJoint* Mechanism::compoundOf(int joint) const {
  if (compound_of_.empty()) return nullptr;
  const int index = compound_of_[static_cast<std::size_t>(joint)];
  return index < 0 ? nullptr : &compounds_[static_cast<std::size_t>(index)];
}

bool Mechanism::isInnerPart(int joint) const {
  const CompoundJoint* const compound = compoundOf(joint);
  return compound && compound->last != joint;
}

int Mechanism::reactionIndex(const std::string& name) const {
  const int compound = indexIn(index_of_compound_, name);
  if (compound >= 0) return compounds_[static_cast<std::size_t>(compound)].last;
  const int index = jointIndex(name);
  return index >= 0 && compoundOf(index) ? -1 : index;
}

const std::string& Mechanism::reactionName(int joint) const {
  const CompoundJoint* const compound = compoundOf(joint);
  return compound ? compound->name : this->joint(joint).name;
}

}  // namespace virtual_work_dynamics
