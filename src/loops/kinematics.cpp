#include "loops/kinematics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace virtual_work_dynamics {

namespace {

Eigen::Index countOf(const ConditionSets& sets) {
  std::size_t count = 0;
  for (const auto& set : sets) count += set->conditions().size();
  return static_cast<Eigen::Index>(count);
}

}  // namespace

LoopKinematics::LoopKinematics(const Mechanism& mechanism, const Scene& scene)
    : LoopKinematics(mechanism, makeConditions(mechanism, scene)) {}

LoopKinematics::LoopKinematics(const Mechanism& mechanism, ConditionSets sets)
    : kernel_(&loopKernelFor(chosenInstructionSet()).one),
      sets_(std::move(sets)),
      bends_(mechanism.coordinates().size(), false),
      state_(mechanism),
      values_(countOf(sets_), static_cast<Eigen::Index>(mechanism.coordinates().size()),
              sets_.size()),
      rates_(values_.phi),
      accelerations_(values_.phi) {
  for (const auto& set : sets_) {
    if (const auto* closure = dynamic_cast<const ClosureConditions*>(set.get())) {
      if (closure->traits().touches()) touching_.push_back(closures_.size());
      if (closure->traits().meshes()) meshing_.push_back(closures_.size());
      closures_.push_back(closure);
    }
    first_.push_back(static_cast<Eigen::Index>(conditions_.size()));
    const std::vector<int>& coordinates = set->coordinates();
    rows_.push_back({coordinates.data(), static_cast<int>(coordinates.size()),
                     static_cast<int>(set->conditions().size()),
                     static_cast<std::size_t>(values_.A.rows())});
    for (const int i : coordinates) {
      if (!set->isLinear()) bends_[static_cast<std::size_t>(i)] = true;
    }
    lengths_.push_back(0);
    for (const Condition& condition : set->conditions()) {
      if (condition.adopts_constant) {
        adopting_.push_back(static_cast<Eigen::Index>(conditions_.size()));
      }
      drives_ = drives_ || condition.drives;
      if (condition.unit == Unit::kMetre) ++lengths_.back();
      conditions_.push_back(&condition);
    }
  }
  first_.push_back(conditions());
  constants_.setZero(static_cast<Eigen::Index>(adopting_.size()));
}

LoopKinematics::Norms LoopKinematics::normsOf(std::size_t set,
                                              const Eigen::VectorXd& conditions) const {
  double lengths = 0, directions = 0;
  for (Eigen::Index i = firstOf(set); i < firstOf(set + 1); ++i) {
    (condition(i).unit == Unit::kRadian ? directions : lengths) += conditions[i] * conditions[i];
  }
  return {std::sqrt(lengths), std::sqrt(directions)};
}

double LoopKinematics::largestBent(const Eigen::VectorXd& way,
                                   const std::vector<double>& scales) const {
  double most = 0;
  for (std::size_t i = 0; i < bends_.size(); ++i) {
    if (bends_[i]) most = std::max(most, std::abs(way[static_cast<Eigen::Index>(i)]) / scales[i]);
  }
  return most;
}

void LoopKinematics::setPosition(const Eigen::VectorXd& q) {
  if (placed_ && state_.q == q) return;
  placed_ = true;
  moving_ = false;
  state_.q = q;
  state_.links.setPosition(q);
  for (std::size_t s = 0; s < sets_.size(); ++s) sets_[s]->setPosition(state_, valuesOf(s));
  if (!adopting_.empty()) subtractConstants();
}

void LoopKinematics::subtractConstants() {
  for (std::size_t j = 0; j < adopting_.size(); ++j) {
    const Eigen::Index i = adopting_[j];
    double& constant = constants_[static_cast<Eigen::Index>(j)];
    if (adopted_) {
      values_.phi[i] -= constant;
      if (std::abs(values_.phi[i]) <= values_.roundings[i]) values_.phi[i] = 0;
      continue;
    }
    constant = values_.phi[i];
    values_.phi[i] = 0;
    values_.A.row(i).setZero();
  }
}

void LoopKinematics::takeSample(const PackedSample& packed, bool whole) {
  placed_ = false;  // neither q nor the Jacobian are taken
  const auto take = [&](const double* from, std::size_t count, double* to) {
    for (std::size_t i = 0; i < count; ++i) to[i] = from[i * packed.width + packed.sample];
  };
  take(packed.frames, kFrameNumbers * closures_.size(), values_.frames.front().R_P.data());
  if (!whole) return;
  take(packed.links, kLinkNumbers * state_.links.count(), state_.links.numbers());
  take(packed.wrenches, kWrenchNumbers * values_.unit_wrenches.size(),
       values_.unit_wrenches.front().force.data());
}

void LoopKinematics::adoptConstants() {
  adopted_ = true;
  placed_ = false;  // values_ are no longer those of the position
}

void LoopKinematics::setVelocity(const Eigen::VectorXd& qd) {
  if (moving_ && state_.qd == qd) return;
  moving_ = true;
  state_.qd = qd;
  state_.links.setVelocity(qd);
  for (std::size_t s = 0; s < sets_.size(); ++s) sets_[s]->setMotion(state_, valuesOf(s));
}

void LoopKinematics::setRates(const Eigen::VectorXd& qd) {
  if (drives_) setVelocity(qd);
  rates_ = values_.b;
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    kernel_->addColumns(rows_[s], entriesOf(s), qd.data(), rates_.data() + first_[s]);  // (3.2)
  }
}

void LoopKinematics::setMotion(const Motion& motion) {
  setVelocity(motion.qd);
  rates_ = values_.b;
  accelerations_ = values_.turning;
  if (drives_) accelerations_ += values_.bd;
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    kernel_->addMotion(rows_[s], entriesOf(s), motion.qd.data(), motion.qdd.data(),
                       rates_.data() + first_[s], accelerations_.data() + first_[s]);  // (3.2)
  }
}

ClosureWrench LoopKinematics::unitEffort(std::size_t closure) const {
  ClosureWrench wrench;
  activePart(closures_[closure]->freeUnit(), wrench) = freeAxis(closure);
  return wrench;
}

Twist LoopKinematics::childTwist(std::size_t closure) const {
  const LinkKinematics::PointMotion C =
      links().motionAt(closures_[closure]->child().link, childOrigin(closure));
  return {C.v, C.w};
}

}  // namespace virtual_work_dynamics
