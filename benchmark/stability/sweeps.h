#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stability/random_numbers.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A mechanism in a scene, and states to compute.
struct StabilityCase {
  Mechanism mechanism;
  Scene scene;
  std::function<Motion(RandomNumbers&)> motion;
};

/// One way in which a scene goes to extremes.
struct Sweep {
  std::string scene;           ///< name in the table
  std::string parameter;       ///< what `values` are, with the unit
  std::vector<double> values;  ///< 0 stands for exactly none
  std::function<StabilityCase(double)> make;
};

/// Of masses, lengths and inertias.
std::vector<Sweep> bodySweeps();
/// Of angles, rates, accelerations and times, of what acts at joints, and of numbers near zero.
std::vector<Sweep> motionSweeps();
/// Of numbers of bodies.
std::vector<Sweep> structureSweeps();
/// Of bodies at rest whose true efforts are zero.
std::vector<Sweep> balanceSweeps();

/// Of closed loops: planar four-bars and slider-cranks near singular positions, their masses,
/// lengths, springs and rates.
std::vector<Sweep> fourBarSweeps();
/// Of closed loops in space, and of many.
std::vector<Sweep> linkageSweeps();

/// Those of trees, in the order of the table, and those of closed loops.
std::vector<Sweep> treeSweeps();
std::vector<Sweep> loopSweeps();

/// Random states between the negative and the positive of these; slides relative to the distance of
/// the joint from its parent's origin, so that they are of its mechanism's size.
struct MotionRange {
  double angle = 3.14159265358979;  ///< rad
  double slide = 0.3;
  double rate = 2;          ///< rad/s, or of that distance 1/s
  double acceleration = 5;  ///< rad/s^2, or of that distance 1/s^2
  double zeros = 0;         ///< share of the numbers that are zero, of either sign
};

StabilityCase caseOf(Mechanism mechanism, const MotionRange& range = {}, Scene scene = {});

/// 10^from, 10^(from + step), ..., 10^to, rounded to double.
std::vector<double> powersOfTen(int from, int to, int step = 1);

}  // namespace virtual_work_dynamics
