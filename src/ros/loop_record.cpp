#include "ros/loop_record.h"

#include <algorithm>

namespace virtual_work_dynamics {
namespace {

constexpr double ClosureResidual::*kLevel[] = {
    &ClosureResidual::position, &ClosureResidual::velocity, &ClosureResidual::acceleration};

void raise(std::atomic<double>& largest, double value) {
  // If take() runs between the two lines, the larger value belongs to the next report.
  if (value > largest.load(std::memory_order_relaxed)) {
    largest.store(value, std::memory_order_relaxed);
  }
}

std::vector<std::size_t> takeMarks(std::vector<std::atomic<bool>>& marks) {
  std::vector<std::size_t> marked;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i].exchange(false, std::memory_order_relaxed)) marked.push_back(i);
  }
  return marked;
}

}  // namespace

constexpr std::size_t LoopRecord::kLevels;
constexpr std::size_t LoopRecord::kHolds;

LoopRecord::LoopRecord(const Dynamics& dynamics, std::size_t reactions, const LoopLimits& limits)
    : closed_(dynamics.closed()),
      limits_(limits),
      closures_(dynamics.closureNames().size()),
      holds_(dynamics.oneSided().size()),
      efforts_(dynamics.effortNames().size()),
      reactions_(reactions) {}

void LoopRecord::recordFit(const MotionFit::Outcome& outcome) {
  const auto relaxed = std::memory_order_relaxed;
  fitted_.fetch_add(1, relaxed);
  fit_wheels_.store(outcome.wheels, relaxed);
  if (!outcome.closed) open_fits_.fetch_add(1, relaxed);
  if (!outcome.explained) unexplained_.fetch_add(1, relaxed);
  const auto add = [&](std::atomic<double>& sum, double rms) {
    sum.store(sum.load(relaxed) + rms * rms, relaxed);
  };
  add(fit_position_squares_, outcome.position_rms);
  add(fit_velocity_squares_, outcome.velocity_rms);
  // A report that is taken between these lines may have the coordinate of another sample.
  if (!(outcome.farthest.deviations > fit_deviations_.load(relaxed))) return;
  fit_deviations_.store(outcome.farthest.deviations, relaxed);
  fit_amount_.store(outcome.farthest.amount, relaxed);
  fit_coordinate_.store(outcome.farthest.coordinate, relaxed);
  fit_level_.store(outcome.farthest.level, relaxed);
}

void LoopRecord::record(const Results& results, const ActivePlan& plan) {
  if (!closed_) return;
  recordResiduals(results);
  for (std::size_t i = 0; i < holds_.size(); ++i) {
    const auto hold = static_cast<std::size_t>(results.loops.holds[i]);
    holds_[i][hold].fetch_add(1, std::memory_order_relaxed);
  }
  const Determinacy& found = results.loops.determinacy;
  rank_.store(found.rank, std::memory_order_relaxed);
  redundant_constraints_.store(found.redundant_constraints, std::memory_order_relaxed);
  redundancy_.store(found.redundancy, std::memory_order_relaxed);
  free_motions_.store(found.free_motions, std::memory_order_relaxed);
  gap_.store(found.gap, std::memory_order_relaxed);
  condition_.store(found.condition, std::memory_order_relaxed);
  if (results.singular()) singular_.add();
  if (results.undirected()) undirected_.add();
  if (results.singular() || results.undirected()) {
    recordLeftOut(results, plan);
  } else if (found.condition > limits_.condition) {
    close_to_singular_.add();
  }
  samples_.add();
}

void LoopRecord::recordResiduals(const Results& results) {
  bool violated = false;
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    if (!results.singular()) {
      raise(closures_[c].condition, results.loops.closure_conditions[c]);
    }
    for (std::size_t i = 0; i < kLevels; ++i) {
      const double relative = results.loops.relative_residuals[c].*kLevel[i];
      raise(closures_[c].largest[i], results.loops.residuals[c].*kLevel[i]);
      raise(closures_[c].relative[i], relative);
      violated = violated || !(relative <= limits_.tolerance);
    }
  }
  if (violated) violations_.add();
}

// Marks results that somebody listens to and that have no value.
void LoopRecord::recordLeftOut(const Results& results, const ActivePlan& plan) {
  const auto mark = [](std::atomic<bool>& left_out, bool exists) {
    if (!exists) left_out.store(true, std::memory_order_relaxed);
  };
  for (std::size_t i = 0; plan.dynamics.request().efforts && i < efforts_.size(); ++i) {
    mark(efforts_[i], results.effortExists(i));
  }
  for (std::size_t i = 0; i < plan.root_reactions.size(); ++i) {
    mark(reactions_[plan.root_reactions[i]], results.rootAxesExist(i) == kAllComponents);
  }
  for (std::size_t i = 0; i < plan.child_reactions.size(); ++i) {
    mark(reactions_[plan.child_reactions[i]], results.childAxesExist(i) == kAllComponents);
  }
}

LoopRecord::Report LoopRecord::take() {
  Report report;
  const std::uint64_t samples = samples_.value();
  report.news = samples > reported_;
  reported_ = samples;
  for (OfClosure& closure : closures_) {
    report.conditions.push_back(closure.condition.exchange(0, std::memory_order_relaxed));
    report.residuals.emplace_back();
    report.relative.emplace_back();
    for (std::size_t i = 0; i < kLevels; ++i) {
      report.residuals.back()[i] = closure.largest[i].exchange(0, std::memory_order_relaxed);
      report.relative.back()[i] = closure.relative[i].exchange(0, std::memory_order_relaxed);
    }
  }
  for (auto& counts : holds_) {
    report.holds.emplace_back();
    for (std::size_t i = 0; i < kHolds; ++i) {
      report.holds.back()[i] = counts[i].exchange(0, std::memory_order_relaxed);
    }
  }
  report.efforts = takeMarks(efforts_);
  report.reactions = takeMarks(reactions_);
  report.singular = singular_.value();
  report.undirected = undirected_.value();
  report.violations = violations_.value();
  report.close_to_singular = close_to_singular_.value();
  report.determinacy.rank = rank_;
  report.determinacy.redundant_constraints = redundant_constraints_;
  report.determinacy.redundancy = redundancy_;
  report.determinacy.free_motions = free_motions_;
  report.determinacy.gap = gap_;
  report.determinacy.condition = condition_;
  report.passive_given = passive_given_;
  const auto relaxed = std::memory_order_relaxed;
  report.fit.fitted = fitted_.exchange(0, relaxed);
  report.fit.open = open_fits_.exchange(0, relaxed);
  report.fit.unexplained = unexplained_.exchange(0, relaxed);
  report.fit.position_squares = fit_position_squares_.exchange(0, relaxed);
  report.fit.velocity_squares = fit_velocity_squares_.exchange(0, relaxed);
  report.fit.farthest.deviations = fit_deviations_.exchange(0, relaxed);
  report.fit.farthest.amount = fit_amount_.load(relaxed);
  report.fit.farthest.level = fit_level_.load(relaxed);
  report.fit.farthest.coordinate =
      report.fit.farthest.deviations > 0 ? fit_coordinate_.load(relaxed) : -1;
  report.fit.wheels = fit_wheels_.load(relaxed);
  return report;
}

}  // namespace virtual_work_dynamics
