#include "loops/packed_rows.h"

#include <algorithm>
#include <utility>

#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

namespace {

template <typename T>
double* numbersIn(std::vector<T>& items) {
  return reinterpret_cast<double*>(items.data());
}

}  // namespace

PackedRows::PackedRows(Common common, const SamplePack& pack, std::size_t capacity)
    : common_(std::move(common)),
      block_(common_.tree, 1, common_.tree.instructionSet()),
      width_(pack.width()),
      coordinates_(block_.coordinates()),
      rows_(capacity / width_ * width_),
      roots_(common_.tree.rootMoves() ? RootState::kNumbers : 0),
      record_(pack.record()),
      memory_(
          (4 * coordinates_ + roots_ + record_.child_axes + record_.root_axes + record_.numbers()) *
          rows_ * sizeof(double)),
      loads_(common_.own_load.wrenches.size() * rows_),
      shown_(common_.usual) {
  double* next = static_cast<double*>(memory_.get());
  const auto deal = [&](std::size_t numbers) {
    double* const here = next;
    next += numbers * rows_;
    return here;
  };
  records_ = deal(record_.numbers());
  for (double** array : {&q_, &qd_, &qdd_, &effort_}) *array = deal(coordinates_);
  root_ = deal(roots_);
  child_axes_ = deal(record_.child_axes);
  root_axes_ = deal(record_.root_axes);
}

void PackedRows::takeMotion(const MotionTable& table, std::size_t first, std::size_t count) {
  const auto take = [&](const Eigen::MatrixXd& from, double* to) {
    for (std::size_t c = 0; c < coordinates_; ++c) {
      std::copy_n(from.col(static_cast<Eigen::Index>(c)).data() + first, count, to + c * count);
    }
  };
  take(table.positions, q_);
  take(table.velocities, qd_);
  take(table.accelerations, qdd_);
  if (roots_ == 0) return;
  for (std::size_t row = 0; row < count; ++row) {
    const RootState state = common_.tree.rootState(table.roots[first + row]);
    for (std::size_t i = 0; i < roots_; ++i) root_[i * count + row] = state.data()[i];
  }
}

void PackedRows::computeTree(std::size_t count, const Load* loads) {
  const MotionBlock<double> motion = {count, q_, qd_, qdd_, root_, nullptr};
  ResultBlock<double> results;
  results.effort = effort_;
  if (!common_.tree.request().child_axes.empty()) results.child_axes = child_axes_;
  if (!common_.tree.request().root_axes.empty()) results.root_axes = root_axes_;
  if (loads) {
    block_.compute(BlockLayout::kStructureOfArrays, motion, loads, results);
  } else {
    block_.compute(BlockLayout::kStructureOfArrays, motion, results);
  }
}

std::size_t PackedRows::compute(const MotionTable& table, std::size_t first, std::size_t count,
                                const Load* loads, SamplePack& pack, std::vector<bool>& computed) {
  const std::size_t whole = count / width_ * width_;
  takeMotion(table, first, whole);
  computeTree(whole, loads);
  const std::size_t own = common_.own_load.wrenches.size();
  loads_given_ = loads != nullptr;
  for (std::size_t row = 0; loads && row < whole; ++row) {
    std::copy_n(loads[row].wrenches.begin(), own,
                loads_.begin() + static_cast<std::ptrdiff_t>(row * own));
  }
  for (std::size_t at = 0; at < whole; at += width_) {
    const TreeNumbers tree{effort_ + at, child_axes_ + at, root_axes_ + at, whole};
    pack.setMotion(q_ + at, qd_ + at, qdd_ + at, whole);
    pack.setEfforts(tree);
    pack.compute();
    pack.report(tree, records_ + at * record_.numbers());
    for (std::size_t i = 0; i < width_; ++i) computed[at + i] = pack.computed(i);
  }
  return whole;
}

const Results& PackedRows::read(std::size_t index) {
  const std::size_t lane = index % width_;
  const double* next = records_ + (index - lane) * record_.numbers() + lane;
  const auto take = [&](std::size_t count, double* to) {
    for (std::size_t i = 0; i < count; ++i, next += width_) to[i] = *next;
  };
  LoopResults& loops = shown_.loops;
  take(record_.efforts, shown_.effort.data());
  const std::size_t own = common_.own_load.wrenches.size();
  const auto from = loads_given_ ? loads_.begin() + static_cast<std::ptrdiff_t>(index * own)
                                 : common_.own_load.wrenches.begin();
  std::copy_n(from, own, loops.tree_wrenches.begin());
  take(record_.loads, numbersIn(loops.tree_wrenches) + 6 * own);
  take(record_.plain, numbersIn(loops.residuals));
  take(record_.relative, numbersIn(loops.relative_residuals));
  double& condition = loops.determinacy.condition;
  condition = 1;
  for (std::size_t c = 0; c < common_.group_of.size(); ++c) {
    const double of_group = next[common_.group_of[c] * width_];
    condition = std::max(condition, of_group);
    loops.closure_conditions[c] = of_group;
  }
  next += record_.conditions * width_;
  for (Hold& hold : loops.holds) {
    hold = static_cast<Hold>(static_cast<int>(*next));
    next += width_;
  }
  loops.determinacy.redundant_constraints = common_.usual.loops.determinacy.redundant_constraints;
  for (std::size_t i = 0; i < record_.chosen; ++i, next += width_) {
    loops.determinacy.redundant_constraints -= static_cast<int>(*next);
  }
  take(record_.child_axes, numbersIn(shown_.child_axes));
  take(record_.root_axes, numbersIn(shown_.root_axes));
  return shown_;
}

}  // namespace virtual_work_dynamics
