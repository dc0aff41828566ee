#include "dirty_descriptions.h"

#include "dirty_faults.h"

namespace virtual_work_dynamics {

namespace {

using dirty::NamedFault;

std::vector<const NamedFault*> allFaults() {
  std::vector<const NamedFault*> all;
  for (const auto* list : {&dirty::inertialFaults(), &dirty::jointFaults(), &dirty::textFaults()}) {
    for (const NamedFault& fault : *list) all.push_back(&fault);
  }
  return all;
}

}  // namespace

std::vector<std::string> dirtyFaults() {
  std::vector<std::string> names;
  for (const NamedFault* fault : allFaults()) names.emplace_back(fault->name);
  return names;
}

DirtyDescription dirtyDescription(unsigned seed) {
  dirty::Dice dice(seed);
  dirty::Robot robot = dirty::cleanRobot(dice);
  const std::vector<const NamedFault*> faults = allFaults();
  DirtyDescription result;
  // Every fault comes alone once, before several come together.
  const std::size_t count = seed < faults.size() ? 1 : dice.below(5);
  for (std::size_t i = 0; i < count; ++i) {
    const NamedFault& fault = *faults[seed < faults.size() ? seed : dice.below(faults.size())];
    fault.apply(robot, dice);
    result.faults.emplace_back(fault.name);
    // Faults undo one another, as where a joint is given another type.
    if (count > 1 || fault.verdict == Verdict::kEither) {
      result.verdict = Verdict::kEither;
    } else {
      result.verdict = fault.verdict;
    }
  }
  result.urdf = dirty::written(robot);
  return result;
}

}  // namespace virtual_work_dynamics
