#include <cmath>
#include <string>
#include <vector>

#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRate = MotionRange().rate, kAcceleration = MotionRange().acceleration;
const Vector3l kX = Vector3l::UnitX(), kY = Vector3l::UnitY(), kZ = Vector3l::UnitZ();
constexpr double kQuarter = 1.5707963267948966;

JointPlace placed(JointType type, const Vector3l& axis, const Vector3l& at = Vector3l::Zero()) {
  return {type, axis, Matrix3l::Identity(), at};
}

Link withoutMass() {
  return MechanismMaker(1).roundBody(0, Vector3l::Zero(), kZ, 0, 0);
}

// A vehicle on slides x and y and a turn about z: its links are up to the index that is returned.
int addVehicle(MechanismMaker& maker) {
  const int x = maker.add(0, placed(JointType::kPrismatic, kX), withoutMass());
  const int y = maker.add(x, placed(JointType::kPrismatic, kY), withoutMass());
  return maker.add(y, placed(JointType::kRevolute, kZ), maker.cuboid(10, 0.4));
}

// A wheel about y on the plane z = 0 of the root, which joints hold at its height.
Closure wheelOn(const std::string& link, double radius, Slip slip) {
  Closure wheel;
  wheel.name = "wheel of " + link;
  wheel.type = ClosureType::kRolling;
  wheel.parent.link = "base";
  wheel.child.link = link;
  wheel.child.rpy = {-kQuarter, 0, 0};
  wheel.touch.radius = radius;
  wheel.touch.normal = false;
  wheel.touch.slip = slip;
  return wheel;
}

// Positions and rates of coordinates, of which `fixed` says where the last ones are.
StabilityCase anyMotion(const MechanismMaker& maker, const std::string& name, const Scene& scene,
                        int coordinates, std::vector<double> fixed = {}, double fast = 1) {
  const auto motion = [coordinates, fixed, fast](RandomNumbers& random) {
    Motion state(coordinates);
    for (Eigen::Index i = 0; i < coordinates; ++i) {
      const double more = i >= 3 ? fast : 1;
      state.q[i] = random.uniform(-1, 1);
      state.qd[i] = more * random.uniform(-kRate, kRate);
      state.qdd[i] = more * random.uniform(-kAcceleration, kAcceleration);
    }
    const auto count = static_cast<Eigen::Index>(fixed.size());
    for (Eigen::Index i = 0; i < count; ++i) {
      state.q[coordinates - count + i] = fixed[static_cast<std::size_t>(i)];
    }
    return state;
  };
  return {maker.mechanism(name), scene, motion};
}

// Two wheels on one axle, driven; they turn the faster, the smaller they are.
StabilityCase smallWheels(double radius) {
  MechanismMaker maker(81);
  const int base = addVehicle(maker);
  Scene scene;
  scene.actuated = std::vector<std::string>{"joint_4", "joint_5"};
  for (const long double side : {0.25L, -0.25L}) {
    const Link wheel =
        maker.roundBody(1, Vector3l::Zero(), kY, 0.5 * radius * radius, 0.25 * radius * radius);
    const int link = maker.add(base, placed(JointType::kContinuous, kY, {0, side, radius}), wheel);
    scene.closures.push_back(wheelOn("link_" + std::to_string(link), radius, Slip::kNone));
  }
  return anyMotion(maker, "differential drive", scene, 5, {}, 1 / radius);
}

// Two wheels that only do not slip sideways are steered by motors; another one drives.
StabilityCase steered(const Vector3l& front, const Vector3l& back, double first, double second) {
  MechanismMaker maker(82);
  const int base = addVehicle(maker);
  const long double radius = 0.1L;
  Scene scene;
  scene.actuated = std::vector<std::string>{"joint_4", "joint_5", "joint_6"};
  const int driven = maker.add(base, placed(JointType::kContinuous, kY, {0.1L, 0.3L, radius}),
                               maker.cuboid(1, 0.05));
  scene.closures = {wheelOn("link_" + std::to_string(driven), 0.1, Slip::kLateral)};
  for (const Vector3l& at : {front, back}) {
    const Vector3l centre = at + radius * kZ;
    const int link =
        maker.add(base, placed(JointType::kRevolute, kZ, centre), maker.cuboid(1, 0.05));
    scene.closures.push_back(wheelOn("link_" + std::to_string(link), 0.1, Slip::kRolling));
  }
  scene.assembly = {{"joint_5", first}, {"joint_6", second}};
  return anyMotion(maker, "steered vehicle", scene, 6, {first, second});
}

// One behind the other, they turn the vehicle about a point that goes to infinity.
StabilityCase farCentre(double angle) {
  return steered(0.3L * kX, -0.3L * kX, angle, -angle);
}

// Side by side on one axle, they hold the vehicle along itself by the angle between them.
StabilityCase toeIn(double angle) {
  return steered(0.25L * kY, -0.25L * kY, 0.5 * angle, -0.5 * angle);
}

// A plate that heaves, rolls and pitches on three points without friction, one of which is `width`
// beside the line of the others.
StabilityCase flatTriangle(double width) {
  MechanismMaker maker(83);
  const int up = maker.add(0, placed(JointType::kPrismatic, kZ), withoutMass());
  const int roll = maker.add(up, placed(JointType::kRevolute, kX), withoutMass());
  const int plate = maker.add(roll, placed(JointType::kRevolute, kY), maker.cuboid(5, 0.3));
  Scene scene;
  scene.actuated.emplace();
  const Eigen::Vector3d points[] = {{0.3, 0, 0}, {-0.3, 0, 0}, {0.1, width, 0}};
  for (const Eigen::Vector3d& point : points) {
    Closure contact;
    contact.name = "contact_" + std::to_string(scene.closures.size());
    contact.type = ClosureType::kContact;
    contact.parent.link = "base";
    contact.child.link = "link_" + std::to_string(plate);
    contact.child.xyz = point;
    contact.touch.slip = Slip::kAll;
    scene.closures.push_back(contact);
  }
  const auto motion = [](RandomNumbers& random) {
    Motion state(3);  // contacts hold it
    for (Eigen::Index i = 0; i < 3; ++i) {
      state.qd[i] = random.uniform(-kRate, kRate);
      state.qdd[i] = random.uniform(-kAcceleration, kAcceleration);
    }
    return state;
  };
  return {maker.mechanism("plate"), scene, motion};
}

// A wheel with teeth drives a rack, or a nut drives a slide through a thread that bears no load.
StabilityCase smallRack(double radius) {
  MechanismMaker maker(84);
  maker.add(0, placed(JointType::kContinuous, kZ, {0, radius, 0}), maker.cuboid(1, 0.1));
  maker.add(0, placed(JointType::kPrismatic, kX), maker.cuboid(2, 0.2));
  Scene scene;
  Closure rack;
  rack.name = "rack";
  rack.type = ClosureType::kRack;
  rack.parent.link = "link_1";
  rack.child.link = "link_2";
  rack.teeth.parent_radius = radius;
  scene.closures = {rack};
  scene.actuated = std::vector<std::string>{"joint_1"};
  const auto motion = [radius](RandomNumbers& random) {
    Motion state(2);
    state.q << random.uniform(-3, 3), 0;
    state.qd << random.uniform(-kRate, kRate), 0;
    state.qdd << random.uniform(-kAcceleration, kAcceleration), 0;
    for (Eigen::VectorXd* rates : {&state.q, &state.qd, &state.qdd}) {
      (*rates)[1] = radius * (*rates)[0];
    }
    return state;
  };
  return {maker.mechanism("rack and pinion"), scene, motion};
}

StabilityCase flatScrew(double pitch) {
  MechanismMaker maker(85);
  maker.add(0, placed(JointType::kContinuous, kZ), maker.cuboid(1, 0.1));
  maker.add(0, placed(JointType::kPrismatic, kZ), maker.cuboid(2, 0.2));
  const double advance = pitch / (4 * kQuarter);
  Scene scene;
  Coupling screw;
  screw.name = "screw";
  screw.terms = {{"joint_2", 1}};
  if (advance > 0) screw.terms.push_back({"joint_1", -advance});
  scene.couplings = {screw};
  scene.actuated = std::vector<std::string>{"joint_1"};
  const auto motion = [advance](RandomNumbers& random) {
    Motion state(2);
    state.q << random.uniform(-3, 3), 0;
    state.qd << random.uniform(-kRate, kRate), 0;
    state.qdd << random.uniform(-kAcceleration, kAcceleration), 0;
    for (Eigen::VectorXd* rates : {&state.q, &state.qd, &state.qdd}) {
      (*rates)[1] = advance * (*rates)[0];
    }
    return state;
  };
  return {maker.mechanism("screw"), scene, motion};
}

std::vector<double> fromZero(std::vector<double> values) {
  values.insert(values.begin(), 0);
  return values;
}

}  // namespace

std::vector<Sweep> touchSweeps() {
  return {
      {"loop_small_wheels", "radius of the wheels [m]", powersOfTen(-6, 0), smallWheels},
      {"loop_far_centre", "steering angles of wheels one behind the other [rad]",
       fromZero(powersOfTen(-16, 0)), farCentre},
      {"loop_toe_in", "angle between wheels on one axle [rad]", powersOfTen(-16, 0), toeIn},
      {"loop_flat_triangle", "distance of the third contact from the line of two [m]",
       powersOfTen(-9, 0), flatTriangle},
      {"loop_small_rack", "radius of the pinion [m]", powersOfTen(-6, 0), smallRack},
      {"loop_flat_screw", "pitch of the screw [m]", fromZero(powersOfTen(-12, 0)), flatScrew},
  };
}

}  // namespace virtual_work_dynamics
