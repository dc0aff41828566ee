#pragma once

#include <vector>

#include "base/aligned_memory.h"
#include "tree/kernel/scratch.h"
#include "tree/plan.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {
namespace {  // see kernel/kernel.h

/// The arrays of one sample. A number that something is recorded of stands in the place of a double
/// and is as large as one.
struct SampleArrays {
  using Numbers = std::vector<double>;

  explicit SampleArrays(const Plan<double>& plan)
      : q(room(plan.coordinates)),
        qd(q),
        qdd(q),
        root(room(RootState::kNumbers)),
        orientations(room(4 * plan.orientations)),
        applied(room(6 * static_cast<int>(plan.applied.size()))),
        effort(q),
        child_axes(room(6 * static_cast<int>(plan.child_axes.size()))),
        root_axes(room(6 * static_cast<int>(plan.root_axes.size()))),
        poses(room(12 * static_cast<int>(plan.root_axes.size()))),
        twists(root_axes) {}

  Numbers q, qd, qdd, root, orientations, applied;       // read
  Numbers effort, child_axes, root_axes, poses, twists;  // written

 private:
  // One more, so that there is an address.
  static Numbers room(int count) { return Numbers(static_cast<std::size_t>(count) + 1); }
};

/// Runs the recursion once on numbers of type T.
/// @param angles finds the sines and cosines: (view, inputs, scratch) -> void
template <typename T, typename Angles>
void runPlan(const Plan<double>& plan, SampleArrays& arrays, const Angles& angles) {
  const PlanView<double> view = viewOf(plan);
  ScratchDealer counting(nullptr);
  dealScratch<T>(view, 0, counting);
  const AlignedMemory memory(counting.used());
  ScratchDealer dealer(memory.get());
  const Scratch<T, double> scratch = dealScratch<T>(view, 0, dealer);
  prepareScratch(view, 0, scratch);
  const KernelInputs<double> in = {arrays.q.data(),
                                   arrays.qd.data(),
                                   arrays.qdd.data(),
                                   1,
                                   arrays.applied.data(),
                                   1,
                                   arrays.root.data(),
                                   1,
                                   arrays.orientations.data(),
                                   1};
  const KernelOutputs<double> out = {plan.efforts ? arrays.effort.data() : nullptr,
                                     arrays.child_axes.data(),
                                     arrays.root_axes.data(),
                                     plan.poses ? arrays.poses.data() : nullptr,
                                     plan.twists ? arrays.twists.data() : nullptr,
                                     1};
  angles(view, in, scratch);
  evaluate(view, in, out, scratch);
}

}  // namespace
}  // namespace virtual_work_dynamics
