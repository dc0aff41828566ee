#include "loops/reactions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "base/printable.h"
#include "scene/closure_types.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Changes by less, of a unit vector, span nothing: their squares are just above rounding errors of
// sums of squares.
constexpr double kLeastSpan = 1e-6;

// Adds the squares of a change's components; moments are divided by `length`.
void addSquares(const ClosureWrench& wrench, double least, double length,
                std::array<double, 6>& sums) {
  for (int i = 0; i < 3; ++i) {
    const double force = wrench.force[i] / least;
    const double moment = wrench.moment[i] / (length * least);
    sums[static_cast<std::size_t>(i)] += force * force;
    sums[static_cast<std::size_t>(i) + 3] += moment * moment;
  }
}

}  // namespace

LoopReactions::LoopReactions(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
                             const std::vector<LoopGroup>& groups,
                             const std::vector<std::string>& names, const MomentPoints* points,
                             Axes axes)
    : child_axes_(axes == Axes::kLink) {
  std::unordered_map<std::string, std::size_t> closures;
  for (const Closure& closure : scene.closures) closures.emplace(closure.name, closures.size());
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    if (!seen.insert(name).second) {
      throw SceneError(entryOf("reactions", i) + ": " + inQuotes(name) + " is named twice");
    }
    const auto closure = closures.find(name);
    if (closure != closures.end()) {
      items_.push_back(itemOfClosure(scene, loops, closure->second));
    } else if (name == kGround || mechanism.reactionIndex(name) >= 0) {
      items_.push_back(itemOfJoint(mechanism, scene, name));
    } else {
      failAtUnknown(mechanism, scene, name, entryOf("reactions", i));
    }
    if (points) setPoint(*points, items_.back());
  }
  addPassages(groups);
  addChanges(groups);
  freedoms_.resize(names.size());
  spans_.resize(names.size());
}

LoopReactions::Item LoopReactions::itemOfClosure(const Scene& scene, const LoopScene& loops,
                                                 std::size_t closure) {
  Item item;
  item.closure = static_cast<int>(closure);
  item.active = traitsOf(scene.closures[closure].type).free_axis.value_or(Unit::kRadian);
  const auto& actuated = loops.actuated_closures;  // in order
  item.drops_active =
      !scene.include_active && std::binary_search(actuated.begin(), actuated.end(), closure);
  return item;
}

LoopReactions::Item LoopReactions::itemOfJoint(const Mechanism& mechanism, const Scene& scene,
                                               const std::string& name) {
  Item item;
  item.joint = mechanism.reactionIndex(name);  // none of ground
  if (item.joint >= 0) {
    const Joint& joint = mechanism.joint(item.joint);
    item.active = unitOf(joint);
    item.drops_active = !scene.include_active && joint.type != JointType::kFixed;
    if (const CompoundJoint* const compound = mechanism.compoundOf(item.joint)) {
      item.compound = *compound;
    }
    if (item.compound && item.compound->type == CompoundType::kScrew) {
      item.pitch = mechanism.joint(item.compound->first).multiplier;
    }
  }
  return item;
}

void LoopReactions::setPoint(const MomentPoints& points, Item& item) {
  const LinkPoint* const point = item.closure >= 0
                                     ? points.ofClosure(static_cast<std::size_t>(item.closure))
                                     : points.ofJoint(item.joint);
  if (!point) return;
  item.point = {point->link, Eigen::Matrix3d::Identity(), point->p_LoPo_L.cast<double>()};
}

void LoopReactions::addPassages(const std::vector<LoopGroup>& groups) {
  std::vector<std::vector<Item*>> items_of;  // by joint
  for (Item& item : items_) {
    if (item.joint < 0) continue;
    items_of.resize(std::max(items_of.size(), static_cast<std::size_t>(item.joint) + 1));
    items_of[static_cast<std::size_t>(item.joint)].push_back(&item);
  }
  for (const LoopGroup& group : groups) {
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      if (static_cast<std::size_t>(crossed.joint) >= items_of.size()) continue;
      for (Item* item : items_of[static_cast<std::size_t>(crossed.joint)]) {
        for (const LoopGroup::Passage& passage : crossed.passages) {
          item->passages.push_back({group.closures[passage.closure], passage.sign});
        }
      }
    }
  }
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

Eigen::Vector3d LoopReactions::originOf(const LoopKinematics& kinematics, const Item& item) {
  return item.closure >= 0 ? kinematics.childOrigin(static_cast<std::size_t>(item.closure))
                           : kinematics.originOf(item.joint + 1);
}

// The vector to the child frame's origin from the point that an item's moment is about, root axes.
Eigen::Vector3d LoopReactions::leverOf(const LoopKinematics& kinematics, const Item& item) {
  return originOf(kinematics, item) - kinematics.links().originOf(*item.point);
}

// What a joint of several freedoms bears of a wrench in root axes, about the child frame's origin.
ClosureWrench LoopReactions::borneByParts(const LoopKinematics& kinematics, const Item& item,
                                          ClosureWrench wrench) {
  const int first = item.compound->first, last = item.compound->last;
  const auto without = [](const Eigen::Vector3d& v, const Eigen::Vector3d& axis) {
    return Eigen::Vector3d(v - axis.dot(v) * axis);
  };
  const Eigen::Vector3d& own = kinematics.axisOf(last);
  switch (item.compound->type) {
    case CompoundType::kPlanar:
      wrench.force = own.dot(wrench.force) * own;
      wrench.moment = without(wrench.moment, own);
      break;
    case CompoundType::kCylindrical:
      wrench = {without(wrench.force, own), without(wrench.moment, own)};
      break;
    case CompoundType::kScrew:
      wrench.moment = without(wrench.moment, own) - item.pitch * own.dot(wrench.force) * own;
      break;
    case CompoundType::kSpherical:
      wrench.moment.setZero();
      break;
    case CompoundType::kFloating:
      wrench = ClosureWrench();
      break;
    case CompoundType::kUniversal: {
      const Eigen::Vector3d normal = kinematics.axisOf(first).cross(own).normalized();
      wrench.moment = normal.dot(wrench.moment) * normal;
      break;
    }
  }
  return wrench;
}

// Takes away what is not reported of a wrench in root axes, about the child frame's origin.
ClosureWrench LoopReactions::borne(const LoopKinematics& kinematics, const Item& item,
                                   ClosureWrench wrench) {
  if (!item.drops_active) return wrench;
  if (item.compound) return borneByParts(kinematics, item, wrench);
  const Eigen::Vector3d axis = item.closure >= 0
                                   ? kinematics.freeAxis(static_cast<std::size_t>(item.closure))
                                   : kinematics.axisOf(item.joint);
  Eigen::Vector3d& active = activePart(item.active, wrench);
  active -= axis.dot(active) * axis;
  return wrench;
}

// Turns a wrench in root axes, about the child frame's origin, into the one that is reported.
ClosureWrench LoopReactions::reported(const LoopKinematics& kinematics, const Item& item,
                                      ClosureWrench wrench) const {
  const bool of_closure = item.closure >= 0;
  const std::size_t c = static_cast<std::size_t>(item.closure);
  wrench = borne(kinematics, item, wrench);
  if (item.point) wrench.moment += leverOf(kinematics, item).cross(wrench.force);
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
    const Item& item = items_[i];
    if (item.closure >= 0) {
      const ClosureWrench wrench =
          reported(kinematics, item, closures[static_cast<std::size_t>(item.closure)]);
      values[i] = {wrench.force, wrench.moment};
      continue;
    }
    values[i] = tree[of_tree++];
    if (item.passages.empty()) continue;
    ClosureWrench sum;
    const Eigen::Vector3d& origin = kinematics.originOf(item.joint + 1);
    for (const LoopGroup::Passage& passage : item.passages) {
      kinematics.addRelief(passage.closure, passage.sign, closures[passage.closure], origin, sum);
    }
    const ClosureWrench added = reported(kinematics, item, sum);
    values[i].force += added.force;
    values[i].torque += added.moment;
  }
}

void LoopReactions::setPoses(const LoopKinematics& kinematics, const std::vector<Pose>& tree,
                             std::vector<Pose>& poses) const {
  std::size_t of_tree = 0;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const std::size_t c = static_cast<std::size_t>(items_[i].closure);
    if (items_[i].closure < 0) {
      poses[i] = tree[of_tree++];
      continue;
    }
    poses[i] = {
        items_[i].point ? kinematics.links().originOf(*items_[i].point) : kinematics.childOrigin(c),
        Eigen::Quaterniond(kinematics.childAxes(c)).normalized()};
  }
}

void LoopReactions::setTwists(const LoopKinematics& kinematics, const std::vector<Twist>& tree,
                              std::vector<Twist>& twists) const {
  std::size_t of_tree = 0;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const std::size_t c = static_cast<std::size_t>(items_[i].closure);
    if (items_[i].closure < 0) {
      twists[i] = tree[of_tree++];
      continue;
    }
    twists[i] = kinematics.childTwist(c);
    if (!items_[i].point) continue;
    twists[i].linear += leverOf(kinematics, items_[i]).cross(twists[i].angular);
  }
}

void LoopReactions::reset() {
  for (auto& freedom : freedoms_) freedom.fill(0);
}

// Calls visit(item, wrench) for each item that the change touches, with the change of its wrench in
// root axes, about the child frame's origin.
template <typename Visit>
void LoopReactions::visitChanged(std::size_t group, const LoopForces& forces,
                                 const LoopForces::State& change, Visit visit) {
  ++calls_;
  for (const std::size_t closure : change.touched_closures) {
    for (const std::size_t i : changes_of_[group][closure]) {
      Change& item = changes_[group][i];
      if (item.counted == calls_) continue;
      item.counted = calls_;
      visit(item.item, item.crossed ? forces.jointWrench(*item.crossed, change)
                                    : change.closures[item.closure]);
    }
  }
}

// Calls visit(item, wrench) as visitChanged() does, with the unit effort of each joint of the group
// that moves freely.
template <typename Visit>
void LoopReactions::visitUnborne(const LoopKinematics& kinematics, std::size_t group,
                                 const LoopForces& forces, Visit visit) {
  for (const Change& change : changes_[group]) {
    if (!change.crossed) continue;
    const Item& item = items_[change.item];
    const int last = item.joint;
    const bool chain = item.compound && item.compound->type != CompoundType::kScrew;
    const int first = chain ? item.compound->first : last;
    for (int joint = first; joint <= last; ++joint) {
      const int coordinate = kinematics.links().coordinateOf({joint, 1});
      const std::vector<int>& all = forces.group().coordinates;
      const auto local = std::find(all.begin(), all.end(), coordinate) - all.begin();
      if (coordinate < 0 || !forces.isFree(local)) continue;
      const Unit unit = kinematics.links().unitOf(joint);
      ClosureWrench wrench;
      activePart(unit, wrench) = effortScaleOf(unit, forces.length()) * kinematics.axisOf(joint);
      visit(change.item, wrench);
    }
  }
}

// Rounding errors of a force make errors of its moment that grow with the lever, so that changes of
// the moment count relative to that.
void LoopReactions::addChangeOf(const LoopKinematics& kinematics, std::size_t item,
                                const LoopForces& forces, const ClosureWrench& wrench) {
  double length = forces.length();
  if (items_[item].point) length = std::max(length, leverOf(kinematics, items_[item]).norm());
  addSquares(reported(kinematics, items_[item], wrench), forces.leastChange(), length,
             freedoms_[item]);
}

void LoopReactions::addChange(const LoopKinematics& kinematics, std::size_t group,
                              const LoopForces& forces, const LoopForces::State& change) {
  visitChanged(group, forces, change, [&](std::size_t item, const ClosureWrench& wrench) {
    addChangeOf(kinematics, item, forces, wrench);
  });
}

void LoopReactions::addUnborne(const LoopKinematics& kinematics, std::size_t group,
                               const LoopForces& forces) {
  visitUnborne(kinematics, group, forces, [&](std::size_t item, const ClosureWrench& wrench) {
    addChangeOf(kinematics, item, forces, wrench);
  });
}

void LoopReactions::addUnborneSpan(const LoopKinematics& kinematics, std::size_t group,
                                   const LoopForces& forces) {
  visitUnborne(kinematics, group, forces, [&](std::size_t item, const ClosureWrench& wrench) {
    addSpanOf(kinematics, item, forces, wrench);
  });
}

void LoopReactions::resetSpans() {
  for (auto& span : spans_) span.setZero();
}

void LoopReactions::addSpan(const LoopKinematics& kinematics, std::size_t group,
                            const LoopForces& forces, const LoopForces::State& change) {
  visitChanged(group, forces, change, [&](std::size_t item, const ClosureWrench& wrench) {
    addSpanOf(kinematics, item, forces, wrench);
  });
}

// The dimension depends neither on axes nor on the point of moments.
void LoopReactions::addSpanOf(const LoopKinematics& kinematics, std::size_t item,
                              const LoopForces& forces, const ClosureWrench& wrench) {
  const ClosureWrench change = borne(kinematics, items_[item], wrench);
  const double scale = std::min(1.0, kLeastSpan / (10 * forces.leastChange()));
  Eigen::Matrix<double, 6, 1> entries;
  entries << scale * change.force, scale / forces.length() * change.moment;
  spans_[item] += entries * entries.transpose();
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
