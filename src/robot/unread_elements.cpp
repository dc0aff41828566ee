#include "robot/unread_elements.h"

#include <algorithm>
#include <functional>
#include <sstream>
#include <string>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "robot/urdf_transmissions.h"
#include "robot/urdf_xml.h"

namespace virtual_work_dynamics {

namespace {

using tinyxml2::XMLElement;
using Words = std::vector<std::string>;

constexpr std::size_t kMost = 20;  // doubts that are told each by itself

bool contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void forEachChild(const XMLElement& parent, const std::function<void(const XMLElement&)>& visit) {
  for (const XMLElement* child = parent.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    visit(*child);
  }
}

// One end of a joint that closes a loop.
struct End {
  std::string link;
  std::string xyz;
};

// The type of a closure of the scene that is the same as a joint type of another format; empty when
// there is none.
std::string closureType(const std::string& type) {
  if (type == "continuous" || type == "hinge") return "revolute";
  if (type == "ball") return "spherical";
  const Words same = {"fixed",     "revolute",  "prismatic", "cylindrical",
                      "universal", "spherical", "planar"};
  return contains(same, type) ? type : "";
}

std::string frameText(const char* key, const End& end) {
  std::istringstream stream(end.xyz);
  std::string numbers;
  int count = 0;
  for (std::string piece; stream >> piece; ++count) {
    double value = 0;
    if (!parseNumber(piece, value)) return frameText(key, {end.link, ""});
    numbers += (count == 0 ? "" : ", ") + piece;
  }
  return std::string(key) + ": {link: " + shortened(end.link) +
         (count == 3 ? ", xyz: [" + numbers + "]}" : "}");
}

// What to write in the scene for a joint that closes a loop.
std::string closureText(const std::string& name, const std::string& type, const End& parent,
                        const End& child) {
  const std::string known = closureType(type);
  return "closures: [{name: " + shortened(name) + ", type: " + (known.empty() ? "..." : known) +
         ", " + frameText("parent", parent) + ", " + frameText("child", child) + "}]" +
         (known == "revolute" || known == "prismatic" || known == "cylindrical"
              ? " with z of both frames along the axis"
              : "");
}

std::string attributeOfChild(const XMLElement& parent, const char* child, const char* name) {
  const XMLElement* found = parent.FirstChildElement(child);
  return found ? attributeOf(*found, name) : "";
}

// Drake's <loop_joint> and the proposed <constraint>.
Doubt loopDoubt(const XMLElement& element) {
  End parent, child;
  parent.link = attributeOfChild(element, "link1", "link");
  parent.xyz = attributeOfChild(element, "link1", "xyz");
  child.link = attributeOfChild(element, "link2", "link");
  child.xyz = attributeOfChild(element, "link2", "xyz");
  if (parent.link.empty()) {
    parent.link = attributeOfChild(element, "parent", "link");
    parent.xyz = attributeOfChild(element, "parent_origin", "xyz");
    child.link = attributeOfChild(element, "child", "link");
    child.xyz = attributeOfChild(element, "child_origin", "xyz");
  }
  return {"element " + shown(element) + " is not read: the loop stays open; in the scene, " +
          closureText(attributeOf(element, "name"), attributeOf(element, "type"), parent, child) +
          " closes it"};
}

bool holdsLinksOrJoints(const XMLElement& element) {
  return element.FirstChildElement("link") || element.FirstChildElement("joint");
}

/// Goes through the elements of a description.
class Search {
 public:
  std::vector<Doubt> run(const XMLElement& robot) {
    forEachChild(robot, [this](const XMLElement& element) { visit(element); });
    if (found_ > kMost) {
      doubts_.push_back({std::to_string(found_ - kMost) + " more elements are not read"});
    }
    return std::move(doubts_);
  }

 private:
  void doubt(Doubt doubt) {
    if (++found_ <= kMost) doubts_.push_back(std::move(doubt));
  }
  void doubt(const std::string& text) { doubt(Doubt{text}); }

  void visit(const XMLElement& element) {
    static const Words kRead = {"link", "joint"};
    static const Words kOthers = {"material", "gazebo", "transmission", "sensor", "frame"};
    const std::string tag = element.Name();
    if (tag == "link") return visitLink(element);
    if (tag == "joint") return visitJoint(element);
    if (tag == "loop_joint" || tag == "constraint") return doubt(loopDoubt(element));
    if (tag == "transmission") return visitTransmission(element);
    if (tag == "gazebo") return visitGazebo(element);
    if (contains(kOthers, tag)) return;
    if (tag.compare(0, 6, "xacro:") == 0) {
      return doubt("element " + shown(element) +
                   " is not read: it is left of a xacro file; rosrun xacro xacro FILE > robot.urdf "
                   "expands it");
    }
    if (holdsLinksOrJoints(element)) {
      return doubt("element " + shown(element) +
                   " is not read, nor are links and joints in it: they have to stand in <robot>");
    }
    const std::string nearest = nearestName(tag, kRead);
    if (!nearest.empty() && !contains(kOthers, nearestName(tag, kOthers))) {
      doubt("element " + shown(element) + " is not read; did you mean <" + nearest + ">?");
    }
  }

  void visitLink(const XMLElement& link) {
    static const Words kRead = {"inertial"}, kOthers = {"visual", "collision"};
    const std::string who = "link " + inQuotes(attributeOf(link, "name"));
    forEachChild(link, [&](const XMLElement& child) {
      const std::string tag = child.Name();
      if (tag == "mass" || tag == "inertia") {
        doubt(who + ": <" + tag + "> is not read: it has to stand in <inertial>");
      } else if (tag == "pose") {
        doubt(who + ": <pose> is not read: it is SDF; <origin> of its joint says where it is");
      } else {
        doubtTag(who, tag, kRead, kOthers);
      }
    });
    const XMLElement* inertial = link.FirstChildElement("inertial");
    if (inertial && inertial->FirstChildElement("pose")) {
      doubt(who + ": <pose> in <inertial> is not read: it is SDF; <origin> says where it is");
    }
  }

  void visitJoint(const XMLElement& joint) {
    static const Words kRead = {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"};
    static const Words kOthers = {"safety_controller", "calibration", "joint_properties"};
    const std::string who = "joint " + inQuotes(attributeOf(joint, "name"));
    forEachChild(joint, [&](const XMLElement& child) {
      const std::string tag = child.Name();
      if (tag == "pose") {
        doubt(who + ": <pose> is not read: it is SDF; <origin> says where it is");
      } else {
        doubtTag(who, tag, kRead, kOthers);
      }
    });
  }

  // Doubts an element that is written almost like one that is read.
  void doubtTag(const std::string& who, const std::string& tag, const Words& read,
                const Words& others) {
    if (contains(read, tag) || contains(others, tag)) return;
    const std::string nearest = nearestName(tag, read);
    if (nearest.empty()) return;
    doubt(who + ": element <" + shortened(tag) + "> is not read; did you mean <" + nearest + ">?");
  }

  void visitTransmission(const XMLElement& transmission) {
    const std::string text = unreadText(transmission);
    if (!text.empty()) doubt(text);
  }

  void visitGazebo(const XMLElement& gazebo) {
    const std::string reference = attributeOf(gazebo, "reference");
    forEachChild(gazebo, [&](const XMLElement& child) {
      const std::string tag = child.Name();
      if (tag == "joint") return visitGazeboJoint(child);
      if (tag == "link" || tag == "model" || tag == "include") {
        return doubt("element " + shown(child) + " in <gazebo> is not read: what it adds to the " +
                     "robot is missing; describe it by <link> and <joint> of <robot>");
      }
      if (tag == "springStiffness") {
        double stiffness = 0;
        if (!parseNumber(textOf(&child), stiffness) || stiffness == 0) return;
        return doubt(
            "element <springStiffness> in <gazebo> is not read; in the scene, joints: "
            "[{name: " +
            shortened(reference) + ", stiffness: " + numberText(stiffness) +
            ", rest: ...}] is a spring in the joint");
      }
      if (tag != "plugin") return;
      if (const XMLElement* mimic = child.FirstChildElement("mimicJoint")) {
        doubt("element <mimicJoint> in <gazebo> is not read: joint " +
              inQuotes(textOf(child.FirstChildElement("joint"))) + " does not follow " +
              inQuotes(textOf(mimic)) + "; <mimic> in the joint says that it does");
      }
    });
  }

  void visitGazeboJoint(const XMLElement& joint) {
    const std::string type = attributeOf(joint, "type");
    const End parent{textOf(joint.FirstChildElement("parent")), ""};
    const End child{textOf(joint.FirstChildElement("child")), ""};
    // The root is fixed to the world anyway.
    if (type == "fixed" && (parent.link == "world" || child.link == "world")) return;
    doubt("element " + shown(joint) +
          " in <gazebo> is not read: a loop that it closes stays open; " + "in the scene, " +
          closureText(attributeOf(joint, "name"), type, parent, child) +
          " and its place on both links (xyz) closes it");
  }

  std::vector<Doubt> doubts_;
  std::size_t found_ = 0;
};

}  // namespace

std::vector<Doubt> unreadElements(const XMLElement& robot) {
  return Search().run(robot);
}

}  // namespace virtual_work_dynamics
