#include "virtual_work_dynamics/block.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/aligned_memory.h"
#include "base/worker_threads.h"
#include "scene/input_checks.h"
#include "tree/applied_values.h"
#include "tree/compiled_plan.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

constexpr int kArrays = 10;  // five of a MotionBlock, five of a ResultBlock
constexpr int kInputs = 5;
// Samples in columns far apart: of each column a pack takes one line, which costs a miss of the
// caches and, with many columns, of the page tables, too. So where arrays are larger than a core's
// second-level cache and columns are long and many, they are copied through columns close together,
// some lines of each at a time.
constexpr std::size_t kLargeBytes = std::size_t(8) << 20;
constexpr std::size_t kLongColumn = 2048;  // samples
constexpr std::size_t kManyColumns = 48;
constexpr std::size_t kMostLines = 32, kFewestLines = 16;
constexpr std::size_t kLinesBytes = std::size_t(1) << 19;  // of more, the fewest

/// The arrays of a block, and how many numbers of each belong to a sample.
template <typename Real>
struct BlockArrays {
  std::size_t samples;
  BlockLayout layout;
  const AppliedValues<Real>* applied;  // of all samples; null: see loads
  const Load* loads;                   // of each sample; null: see applied
  const Real* inputs[kInputs];
  Real* outputs[kArrays - kInputs];
};

int checkedThreads(int threads) {
  if (threads < 1) {
    throw Error("blocks: " + std::to_string(threads) + " threads; at least 1 is needed");
  }
  return threads;
}

}  // namespace

template <typename Real>
struct BlockInverseDynamics<Real>::Impl {
  Impl(const InverseDynamics::Impl& from, int thread_count, InstructionSet set)
      : request(from.request),
        plan(roundPlan<Real>(from.exact)),
        view(viewOf(plan)),
        instruction_set(set),
        kernel(kernelFor<Real>(set)),
        width(static_cast<std::size_t>(kernel.width)),
        own(plan, width),
        given(plan, width),
        of_samples(static_cast<std::size_t>(checkedThreads(thread_count)), own),
        workers(thread_count) {
    const std::size_t coordinates = static_cast<std::size_t>(plan.coordinates);
    const std::size_t in_root_axes = plan.root_axes.size();
    const std::size_t numbers[kArrays] = {coordinates,
                                          coordinates,
                                          coordinates,
                                          plan.root_moves ? std::size_t{RootState::kNumbers} : 0,
                                          4 * static_cast<std::size_t>(plan.orientations),
                                          request.efforts ? coordinates : 0,
                                          6 * plan.child_axes.size(),
                                          6 * in_root_axes,
                                          request.poses ? 12 * in_root_axes : 0,
                                          request.twists ? 6 * in_root_axes : 0};
    std::copy(std::begin(numbers), std::end(numbers), columns);
    const bool outputs[] = {request.efforts, !plan.child_axes.empty(), in_root_axes > 0,
                            request.poses, request.twists};
    std::copy(std::begin(outputs), std::end(outputs), requested);
    for (const std::size_t count : columns) numbers_in_sample += count;
    const bool few = kMostLines * width * numbers_in_sample * sizeof(Real) > kLinesBytes;
    const std::size_t lines = numbers_in_sample < kManyColumns ? 1
                              : few                            ? kFewestLines
                                                               : kMostLines;
    samples_at_once = lines * width;
    tile_stride = samples_at_once + width;     // no power of two
    const std::size_t behind = width * width;  // the last, see toColumns()
    const std::size_t tile_size = (numbers_in_sample * tile_stride + behind) * sizeof(Real);
    for (int i = 0; i < thread_count; ++i) {
      scratch.emplace_back(kernel.scratchSize(view));
      kernel.prepare(view, scratch.back().get());
      tiles.emplace_back(tile_size);
    }
  }

  void check(const BlockArrays<Real>& arrays) const {
    static const char* const kNames[] = {
        "q",      "qd",         "qdd",       "root",  "orientations",
        "effort", "child_axes", "root_axes", "poses", "twists"};
    if (arrays.samples == 0) return;
    for (int i = 0; i < kInputs; ++i) {
      if (columns[i] > 0 && !arrays.inputs[i]) {
        throw MotionError(std::string("block: ") + kNames[i] + " is missing");
      }
    }
    for (int i = kInputs; i < kArrays; ++i) {
      if (!requested[i - kInputs] && arrays.outputs[i - kInputs]) {
        throw MotionError(std::string("block: ") + kNames[i] + " was not requested");
      }
    }
  }

  // Computes with `applied` for all samples or, where it is null, with each sample's own load.
  void compute(BlockLayout layout, const MotionBlock<Real>& motion,
               const AppliedValues<Real>* applied, const Load* loads,
               const ResultBlock<Real>& results) {
    const BlockArrays<Real> arrays = {
        motion.samples,
        layout,
        applied,
        loads,
        {motion.q, motion.qd, motion.qdd, motion.root, motion.orientations},
        {results.effort, results.child_axes, results.root_axes, results.poses, results.twists}};
    check(arrays);
    struct Job {
      Impl* impl;
      const BlockArrays<Real>* arrays;
    } job = {this, &arrays};
    workers.run(
        [](void* context, int index) {
          const Job& all = *static_cast<Job*>(context);
          all.impl->computeShare(*all.arrays, index);
        },
        &job);
  }

  // Computes the samples of one thread, which are whole packs for all threads except the last.
  void computeShare(const BlockArrays<Real>& arrays, int index) {
    const std::size_t packs = (arrays.samples + width - 1) / width;
    const std::size_t threads = tiles.size(), thread = static_cast<std::size_t>(index);
    const std::size_t begin = packs * thread / threads * width;
    const std::size_t end = std::min(arrays.samples, packs * (thread + 1) / threads * width);
    const bool columnwise = arrays.layout == BlockLayout::kStructureOfArrays;
    std::size_t first = begin;
    while (columnwise && first + width <= end && farApart(arrays.samples)) {
      const std::size_t count = std::min(samples_at_once, (end - first) / width * width);
      computeInNearColumns(arrays, first, count, thread);
      first += count;
    }
    for (; first < end; first += width) {
      if (columnwise && first + width <= end) {
        computeInPlace(arrays, first, thread);
      } else {
        computeInTile(arrays, first, std::min(width, end - first), thread);
      }
    }
  }

  bool farApart(std::size_t samples) const {
    return numbers_in_sample >= kManyColumns && samples >= kLongColumn &&
           samples * numbers_in_sample * sizeof(Real) > kLargeBytes;
  }

  // The applied wrenches of a pack; the last sample fills it up.
  const AppliedValues<Real>& appliedOf(const BlockArrays<Real>& arrays, std::size_t first,
                                       std::size_t count, std::size_t thread) {
    if (arrays.applied) return *arrays.applied;
    AppliedValues<Real>& values = of_samples[thread];
    for (std::size_t j = 0; j < width; ++j) {
      values.setSample(plan, arrays.loads[first + std::min(j, count - 1)], j);
    }
    return values;
  }

  void computeInPlace(const BlockArrays<Real>& arrays, std::size_t first, std::size_t thread) {
    const AppliedValues<Real>& applied = appliedOf(arrays, first, width, thread);
    const auto at = [first](auto* array) { return array ? array + first : nullptr; };
    kernel.pack(view,
                {at(arrays.inputs[0]), at(arrays.inputs[1]), at(arrays.inputs[2]), arrays.samples,
                 applied.data(), applied.stride(), at(arrays.inputs[3]), arrays.samples,
                 at(arrays.inputs[4]), arrays.samples},
                {at(arrays.outputs[0]), at(arrays.outputs[1]), at(arrays.outputs[2]),
                 at(arrays.outputs[3]), at(arrays.outputs[4]), arrays.samples},
                scratch[thread].get());
  }

  // Copies some packs into columns close together, and the results back.
  void computeInNearColumns(const BlockArrays<Real>& arrays, std::size_t first, std::size_t count,
                            std::size_t thread) {
    Real* near[kArrays];
    near[0] = static_cast<Real*>(tiles[thread].get());
    for (int i = 1; i < kArrays; ++i) near[i] = near[i - 1] + columns[i - 1] * tile_stride;
    for (int i = 0; i < kInputs; ++i) {
      for (std::size_t c = 0; c < columns[i]; ++c) {
        std::copy_n(arrays.inputs[i] + c * arrays.samples + first, count,
                    near[i] + c * tile_stride);
      }
    }
    for (std::size_t j = 0; j < count; j += width) {
      const AppliedValues<Real>& applied = appliedOf(arrays, first + j, width, thread);
      const auto wanted = [&](int i) {
        return arrays.outputs[i] ? near[kInputs + i] + j : nullptr;
      };
      kernel.pack(view,
                  {near[0] + j, near[1] + j, near[2] + j, tile_stride, applied.data(),
                   applied.stride(), near[3] + j, tile_stride, near[4] + j, tile_stride},
                  {wanted(0), wanted(1), wanted(2), wanted(3), wanted(4), tile_stride},
                  scratch[thread].get());
    }
    for (int i = kInputs; i < kArrays; ++i) {
      Real* const to = arrays.outputs[i - kInputs];
      for (std::size_t c = 0; to && c < columns[i]; ++c) {
        std::copy_n(near[i] + c * tile_stride, count, to + c * arrays.samples + first);
      }
    }
  }

  // Copies a pack into columns of its width, and the results back.
  void computeInTile(const BlockArrays<Real>& arrays, std::size_t first, std::size_t count,
                     std::size_t thread) {
    const AppliedValues<Real>& applied = appliedOf(arrays, first, count, thread);
    Real* tile[kArrays];
    tile[0] = static_cast<Real*>(tiles[thread].get());
    for (int i = 1; i < kArrays; ++i) tile[i] = tile[i - 1] + columns[i - 1] * width;
    const bool whole_rows = arrays.layout == BlockLayout::kRowMajor && count == width;

    for (int i = 0; i < kInputs; ++i) {
      const Real* const from = arrays.inputs[i];
      if (columns[i] == 0) continue;
      if (whole_rows) {
        kernel.toColumns(from + first * columns[i], columns[i], tile[i]);
        continue;
      }
      for (std::size_t c = 0; c < columns[i]; ++c) {
        for (std::size_t j = 0; j < width; ++j) {  // the last sample fills up
          tile[i][c * width + j] =
              from[indexOf(arrays, columns[i], c, first + std::min(j, count - 1))];
        }
      }
    }
    const auto wanted = [&](int i) { return arrays.outputs[i] ? tile[kInputs + i] : nullptr; };
    kernel.pack(view,
                {tile[0], tile[1], tile[2], width, applied.data(), applied.stride(), tile[3], width,
                 tile[4], width},
                {wanted(0), wanted(1), wanted(2), wanted(3), wanted(4), width},
                scratch[thread].get());
    for (int i = kInputs; i < kArrays; ++i) {
      Real* const to = arrays.outputs[i - kInputs];
      if (!to || columns[i] == 0) continue;
      if (whole_rows) {
        kernel.toRows(tile[i], columns[i], to + first * columns[i]);
        continue;
      }
      for (std::size_t c = 0; c < columns[i]; ++c) {
        for (std::size_t j = 0; j < count; ++j) {
          to[indexOf(arrays, columns[i], c, first + j)] = tile[i][c * width + j];
        }
      }
    }
  }

  static std::size_t indexOf(const BlockArrays<Real>& arrays, std::size_t column_count,
                             std::size_t column, std::size_t sample) {
    return arrays.layout == BlockLayout::kRowMajor ? sample * column_count + column
                                                   : column * arrays.samples + sample;
  }

  Request request;
  Plan<Real> plan;
  PlanView<Real> view;
  InstructionSet instruction_set;
  const Kernel<Real>& kernel;
  std::size_t width;
  std::size_t columns[kArrays];                 // numbers a sample of each array
  std::size_t numbers_in_sample = 0;            // of all arrays
  std::size_t samples_at_once, tile_stride;     // of computeInNearColumns()
  bool requested[kArrays - kInputs];            // whether each output is
  AppliedValues<Real> own;                      // values of the scene's applied wrenches
  AppliedValues<Real> given;                    // values of a Load's wrenches
  std::vector<AppliedValues<Real>> of_samples;  // of a pack whose samples differ; by thread
  std::vector<AlignedMemory> scratch, tiles;    // by thread
  WorkerThreads workers;
};

template <typename Real>
BlockInverseDynamics<Real>::BlockInverseDynamics(const InverseDynamics& inverse_dynamics,
                                                 int threads, InstructionSet instruction_set)
    : impl_(new Impl(*inverse_dynamics.impl_, threads, instruction_set)) {}

template <typename Real>
BlockInverseDynamics<Real>::~BlockInverseDynamics() = default;
template <typename Real>
BlockInverseDynamics<Real>::BlockInverseDynamics(BlockInverseDynamics&&) noexcept = default;
template <typename Real>
BlockInverseDynamics<Real>& BlockInverseDynamics<Real>::operator=(BlockInverseDynamics&&) noexcept =
    default;

template <typename Real>
std::size_t BlockInverseDynamics<Real>::coordinates() const {
  return static_cast<std::size_t>(impl_->plan.coordinates);
}

template <typename Real>
const Request& BlockInverseDynamics<Real>::request() const {
  return impl_->request;
}

template <typename Real>
int BlockInverseDynamics<Real>::threads() const {
  return impl_->workers.count();
}

template <typename Real>
InstructionSet BlockInverseDynamics<Real>::instructionSet() const {
  return impl_->instruction_set;
}

template <typename Real>
void BlockInverseDynamics<Real>::compute(BlockLayout layout, const MotionBlock<Real>& motion,
                                         const ResultBlock<Real>& results) {
  impl_->compute(layout, motion, &impl_->own, nullptr, results);
}

template <typename Real>
void BlockInverseDynamics<Real>::compute(BlockLayout layout, const MotionBlock<Real>& motion,
                                         const Load& load, const ResultBlock<Real>& results) {
  impl_->given.set(impl_->plan, load);
  impl_->compute(layout, motion, &impl_->given, nullptr, results);
}

template <typename Real>
void BlockInverseDynamics<Real>::compute(BlockLayout layout, const MotionBlock<Real>& motion,
                                         const Load* loads, const ResultBlock<Real>& results) {
  for (std::size_t i = 0; i < motion.samples; ++i) {
    requireLoad(loads[i], impl_->plan.applied.size());
  }
  impl_->compute(layout, motion, nullptr, loads, results);
}

template class BlockInverseDynamics<float>;
template class BlockInverseDynamics<double>;

}  // namespace virtual_work_dynamics
