#include "stability/mechanism_maker.h"
#include "stability/sweeps.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLength = 0.05;  // m; forces stay of one order along long chains

int addLink(MechanismMaker& maker, int parent, int index) {
  const JointPlace place = maker.anyPlace(mixedType(index), kLength);
  return maker.add(parent, place, maker.cuboid(maker.random().uniform(0.5, 2), kLength));
}

StabilityCase chain(double joints) {
  MechanismMaker maker(61);
  for (int i = 0; i < joints; ++i) addLink(maker, i, i);
  return caseOf(maker.mechanism("chain"));
}

StabilityCase star(double children) {
  MechanismMaker maker(62);
  const int hub = addLink(maker, 0, 0);
  for (int i = 0; i < children; ++i) addLink(maker, hub, i);
  return caseOf(maker.mechanism("star"));
}

void addPair(MechanismMaker& maker, int parent, int levels) {
  if (levels == 0) return;
  for (int i = 0; i < 2; ++i) addPair(maker, addLink(maker, parent, levels + i), levels - 1);
}

StabilityCase tree(double levels) {
  MechanismMaker maker(63);
  addPair(maker, 0, static_cast<int>(levels));
  return caseOf(maker.mechanism("tree"));
}

}  // namespace

std::vector<Sweep> structureSweeps() {
  return {
      {"chains",
       "joints one after the other",
       {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000},
       chain},
      {"stars", "children of the hub", {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000}, star},
      {"binary_trees", "levels of a binary tree", {1, 2, 3, 4, 5, 6, 7, 8, 9}, tree},
  };
}

}  // namespace virtual_work_dynamics
