#include "dynamics/shifted_samples.h"

#include <algorithm>

#include "virtual_work_dynamics/free_turn.h"

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
Eigen::VectorXd& vectorOf(Motion& motion, std::size_t level) {
  return level == 0 ? motion.q : level == 1 ? motion.qd : motion.qdd;
}

// The i-th number of a wrench.
double& numberOf(Wrench& wrench, std::size_t i) {
  const auto component = static_cast<Eigen::Index>(i % 3);
  return i < 3 ? wrench.force[component] : wrench.torque[component];
}

// The joint that turns freely one of whose angles a coordinate is; their number: there is none.
std::size_t freeTurnWith(const Mechanism& mechanism, std::size_t coordinate) {
  std::size_t i = 0;
  for (; i < mechanism.orientations(); ++i) {
    const auto first = static_cast<std::size_t>(mechanism.anglesOf(i));
    if (coordinate >= first && coordinate < first + 3) break;
  }
  return i;
}

Eigen::Quaterniond turnedOn(const Eigen::Quaterniond& orientation, Eigen::Index axis,
                            double angle) {
  return orientation * Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)));
}

// Shifts one of the numbers of TurnCovariance.
void shiftTurn(const Mechanism& mechanism, std::size_t orientation, std::size_t level,
               Eigen::Index axis, double shift, Motion& motion) {
  FreeTurn turn = freeTurnOf(mechanism, orientation, motion);
  if (level == 0) turn.orientation = turnedOn(turn.orientation, axis, shift);
  if (level == 1) turn.angular_velocity[axis] += shift;
  if (level == 2) turn.angular_acceleration[axis] += shift;
  setFreeTurn(mechanism, orientation, turn, motion);
}

// Shifts a level of a coordinate, or of the turn that its joint makes.
void shiftCoordinate(const Mechanism& mechanism, const SampleShifts& shifts, std::size_t level,
                     std::size_t coordinate, Motion& motion) {
  const auto row = static_cast<Eigen::Index>(coordinate);
  const double shift = shifts.coordinates(row, static_cast<Eigen::Index>(level));
  const std::size_t turn =
      shifts.turns ? freeTurnWith(mechanism, coordinate) : mechanism.orientations();
  if (turn == mechanism.orientations()) {
    vectorOf(motion, level)[row] += shift;
  } else {
    shiftTurn(mechanism, turn, level, row - mechanism.anglesOf(turn), shift, motion);
  }
}

// Shifts one of the numbers of RootCovariance.
void shiftRoot(std::size_t number, double shift, RootMotion& root) {
  const auto axis = static_cast<Eigen::Index>(number % 3);
  switch (number / 3) {
    case 0:
      root.orientation = turnedOn(root.orientation, axis, shift);
      return;
    case 1:
      root.angular_velocity[axis] += shift;
      return;
    case 2:
      root.angular_acceleration[axis] += shift;
      return;
    default:
      root.acceleration[axis] += shift;
  }
}

}  // namespace

ShiftPlan::ShiftPlan(const Mechanism& mechanism, const Scene& scene)
    : coordinates(mechanism.coordinates().size()),
      levels(scene.static_motion ? 1 : 3),
      root(scene.root_moves ? 12 : 0) {
  for (std::size_t i = 0; i < scene.applied_wrenches.size(); ++i) {
    if (scene.applied_wrenches[i].deviation) wrenches.push_back(i);
  }
}

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

ShiftedChain::ShiftedChain(const Mechanism& mechanism, const InverseDynamics& dynamics,
                           const ShiftPlan& plan, const Load& own)
    : mechanism_(mechanism),
      dynamics_(dynamics),
      plan_(plan),
      block_(dynamics, 1, dynamics.instructionSet()),
      samples_(wholePacks(plan.columns(), packWidth(dynamics.instructionSet()))),
      inputs_(3 * plan.coordinates * samples_),
      root_(dynamics.rootMoves() ? RootState::kNumbers * samples_ : 0),
      orientations_(4 * dynamics.orientations() * samples_),
      shifted_(dynamics.coordinates(), dynamics.orientations()),
      root_by_link_(mechanism),
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

void ShiftedChain::compute(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law) {
  setCoordinates(motion, shifts);
  setOrientations(motion);
  if (shifts.turns) shiftTurns(motion, shifts);
  setRoots(motion, shifts);
  setLoads(motion, shifts, law);
  const std::size_t size = plan_.coordinates * samples_;
  const double* const inputs = inputs_.data();
  block_.compute(
      BlockLayout::kStructureOfArrays,
      {samples_, inputs, inputs + size, inputs + 2 * size, root_.data(), orientations_.data()},
      loads_.data(), results_);
}

void ShiftedChain::setCoordinates(const Motion& motion, const SampleShifts& shifts) {
  const Eigen::VectorXd* const levels[] = {&motion.q, &motion.qd, &motion.qdd};
  for (std::size_t level = 0; level < 3; ++level) {
    double* const array = inputs_.data() + level * plan_.coordinates * samples_;
    for (std::size_t i = 0; i < plan_.coordinates; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double value = (*levels[level])[row];
      double* const samples = array + i * samples_;
      std::fill(samples, samples + samples_, value);
      if (level >= plan_.levels) continue;
      samples[plan_.columnOf(level, i)] =
          value + shifts.coordinates(row, static_cast<Eigen::Index>(level));
    }
  }
}

// Orientations are the same in all samples; their errors are shifts of the angles behind them,
// unless shiftTurns() replaces these.
void ShiftedChain::setOrientations(const Motion& motion) {
  for (std::size_t c = 0; c < orientations_.size() / samples_; ++c) {
    const double value =
        motion.orientations.empty()
            ? (c % 4 == 3 ? 1 : 0)
            : motion.orientations[c / 4].coeffs()[static_cast<Eigen::Index>(c % 4)];
    std::fill_n(&orientations_[c * samples_], samples_, value);
  }
}

void ShiftedChain::shiftTurns(const Motion& motion, const SampleShifts& shifts) {
  for (std::size_t turn = 0; turn < mechanism_.orientations(); ++turn) {
    const auto first = static_cast<std::size_t>(mechanism_.anglesOf(turn));
    for (std::size_t level = 0; level < plan_.levels; ++level) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        shifted_ = motion;
        shiftCoordinate(mechanism_, shifts, level, first + axis, shifted_);
        const std::size_t column = plan_.columnOf(level, first + axis);
        for (std::size_t of = 0; of < 9; ++of) {
          const std::size_t i = first + of % 3;
          inputs_[(of / 3 * plan_.coordinates + i) * samples_ + column] =
              vectorOf(shifted_, of / 3)[static_cast<Eigen::Index>(i)];
        }
        for (std::size_t c = 0; c < 4; ++c) {
          orientations_[(4 * turn + c) * samples_ + column] =
              shifted_.orientations[turn].coeffs()[static_cast<Eigen::Index>(c)];
        }
      }
    }
  }
}

void ShiftedChain::setRoots(const Motion& motion, const SampleShifts& shifts) {
  if (root_.empty()) return;
  const RootState state = dynamics_.rootState(motion.root);
  for (std::size_t c = 0; c < RootState::kNumbers; ++c) {
    std::fill_n(&root_[c * samples_], samples_, state.data()[c]);
  }
  if (shifts.root_link != 0) {
    setRootsByLink(motion, shifts);
    return;
  }
  for (std::size_t number = 0; number < plan_.root; ++number) {
    RootMotion root = motion.root;
    shiftRoot(number, shifts.root[static_cast<Eigen::Index>(number)], root);
    setRoot(plan_.firstOfRoot() + number, root);
  }
}

// Where a sensor on another link tells how the root moves, each joint's shift moves the root, too.
void ShiftedChain::setRootsByLink(const Motion& motion, const SampleShifts& shifts) {
  root_by_link_.place(motion, shifts.root_link);
  const RootMotion link = root_by_link_.linkOf(motion.root);
  for (std::size_t number = 0; number < plan_.root; ++number) {
    RootMotion shifted = link;
    shiftRoot(number, shifts.root[static_cast<Eigen::Index>(number)], shifted);
    setRoot(plan_.firstOfRoot() + number, root_by_link_.rootOf(shifted));
  }
  for (std::size_t level = 0; level < plan_.levels; ++level) {
    for (std::size_t i = 0; i < plan_.coordinates; ++i) {
      shifted_ = motion;
      shiftCoordinate(mechanism_, shifts, level, i, shifted_);
      root_by_link_.place(shifted_, shifts.root_link);
      setRoot(plan_.columnOf(level, i), root_by_link_.rootOf(link));
    }
  }
}

void ShiftedChain::setRoot(std::size_t sample, const RootMotion& root) {
  const RootState state = dynamics_.rootState(root);
  for (std::size_t c = 0; c < RootState::kNumbers; ++c)
    root_[c * samples_ + sample] = state.data()[c];
}

// Shifts of positions, of the attitude that is measured, against which wrenches may be given, and
// those of wrenches change the load.
void ShiftedChain::setLoads(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law) {
  if (loads_.front().wrenches.empty()) return;
  law(motion, loads_.front());
  const bool by_link = !root_.empty() && shifts.root_link != 0;
  if (by_link) root_by_link_.place(motion, shifts.root_link);
  const RootMotion measured = by_link ? root_by_link_.linkOf(motion.root) : motion.root;
  for (std::size_t sample = 1; sample < samples_; ++sample) {
    const bool of_position = sample <= plan_.coordinates;
    const std::size_t of_root = sample - plan_.firstOfRoot();
    const bool of_attitude = sample >= plan_.firstOfRoot() && of_root < plan_.root / 4;
    if (!of_position && !of_attitude) {
      loads_[sample] = loads_.front();
      continue;
    }
    shifted_ = motion;
    shifted_.root = measured;
    if (of_position) shiftCoordinate(mechanism_, shifts, 0, sample - 1, shifted_);
    if (of_attitude)
      shiftRoot(of_root, shifts.root[static_cast<Eigen::Index>(of_root)], shifted_.root);
    if (by_link) {
      root_by_link_.place(shifted_, shifts.root_link);
      shifted_.root = root_by_link_.rootOf(shifted_.root);
    }
    law(shifted_, loads_[sample]);
  }
  for (std::size_t i = 0; i < plan_.wrenches.size(); ++i) {
    for (std::size_t number = 0; number < 6; ++number) {
      Load& load = loads_[plan_.firstOfWrench(i) + number];
      numberOf(load.wrenches[plan_.wrenches[i]], number) +=
          shifts.wrenches[static_cast<Eigen::Index>(6 * i + number)];
    }
  }
}

ShiftedLoops::ShiftedLoops(const Mechanism& mechanism, const ClosedLoopDynamics& dynamics,
                           const ShiftPlan& plan, const Load& own,
                           const IndependentCoordinates& independent)
    : mechanism_(mechanism),
      dynamics_(dynamics),
      plan_(plan),
      independent_(independent),
      positions_first_(independent.positions != independent.rates),
      workspace_(dynamics.makeWorkspace()),
      numbers_(workspace_.results()),
      samples_(plan.columns()),
      shifted_(dynamics.coordinates(), mechanism.orientations()),
      load_(own),
      root_by_link_(mechanism),
      wrench_shifts_(6 * static_cast<Eigen::Index>(plan.wrenches.size())),
      values_(numbers_.all() * samples_),
      known_(numbers_.all()) {}

void ShiftedLoops::compute(const Motion& motion, const SampleShifts& shifts, const LoadLaw& law) {
  // The sample itself is completed, too: what it violates of the closures is not a shift.
  root_link_ = 0;
  wrench_shifts_ = shifts.wrenches;
  shifted_ = motion;
  bool complete = computeSample(0, law);
  if (complete) setLink(shifted_, shifts);
  markKnown(workspace_.results(), known_);
  complete = complete && computeCoordinates(motion, shifts, law);
  for (std::size_t number = 0; number < plan_.root && complete; ++number) {
    shifted_ = motion;
    const RootMotion link = link_;
    shiftRoot(number, shifts.root[static_cast<Eigen::Index>(number)],
              root_link_ == 0 ? shifted_.root : link_);
    complete = computeSample(plan_.firstOfRoot() + number, law);
    link_ = link;
  }
  for (std::size_t number = 0; number < 6 * plan_.wrenches.size() && complete; ++number) {
    shifted_ = motion;
    complete = computeSample(plan_.firstOfWrench(0) + number, law, static_cast<int>(number));
  }
  if (!complete) std::fill(known_.begin(), known_.end(), false);
}

bool ShiftedLoops::computeCoordinates(const Motion& motion, const SampleShifts& shifts,
                                      const LoadLaw& law) {
  for (std::size_t level = 0; level < plan_.levels; ++level) {
    for (std::size_t i = 0; i < plan_.coordinates; ++i) {
      if (!independent_.of(level)[i]) continue;
      shifted_ = motion;
      shiftCoordinate(mechanism_, shifts, level, i, shifted_);
      if (!computeSample(plan_.columnOf(level, i), law)) return false;
    }
  }
  return true;
}

// Sets whose motion tells how the root moves in all samples but the first, and how it moves.
void ShiftedLoops::setLink(const Motion& motion, const SampleShifts& shifts) {
  root_link_ = shifts.root_link;
  if (root_link_ == 0) return;
  root_by_link_.place(motion, root_link_);
  link_ = root_by_link_.linkOf(motion.root);
}

// Where more positions are independent than rates, the first completion closes the loops, whose
// rates it need not find, and the second leaves them so.
bool ShiftedLoops::complete() {
  if (positions_first_) dynamics_.complete(shifted_, independent_.positions, workspace_);
  return dynamics_.complete(shifted_, independent_.rates, workspace_);
}

// `shifted_wrench` counts the numbers of the plan's wrenches.
bool ShiftedLoops::computeSample(std::size_t sample, const LoadLaw& law, int shifted_wrench) {
  if (!complete()) return false;
  if (root_link_ != 0) {
    root_by_link_.place(shifted_, root_link_);
    shifted_.root = root_by_link_.rootOf(link_);
  }
  law(shifted_, load_);
  if (shifted_wrench >= 0) {
    const auto number = static_cast<std::size_t>(shifted_wrench);
    numberOf(load_.wrenches[plan_.wrenches[number / 6]], number % 6) +=
        wrench_shifts_[shifted_wrench];
  }
  dynamics_.compute(shifted_, load_, workspace_);
  forEachNumber(workspace_.results(), [&](std::size_t number, double value) {
    values_[number * samples_ + sample] = value;
  });
  return true;
}

}  // namespace virtual_work_dynamics
