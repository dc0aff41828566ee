#include "loops/force_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Forces below this fraction of the largest of the loops are zero, as for LoopHolds.
constexpr double kNoForceBound = 1e-10;
constexpr double kNoBound = std::numeric_limits<double>::quiet_NaN();

Eigen::Index mostDirections(const std::vector<LoopForces>& forces) {
  Eigen::Index most = 0;
  for (const LoopForces& group : forces) most = std::max(most, group.unknowns());
  return most;
}

// Numbers of a reaction in the order of its components.
double& component(Wrench& wrench, std::size_t j) {
  return j < 3 ? wrench.force[static_cast<Eigen::Index>(j)]
               : wrench.torque[static_cast<Eigen::Index>(j - 3)];
}

// Teeth press with either flank: what they add to reactions is not linear in their force.
void refuseTeeth(const std::vector<std::string>& closures, const LoopHolds& holds,
                 const LoopKinematics& kinematics, const std::vector<LoopForces>& forces) {
  const std::vector<std::size_t>& teeth = kinematics.meshing();
  for (std::size_t i = 0; i < holds.items().size(); ++i) {
    for (const std::size_t c : forces[holds.items()[i].group].group().closures) {
      if (std::find(teeth.begin(), teeth.end(), c) == teeth.end()) continue;
      throw SceneError("contact_intervals: the teeth " + inQuotes(closures[c]) +
                       " share loops with " + inQuotes(holds.names()[i]) +
                       ", where intervals are not found");
    }
  }
}

}  // namespace

ForceRanges::ForceRanges(const Request& request, const std::vector<std::string>& closures,
                         std::size_t couplings, const LoopHolds& holds,
                         const LoopKinematics& kinematics, const std::vector<LoopForces>& forces,
                         Results& results)
    : holds_(holds),
      intervals_(request.intervals),
      closures_(closures.size()),
      efforts_(static_cast<std::size_t>(results.effort.size())),
      couplings_(couplings),
      child_axes_(results.child_axes.size()),
      program_(mostDirections(forces),
               static_cast<Eigen::Index>(3 * holds.items().size() + efforts_ +
                                         6 * (child_axes_ + results.root_axes.size())),
               holds.items().size()) {
  items_.reserve(holds.items().size());
  if (holds.items().empty()) {
    throw SceneError(
        "contact_intervals: no contact presses and no cable pulls, so that nothing bounds a force");
  }
  if (!intervals_) return;
  refuseTeeth(closures, holds, kinematics, forces);
  const std::size_t places = efforts_ + 6 * (child_axes_ + results.root_axes.size());
  open_.reserve(places);
  open_places_.resize(places);
  changed_.reserve(std::max(child_axes_, results.root_axes.size()));
  for (ForceBounds* bounds : {&results.loops.least, &results.loops.most}) {
    bounds->effort = results.effort;
    bounds->child_axes = results.child_axes;
    bounds->root_axes = results.root_axes;
  }
}

void ForceRanges::addOpen(std::size_t place, double value, double& least, double& most) {
  open_places_[place] = static_cast<int>(open_.size());
  open_.push_back({value, &least, &most});
  least = most = value;
}

// Sets intervals of what is determined, and lists what is not.
void ForceRanges::collect(const Flags& flags, Results& results) {
  open_.clear();
  std::fill(open_places_.begin(), open_places_.end(), -1);
  ForceBounds &least = results.loops.least, &most = results.loops.most;
  least.effort = most.effort = results.effort;
  for (std::size_t i = 0; i < efforts_; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!flags.effort[i]) addOpen(i, results.effort[at], least.effort[at], most.effort[at]);
  }
  std::size_t place = efforts_;
  const auto add = [&](std::vector<Wrench>& values, const std::vector<Determined>& determined,
                       std::vector<Wrench>& lower, std::vector<Wrench>& upper) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      lower[i] = upper[i] = values[i];
      for (std::size_t j = 0; j < 6; ++j, ++place) {
        if (determined[i][j]) continue;
        addOpen(place, component(values[i], j), component(lower[i], j), component(upper[i], j));
      }
    }
  };
  add(results.child_axes, flags.child_axes, least.child_axes, most.child_axes);
  add(results.root_axes, flags.root_axes, least.root_axes, most.root_axes);
}

// Lists what is not decidable of a group; whether anything is to be found.
bool ForceRanges::anyOpen(std::size_t group, const std::vector<Hold>& holds) {
  items_.clear();
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (holds_.items()[i].group == group && holds[i] == Hold::kNotDecidable) items_.push_back(i);
  }
  return !items_.empty() || intervals_;
}

// Functions of an item: its forces along the plane, then the one that acts one way.
void ForceRanges::setCone(const LoopForces& forces, const LoopHolds::Item& item,
                          Eigen::Index column, const Eigen::VectorXd& x, Eigen::Index& row) {
  const double* const units = forces.unitsOf(item.local);
  const double* const own = x.data() + forces.firstUnknownOf(item.local);
  for (int i = item.along_begin; item.friction && i < item.along_end; ++i) {
    program_.function(row++)[column] = units[i] * own[i];
  }
  program_.function(row++)[column] = item.sign * units[item.acting] * own[item.acting];
}

void ForceRanges::setCones(LoopForces& forces) {
  Eigen::Index row = 0;
  for (const std::size_t i : items_) {
    const LoopHolds::Item& item = holds_.items()[i];
    const int along = item.friction ? item.along_end - item.along_begin : 0;
    program_.addCone({row + along, row, along, item.friction.value_or(0)});
    setCone(forces, item, 0, forces.solution().x, row);
  }
}

void ForceRanges::setOpen(std::size_t place, Eigen::Index column, double value) {
  const int open = open_places_[place];
  if (open >= 0) program_.function(cone_functions_ + open)[column] = value;
}

// A column of functions: what one of the changes does that mechanics leaves open.
void ForceRanges::setChange(const LoopKinematics& kinematics, std::size_t group, LoopForces& forces,
                            LoopReactions& child_axes, LoopReactions& root_axes, Eigen::Index i) {
  const LoopForces::State& change = forces.direction(i);
  Eigen::Index row = 0;
  for (const std::size_t item : items_) {
    setCone(forces, holds_.items()[item], 1 + i, change.x, row);
  }
  if (open_.empty()) return;
  for (const std::size_t j : change.touched_efforts) {
    const LoopUnknowns::Effort& actuator = forces.efforts()[j];
    setOpen(actuator.index, 1 + i, actuator.unit * change.x[actuator.unknown]);
  }
  for (const std::size_t local : change.touched_others) {
    const std::size_t coupling = forces.group().sets[local] - closures_;
    setOpen(efforts_ - couplings_ + coupling, 1 + i,
            forces.unitsOf(local)[0] * change.x[forces.firstUnknownOf(local)]);
  }
  std::size_t first = efforts_;
  for (LoopReactions* const reactions : {&child_axes, &root_axes}) {
    reactions->getChanged(kinematics, group, forces, change, changed_);
    for (const LoopReactions::Changed& changed : changed_) {
      for (std::size_t j = 0; j < 6; ++j) {
        setOpen(first + 6 * changed.item + j, 1 + i, changed.by[j]);
      }
    }
    first += 6 * child_axes_;
  }
}

// Adds what a group changes of open results; several groups may share a joint.
void ForceRanges::takeRanges(ConeProgram::Found found, double scale, double least_change) {
  for (std::size_t k = 0; k < open_.size(); ++k) {
    const Eigen::Index row = cone_functions_ + static_cast<Eigen::Index>(k);
    const auto changes = program_.function(row).tail(program_.function(row).size() - 1);
    if (changes.size() == 0 || changes.cwiseAbs().maxCoeff() <= least_change) continue;
    double &least = *open_[k].least, &most = *open_[k].most;
    if (found != ConeProgram::Found::kFeasible) {
      least = most = kNoBound;
      continue;
    }
    const auto [lower, upper] = program_.range(row);
    least += lower;
    most += upper;
    for (double* const bound : {&least, &most}) {
      if (std::abs(*bound) <= kNoForceBound * scale) *bound = 0;
    }
  }
}

void ForceRanges::find(const LoopKinematics& kinematics, std::vector<LoopForces>& forces,
                       LoopReactions& child_axes, LoopReactions& root_axes, const Flags& flags,
                       Results& results) {
  if (intervals_) collect(flags, results);
  std::vector<Hold>& holds = results.loops.holds;
  for (std::size_t g = 0; g < forces.size(); ++g) {
    LoopForces& group = forces[g];
    if (!anyOpen(g, holds) || group.directions() == 0) continue;
    const double scale = group.solution().x.cwiseAbs().maxCoeff();
    cone_functions_ = 0;
    for (const std::size_t i : items_) {
      const LoopHolds::Item& item = holds_.items()[i];
      cone_functions_ += 1 + (item.friction ? item.along_end - item.along_begin : 0);
    }
    program_.start(group.directions(), cone_functions_ + static_cast<Eigen::Index>(open_.size()));
    setCones(group);
    for (Eigen::Index i = 0; i < group.directions(); ++i) {
      setChange(kinematics, g, group, child_axes, root_axes, i);
    }
    // Loads that nothing bears have no forces to choose among.
    const ConeProgram::Found found =
        group.bears() ? program_.solve(scale) : ConeProgram::Found::kUnclear;
    takeRanges(found, scale, group.leastChange());
    if (found == ConeProgram::Found::kUnclear) continue;
    const bool can = found == ConeProgram::Found::kFeasible;
    for (const std::size_t i : items_) holds[i] = can ? Hold::kCanHold : Hold::kCannotHold;
  }
}

void ForceRanges::leaveOut(Results& results) {
  for (ForceBounds* bounds : {&results.loops.least, &results.loops.most}) {
    for (Eigen::Index i = 0; i < bounds->effort.size(); ++i) {
      if (!results.effortExists(static_cast<std::size_t>(i))) bounds->effort[i] = kNoBound;
    }
    const auto leave = [](const Determined& exist, Wrench& bound) {
      for (std::size_t j = 0; j < exist.size(); ++j) {
        if (!exist[j]) component(bound, j) = kNoBound;
      }
    };
    for (std::size_t i = 0; i < bounds->child_axes.size(); ++i) {
      leave(results.childAxesExist(i), bounds->child_axes[i]);
    }
    for (std::size_t i = 0; i < bounds->root_axes.size(); ++i) {
      leave(results.rootAxesExist(i), bounds->root_axes[i]);
    }
  }
}

}  // namespace virtual_work_dynamics
