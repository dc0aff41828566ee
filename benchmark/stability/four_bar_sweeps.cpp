#include <vector>

#include "four_bar.h"
#include "slider_crank.h"
#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRate = MotionRange().rate, kAcceleration = MotionRange().acceleration;

FourBar::Turning drawn(RandomNumbers& random, double least, double most, double rate = kRate,
                       double acceleration = kAcceleration) {
  const double angle = random.uniform(least, most);
  const double qd = random.uniform(-rate, rate);
  return {angle, qd, random.uniform(-acceleration, acceleration)};
}

StabilityCase caseOf(const FourBar& four_bar, const std::vector<JointTerms>& terms = {},
                     double rate = kRate, double acceleration = kAcceleration) {
  FourBar::Cut cut = four_bar.cut('D');
  cut.scene.joints = terms;
  const auto motion = [four_bar, cut, rate, acceleration](RandomNumbers& random) {
    const FourBar::Turning crank = drawn(random, -3, 3, rate, acceleration);
    return cut.motion(four_bar.turnings(crank.angle, crank.rate, crank.acceleration));
  };
  return {cut.mechanism, cut.scene, motion};
}

// The coupler stays parallel to ground; a crank at angle zero is at the change point.
StabilityCase parallelogram(double rod, double ground, double least, double most) {
  FourBar four_bar;
  four_bar.lengths = {rod, ground, rod, ground};
  FourBar::Cut cut = four_bar.cut('D');
  cut.scene.assembly = {{"A", 1.0}, {"B", -1.0}, {"C", 1.0}};
  const auto motion = [cut, least, most](RandomNumbers& random) {
    FourBar::Turning crank = drawn(random, least, most);
    if (random.chance(0.5)) crank.angle = -crank.angle;
    return cut.motion({{crank, {0, 0, 0}, crank}});
  };
  return {cut.mechanism, cut.scene, motion};
}

StabilityCase towardsChangePoint(double angle) {
  return parallelogram(0.3, 0.8, 0.5 * angle, angle);
}

StabilityCase narrowParallelogram(double ratio) {
  return parallelogram(0.25, 0.25 * ratio, 0.6, 2.5);
}

// The slider drives; the weight of the rod asks for a torque of the crank.
StabilityCase towardsDeadCentre(double angle) {
  const SliderCrank slider_crank(1.5);
  Scene scene = slider_crank.scene("joint_3");
  scene.gravity << 0, -9.81, 0;
  const auto motion = [angle](RandomNumbers& random) {
    const FourBar::Turning crank = drawn(random, 0.5 * angle, angle);
    return SliderCrank::motion(static_cast<double>(random.chance(0.5) ? crank.angle : -crank.angle),
                               static_cast<double>(crank.rate),
                               static_cast<double>(crank.acceleration));
  };
  return {slider_crank.mechanism(), scene, motion};
}

StabilityCase heavyCoupler(double factor) {
  FourBar four_bar;
  four_bar.bodies[FourBar::kCoupler].mass *= factor;
  four_bar.bodies[FourBar::kCoupler].moment *= factor;
  return caseOf(four_bar);
}

StabilityCase fastFourBar(double rate) {
  return caseOf(FourBar(), {}, rate, rate * rate);
}

StabilityCase stiffFourBar(double stiffness) {
  std::vector<JointTerms> terms;
  for (const char* name : {"A", "B", "C"}) {
    JointTerms term;
    term.joint = name;
    term.stiffness = stiffness;
    term.damping = 1e-3 * stiffness;
    term.rest = 0.3;
    terms.push_back(term);
  }
  return caseOf(FourBar(), terms);
}

}  // namespace

std::vector<Sweep> fourBarSweeps() {
  const std::vector<double> angles = powersOfTen(-12, 0);
  const std::vector<double> ratios = powersOfTen(-6, 6);
  return {
      {"loop_change_point", "angles from the change point up to [rad]", angles, towardsChangePoint},
      {"loop_dead_centre", "angles from dead centre up to [rad]", angles, towardsDeadCentre},
      {"loop_mass_ratio", "mass of the coupler over an ordinary one's", ratios, heavyCoupler},
      {"loop_unit_of_length", "size over an ordinary one's", ratios,
       [](double unit) { return caseOf(FourBar(unit)); }},
      {"loop_tiny_link", "coupler and ground over crank and rocker", powersOfTen(-9, 0),
       narrowParallelogram},
      {"loop_stiff_joints", "stiffness [N m/rad]", powersOfTen(0, 12), stiffFourBar},
      {"loop_rates", "rates up to [rad/s]", powersOfTen(0, 6), fastFourBar},
  };
}

}  // namespace virtual_work_dynamics
