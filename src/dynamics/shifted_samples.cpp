#include "dynamics/shifted_samples.h"

#include <algorithm>

namespace virtual_work_dynamics {
namespace {

std::size_t packWidth(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kAvx512:
      return 8;
    case InstructionSet::kAvx2:
      return 4;
    default:
      return 2;
  }
}

std::size_t wholePacks(std::size_t samples, std::size_t width) {
  return (samples + width - 1) / width * width;
}

// The vector of a motion that a level is in.
Eigen::VectorXd& vectorOf(Motion& motion, Eigen::Index level) {
  return level == 0 ? motion.q : level == 1 ? motion.qd : motion.qdd;
}

}  // namespace

void markKnown(const Results& results, std::vector<bool>& known) {
  const LoopResults& loops = results.loops;
  std::size_t index = 0;
  for (std::size_t i = 0; i < loops.effort_determined.size(); ++i) {
    known[index++] = loops.effort_determined[i] && results.effortExists(i);
  }
  const auto mark = [&](const std::vector<Determined>& determined,
                        const std::vector<Determined>& exist) {
    for (std::size_t i = 0; i < determined.size(); ++i) {
      for (std::size_t j = 0; j < determined[i].size(); ++j) {
        known[index++] = determined[i][j] && exist[i][j];
      }
    }
  };
  mark(loops.child_axes_determined, loops.child_axes_exist);
  mark(loops.root_axes_determined, loops.root_axes_exist);
}

ShiftedChain::ShiftedChain(const InverseDynamics& dynamics, const Load& own, int levels)
    : dynamics_(dynamics),
      block_(dynamics, 1, dynamics.instructionSet()),
      coordinates_(block_.coordinates()),
      samples_(wholePacks(1 + static_cast<std::size_t>(levels) * coordinates_,
                          packWidth(dynamics.instructionSet()))),
      inputs_(3 * coordinates_ * samples_),
      root_(dynamics.rootMoves() ? RootState::kNumbers * samples_ : 0),
      orientations_(4 * dynamics.orientations() * samples_),
      position_(dynamics.coordinates()),
      loads_(samples_, own) {
  const ResultNumbers numbers(dynamics.makeWorkspace().results());
  outputs_.resize(numbers.all() * samples_);
  double* next = outputs_.data();
  const auto array = [&](std::size_t width) {
    double* const here = width == 0 ? nullptr : next;
    next += width * samples_;
    return here;
  };
  results_.effort = array(numbers.efforts);
  results_.child_axes = array(6 * numbers.child_axes);
  results_.root_axes = array(6 * numbers.root_axes);
}

void ShiftedChain::compute(const Motion& motion, const Eigen::MatrixXd& shifts,
                           const LoadLaw& law) {
  const Eigen::VectorXd* const levels[] = {&motion.q, &motion.qd, &motion.qdd};
  const std::size_t size = coordinates_ * samples_;
  for (std::size_t level = 0; level < 3; ++level) {
    double* const array = inputs_.data() + level * size;
    const bool is_shifted = static_cast<Eigen::Index>(level) < shifts.cols();
    for (std::size_t i = 0; i < coordinates_; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double value = (*levels[level])[row];
      double* const samples = array + i * samples_;
      std::fill(samples, samples + samples_, value);
      if (!is_shifted) continue;
      samples[1 + level * coordinates_ + i] = value + shifts(row, static_cast<Eigen::Index>(level));
    }
  }
  setOrientations(motion);
  setRoots(motion);
  setLoads(motion, shifts, law);
  const double* const inputs = inputs_.data();
  block_.compute(
      BlockLayout::kStructureOfArrays,
      {samples_, inputs, inputs + size, inputs + 2 * size, root_.data(), orientations_.data()},
      loads_.data(), results_);
}

// Orientations are the same in all samples; their errors are shifts of the angles behind them.
void ShiftedChain::setOrientations(const Motion& motion) {
  for (std::size_t c = 0; c < orientations_.size() / samples_; ++c) {
    const double value =
        motion.orientations.empty()
            ? (c % 4 == 3 ? 1 : 0)
            : motion.orientations[c / 4].coeffs()[static_cast<Eigen::Index>(c % 4)];
    std::fill_n(&orientations_[c * samples_], samples_, value);
  }
}

// The root's motion is the same in all samples.
void ShiftedChain::setRoots(const Motion& motion) {
  if (root_.empty()) return;
  const RootState state = dynamics_.rootState(motion.root);
  for (std::size_t c = 0; c < RootState::kNumbers; ++c) {
    std::fill_n(&root_[c * samples_], samples_, state.data()[c]);
  }
}

// Only shifts of positions change the load.
void ShiftedChain::setLoads(const Motion& motion, const Eigen::MatrixXd& shifts,
                            const LoadLaw& law) {
  if (loads_.front().wrenches.empty()) return;
  law(motion.q, loads_.front());
  for (std::size_t sample = 1; sample < samples_; ++sample) {
    const auto i = static_cast<Eigen::Index>(sample) - 1;
    if (i >= shifts.rows()) {
      loads_[sample] = loads_.front();
      continue;
    }
    position_ = motion.q;
    position_[i] += shifts(i, 0);
    law(position_, loads_[sample]);
  }
}

ShiftedLoops::ShiftedLoops(const ClosedLoopDynamics& dynamics, const Load& own,
                           const std::vector<bool>& independent, int levels)
    : dynamics_(dynamics),
      independent_(independent),
      workspace_(dynamics.makeWorkspace()),
      numbers_(workspace_.results()),
      samples_(1 + static_cast<std::size_t>(levels) * independent.size()),
      shifted_(dynamics.coordinates()),
      load_(own),
      values_(numbers_.all() * samples_),
      known_(numbers_.all()) {}

void ShiftedLoops::compute(const Motion& motion, const Eigen::MatrixXd& shifts,
                           const LoadLaw& law) {
  // The sample itself is completed, too: what it violates of the closures is not a shift.
  shifted_ = motion;
  bool complete = computeSample(0, law);
  markKnown(workspace_.results(), known_);
  std::size_t sample = 1;
  for (Eigen::Index level = 0; level < shifts.cols(); ++level) {
    for (Eigen::Index i = 0; i < shifts.rows(); ++i, ++sample) {
      if (!independent_[static_cast<std::size_t>(i)] || !complete) continue;
      shifted_ = motion;
      vectorOf(shifted_, level)[i] += shifts(i, level);
      complete = computeSample(sample, law);
    }
  }
  if (!complete) std::fill(known_.begin(), known_.end(), false);
}

bool ShiftedLoops::computeSample(std::size_t sample, const LoadLaw& law) {
  if (!dynamics_.complete(shifted_, independent_, workspace_)) return false;
  law(shifted_.q, load_);
  dynamics_.compute(shifted_, load_, workspace_);
  forEachNumber(workspace_.results(), [&](std::size_t number, double value) {
    values_[number * samples_ + sample] = value;
  });
  return true;
}

std::vector<bool> independentCoordinates(const ClosedLoopDynamics& dynamics) {
  ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
  std::vector<bool> given(dynamics.actuated().size(), true);
  for (const bool preferred : {false, true}) {
    for (std::size_t i = given.size(); i-- > 0;) {
      if (dynamics.given().coordinates[i] != preferred) continue;
      // At rest the rates are found if and only if what is not given is determined.
      given[i] = false;
      Motion motion(dynamics.coordinates());
      motion.q = dynamics.assembly();
      given[i] = !dynamics.complete(motion, given, workspace);
    }
  }
  return given;
}

}  // namespace virtual_work_dynamics
