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

LeftOut activePartOf(Unit motion) {
  return motion == Unit::kMetre ? LeftOut::kForceAlong : LeftOut::kMomentAbout;
}

LeftOut partsOf(CompoundType type) {
  switch (type) {
    case CompoundType::kPlanar:
      return LeftOut::kPlanar;
    case CompoundType::kCylindrical:
      return LeftOut::kCylindrical;
    case CompoundType::kScrew:
      return LeftOut::kScrew;
    case CompoundType::kSpherical:
      return LeftOut::kSpherical;
    case CompoundType::kFloating:
      return LeftOut::kFloating;
    case CompoundType::kUniversal:
      return LeftOut::kUniversal;
  }
  return LeftOut::kNothing;
}

}  // namespace

LoopReactions::LoopReactions(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
                             const std::vector<LoopGroup>& groups,
                             const std::vector<std::string>& names, const MomentPoints* points,
                             Axes axes)
    : kernel_(&loopKernelFor(chosenInstructionSet()).one), child_axes_(axes == Axes::kLink) {
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
      addClosure(scene, loops, closure->second);
    } else if (name == kGround || mechanism.reactionIndex(name) >= 0) {
      addJoint(mechanism, scene, name);
    } else {
      failAtUnknown(mechanism, scene, name, entryOf("reactions", i));
    }
    if (points) setPoint(*points);
  }
  addPassages(groups);
  addChanges(groups);
  freedoms_.resize(names.size());
  spans_.resize(names.size());
}

void LoopReactions::addClosure(const Scene& scene, const LoopScene& loops, std::size_t closure) {
  Item item;
  item.closure = static_cast<int>(closure);
  ReactionShape shape{item.closure, 0, LeftOut::kNothing, 0, 0, -1, {}, 0, 0};
  const auto& actuated = loops.actuated_closures;  // in order
  if (!scene.include_active && std::binary_search(actuated.begin(), actuated.end(), closure)) {
    shape.left_out =
        activePartOf(traitsOf(scene.closures[closure].type).free_axis.value_or(Unit::kRadian));
  }
  items_.push_back(item);
  shapes_.push_back(shape);
}

void LoopReactions::addJoint(const Mechanism& mechanism, const Scene& scene,
                             const std::string& name) {
  Item item;
  item.joint = mechanism.reactionIndex(name);  // none of ground
  ReactionShape shape{-1, item.joint + 1, LeftOut::kNothing, 0, 0, -1, {}, 0, 0};
  if (item.joint >= 0) {
    const Joint& joint = mechanism.joint(item.joint);
    const CompoundJoint* const compound = mechanism.compoundOf(item.joint);
    if (compound) item.compound = *compound;
    if (!scene.include_active && joint.type != JointType::kFixed) {
      shape.left_out = compound ? partsOf(compound->type) : activePartOf(unitOf(joint));
    }
    if (compound) shape.first_link = compound->first + 1;
    if (shape.left_out == LeftOut::kScrew) {
      shape.pitch = static_cast<double>(mechanism.joint(compound->first).multiplier);
    }
  }
  items_.push_back(item);
  shapes_.push_back(shape);
}

void LoopReactions::setPoint(const MomentPoints& points) {
  Item& item = items_.back();
  const LinkPoint* const point = item.closure >= 0
                                     ? points.ofClosure(static_cast<std::size_t>(item.closure))
                                     : points.ofJoint(item.joint);
  if (!point) return;
  item.point = {point->link, Eigen::Matrix3d::Identity(), point->p_LoPo_L.cast<double>()};
  shapes_.back().point_link = point->link;
  Eigen::Map<Eigen::Vector3d>{shapes_.back().p_LoPo_L} = item.point->p_LoFo_L;
}

void LoopReactions::addPassages(const std::vector<LoopGroup>& groups) {
  std::vector<std::vector<PassageShape>> by_joint;
  for (const LoopGroup& group : groups) {
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      const auto joint = static_cast<std::size_t>(crossed.joint);
      by_joint.resize(std::max(by_joint.size(), joint + 1));
      for (const LoopGroup::Passage& passage : crossed.passages) {
        by_joint[joint].push_back(
            {static_cast<int>(group.closures[passage.closure]), passage.sign});
      }
    }
  }
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const auto joint = static_cast<std::size_t>(items_[i].joint);  // huge where there is none
    shapes_[i].passages_begin = static_cast<int>(passages_.size());
    if (joint < by_joint.size()) {
      passages_.insert(passages_.end(), by_joint[joint].begin(), by_joint[joint].end());
    }
    shapes_[i].passages_end = static_cast<int>(passages_.size());
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
  ClosureWrench reported = wrench;
  kernel_->report(shapes_[item], child_axes_, kinematics.links().numbers(),
                  kinematics.frameNumbers(), reported.force.data());
  addSquares(reported, forces.leastChange(), length, freedoms_[item]);
}

void LoopReactions::addChange(const LoopKinematics& kinematics, std::size_t group,
                              const LoopForces& forces, const LoopForces::State& change) {
  visitChanged(group, forces, change, [&](std::size_t item, const ClosureWrench& wrench) {
    addChangeOf(kinematics, item, forces, wrench);
  });
}

void LoopReactions::getChanged(const LoopKinematics& kinematics, std::size_t group,
                               const LoopForces& forces, const LoopForces::State& change,
                               std::vector<Changed>& changed) {
  changed.clear();
  visitChanged(group, forces, change, [&](std::size_t item, const ClosureWrench& wrench) {
    ClosureWrench reported = wrench;
    kernel_->report(shapes_[item], child_axes_, kinematics.links().numbers(),
                    kinematics.frameNumbers(), reported.force.data());
    const Eigen::Vector3d &f = reported.force, &m = reported.moment;
    changed.push_back({item, {f.x(), f.y(), f.z(), m.x(), m.y(), m.z()}});
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
  ClosureWrench change = wrench;
  kernel_->leaveOut(shapes_[item], kinematics.links().numbers(), kinematics.frameNumbers(),
                    change.force.data());
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
