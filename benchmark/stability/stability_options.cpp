#include "stability/stability_options.h"

namespace virtual_work_dynamics {
const char kStabilityHelp[] =
    R"(stability: errors of inverse dynamics where scenes go to extremes

  stability [options]

  --output FILE   all results as CSV; FILE is complete or not there
  --details FILE  of double, for each value of a scene: the worst certificates, KDL's error over
                  the bound, the worst error over the narrower bound; as CSV, in the same way
  --quick         fewer states of each scene
  --scene NAME    only this scene; may be repeated
  --threads N     computes on so many threads (default: one for each core)
  --list          name the scenes and what is varied in them
  --help          this text

Every scene varies one parameter of a mechanism or its motion. For each value random states, the
same in every run, are computed in every way that the package has: one sample and blocks in both
layouts, by each build that this machine runs, on double and float; one sample on long double. All
are compared with an evaluation in 113 bits of the same input; float is given numbers of float.

error_over_bound    largest error of an effort, or of the force or moment of a reaction (ground and
                    all joints, link and root axes), over 4 L eps S: S is the sum of the norms of
                    the terms that it is the sum of, each number counted as at least the smallest
                    normal one; L the number of joints of the longest path from the root through the
                    joint to a leaf plus the binary logarithms of the numbers of children on the
                    joint's side of it; eps 2^-52, 2^-23 or 2^-63
max_relative_error  the largest error over the largest number of its kind in the state: forces with
                    efforts in N, moments with efforts in N m
one_ulp_sensitivity what the exact results change by, in the same measure, when every number of the
                    motion moves by one unit of its last digit, up or down at random: of float's for
                    float, of double's for the others, whose motions are double
kdl_relative_error  the error of KDL's efforts, in the same measure; empty where KDL has no solver:
                    mimic joints, joint terms

In the details, kdl_error_over_bound is the largest error of KDL's efforts over the same 4 L eps S.
error_over_subtree_bound is the largest error of the package over a narrower bound, whose L counts
no joints before the one whose result it is. That is no limit: orientation in the field of gravity
is a product of the rotations before the joint.

The efforts and the reaction of ground of one sample of double, by the chosen instruction set, are
certified as well (Certifier, certificates.h). A certificate is relative to the sums of norms that
bounds are made of; its limit is 4 L eps, L of the reaction of ground.

Closed loops (loop_...) are computed on double, one sample at a time, path closed_loops, and
compared with the equations of all joints in 64 bits. Their error_over_bound is over
4 (L + n) eps condition S: n unknowns of the loops; S the largest of the sums above, plus what a spring
would exert over the lengths that it compares, plus the largest force that is exact, moments over the
size of the mechanism. In the details, loop_apart is the
number of counts and flags that differ from the exact ones where the rank is clear;
loop_residual_over_limit is how far completed motions leave loops open, over 4 (L + n) eps.

Float is left out where the numbers of a scene are larger than 1e30, or all vanish in float.

Exit status: 0 all stable, 1 an error is beyond its bound, a certificate beyond its limit, one of
them not finite, a loop's count or flag wrong or its completion open, or something failed, 2 wrong
usage.
)";

std::vector<Option> commandLine(StabilityOptions& options) {
  return {text("--output", options.output), text("--details", options.details),
          texts("--scene", options.scenes), count("--threads", 3, options.threads),
          flag("--quick", options.quick),   flag("--list", options.list)};
}

}  // namespace virtual_work_dynamics
