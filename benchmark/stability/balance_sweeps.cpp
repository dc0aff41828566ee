#include <Eigen/Geometry>

#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLength = 0.3;    // m
constexpr double kGravity = 9.81;  // m/s^2

MotionRange atRest() {
  MotionRange range;
  range.rate = range.acceleration = 0;
  return range;
}

Matrix3l turnedAbout(const Vector3l& axis, double angle) {
  return Eigen::AngleAxis<long double>(angle, axis).toRotationMatrix();
}

// Arms one on the other, each with a counterweight that puts the centre of mass of what its joint
// carries on the joint's axis, a little along it so that the reactions have moments. Built from the
// load to the base.
StabilityCase counterweights(double weight_to_load) {
  constexpr int kArms = 4;
  MechanismMaker maker(71);
  JointPlace places[kArms];
  Link bodies[kArms];
  for (JointPlace& place : places) place = maker.anyPlace(JointType::kRevolute, kLength);
  long double carried = 1;
  for (int i = kArms - 1; i >= 0; --i) {
    const Vector3l balanced = kLength / 4 * places[i].axis_K;
    Link& body = bodies[i];
    if (i == kArms - 1) {
      body = maker.roundBody(1, balanced, places[i].axis_K, 0.01, 0.01);
      continue;
    }
    const JointPlace& load = places[i + 1];
    const Vector3l load_centre = load.p_PoKo_P + load.R_PK * (kLength / 4 * load.axis_K);
    const double mass = static_cast<double>(weight_to_load * carried);
    const Vector3l centre = balanced + carried / mass * (balanced - load_centre);
    body = maker.roundBody(mass, centre, places[i].axis_K, 0.01, 0.01);
    carried += mass;
  }
  for (int i = 0; i < kArms; ++i) maker.add(i, places[i], bodies[i]);
  return caseOf(maker.mechanism("counterweights"), atRest());
}

// Links hang on horizontal axes, whose frames stand at any angle that the joint takes back. Their
// centres of mass lie beside the joints along the axes, so that the reactions have moments.
StabilityCase hanging(double joints) {
  MechanismMaker maker(72);
  std::vector<double> positions;
  for (int i = 0; i < joints; ++i) {
    JointPlace place;
    place.type = mixedType(i);
    place.axis_K = Vector3l::UnitX();
    if (i > 0) place.p_PoKo_P << maker.random().uniform(-0.1, 0.1), 0, -kLength;
    const bool slides = place.type == JointType::kPrismatic;
    const double angle = maker.random().uniform(-3, 3);
    if (!slides) place.R_PK = turnedAbout(Vector3l::UnitX(), angle);
    positions.push_back(slides ? 0.1 : -angle);
    const Vector3l centre(maker.random().uniform(-0.1, 0.1), 0, -kLength / 2);
    maker.add(i, place, maker.roundBody(1, centre, Vector3l::UnitZ(), 0.001, 0.01));
  }
  // A slide may be anywhere; an angle is what hangs.
  const auto motion = [positions](RandomNumbers& random) {
    Motion state(static_cast<Eigen::Index>(positions.size()));
    for (Eigen::Index i = 0; i < state.q.size(); ++i) {
      const bool slides = mixedType(static_cast<int>(i)) == JointType::kPrismatic;
      state.q[i] = positions[static_cast<std::size_t>(i)];
      if (slides) state.q[i] = random.uniform(-0.1, 0.1);
    }
    return state;
  };
  return {maker.mechanism("hanging"), Scene(), motion};
}

// Joints turn about axes along gravity, and slide across it, in general position in the root.
StabilityCase verticalAxes(double joints) {
  MechanismMaker maker(73);
  const Matrix3l R_0V = maker.rotation();
  for (int i = 0; i < joints; ++i) {
    JointPlace place;
    place.type = mixedType(i);
    place.axis_K =
        place.type == JointType::kPrismatic ? Vector3l::UnitX() : Vector3l(Vector3l::UnitZ());
    place.p_PoKo_P = kLength * maker.direction();
    place.R_PK = turnedAbout(Vector3l::UnitZ(), maker.random().uniform(-3, 3));
    if (i == 0) place.R_PK = R_0V;
    maker.add(i, place, maker.cuboid(1, kLength));
  }
  Scene scene;
  scene.static_motion = true;
  scene.gravity = (-kGravity * R_0V.col(2)).cast<double>();
  return caseOf(maker.mechanism("vertical axes"), {}, scene);
}

}  // namespace

std::vector<Sweep> balanceSweeps() {
  const std::vector<double> counts = {1, 2, 5, 10, 20, 50, 100, 200, 500};
  return {
      {"balance_counterweights", "counterweight over load", powersOfTen(-9, 9), counterweights},
      {"balance_hanging", "joints one below the other", counts, hanging},
      {"balance_vertical_axes", "joints with axes along gravity", counts, verticalAxes},
  };
}

}  // namespace virtual_work_dynamics
