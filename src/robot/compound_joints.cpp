#include "robot/compound_joints.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

constexpr long double kTurn = 6.283185307179586476925286766559005768L;

// A joint of one freedom in a chain.
struct Part {
  JointType type;
  Vector3l axis;
};

// Right-handed axes whose third is `normal`, the first two as withCompounds() says.
std::pair<Vector3l, Vector3l> axesOfPlane(const Vector3l& normal) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(normal[i]) == 1) {
      const Vector3l x = Vector3l::Unit((i + 1) % 3);
      return {x, normal.cross(x)};
    }
  }
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Vector3l x = Vector3l::Unit(least).cross(normal).normalized();
  return {x, normal.cross(x)};
}

std::vector<Part> partsOf(const CompoundWish& wish) {
  const Part turn{JointType::kContinuous, wish.axis}, slide{JointType::kPrismatic, wish.axis};
  switch (wish.type) {
    case CompoundType::kPlanar: {
      const auto [x, y] = axesOfPlane(wish.axis);
      return {{JointType::kPrismatic, x}, {JointType::kPrismatic, y}, turn};
    }
    case CompoundType::kUniversal:
      return {turn, {JointType::kContinuous, wish.axis2}};
    case CompoundType::kCylindrical:
    case CompoundType::kScrew:
      return {slide, turn};
    case CompoundType::kSpherical:
    case CompoundType::kFloating:
      break;
  }
  std::vector<Part> parts;
  const bool slides = wish.type == CompoundType::kFloating;
  for (int i = 0; slides && i < 3; ++i) {
    parts.push_back({JointType::kPrismatic, Vector3l::Unit(i)});
  }
  parts.push_back({JointType::kOriented, Vector3l::Zero()});
  for (int i = 0; i < 3; ++i) parts.push_back({JointType::kContinuous, Vector3l::Unit(i)});
  return parts;
}

// The type of a joint that moves along or about an axis, however it is limited.
JointType unlimited(JointType type) {
  return type == JointType::kRevolute ? JointType::kContinuous : type;
}

// Copies a mechanism joint by joint.
class Copier {
 public:
  Copier(const Mechanism& from, const std::vector<CompoundWish>& wishes)
      : from_(from),
        wish_of_(from.joints().size(), nullptr),
        link_of_(from.links().size(), -1),
        coordinate_of_(from.coordinates().size(), -1) {
    for (const CompoundWish& wish : wishes) {
      const CompoundJoint* const old = from.compoundOf(wish.joint);
      const int first = old ? old->first : wish.joint, last = old ? old->last : wish.joint;
      for (int k = first; k <= last; ++k) wish_of_[static_cast<std::size_t>(k)] = &wish;
    }
  }

  Mechanism copy() {
    copyLink(0, -1);
    const int count = static_cast<int>(from_.joints().size());
    for (int k = 0; k < count; ++k) {
      const CompoundWish* const wish = wish_of_[static_cast<std::size_t>(k)];
      if (!wish) {
        copyJoint(k);
      } else if (k == lastOf(k)) {
        addCompound(k, *wish);
      }
    }
    followMasters();
    checkNames();
    return Mechanism(from_.name(), std::move(links_), std::move(joints_), from_.doubts(),
                     std::move(compounds_), from_.transmissions());
  }

 private:
  int lastOf(int joint) const {
    const CompoundJoint* const old = from_.compoundOf(joint);
    return old ? old->last : joint;
  }

  void copyLink(int link, int parent_joint) {
    link_of_[static_cast<std::size_t>(link)] = static_cast<int>(links_.size());
    links_.push_back(from_.link(link));
    links_.back().parent_joint = parent_joint;
  }

  void copyJoint(int k) {
    Joint joint = from_.joint(k);
    joint.parent_link = link_of_[static_cast<std::size_t>(joint.parent_link)];
    joint.child_link = static_cast<int>(joints_.size()) + 1;
    if (joint.coordinate >= 0 && !joint.mimics) {
      int& coordinate = coordinate_of_[static_cast<std::size_t>(joint.coordinate)];
      joint.coordinate = coordinate = coordinates_++;
    } else if (joint.type == JointType::kOriented) {
      joint.orientation = orientations_++;
    } else if (joint.mimics) {
      followers_.push_back(static_cast<int>(joints_.size()));
    }
    const CompoundJoint* const old = from_.compoundOf(k);
    if (old && old->last == k) {
      compounds_.push_back(*old);
      compounds_.back().last = static_cast<int>(joints_.size());
      compounds_.back().first = compounds_.back().last - (old->last - old->first);
    }
    joints_.push_back(joint);
    copyLink(k + 1, static_cast<int>(joints_.size()) - 1);
  }

  // Puts the chain where the joint that ends with the old one `k` was.
  void addCompound(int k, const CompoundWish& wish) {
    const CompoundJoint* const old = from_.compoundOf(k);
    const Joint& start = from_.joint(old ? old->first : k);
    const std::string& name = from_.reactionName(k);
    if (start.mimics && !old) {
      throw UrdfError(
          "joint " + inQuotes(name) +
          ": it mimics another joint, and so cannot have a type with freedoms of its own");
    }
    CompoundJoint compound{name, wish.type, static_cast<int>(joints_.size()), 0, wish.pitch};
    const std::vector<Part> parts = partsOf(wish);
    const std::vector<const char*> names = partNames(wish.type);
    const bool screw = wish.type == CompoundType::kScrew;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const int index = static_cast<int>(joints_.size());
      const bool first = i == 0, last = i + 1 == parts.size();
      Joint joint;
      joint.name = screw ? name + (last ? "" : ".slide") : name + "." + names[i];
      joint.type = parts[i].type;
      joint.axis_K = parts[i].axis;
      joint.parent_link = first ? link_of_[static_cast<std::size_t>(start.parent_link)] : index;
      joint.child_link = index + 1;
      if (first) {
        joint.p_PoKo_P = start.p_PoKo_P;
        joint.R_PK = start.R_PK;
      }
      joint.coordinate = coordinates_;
      if (joint.type == JointType::kOriented) {
        joint.coordinate = -1;
        joint.orientation = orientations_++;
      } else if (screw && !last) {
        joint.mimics = true;
        joint.multiplier = static_cast<double>(static_cast<long double>(wish.pitch) / kTurn);
      } else {
        ++coordinates_;
        if (!old && movesAs(start, joint)) takeOver(start, joint);
      }
      joints_.push_back(joint);
      if (last) break;
      Link between;
      between.name = joint.name;
      between.parent_joint = index;
      links_.push_back(between);
    }
    compound.last = static_cast<int>(joints_.size()) - 1;
    compounds_.push_back(compound);
    copyLink(k + 1, compound.last);
  }

  static bool movesAs(const Joint& old, const Joint& part) {
    return unlimited(old.type) == part.type && old.axis_K == part.axis_K;
  }

  // What else is known of a joint that becomes a part.
  void takeOver(const Joint& old, Joint& part) {
    part.type = old.type;
    part.damping = old.damping;
    part.friction = old.friction;
    part.lower = old.lower;
    part.upper = old.upper;
    part.effort_limit = old.effort_limit;
    part.velocity_limit = old.velocity_limit;
    // Who mimics it turns or slides with the part that alone has its name.
    if (part.name == old.name) {
      coordinate_of_[static_cast<std::size_t>(old.coordinate)] = part.coordinate;
    }
  }

  void followMasters() {
    for (const int k : followers_) {
      Joint& joint = joints_[static_cast<std::size_t>(k)];
      const int old = joint.coordinate;
      joint.coordinate = coordinate_of_[static_cast<std::size_t>(old)];
      if (joint.coordinate >= 0) continue;
      throw UrdfError(
          "joint " + inQuotes(joint.name) + ": mimics joint " +
          inQuotes(from_.reactionName(from_.coordinates()[static_cast<std::size_t>(old)])) +
          ", which has several freedoms");
    }
  }

  void checkNames() const {
    std::unordered_map<std::string, int> joints, links;
    for (const Joint& joint : joints_) ++joints[joint.name];
    for (const Link& link : links_) ++links[link.name];
    for (const CompoundJoint& compound : compounds_) {
      for (int k = compound.first; k <= compound.last; ++k) {
        const std::string& part = joints_[static_cast<std::size_t>(k)].name;
        const bool link_too = k < compound.last && links[part] > 1;
        if (joints[part] == 1 && !link_too) continue;
        throw UrdfError("joint " + inQuotes(compound.name) + ": the name of its part " +
                        inQuotes(part) + " is that of another " +
                        (joints[part] > 1 ? "joint" : "link"));
      }
    }
  }

  const Mechanism& from_;
  std::vector<const CompoundWish*> wish_of_;  // by joint
  std::vector<int> link_of_;                  // new index of each link
  std::vector<int> coordinate_of_;            // new index of each coordinate; -1: it is gone
  std::vector<int> followers_;                // new joints that mimic an old coordinate
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<CompoundJoint> compounds_;
  int coordinates_ = 0;
  int orientations_ = 0;
};

}  // namespace

std::vector<const char*> partNames(CompoundType type) {
  switch (type) {
    case CompoundType::kPlanar:
      return {"x", "y", "angle"};
    case CompoundType::kCylindrical:
      return {"slide", "angle"};
    case CompoundType::kUniversal:
      return {"angle1", "angle2"};
    case CompoundType::kScrew:
      return {""};
    case CompoundType::kSpherical:
      return {"orientation", "rx", "ry", "rz"};
    case CompoundType::kFloating:
      break;
  }
  return {"x", "y", "z", "orientation", "rx", "ry", "rz"};
}

Mechanism withCompounds(const Mechanism& mechanism, const std::vector<CompoundWish>& wishes) {
  return Copier(mechanism, wishes).copy();
}

}  // namespace virtual_work_dynamics
