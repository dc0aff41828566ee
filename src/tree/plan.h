#pragma once

#include <string>
#include <vector>

#include "tree/kernel/kernel.h"
#include "tree/plan_types.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// What was left out of a plan, by names of joints.
struct OmittedWork {
  std::vector<std::string> merged;    ///< fixed joints, welded into their parents
  std::vector<std::string> unneeded;  ///< joints whose bodies reach no requested result
  std::vector<std::string> massless;  ///< joints whose wrench is zero
  std::vector<std::string> idle;      ///< joints whose position matters to no requested result
  std::vector<std::string> at_rest;   ///< joints whose parent neither turns nor accelerates
  bool velocity_terms = false;
  bool gravity = false;
};

/// The part of a plan that does not depend on its number type.
struct PlanUse {
  int coordinates = 0;
  int orientations = 0;  ///< that a motion has
  int slots = 0;         ///< motions that are kept for later children
  bool efforts = true;
  bool static_motion = false;
  bool root_moves = false;
  bool poses = false;   ///< whether poses are reported with the reactions in root axes
  bool twists = false;  ///< whether twists are reported with the reactions in root axes
  bool any_pose = false;
  bool child_zeros = false;    ///< some reaction in child axes is known to be zero
  bool root_zeros = false;     ///< some reaction in root axes is known to be zero
  bool geared_angles = false;  ///< some joint that turns is not moved one to one
  int wrenches = 0;  ///< number of the bodies' wrenches and of the partial sums behind them
  std::vector<Carry> carries;
  std::vector<PointStep> point_steps;
  std::vector<int> zero_efforts;  ///< coordinates that no wrench reaches
  OmittedWork left_out;
  double gravity[3] = {};  ///< m/s^2, inertial axes
};

/// A mechanism, a scene and a request, compiled: the constants of the recursion.
template <typename T>
struct Plan : PlanUse {
  PlainWrench<T> root_wrench{};  ///< (3.5) of a root body that rests
  std::vector<Body<T>> bodies;
  std::vector<JointPosition<T>> angles;
  std::vector<JointPosition<T>> slides;
  std::vector<ReactionOutput<T>> child_axes;
  std::vector<ReactionOutput<T>> root_axes;
  std::vector<MovedMoment<T>> moved;
  std::vector<AppliedOutside<T>> applied;
  std::vector<ActuatorTerms<T>> actuators;
};

/// Compiles in long double. @throws SceneError, see InverseDynamics.
Plan<long double> compilePlan(const Mechanism& mechanism, const Scene& scene,
                              const Request& request);

/// A plan as the kernels see it, which must outlive the view.
template <typename T>
PlanView<T> viewOf(const Plan<T>& plan);

/// A copy of a plan with every constant rounded once. T: float or double.
template <typename T>
Plan<T> roundPlan(const Plan<long double>& plan);

}  // namespace virtual_work_dynamics
