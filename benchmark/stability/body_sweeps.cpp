#include <cmath>

#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kJoints = 7;
constexpr double kLength = 0.3;  // m

// Factor i of a geometric row of kJoints that is 1 where it is largest.
double inGeometricRow(int i, double step) {
  return std::pow(step, step > 1 ? i - (kJoints - 1) : i);
}

double stepToTip(double tip_to_base) {
  return std::pow(tip_to_base, 1.0 / (kJoints - 1));
}

StabilityCase chainWithMassSteps(double step) {
  MechanismMaker maker(41);
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(mixedType(i), kLength);
    maker.add(i, place, maker.cuboid(inGeometricRow(i, step), kLength));
  }
  return caseOf(maker.mechanism("masses"));
}

StabilityCase chainWithLengthSteps(double step) {
  MechanismMaker maker(42);
  for (int i = 0; i < kJoints; ++i) {
    const double length = inGeometricRow(i, step);
    const JointPlace place = maker.anyPlace(mixedType(i), length);
    maker.add(i, place, maker.cuboid(1, length));
  }
  return caseOf(maker.mechanism("lengths"));
}

// Every other body's axis is its joint's, where the small moment of inertia is all there is.
StabilityCase chainOfRoundBodies(double axial_to_transverse) {
  MechanismMaker maker(43);
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(mixedType(i), kLength);
    const Vector3l axis = i % 2 == 0 ? place.axis_K : maker.direction();
    const double transverse = kLength * kLength / 12;
    maker.add(
        i, place,
        maker.roundBody(1, kLength / 2 * axis, axis, axial_to_transverse * transverse, transverse));
  }
  return caseOf(maker.mechanism("round bodies"));
}

// Discs: the second moment of mass along the axis vanishes, axial = 2 transverse in the limit.
StabilityCase chainOfDiscs(double thickness_to_diameter) {
  MechanismMaker maker(44);
  const double radial = kLength * kLength / 16;  // second moments of mass of 1 kg
  const double along = thickness_to_diameter * thickness_to_diameter * kLength * kLength / 12;
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(mixedType(i), kLength);
    const Vector3l axis = i % 2 == 0 ? place.axis_K : maker.direction();
    maker.add(
        i, place,
        maker.roundBody(1, kLength / 2 * maker.direction(), axis, 2 * radial, radial + along));
  }
  return caseOf(maker.mechanism("discs"));
}

StabilityCase chainOfSmallBodies(double size_to_distance) {
  MechanismMaker maker(45);
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(mixedType(i), kLength);
    const double moment = std::pow(size_to_distance * kLength / 2, 2);
    const Vector3l centre = kLength / 2 * maker.direction();
    maker.add(i, place, maker.roundBody(1, centre, maker.direction(), moment, moment));
  }
  return caseOf(maker.mechanism("small bodies"));
}

// The last ones of a chain, or every other one.
StabilityCase chainWithMassless(double count) {
  MechanismMaker maker(46);
  for (int i = 0; i < kJoints; ++i) {
    const JointPlace place = maker.anyPlace(mixedType(i), kLength);
    Link body = maker.cuboid(1, kLength);
    const int rank = i % 2 == 0 ? i / 2 : kJoints / 2 + 1 + i / 2;  // evens lose theirs first
    if (rank < count) body = Link();
    maker.add(i, place, body);
  }
  return caseOf(maker.mechanism("massless"));
}

}  // namespace

std::vector<Sweep> bodySweeps() {
  const std::vector<double> ratios = powersOfTen(-9, 9);
  std::vector<double> sizes = powersOfTen(-9, 0);
  sizes.insert(sizes.begin(), 0);
  return {
      {"mass_tip_to_base", "mass of the last link over the first's", ratios,
       [](double ratio) { return chainWithMassSteps(stepToTip(ratio)); }},
      {"mass_link_to_link", "mass of each link over its parent's", ratios, chainWithMassSteps},
      {"length_tip_to_base", "length of the last link over the first's", ratios,
       [](double ratio) { return chainWithLengthSteps(stepToTip(ratio)); }},
      {"length_link_to_link", "length of each link over its parent's", ratios,
       chainWithLengthSteps},
      {"needles", "axial over transverse moment of inertia", sizes, chainOfRoundBodies},
      {"discs", "thickness over diameter", sizes, chainOfDiscs},
      {"point_masses", "radius of gyration over distance from the joint", sizes,
       chainOfSmallBodies},
      {"massless", "massless links of seven", {0, 1, 2, 3, 4, 5, 6}, chainWithMassless},
  };
}

}  // namespace virtual_work_dynamics
