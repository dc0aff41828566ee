#include "loops/reactions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "base/printable.h"
#include "scene/closure_types.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Changes by less, of a unit vector, span nothing: their squares are just above rounding errors of
// sums of squares.
constexpr double kLeastSpan = 1e-6;

void addSquares(const ClosureWrench& wrench, const LoopForces& forces,
                std::array<double, 6>& sums) {
  const double least = forces.leastChange();
  for (int i = 0; i < 3; ++i) {
    const double force = wrench.force[i] / least;
    const double moment = wrench.moment[i] / (forces.length() * least);
    sums[static_cast<std::size_t>(i)] += force * force;
    sums[static_cast<std::size_t>(i) + 3] += moment * moment;
  }
}

}  // namespace

LoopReactions::LoopReactions(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
                             const std::vector<LoopGroup>& groups,
                             const std::vector<std::string>& names, Axes axes)
    : child_axes_(axes == Axes::kLink) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    const std::string place = entryOf("reactions", static_cast<std::size_t>(name - names.begin()));
    if (std::find(names.begin(), name, *name) != name) {
      throw SceneError(place + ": " + inQuotes(*name) + " is named twice");
    }
    addItem(mechanism, scene, loops, *name, place);
  }
  addChanges(groups);
  freedoms_.resize(names.size());
  spans_.resize(names.size());
}

void LoopReactions::addItem(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
                            const std::string& name, const std::string& place) {
  Item item;
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    if (scene.closures[c].name != name) continue;
    item.closure = static_cast<int>(c);
    item.active = traitsOf(scene.closures[c].type).free_axis.value_or(Unit::kRadian);
    const auto& actuated = loops.actuated_closures;
    item.drops_active =
        !scene.include_active && std::find(actuated.begin(), actuated.end(), c) != actuated.end();
  }
  if (item.closure < 0) {
    item.joint = mechanism.jointIndex(name);
    if (item.joint < 0 && name != kGround) {
      failAtUnknown(mechanism, scene, name, place);
    }
    if (item.joint >= 0) {
      const Joint& joint = mechanism.joint(item.joint);
      item.active = unitOf(joint);
      item.drops_active = !scene.include_active && joint.type != JointType::kFixed;
    }
  }
  items_.push_back(item);
}

void LoopReactions::addChanges(const std::vector<LoopGroup>& groups) {
  changes_.resize(groups.size());
  changes_of_.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const LoopGroup& group = groups[g];
    changes_of_[g].resize(group.closures.size());
    for (std::size_t i = 0; i < items_.size(); ++i) {
      for (const LoopGroup::CrossedJoint& crossed : group.joints) {
        if (crossed.joint != items_[i].joint) continue;
        for (const LoopGroup::Passage& passage : crossed.passages) {
          changes_of_[g][passage.closure].push_back(changes_[g].size());
        }
        changes_[g].push_back({i, &crossed, 0});
      }
      for (std::size_t c = 0; c < group.closures.size(); ++c) {
        if (static_cast<int>(group.closures[c]) != items_[i].closure) continue;
        changes_of_[g][c].push_back(changes_[g].size());
        changes_[g].push_back({i, nullptr, c});
      }
    }
  }
}

// Turns a wrench in root axes into the one that is reported.
ClosureWrench LoopReactions::reported(const LoopKinematics& kinematics, const Item& item,
                                      ClosureWrench wrench) const {
  const bool of_closure = item.closure >= 0;
  const std::size_t c = static_cast<std::size_t>(item.closure);
  if (item.drops_active) {
    const Eigen::Vector3d axis =
        of_closure ? kinematics.freeAxis(c) : kinematics.axisOf(item.joint);
    Eigen::Vector3d& active = activePart(item.active, wrench);
    active -= axis.dot(active) * axis;
  }
  if (!child_axes_) return wrench;
  const Eigen::Matrix3d R =
      of_closure ? kinematics.childAxes(c) : kinematics.axesOf(item.joint + 1);
  return {R.transpose() * wrench.force, R.transpose() * wrench.moment};
}

void LoopReactions::setValues(const LoopKinematics& kinematics, const std::vector<Wrench>& tree,
                              const std::vector<ClosureWrench>& closures,
                              std::vector<Wrench>& values) const {
  std::size_t of_tree = 0;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (items_[i].closure < 0) {
      values[i] = tree[of_tree++];
    } else {
      const auto wrench =
          reported(kinematics, items_[i], closures[static_cast<std::size_t>(items_[i].closure)]);
      values[i] = {wrench.force, wrench.moment};
    }
  }
}

void LoopReactions::setPoses(const LoopKinematics& kinematics, const std::vector<Pose>& tree,
                             std::vector<Pose>& poses) const {
  std::size_t of_tree = 0;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const std::size_t c = static_cast<std::size_t>(items_[i].closure);
    poses[i] = items_[i].closure < 0
                   ? tree[of_tree++]
                   : Pose{kinematics.childOrigin(c),
                          Eigen::Quaterniond(kinematics.childAxes(c)).normalized()};
  }
}

void LoopReactions::setTwists(const LoopKinematics& kinematics, const std::vector<Twist>& tree,
                              std::vector<Twist>& twists) const {
  std::size_t of_tree = 0;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const std::size_t c = static_cast<std::size_t>(items_[i].closure);
    twists[i] = items_[i].closure < 0 ? tree[of_tree++] : kinematics.childTwist(c);
  }
}

void LoopReactions::reset() {
  for (auto& freedom : freedoms_) freedom.fill(0);
}

// Calls visit(item, wrench) for each item that the change touches.
template <typename Visit>
void LoopReactions::visitChanged(const LoopKinematics& kinematics, std::size_t group,
                                 const LoopForces& forces, const LoopForces::State& change,
                                 Visit visit) {
  ++calls_;
  for (const std::size_t closure : change.touched_closures) {
    for (const std::size_t i : changes_of_[group][closure]) {
      Change& item = changes_[group][i];
      if (item.counted == calls_) continue;
      item.counted = calls_;
      visit(item.item, reported(kinematics, items_[item.item],
                                item.crossed ? forces.jointWrench(*item.crossed, change)
                                             : change.closures[item.closure]));
    }
  }
}

void LoopReactions::addChange(const LoopKinematics& kinematics, std::size_t group,
                              const LoopForces& forces, const LoopForces::State& change) {
  visitChanged(kinematics, group, forces, change,
               [&](std::size_t item, const ClosureWrench& wrench) {
                 addSquares(wrench, forces, freedoms_[item]);
               });
}

void LoopReactions::resetSpans() {
  for (auto& span : spans_) span.setZero();
}

void LoopReactions::addSpan(const LoopKinematics& kinematics, std::size_t group,
                            const LoopForces& forces, const LoopForces::State& change) {
  const double scale = std::min(1.0, kLeastSpan / (10 * forces.leastChange()));
  visitChanged(kinematics, group, forces, change,
               [&](std::size_t item, const ClosureWrench& wrench) {
                 Eigen::Matrix<double, 6, 1> entries;
                 entries << scale * wrench.force, scale / forces.length() * wrench.moment;
                 spans_[item] += entries * entries.transpose();
               });
}

void LoopReactions::getRanks(std::vector<int>& ranks) const {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> squares(
        spans_[i], Eigen::EigenvaluesOnly);
    ranks[i] = static_cast<int>((squares.eigenvalues().array() > kLeastSpan * kLeastSpan).count());
  }
}

void LoopReactions::setFlags(std::vector<Determined>& determined) const {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    for (std::size_t j = 0; j < 6; ++j) determined[i][j] = freedoms_[i][j] <= 1;
  }
}

}  // namespace virtual_work_dynamics
