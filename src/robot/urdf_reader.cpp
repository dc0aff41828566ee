#include "virtual_work_dynamics/urdf_reader.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <sstream>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "robot/compound_joints.h"
#include "robot/inertia_doubts.h"
#include "robot/unit_doubts.h"
#include "robot/unread_elements.h"
#include "robot/urdf_angles.h"
#include "robot/urdf_checks.h"
#include "robot/urdf_transmissions.h"
#include "robot/urdf_xml.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Largest deviation of an axis from unit length of which the user is not told.
constexpr long double kUnitTolerance = 1e-6L;
// Bytes, beyond descriptions of a hundred thousand links with their shapes.
constexpr std::size_t kLongestDescription = std::size_t{256} << 20;

// Keeps the complaints of urdfdom off the console, through which alone it makes them.
class CapturedConsole : public console_bridge::OutputHandler {
 public:
  CapturedConsole() { console_bridge::useOutputHandler(this); }
  ~CapturedConsole() override { console_bridge::restorePreviousOutputHandler(); }
  CapturedConsole(const CapturedConsole&) = delete;
  CapturedConsole& operator=(const CapturedConsole&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    lines_.push_back(text);
  }
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

// Lets urdfdom parse a description that was checked.
urdf::ModelInterfaceSharedPtr parse(const std::string& checked) {
  static std::mutex console_mutex;  // console_bridge has one handler for the whole process
  const std::lock_guard<std::mutex> lock(console_mutex);
  CapturedConsole console;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(checked);
  } catch (const std::exception& error) {
    throw UrdfError("robot description is broken: " + printable(error.what()));
  }
  if (!model || !model->getRoot() || !console.lines().empty()) {
    throw UrdfError("robot description is broken: " + (console.lines().empty()
                                                           ? "no root link"
                                                           : printable(console.lines().front())));
  }
  return model;
}

Vector3l toEigen(const urdf::Vector3& v) {
  return Vector3l(v.x, v.y, v.z);
}

std::string numbersText(const urdf::Vector3& v) {
  std::ostringstream text;
  text << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return text.str();
}

Matrix3l rotationIn(const std::map<std::string, Matrix3l>& rotations, const std::string& name) {
  const auto found = rotations.find(name);
  return found == rotations.end() ? Matrix3l(Matrix3l::Identity()) : found->second;
}

// Walks urdfdom's model depth first and collects links and joints in the Mechanism's order.
class Reader {
 public:
  explicit Reader(const std::string& text) {
    tinyxml2::XMLDocument document;
    const tinyxml2::XMLElement& robot = parseUrdfXml(text, document);
    doubts_ = unreadElements(robot);
    transmissions_ = transmissionsOf(robot);
    const std::string checked = checkedUrdf(robot, doubts_);
    angles_ = readUrdfAngles(robot);
    model_ = parse(checked);
  }

  // Breaks loops of links, which would never be freed, as urdfdom's links own their children.
  ~Reader() {
    for (const auto& entry : model_->links_) entry.second->child_links.clear();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  Mechanism read() {
    walk();
    checkReached();
    resolveMimics();
    for (Doubt& doubt : inertiaDoubts(links_, joints_)) doubts_.push_back(std::move(doubt));
    for (Doubt& doubt : unitDoubts(links_, joints_)) doubts_.push_back(std::move(doubt));
    const Mechanism mechanism(model_->getName(), std::move(links_), std::move(joints_),
                              std::move(doubts_), {}, std::move(transmissions_));
    return compounds_.empty() ? mechanism : withCompounds(mechanism, compounds_);
  }

 private:
  // Refuses links that are one another's parents and so hang on no root; urdfdom accepts them.
  void checkReached() const {
    if (links_.size() == model_->links_.size()) return;
    std::unordered_set<std::string> reached;
    for (const Link& link : links_) reached.insert(link.name);
    for (const auto& entry : model_->links_) {
      const std::string& name = entry.first;
      if (reached.count(name) == 0) {
        throw UrdfError("link " + inQuotes(name) +
                        ": its parents form a loop that never reaches the root " +
                        inQuotes(links_.front().name));
      }
    }
  }

  // Visits the links depth first, children by joint name. Does not recurse, as a chain may be as
  // long as memory allows.
  void walk() {
    std::vector<std::pair<const urdf::Joint*, int>> pending;  // joint, its parent link
    const auto addLink = [&](const urdf::Link& source, int parent_joint) {
      const int index = static_cast<int>(links_.size());
      links_.push_back(link(source, parent_joint));
      auto children = source.child_joints;
      std::sort(children.begin(), children.end(),
                [](const auto& a, const auto& b) { return a->name > b->name; });
      for (const auto& child : children) pending.emplace_back(child.get(), index);
    };
    addLink(*model_->getRoot(), -1);
    while (!pending.empty()) {
      const auto [joint, parent_link] = pending.back();
      pending.pop_back();
      addJoint(*joint, parent_link);
      addLink(*model_->getLink(joint->child_link_name), static_cast<int>(joints_.size()) - 1);
    }
  }

  Link link(const urdf::Link& source, int parent_joint) const {
    Link link;
    link.name = source.name;
    link.parent_joint = parent_joint;
    if (!source.inertial) return link;
    const urdf::Inertial& inertial = *source.inertial;
    if (!std::isfinite(inertial.mass) || inertial.mass < 0) {
      throw UrdfError("link " + inQuotes(source.name) + ": mass " + numberText(inertial.mass) +
                      " kg is negative or not finite");
    }
    Matrix3l inertia;
    inertia << inertial.ixx, inertial.ixy, inertial.ixz,  //
        inertial.ixy, inertial.iyy, inertial.iyz,         //
        inertial.ixz, inertial.iyz, inertial.izz;
    link.mass = inertial.mass;
    link.p_KoCm_K = toEigen(inertial.origin.position);
    if (!inertia.allFinite() || !link.p_KoCm_K.allFinite()) {
      throw UrdfError("link " + inQuotes(source.name) +
                      ": inertia or centre of mass is not finite");
    }
    const Matrix3l R = rotationIn(angles_.inertial_origins, source.name);
    link.inertia_Cm_K = R * inertia * R.transpose();
    return link;
  }

  void addJoint(const urdf::Joint& source, int parent_link) {
    if (source.name == kGround) {
      throw UrdfError("joint 'ground': the name is reserved for the wrench of ground on the root");
    }
    if (source.name.empty()) {
      throw UrdfError("joint of link " + inQuotes(source.child_link_name) + ": its name is empty");
    }
    Joint joint;
    joint.name = source.name;
    joint.type = typeOf(source);
    joint.parent_link = parent_link;
    joint.child_link = static_cast<int>(joints_.size()) + 1;
    joint.p_PoKo_P = toEigen(source.parent_to_joint_origin_transform.position);
    joint.R_PK = rotationIn(angles_.joint_origins, source.name);
    if (!joint.p_PoKo_P.allFinite()) {
      throw UrdfError("joint " + inQuotes(source.name) + ": origin is not finite");
    }
    if (source.type == urdf::Joint::PLANAR || source.type == urdf::Joint::FLOATING) {
      addCompound(source, static_cast<int>(joints_.size()));
    } else if (joint.type != JointType::kFixed) {
      joint.axis_K = axisOf(source);
      readDynamics(source, joint);
      readLimits(source, joint);
      if (!source.mimic) joint.coordinate = coordinates_++;
    } else if (source.mimic) {
      doubts_.push_back(
          {"joint " + inQuotes(source.name) + ": is fixed, its <mimic> has no meaning"});
    }
    joints_.push_back(joint);
  }

  // A joint that becomes planar or floating once the tree is complete; until then it counts as
  // fixed.
  void addCompound(const urdf::Joint& source, int index) {
    const bool planar = source.type == urdf::Joint::PLANAR;
    const std::string who = "joint " + inQuotes(source.name);
    if (source.mimic) {
      throw UrdfError(who + (planar ? ": is planar" : ": is floating") + " and cannot mimic");
    }
    CompoundWish wish;
    wish.joint = index;
    wish.type = planar ? CompoundType::kPlanar : CompoundType::kFloating;
    if (planar) wish.axis = axisOf(source);
    compounds_.push_back(wish);
    if (source.dynamics && (source.dynamics->damping != 0 || source.dynamics->friction != 0)) {
      doubts_.push_back({who + ": its <dynamics> is not used, as it says nothing of each freedom"});
    }
  }

  static void readDynamics(const urdf::Joint& source, Joint& joint) {
    if (!source.dynamics) return;
    joint.damping = source.dynamics->damping;
    joint.friction = source.dynamics->friction;
    if (!std::isfinite(joint.damping) || !std::isfinite(joint.friction)) {
      throw UrdfError("joint " + inQuotes(source.name) + ": damping or friction is not finite");
    }
  }

  static double limitOf(double described) {
    return std::isfinite(described) && described > 0 ? described : 0;
  }

  // Limits that contradict each other, as those that a description leaves out, are none.
  static void readLimits(const urdf::Joint& source, Joint& joint) {
    if (source.limits && joint.type != JointType::kFixed) {
      joint.effort_limit = limitOf(source.limits->effort);
      joint.velocity_limit = limitOf(source.limits->velocity);
    }
    const bool bounded = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
    if (!bounded || !source.limits || !(source.limits->lower < source.limits->upper)) return;
    joint.lower = source.limits->lower;
    joint.upper = source.limits->upper;
  }

  static JointType typeOf(const urdf::Joint& source) {
    switch (source.type) {
      case urdf::Joint::REVOLUTE:
        return JointType::kRevolute;
      case urdf::Joint::CONTINUOUS:
        return JointType::kContinuous;
      case urdf::Joint::PRISMATIC:
        return JointType::kPrismatic;
      case urdf::Joint::PLANAR:
      case urdf::Joint::FLOATING:
      case urdf::Joint::FIXED:
        return JointType::kFixed;
      default:
        throw UrdfError("joint " + inQuotes(source.name) + ": unknown joint type");
    }
  }

  Vector3l axisOf(const urdf::Joint& source) {
    const Vector3l axis = toEigen(source.axis);
    const long double length = axis.norm();
    if (!std::isfinite(length) || length == 0) {
      throw UrdfError("joint " + inQuotes(source.name) + ": axis " + numbersText(source.axis) +
                      " has no direction");
    }
    if (std::abs(length - 1) > kUnitTolerance) {
      doubts_.push_back({"joint " + inQuotes(source.name) + ": axis " + numbersText(source.axis) +
                         " is not of unit length, its direction is used"});
    }
    return axis / length;
  }

  // Gives every mimic joint the coordinate that moves it in the end. A master that mimics, too,
  // comes before what mimics it, so that each joint is followed once, however long the chains are.
  void resolveMimics() {
    std::unordered_map<std::string, std::size_t> index_of;
    for (std::size_t k = 0; k < joints_.size(); ++k) index_of.emplace(joints_[k].name, k);
    enum class State { kNew, kFollowed, kResolved };
    std::vector<State> states(joints_.size(), State::kNew);
    std::vector<std::size_t> followed;
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      followed.clear();
      for (std::size_t at = k; states[at] != State::kResolved;) {
        if (states[at] == State::kFollowed) {
          throw UrdfError("joint " + inQuotes(joints_[k].name) + ": its <mimic> leads in a cycle");
        }
        states[at] = State::kFollowed;
        followed.push_back(at);
        const urdf::JointMimic* mimic = mimicOf(joints_[at]);
        if (!mimic) break;
        at = masterOf(joints_[at], mimic->joint_name, index_of);
      }
      for (; !followed.empty(); followed.pop_back()) {
        resolveMimic(joints_[followed.back()], index_of);
        states[followed.back()] = State::kResolved;
      }
    }
  }

  // Takes the coordinate of a mimic joint from its master, which has been resolved.
  void resolveMimic(Joint& joint, const std::unordered_map<std::string, std::size_t>& index_of) {
    const urdf::JointMimic* mimic = mimicOf(joint);
    if (!mimic) return;
    const Joint& master = joints_[index_of.at(mimic->joint_name)];
    joint.mimics = true;
    joint.offset = mimic->multiplier * master.offset + mimic->offset;
    joint.multiplier = mimic->multiplier * master.multiplier;
    joint.coordinate = master.coordinate;
    if (!std::isfinite(joint.multiplier) || !std::isfinite(joint.offset)) {
      throw UrdfError("joint " + inQuotes(joint.name) +
                      ": mimic multiplier or offset is not finite");
    }
  }

  const urdf::JointMimic* mimicOf(const Joint& joint) const {
    if (joint.type == JointType::kFixed) return nullptr;
    return model_->getJoint(joint.name)->mimic.get();
  }

  std::size_t masterOf(const Joint& joint, const std::string& name,
                       const std::unordered_map<std::string, std::size_t>& index_of) const {
    const auto found = index_of.find(name);
    if (found == index_of.end()) {
      throw UrdfError("joint " + inQuotes(joint.name) + ": mimics unknown joint " + inQuotes(name) +
                      nameHelp(name, jointNames()));
    }
    const auto isMaster = [&](const CompoundWish& wish) {
      return wish.joint == static_cast<int>(found->second);
    };
    if (std::any_of(compounds_.begin(), compounds_.end(), isMaster)) {
      throw UrdfError("joint " + inQuotes(joint.name) + ": mimics joint " + inQuotes(name) +
                      ", which has several freedoms");
    }
    if (joints_[found->second].type == JointType::kFixed) {
      throw UrdfError("joint " + inQuotes(joint.name) + ": mimics fixed joint " + inQuotes(name));
    }
    return found->second;
  }

  std::vector<std::string> jointNames() const {
    std::vector<std::string> names;
    for (const Joint& joint : joints_) names.push_back(joint.name);
    return names;
  }

  urdf::ModelInterfaceSharedPtr model_;
  UrdfAngles angles_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<Doubt> doubts_;
  std::vector<CompoundWish> compounds_;
  std::vector<Transmission> transmissions_;
  int coordinates_ = 0;
};

}  // namespace

Mechanism readUrdf(const std::string& urdf) {
  return Reader(urdf).read();
}

Mechanism readUrdfFile(const std::string& path) {
  const std::string text = readTextFile(path, kLongestDescription);
  try {
    return readUrdf(text);
  } catch (const UrdfError& error) {
    throw UrdfError(path + ": " + error.what());
  }
}

}  // namespace virtual_work_dynamics
