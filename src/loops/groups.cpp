#include "loops/groups.h"

#include <algorithm>
#include <numeric>

namespace virtual_work_dynamics {

namespace {

int rootOf(const std::vector<int>& leaders, int i) {
  while (leaders[static_cast<std::size_t>(i)] != i) i = leaders[static_cast<std::size_t>(i)];
  return i;
}

LoopGroup::CrossedJoint& crossing(LoopGroup& group, int joint, bool moves) {
  for (LoopGroup::CrossedJoint& crossed : group.joints) {
    if (crossed.joint == joint) return crossed;
  }
  group.joints.push_back({joint, moves, {}});
  return group.joints.back();
}

void addMoved(const Mechanism& mechanism, const LoopKinematics& kinematics, LoopGroup& group) {
  for (const std::size_t c : group.closures) {
    std::vector<int> moved;
    for (const LoopKinematics::Step& step : kinematics.path(c)) {
      const int coordinate = mechanism.joint(step.joint).coordinate;
      if (coordinate < 0) continue;
      const auto& all = group.coordinates;
      const auto place = std::find(all.begin(), all.end(), coordinate) - all.begin();
      moved.push_back(static_cast<int>(place));
    }
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    group.moved.push_back(moved);
  }
}

}  // namespace

std::vector<LoopGroup> loopGroups(const Mechanism& mechanism, const LoopKinematics& kinematics,
                                  std::size_t closures) {
  const auto coordinateOf = [&](const LoopKinematics::Step& step) {
    return mechanism.joint(step.joint).coordinate;
  };
  // Coordinates are joined closure by closure; the least of a set leads it.
  std::vector<int> leaders(mechanism.coordinates().size());
  std::iota(leaders.begin(), leaders.end(), 0);
  std::vector<int> first(closures, -1);  // a coordinate of each closure
  for (std::size_t c = 0; c < closures; ++c) {
    for (const LoopKinematics::Step& step : kinematics.path(c)) {
      const int coordinate = coordinateOf(step);
      if (coordinate < 0) continue;
      if (first[c] < 0) first[c] = coordinate;
      const int a = rootOf(leaders, first[c]), b = rootOf(leaders, coordinate);
      leaders[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::vector<LoopGroup> groups;
  std::vector<int> group_of(leaders.size(), -1);
  for (std::size_t c = 0; c < closures; ++c) {
    const std::size_t leader = static_cast<std::size_t>(rootOf(leaders, first[c]));
    if (group_of[leader] < 0) {
      group_of[leader] = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    LoopGroup& group = groups[static_cast<std::size_t>(group_of[leader])];
    for (const LoopKinematics::Step& step : kinematics.path(c)) {
      crossing(group, step.joint, coordinateOf(step) >= 0)
          .passages.push_back({group.closures.size(), step.sign});
    }
    group.closures.push_back(c);
  }
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const int group = group_of[static_cast<std::size_t>(rootOf(leaders, static_cast<int>(i)))];
    if (group >= 0) groups[static_cast<std::size_t>(group)].coordinates.push_back(int(i));
  }
  for (LoopGroup& group : groups) addMoved(mechanism, kinematics, group);
  return groups;
}

double loopLength(const std::vector<LoopGroup>& groups, const LoopKinematics& kinematics) {
  double longest = 0;
  for (const LoopGroup& group : groups) {
    std::vector<Eigen::Vector3d> origins;
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      origins.push_back(kinematics.originOf(crossed.joint + 1));
    }
    for (const std::size_t c : group.closures) {
      origins.push_back(kinematics.parentOrigin(c));
      origins.push_back(kinematics.childOrigin(c));
    }
    for (const Eigen::Vector3d& a : origins) {
      for (const Eigen::Vector3d& b : origins) longest = std::max(longest, (a - b).norm());
    }
  }
  return longest > 0 ? longest : 1;
}

}  // namespace virtual_work_dynamics
