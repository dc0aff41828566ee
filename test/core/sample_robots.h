#pragma once

#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// The description of the paper's composed pendulum (section 5).
inline std::string pendulumUrdf() {
  return R"(<robot name="composed_pendulum">
  <link name="base"/>
  <link name="rod_1"><inertial><origin xyz="0.25 0 0"/><mass value="0.25"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0.005208333333333333" iyz="0" izz="0.005208333333333333"/>
  </inertial></link>
  <link name="rod_2"><inertial><origin xyz="0.375 0 0"/><mass value="1"/>
    <inertia ixx="0" ixy="0" ixz="0" iyy="0.046875" iyz="0" izz="0.046875"/>
  </inertial></link>
  <joint name="joint_1" type="continuous"><parent link="base"/><child link="rod_1"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="joint_2" type="continuous"><parent link="rod_1"/><child link="rod_2"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint>
</robot>)";
}

/// Random trees as descriptions: every joint type, mimic joints, axes along +-x, +-y, +-z and
/// oblique, welded links, rotated inertial frames. The same seed gives the same robot.
class RandomRobot {
 public:
  RandomRobot(unsigned seed, int links) : generator_(seed) {
    text_.precision(17);
    text_ << "<robot name='random_" << seed << "'>\n";
    for (int i = 0; i < links; ++i) addLink(i);
    for (int i = 1; i < links; ++i) addJoint(i);
    text_ << "</robot>\n";
  }

  std::string urdf() const { return text_.str(); }

  Motion motion(const Mechanism& mechanism, double scale = 1) {
    Motion motion(static_cast<Eigen::Index>(mechanism.coordinates().size()));
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      motion.q[i] = uniform(-3, 3);
      motion.qd[i] = scale * uniform(-2, 2);
      motion.qdd[i] = scale * uniform(-5, 5);
    }
    return motion;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(generator_); }

 private:
  void vector(const char* name, double size) {
    text_ << ' ' << name << "='" << uniform(-size, size) << ' ' << uniform(-size, size) << ' '
          << uniform(-size, size) << "'";
  }

  void addLink(int i) {
    text_ << "<link name='link_" << i << "'>";
    if (pick(8) != 0) {  // one in eight has no mass
      const double a = uniform(0.01, 0.1), b = uniform(0.01, 0.1), c = uniform(0.01, 0.1);
      text_ << "<inertial><origin";
      vector("xyz", 0.3);
      vector("rpy", 3);
      text_ << "/><mass value='" << uniform(0.1, 5) << "'/><inertia ixx='" << b + c
            << "' ixy='0.001' ixz='-0.002' iyy='" << a + c << "' iyz='0.0005' izz='" << a + b
            << "'/></inertial>";
    }
    text_ << "</link>\n";
  }

  void addJoint(int i) {
    static const char* const kTypes[] = {"revolute", "continuous", "prismatic", "fixed"};
    static const char* const kAxes[] = {"1 0 0", "-1 0 0", "0 1 0", "0 -1 0",
                                        "0 0 1", "0 0 -1", "",      ""};
    const int type = i == 1 ? 0 : pick(4);
    const int axis = pick(8);
    text_ << "<joint name='joint_" << i << "' type='" << kTypes[type] << "'><parent link='link_"
          << pick(i) << "'/><child link='link_" << i << "'/><origin";
    vector("xyz", 0.5);
    if (pick(4) != 0) vector("rpy", 3);
    text_ << "/><axis";
    if (kAxes[axis][0]) {
      text_ << " xyz='" << kAxes[axis] << "'";
    } else {
      vector("xyz", 1);
    }
    text_ << "/><limit lower='-3' upper='3' effort='1' velocity='1'/>";
    if (i > 1 && type != 3 && pick(5) == 0) {
      text_ << "<mimic joint='joint_1' multiplier='" << uniform(-2, 2) << "' offset='"
            << uniform(-1, 1) << "'/>";
    }
    text_ << "</joint>\n";
  }

  std::mt19937 generator_;
  std::ostringstream text_;
};

}  // namespace virtual_work_dynamics
