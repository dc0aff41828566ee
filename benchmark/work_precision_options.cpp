#include "work_precision_options.h"

#include <algorithm>

#include "contenders/robots.h"

namespace virtual_work_dynamics {
namespace {

std::string knownScene(const std::string& name) {
  const std::vector<std::string> names = sceneNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  throw OptionError("--scene: there is no scene '" + name + "'; --list shows all");
}

}  // namespace

const char kWorkPrecisionHelp[] =
    R"(work_precision: run time and error of inverse dynamics, beside other libraries

  work_precision [options]

  --output FILE    all results as CSV; FILE is complete or not there
  --quick          shorter and fewer rounds, and no rows of more than 20 closed loops: all in about
                   a minute
  --scene NAME     only this scene; may be repeated
  --method NAME    only this method, as "virtual_work"; may be repeated
  --rounds N       how often every contender is timed (default: 15, with --quick: 5)
  --list           say what would be timed
  --description N  print the description of a scene without closed loops
  --list-loops     say what the scenes with closed loops consist of, as CSV
  --help           this text

All contenders of a scene compute the same 16 random states. Each is compared with a reference first,
an evaluation in 113 bits, or for closed loops in long double; one that disagrees is named, not timed,
and makes the exit status 1. Then they are timed in turn, round after round; times are the median,
least and largest of the rounds. max_relative_error is the largest error of an effort over the largest
effort of its state, or of a reaction's force or moment over the largest force or moment, whichever is
worst. Components that rigid bodies do not determine do not count. Of more than 50 joints and closures
in loops only the first state is compared.

A contender of one thread stays on one core, and its time is the time for which the thread ran;
those of several threads may use all cores and are timed by the clock.

Methods
  kdl_chain         KDL's ChainIdSolver_RNE, a segment for each link as kdl_parser makes them; only
                    for serial robots and efforts
  kdl_chain_lumped  the same with fixed joints merged: KDL at its best
  kdl_tree          KDL's TreeIdSolver_RNE, a segment for each link; only efforts
  mujoco            mj_kinematics, mj_comPos, mj_comVel and mj_rne or mj_rnePostConstraint, with
                    fixed joints merged; its reactions stay in root axes, about a common point
  dart              Skeleton::computeInverseDynamics with fixed joints merged
  virtual_work      this package; reactions of all movable joints in the axes of the child link.
                    Mode "single" is one sample a call; "block_<layout>_<instruction set>" up to
                    1008 samples, fewer where their arrays would exceed 1 MiB but at least 16; four
                    times that for each of several threads. Errors of float include those of its rounded input
  generated         straight-line C of the robot by this package (--generate of the offline tool),
                    compiled by cc with the same instructions; not of robots with more than 60 joints
  lagrange          this package's witness: Lagrange's equations, differentiated automatically; not
                    of robots with more than 100 joints, for its cost grows with their square. With
                    closed loops the tests' own, with multipliers, set up for each sample

Of scenes with closed loops, virtual_work in mode "single" is given the motion of all joints, in mode
"completed" only that of the actuated joints; mode "completion" gives the motion of the others. It
starts from their positions 1 ms before. There are two methods more, both for up to 30 joints:
  maximal_coordinates   the wrenches in all joints and closures from one dense linear system of all
                        bodies, by Gauss with full pivoting and the null space
  dense                 a user's own code with Eigen's dense LU or QR, for revolute and spherical
                        closures: efforts, and completions

Exit status: 0 done, 1 something is wrong or disagrees, 2 wrong usage.
)";

std::vector<Option> commandLine(WorkPrecisionOptions& options) {
  return {text("--output", options.output),
          {"--scene", true,
           [&options](const std::string& name) { options.scenes.push_back(knownScene(name)); }},
          texts("--method", options.methods),
          count("--rounds", 4, options.rounds),
          flag("--quick", options.quick),
          text("--description", options.description),
          flag("--list", options.list),
          flag("--list-loops", options.list_loops)};
}

}  // namespace virtual_work_dynamics
