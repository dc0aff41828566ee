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

/// A scene of which one parameter goes to extremes.
struct Sweep {
  std::string scene;           ///< name of the scene in the table
  std::string parameter;       ///< name of the parameter, with the unit
  std::vector<double> values;  ///< values of the parameter; 0 stands for exactly none
  std::function<StabilityCase(double)> make;
};

/// Sweeps of masses, lengths and inertias.
std::vector<Sweep> bodySweeps();
/// Sweeps of angles, rates, accelerations and times, of joint terms, and of numbers near zero.
std::vector<Sweep> motionSweeps();
/// Sweeps of numbers of bodies.
std::vector<Sweep> structureSweeps();
/// Sweeps of bodies at rest whose true efforts are zero.
std::vector<Sweep> balanceSweeps();

/// Sweeps of closed loops: planar four-bars and slider-cranks near singular positions, their
/// masses, lengths, springs and rates.
std::vector<Sweep> fourBarSweeps();
/// Sweeps of closures that hold the one coordinate of a mechanism, which is passive, with a lever
/// or a slope that vanishes.
std::vector<Sweep> heldSweeps();
/// Sweeps of closed loops in space, and of many loops.
std::vector<Sweep> linkageSweeps();
/// Sweeps of wheels, contacts, teeth and couplings.
std::vector<Sweep> touchSweeps();

/// All sweeps of trees, in the order of the table.
std::vector<Sweep> treeSweeps();
/// All sweeps of closed loops, in the order of the table.
std::vector<Sweep> loopSweeps();

/// Random states have numbers between the negatives and the positives of these. Slides are relative
/// to the distance of the joint from its parent's origin, so that they fit the mechanism's size.
struct MotionRange {
  double angle = 3.14159265358979;  ///< rad
  double slide = 0.3;
  double rate = 2;          ///< rad/s, or that distance per s
  double acceleration = 5;  ///< rad/s^2, or that distance per s^2
  double zeros = 0;         ///< share of the numbers that are zero, of either sign
};

StabilityCase caseOf(Mechanism mechanism, const MotionRange& range = {}, Scene scene = {});

/// The powers 10^from, 10^(from + step), ..., 10^to, rounded to double.
std::vector<double> powersOfTen(int from, int to, int step = 1);

}  // namespace virtual_work_dynamics
