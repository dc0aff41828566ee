#include "loops/forces.h"

namespace virtual_work_dynamics {

namespace {

// How often a choice is made anew because it turned over the flank of teeth that it was made for.
constexpr int kMostFlanks = 8;

}  // namespace

void LoopForces::choose(const std::vector<Wrench>& tree_reactions) {
  for (int round = 0; round < kMostFlanks; ++round) {
    if (!chooseOnFlanks(tree_reactions)) return;
  }
}

// Makes the efforts of a solution least along the one change that is open.
void LoopForces::chooseAlong() {
  if (effortsAreUnique()) return;
  const State& change = direction(0);
  double along = 0, square = 0;
  for (const LoopUnknowns::Effort& effort : unknowns_.efforts) {
    const double part = change.x[effort.unknown];
    along += part * solution_.x[effort.unknown];
    square += part * part;
  }
  const double way = along / square;
  for (Eigen::Index i = 0; i < unknowns(); ++i) {
    if (change.x[i] != 0) solution_.x[i] -= way * change.x[i];
  }
  redundant_constraints_ = 0;
}

// Costs are those of the flanks that bear at the start; returns whether the choice turns one over.
bool LoopForces::chooseOnFlanks(const std::vector<Wrench>& tree_reactions) {
  redundant_constraints_ = direction_count_;
  if (sound_ && cost_rows_ == 0 && efforts_follow_) return false;
  if (sound_ && cost_rows_ == 0 && direction_count_ == 1) {
    chooseAlong();
    return false;
  }
  startNorms();
  if (norms_.open() == 0) return false;
  const auto efforts = static_cast<Eigen::Index>(unknowns_.efforts.size());
  for (Eigen::Index j = 0; j < efforts; ++j) {
    const Eigen::Index unknown = unknowns_.efforts[std::size_t(j)].unknown;
    norms_.costs(efforts).row(j) = norms_.space().row(unknown);
    norms_.costOfSolution(efforts)[j] = solution_.x[unknown];
  }
  redundant_constraints_ -= norms_.reduce(efforts, solution_.x);
  const bool costs = norms_.open() > 0 && cost_rows_ > 0;
  if (costs) {
    setClosures(solution_);
    putCosts(solution_, &tree_reactions, norms_.costOfSolution(cost_rows_));
    touchAll(change_);
    for (Eigen::Index j = 0; j < norms_.open(); ++j) {
      change_.x = norms_.space().col(j);
      setClosures(change_);
      putCosts(change_, nullptr, norms_.costs(cost_rows_).col(j));
    }
    change_.x = solution_.x;
    norms_.reduce(cost_rows_, solution_.x);
  }
  norms_.finish(solution_.x);
  return costs && turnsFlank(change_.x, solution_.x);
}

}  // namespace virtual_work_dynamics
