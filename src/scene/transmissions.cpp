#include "virtual_work_dynamics/transmissions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "robot/added_joints.h"
#include "scene/lookup.h"
#include "scene/touch_rows.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

using NameList = std::vector<std::string>;

const std::string kKey = "urdf_transmissions";

[[noreturn]] void refuse(const Transmission& transmission, const std::string& why) {
  throw SceneError(kKey + ": transmission " + inQuotes(transmission.name) + ": " + why);
}

// Whether each transmission of the description is asked for.
std::vector<bool> askedFor(const Mechanism& mechanism, const Scene& scene) {
  const std::vector<Transmission>& all = mechanism.transmissions();
  const bool everything = scene.transmissions == TransmissionSelection::kAll;
  if (everything && all.empty()) throw SceneError(kKey + ": the description has none");
  std::vector<bool> asked(all.size(), everything);
  if (everything) return asked;
  NameList known;
  for (const Transmission& transmission : all) known.push_back(transmission.name);
  for (std::size_t i = 0; i < scene.transmission_names.size(); ++i) {
    const std::string& name = scene.transmission_names[i];
    const auto first = std::find(known.begin(), known.end(), name);
    if (first == known.end()) {
      throw SceneError(entryOf(kKey, i) + ": the description has no transmission " +
                       inQuotes(name) + nameHelp(name, known));
    }
    if (std::find(first + 1, known.end(), name) != known.end()) {
      throw SceneError(entryOf(kKey, i) + ": the description has several transmissions " +
                       inQuotes(name));
    }
    const auto place = static_cast<std::size_t>(first - known.begin());
    if (asked[place])
      throw SceneError(entryOf(kKey, i) + ": " + inQuotes(name) + " is given twice");
    asked[place] = true;
  }
  return asked;
}

// What actuator `i` moves by for each joint.
std::vector<long double> ratiosOf(const Transmission& transmission, std::size_t i) {
  const long double a = transmission.actuators[i].reduction;
  const long double j1 = transmission.joints.front().reduction;
  if (transmission.joints.size() == 1) return {a};
  const long double j2 = transmission.joints.back().reduction;
  if (transmission.type == "DifferentialTransmission") return {a * j1, i == 0 ? a * j2 : -a * j2};
  if (i == 0) return {a * j1, 0};
  return {a, a * j2};
}

Coupling couplingOf(const Transmission& transmission, std::size_t i) {
  const std::string& actuator = transmission.actuators[i].name;
  Coupling coupling;
  coupling.name = transmission.name + "." + actuator;
  coupling.terms = {{actuator, 1}};
  const std::vector<long double> ratios = ratiosOf(transmission, i);
  long double offset = 0;
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    if (ratios[k] == 0) continue;
    const TransmissionEnd& joint = transmission.joints[k];
    const auto factor = static_cast<double>(-ratios[k]);
    if (!std::isfinite(factor) || factor == 0) {
      refuse(transmission, "its reductions overflow");
    }
    coupling.terms.push_back({joint.name, factor});
    offset -= ratios[k] * joint.offset;
  }
  if (!std::isfinite(static_cast<double>(offset))) refuse(transmission, "its offsets overflow");
  coupling.offset = static_cast<double>(offset);
  return coupling;
}

// A motor that is fixed to a link; which way it points makes no difference.
Joint motorOn(int link, const std::string& name) {
  Joint motor;
  motor.name = name;
  motor.type = JointType::kContinuous;
  motor.parent_link = link;
  motor.axis_K = Vector3l::UnitZ();
  return motor;
}

class TransmissionScene {
 public:
  TransmissionScene(const Mechanism& mechanism, const Scene& scene)
      : mechanism_(mechanism), scene_(scene) {}

  SceneOfMechanism read() {
    const std::vector<bool> asked = askedFor(mechanism_, scene_);
    std::vector<Transmission> others;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const Transmission& transmission = mechanism_.transmissions()[i];
      if (asked[i]) {
        add(transmission);
      } else {
        others.push_back(transmission);
      }
    }
    return {withAddedJoints(mechanism_, motors_, doubts(), std::move(others)), changedScene()};
  }

 private:
  void add(const Transmission& transmission) {
    if (!transmission.problem.empty()) refuse(transmission, transmission.problem);
    NameList actuators;
    for (const TransmissionEnd& actuator : transmission.actuators) {
      const std::string& name = actuator.name;
      const std::string who = "its actuator " + inQuotes(name);
      if (mechanism_.jointIndex(name) >= 0 || mechanism_.reactionIndex(name) >= 0) {
        refuse(transmission, who + " has the name of a joint");
      }
      if (mechanism_.linkIndex(name) >= 0) refuse(transmission, who + " has the name of a link");
      if (name == kGround) refuse(transmission, who + " has a name that is reserved");
      if (!joints_of_.emplace(name, NameList()).second) {
        refuse(transmission, who + " is that of another transmission, too");
      }
      actuators.push_back(name);
    }
    int parent = -1;
    NameList joints;
    for (const TransmissionEnd& joint : transmission.joints) {
      const int link = linkBeside(transmission, joint.name);
      if (parent < 0) parent = link;
      if (std::count(joints.begin(), joints.end(), joint.name) > 0) {
        refuse(transmission, "joint " + inQuotes(joint.name) + " is given twice");
      }
      joints.push_back(joint.name);
      NameList& all = actuators_of_[joint.name];
      all.insert(all.end(), actuators.begin(), actuators.end());
    }
    for (std::size_t i = 0; i < actuators.size(); ++i) {
      joints_of_[actuators[i]] = joints;
      motors_.push_back(motorOn(parent, actuators[i]));
      couplings_.push_back(couplingOf(transmission, i));
    }
    all_read_.push_back(transmission);
    read_.push_back(transmission.name);
    unread_.insert(transmission.unread);
  }

  // The link that the joint hangs on, and its motors, too.
  int linkBeside(const Transmission& transmission, const std::string& name) const {
    const int k = mechanism_.jointIndex(name);
    const std::string who = "its joint " + inQuotes(name);
    if (k < 0) {
      refuse(transmission,
             mechanism_.reactionIndex(name) < 0
                 ? who + " does not exist" + nameHelp(name, mechanism_.coordinateNames())
                 : who + " has several freedoms");
    }
    const Joint& joint = mechanism_.joint(k);
    if (joint.coordinate < 0) refuse(transmission, who + " is fixed");
    if (joint.mimics) refuse(transmission, who + " mimics another joint");
    const CompoundJoint* const compound = mechanism_.compoundOf(k);
    return compound ? mechanism_.joint(compound->first).parent_link : joint.parent_link;
  }

  std::vector<Doubt> doubts() const {
    std::vector<Doubt> doubts;
    for (const Doubt& doubt : mechanism_.doubts()) {
      if (unread_.count(doubt.text) == 0) doubts.push_back(doubt);
    }
    NameList motors;
    for (const Joint& motor : motors_) motors.push_back(motor.name);
    doubts.push_back({"transmissions " + namesInQuotes(read_) +
                      " are read: efforts are those of their actuators " + namesInQuotes(motors) +
                      ", not of the joints that these move"});
    return doubts;
  }

  // The names with others in place of those that a table has, and parts in place of joints with
  // several freedoms.
  NameList replaced(const NameList& names, const std::map<std::string, NameList>& table) const {
    NameList result;
    std::set<std::string> added;  // in place of others
    const auto add = [&](const std::string& name) {
      const auto found = table.find(name);
      if (found == table.end()) return result.push_back(name);
      for (const std::string& other : found->second) {
        if (std::count(names.begin(), names.end(), other) > 0) continue;
        if (added.insert(other).second) result.push_back(other);
      }
    };
    for (const std::string& name : names) {
      const bool whole = mechanism_.jointIndex(name) < 0 && mechanism_.reactionIndex(name) >= 0;
      if (!whole) {
        add(name);
        continue;
      }
      const CompoundJoint& compound = *mechanism_.compoundOf(mechanism_.reactionIndex(name));
      for (int k = compound.first; k <= compound.last; ++k) {
        const Joint& part = mechanism_.joint(k);
        if (part.coordinate >= 0 && !part.mimics) add(part.name);
      }
    }
    return result;
  }

  Scene changedScene() const {
    Scene scene = scene_;
    scene.transmissions = TransmissionSelection::kNone;
    scene.transmission_names.clear();
    scene.actuators_of = actuators_of_;
    scene.couplings.insert(scene.couplings.end(), couplings_.begin(), couplings_.end());
    if (scene.reactions == ReactionSelection::kAll) {
      scene.reaction_names = requestedReactions(mechanism_, scene_);
      scene.reactions = ReactionSelection::kNamed;
    }
    // What free motions demand of a scene is not met by what is added here.
    if (!scene.actuated && scene.free_motion) return scene;
    const NameList moved = scene.actuated.value_or(mechanism_.coordinateNames());
    // Where positions do not follow from each other, and where loops move freely, motions give all
    // joints, as without motors.
    const bool freely = scene_.free_motion && !isOpenChain();
    if (!scene.given && hasPositions(scene) && !freely) scene.given = givenFor(moved);
    scene.actuated = replaced(withDriven(moved), actuators_of_);
    return scene;
  }

  bool isDriven(const std::string& name) const {
    return std::any_of(scene_.drives.begin(), scene_.drives.end(),
                       [&](const DriveLaw& drive) { return drive.name == name; });
  }

  // What is actuated, with the joints that drives move: their motors then deliver.
  NameList withDriven(NameList moved) const {
    for (const DriveLaw& drive : scene_.drives) {
      const bool named = std::count(moved.begin(), moved.end(), drive.name) > 0;
      if (!named && actuators_of_.count(drive.name) > 0) moved.push_back(drive.name);
    }
    return moved;
  }

  bool isOpenChain() const { return scene_.closures.empty() && scene_.couplings.empty(); }

  // What motions give in place of what is actuated: of an open chain that moves freely all joints,
  // and nothing that drives say already.
  NameList givenFor(const NameList& moved) const {
    NameList given =
        replaced(scene_.free_motion ? mechanism_.coordinateNames() : moved, joints_of_);
    given.erase(std::remove_if(given.begin(), given.end(),
                               [&](const std::string& name) { return isDriven(name); }),
                given.end());
    for (const Transmission& transmission : all_read_) {
      for (std::size_t i = 0; i < transmission.actuators.size(); ++i) {
        if (isDriven(transmission.actuators[i].name)) dropJointOf(transmission, i, given);
      }
    }
    return given;
  }

  // Takes a joint away that an actuator, which is driven, moves.
  static void dropJointOf(const Transmission& transmission, std::size_t i, NameList& given) {
    const std::vector<long double> ratios = ratiosOf(transmission, i);
    for (std::size_t k = 0; k < ratios.size(); ++k) {
      const auto found = std::find(given.begin(), given.end(), transmission.joints[k].name);
      if (ratios[k] == 0 || found == given.end()) continue;
      given.erase(found);
      return;
    }
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  std::vector<Joint> motors_;
  std::vector<Coupling> couplings_;
  std::map<std::string, NameList> joints_of_, actuators_of_;  // by actuator, and by joint
  std::vector<Transmission> all_read_;
  NameList read_;  // their names
  std::set<std::string> unread_;
};

}  // namespace

SceneOfMechanism withTransmissions(const Mechanism& mechanism, const Scene& scene) {
  if (scene.transmissions == TransmissionSelection::kNone) return {mechanism, scene};
  return TransmissionScene(mechanism, scene).read();
}

}  // namespace virtual_work_dynamics
