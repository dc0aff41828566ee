#pragma once

#include "tree/kernel/joint_angles.h"
#include "tree/kernel/scratch.h"
#include "tree/kernel/transpose.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

/// The functions of a Kernel for packs of kWidth samples, and for one sample with the sines and
/// cosines of kAngles joints at a time.
template <typename R, int kWidth>
struct KernelBuild {
  using Samples = Pack<R, kWidth>;
  // Of one sample the other operations are of single numbers, which wait where vectors are the
  // widest.
  static constexpr int kMostAngles = 32 / static_cast<int>(sizeof(R));
  static constexpr int kAngles = kWidth < kMostAngles ? kWidth : kMostAngles;

  struct Memory {
    Scratch<R, R> one;
    Scratch<Samples, R> pack;
    std::size_t size;
  };

  static Memory memory(const PlanView<R>& plan, void* scratch) {
    ScratchDealer dealer(scratch);
    Memory result;
    result.one = dealScratch<R>(plan, kWidth, dealer);
    result.pack = dealScratch<Samples, R>(plan, 0, dealer);
    result.size = dealer.used();
    return result;
  }

  static std::size_t scratchSize(const PlanView<R>& plan) { return memory(plan, nullptr).size; }

  static void prepare(const PlanView<R>& plan, void* scratch) {
    const Memory all = memory(plan, scratch);
    prepareScratch(plan, kWidth, all.one);
    prepareScratch(plan, 0, all.pack);
  }

  static void one(const PlanView<R>& plan, const KernelInputs<R>& in, const KernelOutputs<R>& out,
                  void* scratch) {
    const Scratch<R, R> arrays = memory(plan, scratch).one;
    // Strides that the compiler knows.
    const KernelInputs<R> alone = {in.q,    in.qd, in.qdd,          1, in.applied, 1,
                                   in.root, 1,     in.orientations, 1};
    const KernelOutputs<R> results = {out.effort, out.child_axes, out.root_axes,
                                      out.poses,  out.twists,     1};
    sampleAngles<kAngles>(plan, alone, arrays);
    evaluate(plan, alone, results, arrays);
  }

  static void pack(const PlanView<R>& plan, const KernelInputs<R>& in, const KernelOutputs<R>& out,
                   void* scratch) {
    const Scratch<Samples, R> arrays = memory(plan, scratch).pack;
    packAngles(plan, in, arrays);
    evaluate(plan, in, out, arrays);
  }

  static const Kernel<R>* kernel() {
    static constexpr Kernel<R> kKernel = {kWidth, scratchSize,          prepare,          one,
                                          pack,   toColumns<R, kWidth>, toRows<R, kWidth>};
    return &kKernel;
  }
};

}  // namespace
}  // namespace virtual_work_dynamics
