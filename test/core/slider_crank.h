#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "robot_builder.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A slider-crank in the x-y plane: joint_1 turns the crank about the origin, joint_2 the rod about
/// the crank's end, joint_3 slides along x; the closure "pin" joins rod and slider. The crank is
/// balanced. joint_4 turns an arm that is in no loop.
class SliderCrank {
 public:
  static constexpr double kCrank = 0.5, kRod = 1.25, kSlider = 2;  // m, m, kg

  /// Makes the mechanism. A rod without mass bears no force unless it must.
  explicit SliderCrank(double rod_mass = 0, bool arm = false) : builder_(1) {
    const Matrix3l R = Matrix3l::Identity();
    const Vector3l zero = Vector3l::Zero();
    builder_.add(JointType::kContinuous, 0, Vector3l::UnitZ(), R, zero);
    builder_.add(JointType::kContinuous, 1, Vector3l::UnitZ(), R, Vector3l(kCrank, 0, 0));
    builder_.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, zero);
    if (arm) builder_.add(JointType::kContinuous, 0, Vector3l::UnitZ(), R, zero);
    builder_.link(1).p_KoCm_K.setZero();
    builder_.removeInertia(2);
    builder_.link(2).mass = rod_mass;
    builder_.link(2).p_KoCm_K << 0.4L, 0, 0;
    builder_.link(3).mass = kSlider;
    builder_.link(3).p_KoCm_K.setZero();
  }

  Mechanism mechanism() const { return builder_.build(); }

  Scene scene(const std::string& actuated) const {
    Scene scene;
    scene.gravity.setZero();
    Closure pin;
    pin.name = "pin";
    pin.type = ClosureType::kRevolute;
    pin.parent.link = "link_2";
    pin.parent.xyz << kRod, 0, 0;
    pin.child.link = "link_3";
    scene.closures = {pin};
    scene.actuated = std::vector<std::string>{actuated};
    const Motion start = motion(0.7, 0, 0);
    for (int i = 0; i < 3; ++i) {
      scene.assembly.push_back({"joint_" + std::to_string(i + 1), start.q[i]});
    }
    return scene;
  }

  /// The motion of all joints from that of the crank: sin(rod) = -crank / rod sin(crank), x = crank
  /// cos + rod cos.
  static Motion motion(double angle, double rate, double acceleration, int coordinates = 3) {
    const double r = kCrank, l = kRod, s = std::sin(angle), c = std::cos(angle);
    const double rod = -std::asin(r / l * s);
    const double rod_rate = -r / l * c * rate / std::cos(rod);
    const double rod_acceleration =
        (-r / l * (c * acceleration - s * rate * rate) + std::sin(rod) * rod_rate * rod_rate) /
        std::cos(rod);
    Motion motion(coordinates);
    motion.q.head(3) << angle, rod - angle, r * c + l * std::cos(rod);
    motion.qd.head(3) << rate, rod_rate - rate, -r * s * rate - l * std::sin(rod) * rod_rate;
    motion.qdd.head(3) << acceleration, rod_acceleration - acceleration,
        -r * (s * acceleration + c * rate * rate) -
            l * (std::sin(rod) * rod_acceleration + std::cos(rod) * rod_rate * rod_rate);
    return motion;
  }

 private:
  RobotBuilder builder_;
};

/// The slider-crank with a pin in place of the slider, whose slide is a closure; on a table, its
/// joints are the ones after the table's.
inline Mechanism sliderCrankOfPins(bool on_table) {
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  const Vector3l z = Vector3l::UnitZ();
  int link = 0;
  if (on_table) link = builder.add(JointType::kContinuous, link, z, R, Vector3l::Zero());
  link = builder.add(JointType::kContinuous, link, z, R, Vector3l::Zero());
  link = builder.add(JointType::kContinuous, link, z, R, Vector3l(SliderCrank::kCrank, 0, 0));
  builder.add(JointType::kContinuous, link, z, R, Vector3l(SliderCrank::kRod, 0, 0));
  return builder.build();
}

/// Its slide, along x; on a table 0.2 m farther, and beside the pins.
inline Closure slideOfPins(bool on_table) {
  Closure slide;
  slide.name = "slide";
  slide.type = ClosureType::kPrismatic;
  slide.parent.link = on_table ? "link_1" : "link_0";
  slide.child.link = on_table ? "link_4" : "link_3";
  slide.parent.rpy << 0, 1.5707963267948966, 0;
  slide.child.rpy = slide.parent.rpy;
  if (on_table) {
    slide.parent.xyz << 0.2, 0.3, 0;
    slide.child.xyz << 0, 0.3, 0;
  }
  return slide;
}

}  // namespace virtual_work_dynamics
