#include <algorithm>
#include <cmath>

#include "loops/forces.h"

namespace virtual_work_dynamics {

namespace {

// Least work on free motions, of a unit vector of load, that counts as bearing them.
constexpr double kWorks = 1e-6;

}  // namespace

// Adds what a unit load on a coordinate that takes part in a free motion changes; loads on
// coordinates that depend on others follow from these and add nothing new.
void LoopForces::addOpenLoads() {
  touchAll(change_);
  for (Eigen::Index row = 0; row < coordinates(); ++row) {
    if (!isFree(row)) continue;
    load_.setZero();
    load_[row] = 1;
    solveWhole(change_.x);
    const double norm = change_.x.norm();
    if (norm > 0) directions_.col(direction_count_++) = change_.x / norm;
  }
}

// Beside the position, what bears the load grows without bound and turns with the joints: to first
// order a finite change, which takes part in bearing the load. A mixture of all changes stands for
// the multipliers that grow.
void LoopForces::addTurns() {
  change_.x.setZero();
  for (Eigen::Index j = 0; j < rank_.changes(); ++j) {
    change_.x += (1 + 0.37 * std::sin(1.0 + 2.1 * static_cast<double>(j))) * directions_.col(j);
  }
  if (change_.x.norm() > 0) change_.x.normalize();
  touchAll(change_);
  setClosures(change_);
  for (std::size_t local = 0; local < group_.closures.size(); ++local) {
    for (const PathStep& step : kinematics_.path(group_.closures[local])) addTurn(local, step);
  }
}

void LoopForces::addTurn(std::size_t local, const PathStep& step) {
  const int coordinate = kinematics_.links().coordinateOf(step);
  if (coordinate < 0) return;
  const ClosureWrench growing = change_.closures[local];
  const std::size_t closure = group_.closures[local];
  const LinkKinematics::Displacement moves = kinematics_.closure(closure).displacedBy(
      kinematics_.links(), kinematics_.frames(closure), step, length_);
  Turn turn;
  turn.local = local;
  turn.wrench.force = moves.turn.cross(growing.force);
  turn.wrench.moment = moves.turn.cross(growing.moment);
  turn.shift = moves.origin.cross(growing.force);
  const LoopUnknowns::OfSet& own = unknowns_.of_sets[local];
  gatherForce(own, {turn.wrench.force, turn.wrench.moment + turn.shift});
  load_.setZero();
  for (const int row : own.coordinates) {
    load_[row] =
        -gathered_[group_.coordinates[std::size_t(row)]] / unknowns_.row_units[std::size_t(row)];
  }
  double works = 0;
  for (Eigen::Index j = 0; j < coordinates() - rank(); ++j) {
    works = std::max(works, std::abs(rank_.freeMotions().col(j).dot(load_)));
  }
  if (!(works > kWorks)) return;
  solveWhole(directions_.col(direction_count_++));
  turns_.push_back(turn);
}

}  // namespace virtual_work_dynamics
