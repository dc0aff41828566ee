#include "loops/forces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "loops/condition_sizes.h"

namespace virtual_work_dynamics {

namespace {

// Largest part of the load along a free motion that counts as rounding, relative to the whole load.
constexpr double kBorne = 1e-9;
// Entry of a free motion, a unit vector, below which its coordinate does not take part in it.
constexpr double kTakesPart = 1e-6;
// Largest effort in a change, a unit vector, that counts as rounding.
constexpr double kNoEffort = 1e-10;
// A component is determined when no unit vector of change alters it by more.
constexpr double kOpen = 1e-8;

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

// Most rows of costs: one for each unknown, or six for each reaction.
Eigen::Index mostCosts(const LoopGroup& group, Eigen::Index unknowns) {
  return std::max(unknowns, index(6 * (group.closures.size() + group.joints.size())));
}

// How many joints the wrenches of all closures pass through, each counted anew.
Eigen::Index passages(const LoopGroup& group) {
  std::size_t count = 0;
  for (const LoopGroup::CrossedJoint& crossed : group.joints) {
    if (crossed.moves) count += crossed.passages.size();
  }
  return index(count);
}

Eigen::VectorXd sizesOf(const Mechanism& mechanism, const LoopKinematics& kinematics,
                        const LoopGroup& group, const LoopUnknowns& unknowns, double length,
                        double rank_tolerance) {
  const ConditionSizes sizes(mechanism, kinematics, group, length, rank_tolerance);
  Eigen::VectorXd by_unknown(unknowns.count);
  for (std::size_t j = 0; j < unknowns.effort_rows.size(); ++j) {
    const std::size_t row = static_cast<std::size_t>(unknowns.effort_rows[j]);
    by_unknown[index(j)] = unknowns.efforts[j].unit / unknowns.row_units[row];
  }
  for (std::size_t local = 0; local < unknowns.of_sets.size(); ++local) {
    const LoopUnknowns::OfSet& own = unknowns.of_sets[local];
    for (std::size_t j = 0; j < own.columns.size(); ++j) {
      const LoopUnknowns::Column& column = own.columns[j];
      const Unit unit = column.condition >= 0 ? kinematics.condition(column.condition).unit
                                              : kinematics.closure(own.set).freeUnit();
      by_unknown[own.first + index(j)] =
          sizes.ofRow(local, unit) * column.unit / effortScaleOf(unit, length);
    }
  }
  return by_unknown;
}

}  // namespace

LoopForces::LoopForces(const Mechanism& mechanism, const LoopKinematics& kinematics,
                       const LoopScene& scene, const LoopGroup& group, double length)
    : kinematics_(kinematics),
      group_(group),
      unknowns_(mechanism, kinematics, scene, group, length),
      rank_tolerance_(scene.rank_tolerance),
      length_(length),
      qr_(unknowns_.rowBlocks(mechanism, kinematics), static_cast<int>(group.coordinates.size())),
      rank_(sizesOf(mechanism, kinematics, group, unknowns_, length, rank_tolerance_),
            qr_.columns(), rank_tolerance_),
      all_(group.coordinates.size(), true),
      efforts_follow_(qr_.layout().filledRows() == group.coordinates.size()),
      norms_(unknowns(), mostCosts(group, unknowns())),
      load_(coordinates()),
      gathered_(scene.start.size()),
      kernel_(&loopKernelFor(chosenInstructionSet()).one),
      directions_(unknowns(), unknowns() + coordinates() + passages(group)) {
  turns_.reserve(static_cast<std::size_t>(passages(group)));
  addCosts(scene);
  for (std::size_t j = 0; j < unknowns_.effort_rows.size(); ++j) {
    const std::size_t row = static_cast<std::size_t>(unknowns_.effort_rows[j]);
    qr_.entriesOf(j)(0, 0) = unknowns_.efforts[j].unit / unknowns_.row_units[row];
  }
  for (const LoopUnknowns::OfSet& own : unknowns_.of_sets) {
    Entries entries;
    for (std::size_t k = 0; k < own.coordinates.size(); ++k) {
      const std::size_t row = static_cast<std::size_t>(own.coordinates[k]);
      entries.columns.push_back(
          {group_.coordinates[row], static_cast<int>(k), 1 / unknowns_.row_units[row]});
    }
    for (const LoopUnknowns::Column& column : own.columns) entries.units.push_back(column.unit);
    entries_.push_back(std::move(entries));
  }
  for (State* state : {&solution_, &change_}) {
    state->x.setZero(unknowns());
    state->closures.resize(group_.closures.size());
    touchAll(*state);
  }
}

void LoopForces::addCosts(const LoopScene& scene) {
  for (const std::size_t c : group_.closures) {
    const double factor = scene.policy == RedundancyPolicy::kStiffness
                              ? 1 / std::sqrt(scene.closure_stiffness[c])
                              : scene.policy == RedundancyPolicy::kZeroAt && scene.zero_at[c];
    closure_costs_.push_back(factor);
    if (factor > 0) cost_rows_ += 6;
  }
  for (const LoopGroup::CrossedJoint& crossed : group_.joints) {
    const double factor =
        scene.policy == RedundancyPolicy::kStiffness && crossed.moves
            ? 1 / std::sqrt(scene.joint_stiffness[static_cast<std::size_t>(crossed.joint)])
            : 0;
    joint_costs_.push_back(factor);
    if (factor > 0) cost_rows_ += 6;
  }
  // Only ratios of the factors matter: the largest becomes one, as costs are compared with unit
  // vectors.
  double largest = 0;
  for (const double factor : closure_costs_) largest = std::max(largest, factor);
  for (const double factor : joint_costs_) largest = std::max(largest, factor);
  for (double& factor : closure_costs_) factor /= largest > 0 ? largest : 1;
  for (double& factor : joint_costs_) factor /= largest > 0 ? largest : 1;
}

// The generalized force of a unit multiplier is its row of the conditions' Jacobian.
void LoopForces::setEntries() {
  for (std::size_t local = 0; local < unknowns_.of_sets.size(); ++local) {
    const LoopUnknowns::OfSet& own = unknowns_.of_sets[local];
    const Entries& scaled = entries_[local];
    Eigen::MatrixXd& entries = qr_.entriesOf(unknowns_.effort_rows.size() + local);
    kernel_->scaleColumns(kinematics_.rowsOf(own.set),  // (3.1), a_ik
                          {scaled.columns.data(), static_cast<int>(scaled.columns.size()),
                           static_cast<int>(entries.rows())},
                          scaled.units.data(), kinematics_.entriesOf(own.set), entries.data());
    if (own.effort < 0) continue;
    gatherForce(own, kinematics_.unitEffort(own.set));
    for (const ScaledColumn& column : scaled.columns) {
      entries(own.multipliers(), column.place) =
          own.columns.back().unit * gathered_[column.coordinate] * column.factor;
    }
  }
}

void LoopForces::gatherForce(const LoopUnknowns::OfSet& own, const ClosureWrench& wrench) {
  for (const int row : own.coordinates) gathered_[group_.coordinates[std::size_t(row)]] = 0;
  kinematics_.addGeneralizedForce(own.set, wrench, gathered_);
}

void LoopForces::setPosition() {
  setEntries();
  sound_ = qr_.factorize(MultifrontalQr::sureCondition(rank_tolerance_), rank_.largestSize());
  if (!sound_) rank_.decide(qr_, all_);
}

double LoopForces::gap() const {
  return sound_ ? std::numeric_limits<double>::infinity() : rank_.gap();
}

double LoopForces::condition() const {
  const double whole = qr_.condition();
  return rank() == coordinates() && std::isfinite(whole) ? whole : rank_.condition();
}

bool LoopForces::isFree(Eigen::Index local) const {
  return partInFreeMotions(local) > kTakesPart;
}

double LoopForces::partInFreeMotions(Eigen::Index local) const {
  return rank() < coordinates() ? rank_.freeMotions().row(local).norm() : 0;
}

void LoopForces::solve(const Eigen::VectorXd& tree_effort,
                       const std::vector<Wrench>& tree_reactions) {
  for (Eigen::Index row = 0; row < coordinates(); ++row) {
    load_[row] =
        tree_effort[group_.coordinates[std::size_t(row)]] / unknowns_.row_units[std::size_t(row)];
  }
  bearLoad();
  turns_.clear();
  change_.shift.setZero();
  if (sound_) {
    qr_.leastNorm(load_.data(), solution_.x.data());
    direction_count_ = index(qr_.nullity());
  } else {
    direction_count_ = rank_.changes();
    rank_.getChanges(directions_.leftCols(direction_count_));
    solveWhole(solution_.x);
  }
  choose(tree_reactions);
  setClosures(solution_);
  if (bears_) return;
  addOpenLoads();
  addTurns();
}

// Removes from the load what points along a free motion, which nothing bears.
void LoopForces::bearLoad() {
  bears_ = true;
  if (rank() == coordinates()) return;
  const double load = load_.norm();
  for (Eigen::Index j = 0; j < coordinates() - rank(); ++j) {
    const auto motion = rank_.freeMotions().col(j);
    const double along = motion.dot(load_);
    load_ -= along * motion;
    if (!(std::abs(along) <= kBorne * load)) bears_ = false;
  }
}

// Solves for the x of least norm, once the directions of changes are set.
void LoopForces::solveWhole(Eigen::Ref<Eigen::VectorXd> x) const {
  rank_.solveLoad(load_, x);
  for (Eigen::Index j = 0; j < rank_.changes(); ++j) {
    x -= directions_.col(j).dot(x) * directions_.col(j);
  }
}

bool LoopForces::isDetermined(Eigen::Index unknown) {
  if (!bears_) return false;
  if (sound_) return qr_.nullity() == 0 || isUnique(qr_.nullSquare(unknown));
  for (Eigen::Index j = 0; j < direction_count_; ++j) {
    if (!(std::abs(directions_(unknown, j)) <= kNoEffort)) return false;
  }
  return true;
}

bool LoopForces::isUnique(double null_square) {
  return null_square <= kLargestUnique;
}

// Whether efforts are the same in all solutions, as nothing in the null space moves them.
bool LoopForces::effortsAreUnique() {
  const auto unique = [&](const LoopUnknowns::Effort& effort) {
    return isUnique(qr_.nullSquare(effort.unknown));
  };
  return std::all_of(unknowns_.efforts.begin(), unknowns_.efforts.end(), unique);
}

// Starts with the open directions that the criteria of choose() can tell apart.
void LoopForces::startNorms() {
  if (!sound_) return norms_.start(directions_.leftCols(direction_count_));
  if (cost_rows_ == 0 && effortsAreUnique()) return norms_.start(directions_.leftCols(0));
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < direction_count_; ++i) {
    const State& change = direction(i);
    const auto moves = [&](std::size_t effort) {
      return std::abs(change.x[unknowns_.efforts[effort].unknown]) > kNoEffort;
    };
    if (cost_rows_ > 0 ||
        std::any_of(change.touched_efforts.begin(), change.touched_efforts.end(), moves)) {
      directions_.col(count++) = change.x;
    }
  }
  norms_.start(directions_.leftCols(count));
}

void LoopForces::putCosts(const State& state, const std::vector<Wrench>* tree_reactions,
                          Eigen::Ref<Eigen::VectorXd> costs) const {
  Eigen::Index row = 0;
  const auto put = [&](const ClosureWrench& wrench, double factor) {
    costs.segment<3>(row) = factor * wrench.force;
    costs.segment<3>(row + 3) = factor / length_ * wrench.moment;
    row += 6;
  };
  for (std::size_t c = 0; c < closure_costs_.size(); ++c) {
    if (closure_costs_[c] > 0) put(state.closures[c], closure_costs_[c]);
  }
  for (std::size_t k = 0; k < joint_costs_.size(); ++k) {
    if (joint_costs_[k] == 0) continue;
    ClosureWrench wrench = jointWrench(group_.joints[k], state);
    if (tree_reactions) {
      const Wrench& own = (*tree_reactions)[static_cast<std::size_t>(group_.joints[k].joint)];
      wrench.force += own.force;
      wrench.moment += own.torque;
    }
    put(wrench, joint_costs_[k]);
  }
}

double LoopForces::leastChange() const {
  const double steps = static_cast<double>(coordinates() + unknowns());
  return std::max(kOpen, steps * std::numeric_limits<double>::epsilon() * condition());
}

const LoopForces::State& LoopForces::direction(Eigen::Index i) {
  if (!sound_) {
    change_.x = directions_.col(i);
    touchAll(change_);
    setClosures(change_);
    const Eigen::Index turns = index(turns_.size());
    change_.shift.setZero();
    if (i >= direction_count_ - turns) {
      const Turn& turn = turns_[static_cast<std::size_t>(i - direction_count_ + turns)];
      change_.closures[turn.local].force += turn.wrench.force;
      change_.closures[turn.local].moment += turn.wrench.moment;
      change_.shifted = turn.local;
      change_.shift = turn.shift;
    }
    return change_;
  }
  for (const std::size_t effort : change_.touched_efforts) {
    change_.x[unknowns_.efforts[effort].unknown] = 0;
  }
  const auto clear = [&](std::size_t local) {
    const LoopUnknowns::OfSet& own = unknowns_.of_sets[local];
    change_.x.segment(own.first, index(own.columns.size())).setZero();
  };
  for (const std::size_t local : change_.touched_closures) {
    clear(local);
    change_.closures[local] = {};
  }
  for (const std::size_t local : change_.touched_others) clear(local);
  qr_.nullVector(static_cast<std::size_t>(i), change_.x);
  change_.touched_efforts.clear();
  change_.touched_closures.clear();
  change_.touched_others.clear();
  for (const std::size_t block : qr_.touched()) {
    if (block < unknowns_.effort_rows.size()) {
      change_.touched_efforts.push_back(block);
      continue;
    }
    const std::size_t local = block - unknowns_.effort_rows.size();
    const int effort = unknowns_.of_sets[local].effort;
    (isClosure(local) ? change_.touched_closures : change_.touched_others).push_back(local);
    if (effort >= 0) change_.touched_efforts.push_back(static_cast<std::size_t>(effort));
  }
  setClosures(change_);
  return change_;
}

void LoopForces::touchAll(State& state) const {
  state.touched_efforts.resize(efforts().size());
  std::iota(state.touched_efforts.begin(), state.touched_efforts.end(), 0);
  state.touched_closures.resize(group_.closures.size());
  std::iota(state.touched_closures.begin(), state.touched_closures.end(), 0);
  state.touched_others.resize(group_.sets.size() - group_.closures.size());
  std::iota(state.touched_others.begin(), state.touched_others.end(), group_.closures.size());
}

void LoopForces::setClosures(State& state) const {
  for (const std::size_t local : state.touched_closures) {
    const LoopUnknowns::OfSet& own = unknowns_.of_sets[local];
    const double* x = state.x.data() + own.first;
    ClosureWrench& sum = state.closures[local];
    kernel_->sumWrenches(kinematics_.closure(own.set).shape(), entries_[local].units.data(), x,
                         kinematics_.unitWrenches(kinematics_.firstOf(own.set)), sum.force.data());
    if (own.effort < 0) continue;
    const double effort = x[own.multipliers()] * own.columns.back().unit;
    activePart(kinematics_.closure(own.set).freeUnit(), sum) +=
        effort * kinematics_.freeAxis(own.set);
  }
  if (!kinematics_.meshing().empty()) setTeeth(state);
}

ClosureWrench LoopForces::jointWrench(const LoopGroup::CrossedJoint& crossed,
                                      const State& state) const {
  ClosureWrench sum;
  const Eigen::Vector3d& origin = kinematics_.originOf(crossed.joint + 1);
  for (const LoopGroup::Passage& passage : crossed.passages) {
    kinematics_.addRelief(group_.closures[passage.closure], passage.sign,
                          state.closures[passage.closure], origin, sum);
    if (passage.closure == state.shifted) sum.moment -= passage.sign * state.shift;
  }
  return sum;
}

}  // namespace virtual_work_dynamics
