#include "loops/sample_pack.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

namespace {

constexpr std::size_t kResiduals = 3;  // of a closure

std::size_t blockNumbers(const MultifrontalQr& qr, std::size_t block) {
  return static_cast<std::size_t>(qr.entriesOf(block).size());
}

// Calls take(count) for each array of a group, in the order of SamplePack::Group.
template <typename Take>
void visitArrays(const MultifrontalQr& qr, std::size_t null_squares, bool chooses, Take take) {
  for (std::size_t b = 0; b < qr.blocks(); ++b) take(blockNumbers(qr, b));
  take(qr.layout().numbers());
  take(static_cast<std::size_t>(qr.columns()));
  take(qr.layout().rows());
  take(1);
  take(std::max<std::size_t>(null_squares, 1));
  take(chooses ? static_cast<std::size_t>(qr.rows()) : 0);
  take(1);
}

}  // namespace

void LoopForces::takeSample(const PackedSolution& packed, bool whole) {
  const auto number = [&](const double* from, Eigen::Index i) {
    return from[static_cast<std::size_t>(i) * packed.width + packed.sample];
  };
  for (Eigen::Index i = 0; i < unknowns(); ++i) solution_.x[i] = number(packed.x, i);
  for (std::size_t c = 0; c < solution_.closures.size(); ++c) {
    const auto first = static_cast<Eigen::Index>(kWrenchNumbers * group_.closures[c]);
    ClosureWrench& wrench = solution_.closures[c];
    for (int i = 0; i < 3; ++i) wrench.force[i] = number(packed.closures, first + i);
    for (int i = 0; i < 3; ++i) wrench.moment[i] = number(packed.closures, first + 3 + i);
  }
  qr_.take(packed.numbers, packed.states, packed.stairs, number(packed.condition, 0), packed.width,
           packed.sample, whole);
  sound_ = bears_ = true;
  turns_.clear();
  change_.shift.setZero();
  direction_count_ = static_cast<Eigen::Index>(qr_.nullity());
  redundant_constraints_ = packed.chosen ? 0 : direction_count_;
}

bool SamplePack::serves(const ClosedLoopDynamics::Impl& plan) {
  return plan.closures > 0 && plan.springs.size() == 0 && plan.actuated_closures.empty() &&
         !plan.weighed_pass && plan.loops.policy == RedundancyPolicy::kMinimumNorm &&
         plan.kinematics.sets() == plan.closures && plan.kinematics.conditions() > 0 &&
         !plan.kinematics.drives() && plan.mechanism.orientations() == 0 &&
         !plan.request.can_hold && !plan.request.intervals;
}

SamplePack::SamplePack(const ClosedLoopDynamics::Impl& plan, const LoopSolvers& solvers)
    : plan_(plan),
      solvers_(solvers),
      loops_(loopKernelFor(chosenInstructionSet()).pack),
      fronts_(frontKernelFor(chosenInstructionSet()).pack),
      width_(static_cast<std::size_t>(loopKernelFor(chosenInstructionSet()).width)),
      coordinates_(static_cast<std::size_t>(plan.assembly.size())),
      conditions_(static_cast<std::size_t>(solvers.kinematics.conditions())),
      links_(plan.mechanism.links().size()),
      record_{coordinates_,
              2 * kWrenchNumbers * plan.closures,
              plan.request.residuals ? kResiduals * plan.closures : 0,
              plan.request.residuals ? kResiduals * plan.closures : 0,
              solvers.forces.size(),
              plan.holds.items().size(),
              solvers.forces.size(),
              kWrenchNumbers * plan.child_axes->size(),
              kWrenchNumbers * plan.root_axes->size()},
      memory_([&] {
        const LinksView view = solvers.kinematics.links().view();
        std::size_t count = 4 * coordinates_ + kLinkNumbers * links_ +
                            2 * static_cast<std::size_t>(view.angle_count + kMostAngleLanes) +
                            conditions_ * (5 + coordinates_ + kWrenchNumbers) +
                            plan.holds.items().size() +
                            plan.closures * (kFrameNumbers + kWrenchNumbers + 2 * kResiduals);
        for (std::size_t g = 0; g < solvers.forces.size(); ++g) {
          visitArrays(solvers.forces[g].factorization(), groupOf(g).unknowns.size(),
                      choosesAlong(solvers.forces[g]), [&](std::size_t size) { count += size; });
        }
        return count * width_ * sizeof(double);
      }()),
      computed_(width_, false) {
  std::size_t next = 0;
  const auto deal = [&](std::size_t count) {
    double* const here = numbers(next);
    next += count;
    return here;
  };
  const LinksView view = solvers.kinematics.links().view();
  for (double** array : {&q_, &qd_, &qdd_, &efforts_}) *array = deal(coordinates_);
  angles_ = deal(2 * static_cast<std::size_t>(view.angle_count + kMostAngleLanes));
  link_numbers_ = deal(kLinkNumbers * links_);
  for (std::size_t i = 0; i < 9; i += 4) {  // the root's axes
    std::fill_n(link_numbers_ + (kLinkR + i) * width_, width_, 1.0);
  }
  for (double** array : {&phi_, &turning_, &rates_, &accelerations_}) *array = deal(conditions_);
  A_ = deal(conditions_ * coordinates_);
  wrenches_ = deal(kWrenchNumbers * conditions_);
  frames_ = deal(kFrameNumbers * plan.closures);
  residuals_ = deal(2 * kResiduals * plan.closures);
  closures_ = deal(kWrenchNumbers * plan.closures);
  roundings_ = deal(conditions_);
  holds_ = deal(plan.holds.items().size());
  for (std::size_t g = 0; g < solvers.forces.size(); ++g) {
    const LoopForces& forces = solvers.forces[g];
    const MultifrontalQr& qr = forces.factorization();
    Group group = groupOf(g);
    std::vector<double*> arrays;
    visitArrays(qr, group.unknowns.size(), choosesAlong(forces),
                [&](std::size_t size) { arrays.push_back(deal(size)); });
    const std::size_t blocks = qr.blocks();
    group.entries.assign(arrays.begin(), arrays.begin() + static_cast<std::ptrdiff_t>(blocks));
    group.entries_read.assign(group.entries.begin(), group.entries.end());
    group.numbers = arrays[blocks];
    group.load = arrays[blocks + 1];
    group.x = arrays[blocks + 2];
    group.condition = arrays[blocks + 3];
    group.null_square = arrays[blocks + 4];
    group.null_vector = choosesAlong(forces) ? arrays[blocks + 5] : nullptr;
    group.chosen = arrays[blocks + 6];
    group.reached.resize(qr.layout().fronts().size());
    group.states.resize(qr.layout().fronts().size());
    group.stairs.resize(qr.layout().stairs());
    for (std::size_t b = 0; b < forces.effortBlocks(); ++b) {  // these never change
      std::fill_n(group.entries[b], width_, qr.entriesOf(b)(0, 0));
    }
    groups_.push_back(std::move(group));
  }
}

// A group without its arrays.
SamplePack::Group SamplePack::groupOf(std::size_t index) const {
  const LoopForces& forces = solvers_.forces[index];
  Group group{};
  if (!forces.effortsFollow()) {
    for (const LoopUnknowns::Effort& effort : forces.efforts()) {
      group.unknowns.push_back(effort.unknown);
    }
  }
  group.efforts = group.unknowns.size();
  const bool open = forces.factorization().nullity() > 0;
  const std::vector<LoopHolds::Item>& items = plan_.holds.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].group != index || items[i].acting < 0) continue;
    group.items.push_back(i);
    const Eigen::Index first = forces.firstUnknownOf(items[i].local);
    for (int j = items[i].along_begin; open && j < items[i].along_end; ++j) {
      group.unknowns.push_back(first + j);
    }
    if (open) group.unknowns.push_back(first + items[i].acting);
  }
  return group;
}

void SamplePack::setMotion(const double* q, const double* qd, const double* qdd,
                           std::size_t stride) {
  const auto copy = [&](const double* from, double* to) {
    for (std::size_t i = 0; i < coordinates_; ++i) {
      std::copy_n(from + i * stride, width_, to + i * width_);
    }
  };
  copy(q, q_);
  if (plan_.static_motion || !(plan_.moves || plan_.request.residuals)) return;
  copy(qd, qd_);
  copy(qdd, qdd_);
}

void SamplePack::setEfforts(const TreeNumbers& tree) {
  for (std::size_t i = 0; i < coordinates_; ++i) {
    std::copy_n(tree.effort + i * tree.stride, width_, efforts_ + i * width_);
  }
}

void SamplePack::setEfforts(std::size_t sample, const Eigen::VectorXd& tree_effort) {
  for (std::size_t i = 0; i < coordinates_; ++i) {
    efforts_[i * width_ + sample] = tree_effort[static_cast<Eigen::Index>(i)];
  }
}

void SamplePack::compute() {
  std::fill(computed_.begin(), computed_.end(), true);
  place();
  if (plan_.moves || plan_.request.residuals) {
    loops_.moveLinks(solvers_.kinematics.links().view(), qd_, link_numbers_);
  }
  if (plan_.request.residuals) findResiduals();
  for (std::size_t g = 0; g < groups_.size(); ++g) solve(solvers_.forces[g], groups_[g]);
}

ClosureNumbers SamplePack::numbersOf(std::size_t closure) const {
  const std::size_t first = static_cast<std::size_t>(solvers_.kinematics.firstOf(closure)) * width_;
  return {phi_ + first,
          A_ + first,
          conditions_,
          wrenches_ + kWrenchNumbers * first,
          frames_ + kFrameNumbers * closure * width_,
          turning_ + first};
}

// Poses of links, and conditions.
void SamplePack::place() {
  const LoopKinematics& kinematics = solvers_.kinematics;
  loops_.placeLinks(kinematics.links().view(), q_, angles_, link_numbers_);
  for (std::size_t c = 0; c < plan_.closures; ++c) {
    loops_.placeClosure(kinematics.closure(c).shape(), link_numbers_, numbersOf(c));
  }
}

// Velocities and accelerations of conditions, and how far these are violated.
void SamplePack::findResiduals() {
  const LoopKinematics& kinematics = solvers_.kinematics;
  std::fill_n(rates_, conditions_ * width_, 0.0);
  for (std::size_t c = 0; c < plan_.closures; ++c) {
    const RowsShape& rows = kinematics.rowsOf(c);
    const std::size_t first = static_cast<std::size_t>(kinematics.firstOf(c)) * width_;
    loops_.moveClosure(kinematics.closure(c).shape(), link_numbers_, numbersOf(c));
    std::copy_n(turning_ + first, static_cast<std::size_t>(rows.rows) * width_,
                accelerations_ + first);
    loops_.addMotion(rows, A_ + first, qd_, qdd_, rates_ + first, accelerations_ + first);
  }
  subtractConstants();
  loops_.residuals(
      solvers_.residuals.view(),
      {{phi_, rates_, accelerations_}, qd_, qdd_, residuals_, residuals_ + record_.plain * width_});
}

// See LoopKinematics::setPosition().
void SamplePack::subtractConstants() {
  const LoopKinematics& kinematics = solvers_.kinematics;
  for (const std::size_t c : kinematics.meshing()) {
    const std::size_t first = static_cast<std::size_t>(kinematics.firstOf(c)) * width_;
    loops_.sumTurns(*kinematics.closure(c).shape().teeth, q_, phi_ + first, roundings_ + first);
  }
  for (std::size_t i = 0; i < kinematics.adopting(); ++i) {
    const LoopKinematics::Adopted adopted = kinematics.adopted(i);
    const std::size_t first = static_cast<std::size_t>(adopted.condition) * width_;
    for (std::size_t j = first; j < first + width_; ++j) {
      phi_[j] -= adopted.constant;
      if (std::abs(phi_[j]) <= roundings_[j]) phi_[j] = 0;
    }
  }
}

void SamplePack::solve(const LoopForces& forces, Group& group) {
  const MultifrontalQr& qr = forces.factorization();
  const LoopKinematics& kinematics = solvers_.kinematics;
  for (std::size_t local = 0; local < forces.group().sets.size(); ++local) {
    const std::size_t set = forces.group().sets[local];
    const std::size_t first = static_cast<std::size_t>(kinematics.firstOf(set)) * width_;
    const std::size_t block = forces.effortBlocks() + local;
    loops_.scaleColumns(kinematics.rowsOf(set), forces.columnsOf(local), forces.unitsOf(local),
                        A_ + first, group.entries[block]);
  }
  const FrontsView& view = qr.layout().view();
  const FrontsMemory memory{group.numbers, group.states.data(), group.stairs.data()};
  const Factorized done = fronts_.factorize(view, group.entries_read.data(), forces.largestSize(),
                                            memory, group.condition);
  if (done != Factorized::kWhole) {
    std::fill(computed_.begin(), computed_.end(), false);
    return;
  }
  const std::vector<int>& coordinates = forces.group().coordinates;
  for (std::size_t row = 0; row < coordinates.size(); ++row) {
    const double* const effort = efforts_ + static_cast<std::size_t>(coordinates[row]) * width_;
    const double unit = forces.rowUnit(row);
    for (std::size_t j = 0; j < width_; ++j) group.load[row * width_ + j] = effort[j] / unit;
  }
  fronts_.leastNorm(view, memory, group.load, group.x);
  for (std::size_t i = 0; i < group.unknowns.size(); ++i) {
    const FrontLayout::RowPlace& place =
        qr.layout().placeOf(static_cast<std::size_t>(group.unknowns[i]));
    fronts_.nullSquare(view, memory, place.front, place.row, group.null_square + i * width_);
  }
  judge(forces, group);
  if (group.null_vector) chooseEfforts(forces, memory, group);
  judgeHolds(forces, group);
  sumWrenches(forces, group);
}

void SamplePack::sumWrenches(const LoopForces& forces, const Group& group) {
  const LoopKinematics& kinematics = solvers_.kinematics;
  for (std::size_t c = 0; c < forces.group().closures.size(); ++c) {
    const std::size_t closure = forces.group().closures[c];
    const ClosureShape& shape = kinematics.closure(closure).shape();
    const std::size_t first = static_cast<std::size_t>(kinematics.firstOf(closure)) * width_;
    const double* const x = group.x + static_cast<std::size_t>(forces.firstUnknownOf(c)) * width_;
    double* const sum = closures_ + kWrenchNumbers * closure * width_;
    loops_.sumWrenches(shape, forces.unitsOf(c), x, wrenches_ + kWrenchNumbers * first, sum);
    if (!shape.teeth) continue;
    loops_.takeFlank(shape, forces.unitsOf(c), x, x, frames_ + kFrameNumbers * closure * width_,
                     sum);
  }
}

// What ClosedLoopDynamics::Workspace::Impl::collect() sets.
void SamplePack::reportEfforts(const TreeNumbers& tree, double* to) const {
  for (std::size_t i = 0; i < coordinates_; ++i) {
    if (plan_.loops.actuated[i]) {
      std::copy_n(tree.effort + i * tree.stride, width_, to + i * width_);
    } else {
      std::fill_n(to + i * width_, width_, 0.0);
    }
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    for (const LoopUnknowns::Effort& effort : solvers_.forces[g].efforts()) {
      const double* const x = groups_[g].x + static_cast<std::size_t>(effort.unknown) * width_;
      for (std::size_t j = 0; j < width_; ++j) to[effort.index * width_ + j] = effort.unit * x[j];
    }
  }
}

void SamplePack::report(const TreeNumbers& tree, double* records) const {
  double* next = records;
  const auto deal = [&](std::size_t count) {
    double* const here = next;
    next += count * width_;
    return here;
  };
  reportEfforts(tree, deal(record_.efforts));
  double* const loads = deal(record_.loads);
  loops_.closureLoads(static_cast<int>(plan_.closures), frames_, closures_, loads);
  for (const std::size_t c : solvers_.kinematics.touching()) {  // they act at points of the links
    loops_.referToChild(solvers_.kinematics.closure(c).shape(), link_numbers_,
                        frames_ + kFrameNumbers * c * width_,
                        loads + 2 * kWrenchNumbers * c * width_);
  }
  const std::size_t residuals = record_.plain + record_.relative;
  std::copy_n(residuals_, residuals * width_, deal(residuals));
  for (const Group& group : groups_) std::copy_n(group.condition, width_, deal(1));
  std::copy_n(holds_, record_.holds * width_, deal(record_.holds));
  for (const Group& group : groups_) std::copy_n(group.chosen, width_, deal(1));
  loops_.reactions(plan_.child_axes->view(), {link_numbers_, frames_, closures_, tree.child_axes,
                                              tree.stride, deal(record_.child_axes)});
  loops_.reactions(plan_.root_axes->view(), {link_numbers_, frames_, closures_, tree.root_axes,
                                             tree.stride, deal(record_.root_axes)});
}

void SamplePack::take(std::size_t sample, bool whole, LoopSolvers& solvers,
                      LoopResults& results) const {
  solvers.kinematics.takeSample({link_numbers_, wrenches_, frames_, width_, sample}, whole);
  if (plan_.request.residuals) takeResiduals(sample, results);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    solvers.forces[g].takeSample(
        {group.x, closures_, group.condition, group.numbers, group.states.data(),
         group.stairs.data(), width_, sample, group.chosen[sample] > 0},
        whole);
  }
}

void SamplePack::takeResiduals(std::size_t sample, LoopResults& results) const {
  const double* const relative = residuals_ + record_.plain * width_;
  const auto takeFrom = [&](const double* from, std::vector<ClosureResidual>& to) {
    double* numbers = &to.front().position;
    for (std::size_t i = 0; i < kResiduals * to.size(); ++i) numbers[i] = from[i * width_ + sample];
  };
  takeFrom(residuals_, results.residuals);
  takeFrom(relative, results.relative_residuals);
}

}  // namespace virtual_work_dynamics
