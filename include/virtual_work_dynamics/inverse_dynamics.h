#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/instruction_set.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/plan_summary.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

class Workspace;

/// Inverse dynamics of a tree by the recursive virtual-work model (2.5)-(2.7), (3.5)-(3.8), (4.3),
/// which doc/theory.md explains and notation.h has the symbols of: a mechanism, a scene and a
/// request compiled into one plan. Immutable: one instance may serve any number of threads, each
/// with a workspace of its own.
class InverseDynamics {
 public:
  /// Compiles a plan. What matters to no requested result is left out: branches, bodies without
  /// inertia at the ends of branches, terms of motions and gravity that are zero. Fixed joints are
  /// lumped into their parents unless their reaction is requested.
  /// @throws SceneError when scene or request name a joint or link that the mechanism lacks, or a
  ///   reaction twice, when the scene is strict about inertias and the mechanism has doubtful ones,
  ///   or when it needsClosedLoops(); Error when the instruction set is not supported.
  InverseDynamics(const Mechanism& mechanism, const Scene& scene, const Request& request,
                  InstructionSet instruction_set = chosenInstructionSet());
  /// Compiles everything the scene asks for: efforts, and its reactions in both axes.
  InverseDynamics(const Mechanism& mechanism, const Scene& scene);
  ~InverseDynamics();
  InverseDynamics(InverseDynamics&&) noexcept;
  InverseDynamics& operator=(InverseDynamics&&) noexcept;

  /// Number of generalized coordinates: the length of q, qd, qdd and of the effort.
  Eigen::Index coordinates() const;
  /// Number of orientations of a motion, see Mechanism::orientations().
  std::size_t orientations() const;
  const Request& request() const;
  InstructionSet instructionSet() const;
  /// Whether the scene's root link moves: motions then say how, Motion::root.
  bool rootMoves() const;
  /// What a MotionBlock takes of the motion of a root link, in the scene's gravity.
  RootState rootState(const RootMotion& motion) const;
  /// Says what was left out, and counts the operations that remain. Allocates; runs the recursion
  /// once.
  PlanSummary summary() const;

  /// Memory for compute(). Allocates; compute() then does not.
  Workspace makeWorkspace() const;

  /// Efforts and reactions of one sample, into the workspace. Does not allocate. Angles may be
  /// any finite number; a mimic joint's, multiplier * q + offset, keeps what a double would lose of
  /// it up to 1e13 rad.
  /// @throws MotionError when a vector of `motion` has the wrong length, or the workspace is
  ///   another plan's.
  void compute(const Motion& motion, Workspace& workspace) const;
  /// Computes with `load` in place of the values of the scene's applied wrenches.
  /// @throws SceneError when it has not one wrench for each of them.
  void compute(const Motion& motion, const Load& load, Workspace& workspace) const;

 private:
  struct Impl;
  // Computes with a load; null stands for the scene's own.
  void computeWith(const Load* load, const Motion& motion, Workspace& workspace) const;
  friend class Workspace;
  friend class SampleBlock;
  template <typename Real>
  friend class BlockInverseDynamics;
  std::unique_ptr<const Impl> impl_;
};

/// Results and scratch memory of one thread's computations; made by
/// InverseDynamics::makeWorkspace(), whose maker must outlive it.
class Workspace {
 public:
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  /// Results of the sample computed last.
  const Results& results() const { return results_; }

  /// Effort of each generalized coordinate, N m or N; (3.7), mimic joints and what the scene says
  /// of joints' springs, friction and rotors included. Empty when the request leaves efforts out.
  const Eigen::VectorXd& effort() const { return results_.effort; }
  /// Reactions in the order of Request::child_axes.
  const std::vector<Wrench>& childAxes() const { return results_.child_axes; }
  /// Reactions (4.3) in the order of Request::root_axes.
  const std::vector<Wrench>& rootAxes() const { return results_.root_axes; }
  /// Poses of joint frames in the order of Request::root_axes; empty unless requested.
  const std::vector<Pose>& poses() const { return results_.poses; }
  /// Velocities of joint frames in the order of Request::root_axes; empty unless requested.
  const std::vector<Twist>& twists() const { return results_.twists; }

  /// False when any result overflowed to infinity or NaN, as huge inputs can.
  bool finite() const { return results_.finite(); }

 private:
  friend class InverseDynamics;
  friend class SampleBlock;
  struct Scratch;
  explicit Workspace(const InverseDynamics::Impl& plan);
  void requirePlan(const InverseDynamics::Impl* plan) const;
  // Takes results as they stand in rows of a ResultBlock; poses are turned into quaternions.
  void assign(const double* effort, const double* child_axes, const double* root_axes,
              const double* poses, const double* twists);

  Results results_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace virtual_work_dynamics
