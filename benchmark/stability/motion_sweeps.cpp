#include <utility>

#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kJoints = 7;
constexpr double kLength = 0.3;  // m

MechanismMaker chain(double mass = 1) {
  MechanismMaker maker(51);
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(mixedType(i), kLength);
    maker.add(i, place, maker.cuboid(mass * maker.random().uniform(0.5, 2), kLength));
  }
  return maker;
}

MotionRange withAngles(double angle) {
  MotionRange range;
  range.angle = angle;
  return range;
}

// Two joints follow the first; their multipliers are no numbers of few bits.
StabilityCase gearedChain(double angle) {
  MechanismMaker maker(52);
  for (int i = 0; i < kJoints; ++i) {
    const bool geared = i == 3 || i == 5;
    const JointType type = geared ? JointType::kRevolute : mixedType(i);
    const JointPlace place = maker.anyPlace(type, kLength);
    maker.add(i, place, maker.cuboid(1, kLength));
    if (i == 3) maker.mimic(0, -2.7, 0.3);
    if (i == 5) maker.mimic(0, 0.1, -1.7);
  }
  return caseOf(maker.mechanism("geared"), withAngles(angle));
}

StabilityCase fastChain(double rate) {
  MotionRange range;
  range.rate = rate;
  return caseOf(chain().mechanism("rates"), range);
}

StabilityCase acceleratedChain(double acceleration) {
  MotionRange range;
  range.acceleration = acceleration;
  return caseOf(chain().mechanism("accelerations"), range);
}

StabilityCase chainInTime(double seconds) {
  MotionRange range;
  range.rate = 1 / seconds;
  range.acceleration = 1 / (seconds * seconds);
  return caseOf(chain().mechanism("time scales"), range);
}

StabilityCase slowChain(double rate) {
  Scene scene;
  scene.gravity.setZero();
  MotionRange range;
  range.rate = range.acceleration = rate;
  return caseOf(chain().mechanism("tiny rates"), range, scene);
}

StabilityCase almostStraightChain(double position) {
  MotionRange range;
  range.angle = range.slide = position;
  return caseOf(chain().mechanism("tiny positions"), range);
}

StabilityCase chainWithZeros(double share) {
  MotionRange range;
  range.zeros = share;
  return caseOf(chain().mechanism("signed zeros"), range);
}

// Terms at every joint, one of which follows the first.
StabilityCase chainWithTerms(const JointTerms& terms) {
  MechanismMaker maker(53);
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(i == 3 ? JointType::kRevolute : mixedType(i), kLength);
    maker.add(i, place, maker.cuboid(1, kLength));
    if (i == 3) maker.mimic(0, -2.7, 0.3);
  }
  Mechanism mechanism = maker.mechanism("joint terms");
  Scene scene;
  for (const Joint& joint : mechanism.joints()) {
    scene.joints.push_back(terms);
    scene.joints.back().joint = joint.name;
    scene.joints.back().rest = maker.random().uniform(-1, 1);
  }
  return caseOf(std::move(mechanism), {}, scene);
}

StabilityCase stiffJoints(double stiffness) {
  JointTerms terms;
  terms.stiffness = stiffness;
  return chainWithTerms(terms);
}

// With the friction and the rotor of a drive beside.
StabilityCase dampedJoints(double damping) {
  JointTerms terms;
  terms.damping = damping;
  terms.coulomb = 1;
  terms.rotor_inertia = 0.1;
  return chainWithTerms(terms);
}

}  // namespace

std::vector<Sweep> motionSweeps() {
  // Around the smallest normal number, and around its square root, as rates are squared.
  const std::vector<double> denormal = {1e-322, 1e-319, 1e-316, 1e-313, 1e-310,
                                        1e-308, 1e-305, 1e-300, 1e-290, 1e-280};
  const std::vector<double> squared = {1e-320, 1e-310, 1e-300, 1e-200, 1e-170, 1e-162,
                                       1e-160, 1e-157, 1e-154, 1e-150, 1e-140, 1e-100};
  const std::vector<double> float_denormal = powersOfTen(-44, -32);
  const std::vector<double> float_squared = powersOfTen(-44, -14, 2);
  const auto with_tiny_masses = [](double mass) {
    return caseOf(chain(mass).mechanism("tiny masses"));
  };
  return {
      {"angles", "angles up to [rad]", powersOfTen(0, 9),
       [](double angle) { return caseOf(chain().mechanism("angles"), withAngles(angle)); }},
      {"geared_angles", "angles of the joint that is followed up to [rad]", powersOfTen(0, 9),
       gearedChain},
      {"rates", "rates up to [rad/s]", powersOfTen(0, 6), fastChain},
      {"accelerations", "accelerations up to [rad/s^2]", powersOfTen(0, 9), acceleratedChain},
      {"time_scales", "time scale [s]", powersOfTen(-6, 6), chainInTime},
      {"joint_stiffness", "stiffness [N m/rad or N/m]", powersOfTen(0, 12), stiffJoints},
      {"joint_damping", "damping [N m s/rad or N s/m]", powersOfTen(0, 12), dampedJoints},
      {"tiny_masses", "masses of about [kg]", denormal, with_tiny_masses},
      {"tiny_rates", "rates and accelerations up to [1/s and 1/s^2]", squared, slowChain},
      {"tiny_positions", "positions up to [rad]", denormal, almostStraightChain},
      {"tiny_float_masses", "masses of about [kg]", float_denormal, with_tiny_masses},
      {"tiny_float_rates", "rates and accelerations up to [1/s and 1/s^2]", float_squared,
       slowChain},
      {"tiny_float_positions", "positions up to [rad]", float_denormal, almostStraightChain},
      {"signed_zeros", "share of zeros in the motion", {0, 0.25, 0.5, 0.75, 1}, chainWithZeros},
  };
}

}  // namespace virtual_work_dynamics
