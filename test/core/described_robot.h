#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace virtual_work_dynamics {
namespace dirty {

struct LinkText {
  std::string name;
  std::string inertial, visual, more;
};

struct JointText {
  std::string name, type, parent, child;
  std::string origin, axis, limit, more;
};

// The parts of a description, each of which a fault may spoil.
struct Robot {
  std::string start = "<?xml version=\"1.0\"?>\n", attributes = " name=\"robot\"";
  std::vector<LinkText> links;
  std::vector<JointText> joints;  // joints[i] carries links[i + 1]
  std::string more;
  std::function<std::string(std::string)> finish = [](std::string text) { return text; };
};

class Dice {
 public:
  explicit Dice(unsigned seed) : generator_(seed) {}
  // From 0 to below `end`.
  std::size_t below(std::size_t end) { return static_cast<std::size_t>(generator_() % end); }
  double number(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) / 9007199254740992.0;
  }
  template <typename Item>
  Item& one(std::vector<Item>& items) {
    return items[below(items.size())];
  }

 private:
  std::mt19937_64 generator_;
};

inline std::string text(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.6g", value);
  return digits;
}

inline std::string triple(double x, double y, double z) {
  return text(x) + " " + text(y) + " " + text(z);
}

// The inertial of a box.
inline std::string inertial(double mass, double a, double b, double c, const std::string& xyz) {
  const auto moment = [&](double u, double v) { return text(mass / 12 * (u * u + v * v)); };
  return "<inertial><origin xyz=\"" + xyz + "\" rpy=\"0 0 0\"/><mass value=\"" + text(mass) +
         "\"/><inertia ixx=\"" + moment(b, c) + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + moment(a, c) +
         "\" iyz=\"0\" izz=\"" + moment(a, b) + "\"/></inertial>";
}

inline std::string visual(Dice& dice) {
  const std::string shapes[] = {
      "<box size=\"0.1 0.1 0.1\"/>", "<cylinder radius=\"0.05\" length=\"0.2\"/>",
      "<sphere radius=\"0.1\"/>", "<mesh filename=\"package://robot/meshes/link.stl\"/>",
      "<mesh filename=\"file:///C:\\parts\\Base Link.dae\" scale=\"0.001 0.001 0.001\"/>"};
  return "<visual><geometry>" + shapes[dice.below(5)] +
         "</geometry><material name=\"grey\"/></visual>";
}

inline Robot cleanRobot(Dice& dice) {
  Robot robot;
  const std::size_t count = 2 + dice.below(dice.below(10) == 0 ? 200 : 14);
  const std::string styles[] = {"", "left/", "r_", "Robot 1 "};
  const std::string prefix = styles[dice.below(4)];
  const std::string moving[] = {"revolute", "continuous", "prismatic"};
  for (std::size_t i = 0; i < count; ++i) {
    LinkText link;
    link.name = prefix + "link_" + std::to_string(i);
    if (i > 0) {
      const double a = dice.number(0.03, 0.2), c = dice.number(0.05, 0.4);
      link.inertial = inertial(dice.number(0.05, 8), a, a, c, triple(0, 0, c / 2));
      link.visual = visual(dice);
    }
    robot.links.push_back(link);
    if (i == 0) continue;
    JointText joint;
    joint.name = prefix + "joint_" + std::to_string(i);
    joint.type = dice.below(6) == 0 ? "fixed" : moving[dice.below(3)];
    joint.parent = robot.links[dice.below(2) == 0 ? i - 1 : dice.below(i)].name;
    joint.child = link.name;
    joint.origin = "<origin xyz=\"" + triple(0, dice.number(-0.1, 0.1), dice.number(0.1, 0.4)) +
                   "\" rpy=\"" + triple(0, 0, dice.number(-1.5, 1.5)) + "\"/>";
    const std::string axes[] = {"1 0 0", "0 1 0", "0 0 1", "0 0 -1"};
    joint.axis = "<axis xyz=\"" + axes[dice.below(4)] + "\"/>";
    joint.limit = "<limit lower=\"-1.57\" upper=\"1.57\" effort=\"100\" velocity=\"3\"/>";
    robot.joints.push_back(joint);
  }
  return robot;
}

inline std::string written(const Robot& robot) {
  std::string text = robot.start + "<robot" + robot.attributes + ">\n";
  for (const LinkText& link : robot.links) {
    text += "  <link name=\"" + link.name + "\">" + link.inertial + link.visual + link.more +
            "</link>\n";
  }
  for (const JointText& joint : robot.joints) {
    text += "  <joint name=\"" + joint.name + "\" type=\"" + joint.type + "\"><parent link=\"" +
            joint.parent + "\"/><child link=\"" + joint.child + "\"/>" + joint.origin + joint.axis +
            joint.limit + joint.more + "</joint>\n";
  }
  return robot.finish(text + robot.more + "</robot>\n");
}

inline void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at != std::string::npos) text.replace(at, from.size(), to);
}

inline std::string replacedAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// Gives one link another inertial; all but the root have one.
inline LinkText& bodyOf(Robot& robot, Dice& dice) {
  return robot.links[1 + dice.below(robot.links.size() - 1)];
}

inline void setMass(LinkText& link, const std::string& value) {
  const std::size_t at = link.inertial.find("<mass value=\"") + 13;
  if (at < 13) return;
  link.inertial.replace(at, link.inertial.find('"', at) - at, value);
}

inline void setMoment(LinkText& link, const std::string& name, const std::string& value) {
  const std::size_t at = link.inertial.find(name + "=\"") + name.size() + 2;
  if (at < name.size() + 2) return;
  link.inertial.replace(at, link.inertial.find('"', at) - at, value);
}

inline void rename(Robot& robot, std::size_t index, const std::string& name) {
  const std::string old = robot.links[index].name;
  robot.links[index].name = name;
  for (JointText& joint : robot.joints) {
    if (joint.parent == old) joint.parent = name;
    if (joint.child == old) joint.child = name;
  }
}

inline void makeRevolute(JointText& joint) {
  joint.type = "revolute";
}

}  // namespace dirty
}  // namespace virtual_work_dynamics
