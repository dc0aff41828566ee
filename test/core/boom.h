#pragma once

#include <cmath>
#include <string>

namespace virtual_work_dynamics {

/// An excavator's boom in the plane of x and z. The boom turns about y on its pin at the origin, up
/// for negative angles. A ram, whose cylinder hangs on a pin behind and below that of the boom,
/// lifts it at the boom's eye. The ram's position is its length from pin to eye; the pin at the eye
/// closes the loop.
struct Boom {
  static constexpr double kPinX = -0.4, kPinZ = -0.3, kEye = 1.1;  // m
  static constexpr double kMass = 210, kCentre = 1.7;              // kg, m
  static constexpr double kCylinder = 31, kCylinderCentre = 0.45;  // from its pin
  static constexpr double kRod = 19, kRodCentre = 0.25;            // from the eye
  static constexpr double kGravity = 9.81;

  /// The boom raised by an angle above x; the derivatives are by that angle.
  explicit Boom(double raised) : angle(raised) {
    const double x = kEye * std::cos(angle) - kPinX, z = kEye * std::sin(angle) - kPinZ;
    const double dx = -kEye * std::sin(angle), dz = kEye * std::cos(angle);
    length = std::hypot(x, z);
    slope = (x * dx + z * dz) / length;
    direction = std::atan2(z, x);
    turn = (x * dz - z * dx) / (length * length);
  }

  /// The ram's push at rest: F dl is what the weights take when the boom goes up.
  double push() const {
    const double boom = kMass * kCentre * std::cos(angle);
    const double cylinder = kCylinder * kCylinderCentre * std::cos(direction) * turn;
    const double rod =
        kRod * (slope * std::sin(direction) + (length - kRodCentre) * std::cos(direction) * turn);
    return kGravity * (boom + cylinder + rod) / slope;
  }

  double angle, length, slope, direction, turn;
};

constexpr char kBoom[] = R"(<robot name="boom">
  <link name="frame"/>
  <link name="boom"><inertial><origin xyz="1.7 0 0"/><mass value="210"/>
    <inertia ixx="2" iyy="90" izz="90" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="cylinder"><inertial><origin xyz="0.45 0 0"/><mass value="31"/>
    <inertia ixx="0.1" iyy="2" izz="2" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rod"><inertial><origin xyz="-0.25 0 0"/><mass value="19"/>
    <inertia ixx="0.1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="boom_pin" type="continuous"><parent link="frame"/><child link="boom"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="cylinder_pin" type="continuous"><parent link="frame"/><child link="cylinder"/>
    <origin xyz="-0.4 0 -0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="ram" type="prismatic"><parent link="cylinder"/><child link="rod"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="3" effort="1" velocity="1"/></joint>
</robot>)";

/// A scene of the boom. @param rest further lines.
inline std::string boomScene(const std::string& rest) {
  return "closures:\n  - name: eye\n    type: revolute\n"
         "    parent: {link: rod, rpy: [-1.5707963267948966, 0, 0]}\n"
         "    child: {link: boom, xyz: [1.1, 0, 0], rpy: [-1.5707963267948966, 0, 0]}\n"
         "actuated: [ram]\n" +
         rest;
}

/// A start near 0.2 rad above x.
constexpr char kBoomStart[] =
    "assembly: [{name: boom_pin, position: -0.2}, {name: cylinder_pin, position: -0.3}, "
    "{name: ram, position: 1.6}]\n";

}  // namespace virtual_work_dynamics
