#include "tree/sample_block.h"

#include <algorithm>
#include <string>
#include <vector>

#include "scene/input_checks.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

struct SampleBlock::Impl {
  Impl(const InverseDynamics& inverse_dynamics, std::size_t rows, int threads)
      : block(inverse_dynamics, threads, inverse_dynamics.instructionSet()),
        dynamics(inverse_dynamics),
        plan(inverse_dynamics.impl_.get()),
        capacity(rows),
        efforts(block.request().efforts ? block.coordinates() : 0),
        child_axes(6 * block.request().child_axes.size()),
        root_axes(6 * block.request().root_axes.size()),
        poses(block.request().poses ? 12 * block.request().root_axes.size() : 0),
        twists(block.request().twists ? root_axes : 0),
        inputs(3 * capacity * block.coordinates()),
        roots(inverse_dynamics.rootMoves() ? RootState::kNumbers * capacity : 0),
        outputs(capacity * (efforts + child_axes + root_axes + poses + twists)) {
    double* next = outputs.data();
    const auto array = [&](std::size_t width) {
      double* const here = next;
      next += capacity * width;
      return width == 0 ? nullptr : here;
    };
    results.effort = array(efforts);
    results.child_axes = array(child_axes);
    results.root_axes = array(root_axes);
    results.poses = array(poses);
    results.twists = array(twists);
  }

  double* input(std::size_t index) {
    return inputs.data() + index * capacity * block.coordinates();
  }

  void takeRoots(const MotionTable& table, std::size_t first, std::size_t count) {
    if (roots.empty()) return;
    requireRoots(table, first + count);
    for (std::size_t row = 0; row < count; ++row) {
      const RootState state = dynamics.rootState(table.roots[first + row]);
      std::copy_n(state.data(), RootState::kNumbers, &roots[RootState::kNumbers * row]);
    }
  }

  BlockInverseDynamics<double> block;
  const InverseDynamics& dynamics;
  const InverseDynamics::Impl* plan;  // is compared, never read
  std::size_t computed = 0;           // samples of the last block
  std::size_t capacity;
  std::size_t efforts, child_axes, root_axes, poses, twists;  // numbers of each in a sample
  std::vector<double> inputs, roots, outputs;  // arrays one after the other; roots: RootStates
  ResultBlock<double> results;                 // their places in `outputs`
};

SampleBlock::SampleBlock(const InverseDynamics& inverse_dynamics, std::size_t capacity, int threads)
    : impl_(new Impl(inverse_dynamics, capacity, threads)) {}

SampleBlock::~SampleBlock() = default;
SampleBlock::SampleBlock(SampleBlock&&) noexcept = default;
SampleBlock& SampleBlock::operator=(SampleBlock&&) noexcept = default;

std::size_t SampleBlock::capacity() const {
  return impl_->capacity;
}

void SampleBlock::compute(const MotionTable& table, std::size_t first, std::size_t count,
                          const Load* loads) {
  Impl& impl = *impl_;
  const std::size_t coordinates = impl.block.coordinates();
  const Eigen::MatrixXd* const sources[] = {&table.positions, &table.velocities,
                                            &table.accelerations};
  if (count > impl.capacity) {
    throw MotionError("block: " + std::to_string(count) + " rows are more than its capacity, " +
                      std::to_string(impl.capacity));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::MatrixXd& source = *sources[i];
    if (coordinates > 0 && (static_cast<std::size_t>(source.cols()) != coordinates ||
                            static_cast<std::size_t>(source.rows()) < first + count)) {
      static const char* const kNames[] = {"positions", "velocities", "accelerations"};
      throw MotionError(std::string("motion: ") + kNames[i] + " are " +
                        std::to_string(source.rows()) + " x " + std::to_string(source.cols()) +
                        ", needed are " + std::to_string(first + count) + " x " +
                        std::to_string(coordinates));
    }
    double* const to = impl.input(i);
    for (std::size_t c = 0; c < coordinates; ++c) {
      const double* const column = source.col(static_cast<Eigen::Index>(c)).data() + first;
      for (std::size_t row = 0; row < count; ++row) to[row * coordinates + c] = column[row];
    }
  }
  impl.takeRoots(table, first, count);
  const MotionBlock<double> motion = {count, impl.input(0), impl.input(1), impl.input(2),
                                      impl.roots.data()};
  if (loads) {
    impl.block.compute(BlockLayout::kRowMajor, motion, loads, impl.results);
  } else {
    impl.block.compute(BlockLayout::kRowMajor, motion, impl.results);
  }
  impl.computed = count;
}

void SampleBlock::read(std::size_t index, Workspace& workspace) const {
  if (index >= impl_->computed) {
    throw MotionError("block: there is no sample " + std::to_string(index) + ", it has " +
                      std::to_string(impl_->computed));
  }
  workspace.requirePlan(impl_->plan);
  const ResultBlock<double>& results = impl_->results;
  const auto row = [index](const double* array, std::size_t width) {
    return array + index * width;
  };
  workspace.assign(row(results.effort, impl_->efforts), row(results.child_axes, impl_->child_axes),
                   row(results.root_axes, impl_->root_axes), row(results.poses, impl_->poses),
                   row(results.twists, impl_->twists));
}

}  // namespace virtual_work_dynamics
