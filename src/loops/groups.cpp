#include "loops/groups.h"

#include <algorithm>
#include <numeric>

namespace virtual_work_dynamics {

namespace {

// Of the distance of its origins from the root, the least that is the size of a loop: with the
// default tolerance of the rank, some ten rounding errors of their positions are then no gap.
constexpr double kLeastShare = 1e-4;

// Of that distance, what is no size but rounding.
constexpr double kNoSize = 1e-13;
// What loops extend by rounding alone, m: origins that coincide have sums of rounding errors
// between them, wherever they are not far.
constexpr double kNoLength = 1e-15;

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

void addMoved(const LoopKinematics& kinematics, LoopGroup& group) {
  for (const std::size_t s : group.sets) {
    std::vector<int> moved;
    for (const int coordinate : kinematics.set(s).coordinates()) {
      const auto& all = group.coordinates;
      const auto place = std::find(all.begin(), all.end(), coordinate) - all.begin();
      moved.push_back(static_cast<int>(place));
    }
    group.moved.push_back(moved);
  }
}

// Whether a joint has a reaction that stiffness can weigh.
bool reacts(const Mechanism& mechanism, int joint) {
  return mechanism.joint(joint).coordinate >= 0 && !mechanism.isInnerPart(joint);
}

void addClosure(const Mechanism& mechanism, const LoopKinematics& kinematics, std::size_t closure,
                LoopGroup& group) {
  for (const PathStep& step : kinematics.path(closure)) {
    crossing(group, step.joint, reacts(mechanism, step.joint))
        .passages.push_back({group.closures.size(), step.sign});
  }
  group.closures.push_back(closure);
}

bool hasSize(const LoopKinematics& kinematics, const LoopGroup& group,
             const LoopGroup::CrossedJoint& crossed) {
  return std::any_of(crossed.passages.begin(), crossed.passages.end(), [&](const auto& passage) {
    return kinematics.sizes(group.closures[passage.closure], crossed.joint);
  });
}

}  // namespace

std::vector<LoopGroup> loopGroups(const Mechanism& mechanism, const LoopKinematics& kinematics) {
  // Coordinates are joined set by set; the least of those joined leads them.
  std::vector<int> leaders(mechanism.coordinates().size());
  std::iota(leaders.begin(), leaders.end(), 0);
  for (std::size_t s = 0; s < kinematics.sets(); ++s) {
    const std::vector<int>& coordinates = kinematics.set(s).coordinates();
    for (const int coordinate : coordinates) {
      const int a = rootOf(leaders, coordinates.front()), b = rootOf(leaders, coordinate);
      leaders[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::vector<LoopGroup> groups;
  std::vector<int> group_of(leaders.size(), -1);
  for (std::size_t s = 0; s < kinematics.sets(); ++s) {
    const int first = kinematics.set(s).coordinates().front();
    const std::size_t leader = static_cast<std::size_t>(rootOf(leaders, first));
    if (group_of[leader] < 0) {
      group_of[leader] = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    LoopGroup& group = groups[static_cast<std::size_t>(group_of[leader])];
    if (s < kinematics.closures()) addClosure(mechanism, kinematics, s, group);
    group.sets.push_back(s);
  }
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const int group = group_of[static_cast<std::size_t>(rootOf(leaders, static_cast<int>(i)))];
    if (group >= 0) groups[static_cast<std::size_t>(group)].coordinates.push_back(int(i));
  }
  for (LoopGroup& group : groups) addMoved(kinematics, group);
  return groups;
}

double loopLength(const std::vector<LoopGroup>& groups, const LoopKinematics& kinematics) {
  double longest = 0, farthest = 0;
  for (const LoopGroup& group : groups) {
    std::vector<Eigen::Vector3d> origins;
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      const Eigen::Vector3d& origin = kinematics.originOf(crossed.joint + 1);
      farthest = std::max(farthest, origin.norm());
      if (hasSize(kinematics, group, crossed)) origins.push_back(origin);
    }
    for (const std::size_t c : group.closures) {
      origins.push_back(kinematics.parentEnd(c));
      origins.push_back(kinematics.childOrigin(c));
    }
    for (const Eigen::Vector3d& a : origins) {
      farthest = std::max(farthest, a.norm());
      for (const Eigen::Vector3d& b : origins) longest = std::max(longest, (a - b).norm());
    }
  }
  if (longest > std::max(kNoLength, kLeastShare * farthest)) return longest;
  // What touches goes far on the joints that carry it, and its levers stay what they are.
  const bool carried = !kinematics.touching().empty() && longest > kNoSize * farthest;
  if (carried) return kLeastShare * farthest;
  return farthest > kNoLength ? farthest : 1;
}

}  // namespace virtual_work_dynamics
