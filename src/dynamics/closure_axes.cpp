#include "virtual_work_dynamics/closure_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/printable.h"
#include "loops/link_kinematics.h"
#include "robot/added_joints.h"
#include "scene/lookup.h"
#include "scene/resolved_loops.h"
#include "scene/touch_rows.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {

namespace {

// What is added to the name of a closure whose free axis is a joint.
const std::string kRest = ".fixed";

const Closure* closureNamed(const Scene& scene, const std::string& name) {
  const auto& all = scene.closures;
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Closure& closure) { return closure.name == name; });
  return found == all.end() ? nullptr : &*found;
}

// The closures that couplings name.
std::set<std::string> coupledClosures(const Mechanism& mechanism, const Scene& scene) {
  std::set<std::string> names;
  for (const Coupling& coupling : scene.couplings) {
    for (const NamedNumber& term : coupling.terms) {
      if (mechanism.jointIndex(term.name) >= 0) continue;
      const Closure* const closure = closureNamed(scene, term.name);
      if (!closure) continue;
      const std::string name = inQuotes(term.name);
      if (closure->type != ClosureType::kRevolute && closure->type != ClosureType::kPrismatic) {
        throw SceneError("couplings: " + inQuotes(coupling.name) + ": closure " + name +
                         " is neither revolute nor prismatic");
      }
      if (mechanism.linkIndex(term.name) >= 0) {
        throw SceneError("closures: " + name + " is also the name of a link; a closure that " +
                         "couplings name needs another name");
      }
      names.insert(term.name);
    }
  }
  return names;
}

Matrix3l axesOfFrame(const LinkFrame& frame) {
  using Turn = Eigen::AngleAxis<long double>;
  const Vector3l rpy = frame.rpy.cast<long double>();
  return (Turn(rpy.z(), Vector3l::UnitZ()) * Turn(rpy.y(), Vector3l::UnitY()) *
          Turn(rpy.x(), Vector3l::UnitX()))
      .toRotationMatrix();
}

LinkKinematics::Frame frameOn(int link, const LinkFrame& frame) {
  return {link, axesOfFrame(frame).cast<double>(), frame.xyz};
}

class ClosureAxes {
 public:
  ClosureAxes(const Mechanism& mechanism, const Scene& scene, std::set<std::string> names)
      : mechanism_(mechanism), old_(scene), names_(std::move(names)), scene_(scene) {}

  SceneOfMechanism read() {
    const Eigen::VectorXd start = resolveLoopScene(mechanism_, old_).start;
    LinkKinematics links(mechanism_);
    links.setPosition(start);
    for (Closure& closure : scene_.closures) {
      if (names_.count(closure.name) > 0) replace(links, closure);
    }
    tellWhatMoves();
    tellRedundancy();
    if (old_.reactions == ReactionSelection::kAll) {
      scene_.reaction_names = requestedReactions(mechanism_, old_);
      scene_.reactions = ReactionSelection::kNamed;
    }
    return {withAddedJoints(mechanism_, joints_, mechanism_.doubts(), mechanism_.transmissions()),
            scene_};
  }

 private:
  void replace(const LinkKinematics& links, Closure& closure) {
    const std::size_t place = static_cast<std::size_t>(&closure - scene_.closures.data());
    const std::string where = entryOf("closures", place);
    const LinkFrame parent = closure.parent;
    Joint joint;
    joint.name = closure.name;
    joint.type =
        closure.type == ClosureType::kPrismatic ? JointType::kPrismatic : JointType::kContinuous;
    joint.parent_link = linkNamed(mechanism_, parent.link, where + ".parent.link");
    joint.p_PoKo_P = parent.xyz.cast<long double>();
    joint.R_PK = axesOfFrame(parent);
    joint.axis_K = Vector3l::UnitZ();
    joints_.push_back(joint);
    const int child = linkNamed(mechanism_, closure.child.link, where + ".child.link");
    scene_.assembly.push_back(
        {closure.name, positionOf(links, frameOn(joint.parent_link, parent),
                                  frameOn(child, closure.child), unitOf(joint))});
    closure.parent = {closure.name, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    closure.name += kRest;
    closure.type = ClosureType::kFixed;
  }

  // The position of the free axis at which its frames are closest.
  static double positionOf(const LinkKinematics& links, const LinkKinematics::Frame& parent,
                           const LinkKinematics::Frame& child, Unit unit) {
    if (unit == Unit::kMetre) {
      return links.axisOf(parent, 2).dot(links.originOf(child) - links.originOf(parent));
    }
    const Eigen::Matrix3d R = links.axesOf(parent).transpose() * links.axesOf(child);
    return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
  }

  // The joints of the tree carry effort as before, and the new ones where the scene names them.
  // What motions give follows from that, except where closures are actuated besides joints: the
  // joints then still are enough.
  void tellWhatMoves() {
    if (!old_.actuated && old_.free_motion) return;
    const std::vector<std::string> all = old_.actuated.value_or(mechanism_.coordinateNames());
    std::vector<std::string> joints, given;
    for (const std::string& name : all) {
      if (closureNamed(old_, name)) continue;
      joints.push_back(name);
      const auto is_it = [&](const DriveLaw& drive) { return drive.name == name; };
      if (std::none_of(old_.drives.begin(), old_.drives.end(), is_it)) given.push_back(name);
    }
    const bool both = joints.size() < all.size() && !joints.empty();
    if (!old_.given && both && hasPositions(old_)) scene_.given = given;
    if (!old_.actuated) scene_.actuated = joints;
  }

  void tellRedundancy() {
    Redundancy& redundancy = scene_.redundancy;
    for (std::string& name : redundancy.zero_at) {
      if (names_.count(name) > 0) name += kRest;
    }
    if (redundancy.policy != RedundancyPolicy::kStiffness) return;
    // The same wrench goes through the joint and the closure behind it: one after the other, two
    // springs are as soft as what they stand for.
    for (const std::string& name : names_) {
      double stiffness = 1;
      const auto is_it = [&](const NamedNumber& entry) { return entry.name == name; };
      auto& all = redundancy.stiffness;
      const auto found = std::find_if(all.begin(), all.end(), is_it);
      if (found != all.end()) stiffness = found->value;
      all.erase(std::remove_if(all.begin(), all.end(), is_it), all.end());
      for (const std::string& half : {name, name + kRest}) all.push_back({half, 2 * stiffness});
    }
  }

  const Mechanism& mechanism_;
  const Scene& old_;
  const std::set<std::string> names_;
  Scene scene_;
  std::vector<Joint> joints_;
};

}  // namespace

SceneOfMechanism withClosureAxes(const Mechanism& mechanism, const Scene& scene) {
  const std::set<std::string> names = coupledClosures(mechanism, scene);
  if (names.empty()) return {mechanism, scene};
  return ClosureAxes(mechanism, scene, names).read();
}

std::string axisOfClosure(const Mechanism& mechanism, const Scene& scene, const Closure& closure) {
  const std::string& axis = closure.parent.link;
  const int joint = mechanism.jointIndex(axis);
  if (closure.type != ClosureType::kFixed || closure.name != axis + kRest || joint < 0) return "";
  const Link& link = mechanism.link(mechanism.joint(joint).child_link);
  const bool added = link.name == axis && link.mass == 0 && closure.parent.xyz.isZero(0) &&
                     closure.parent.rpy.isZero(0);
  const auto names_it = [&](const Coupling& coupling) {
    return std::any_of(coupling.terms.begin(), coupling.terms.end(),
                       [&](const NamedNumber& term) { return term.name == axis; });
  };
  const auto& couplings = scene.couplings;
  return added && std::any_of(couplings.begin(), couplings.end(), names_it) ? axis : "";
}

SceneOfMechanism mechanismFor(const Mechanism& described, const Scene& scene) {
  const SceneOfMechanism robot = withTransmissions(withJointTypes(described, scene), scene);
  return withClosureAxes(robot.mechanism, robot.scene);
}

}  // namespace virtual_work_dynamics
