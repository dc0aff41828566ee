#include "offline/loop_report.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "offline/check_report.h"
#include "offline/loop_rows.h"
#include "scene/closure_types.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

int conditionsOf(const Scene& scene) {
  int conditions = 0;
  for (const Closure& closure : scene.closures) conditions += traitsOf(closure.type).conditions;
  return conditions;
}

void printClosures(std::ostream& out, const Scene& scene) {
  Names closures, springs;
  for (const Closure& closure : scene.closures) {
    closures.push_back(closure.name + " (" + traitsOf(closure.type).name + ", " +
                       closure.parent.link + " to " + closure.child.link + ")");
  }
  for (const PointSpring& spring : scene.springs) {
    springs.push_back(spring.name + " (" + spring.link_a + " to " + spring.link_b + ")");
  }
  printNames(out, "closures", closures);
  printNames(out, "springs", springs);
}

void printActuated(std::ostream& out, const Mechanism& mechanism,
                   const ClosedLoopDynamics& dynamics) {
  Names actuated, passive;
  for (std::size_t i = 0; i < dynamics.actuated().size(); ++i) {
    (dynamics.actuated()[i] ? actuated : passive).push_back(mechanism.coordinateNames()[i]);
  }
  const Names& closures = dynamics.actuatedClosures();
  actuated.insert(actuated.end(), closures.begin(), closures.end());
  printNames(out, "actuated", actuated);
  printNames(out, "passive", passive);
}

void printCount(std::ostream& out, const std::string& what, int count) {
  out << "  " << what << ": " << count << "\n";
}

// "pin (fz tx ty)" for each reaction with components that are not determined.
Names undeterminedReactions(const Names& names, const std::vector<Determined>& flags) {
  Names texts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string components;
    for (std::size_t j = 0; j < flags[i].size(); ++j) {
      if (!flags[i][j])
        components += (components.empty() ? "" : " ") + std::string(kWrenchComponents[j]);
    }
    if (!components.empty()) texts.push_back(names[i] + " (" + components + ")");
  }
  return texts;
}

void printUndetermined(std::ostream& out, const Mechanism& mechanism,
                       const ClosedLoopDynamics& dynamics) {
  const Request& request = dynamics.request();
  Names texts;
  if (request.efforts) {
    const Names names = namesOfEfforts(mechanism, dynamics);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!dynamics.effortDetermined()[i]) texts.push_back("effort of " + names[i]);
    }
  }
  for (const Names& found :
       {undeterminedReactions(request.child_axes, dynamics.childAxesDetermined()),
        undeterminedReactions(request.root_axes, dynamics.rootAxesDetermined())}) {
    texts.insert(texts.end(), found.begin(), found.end());
  }
  printNames(out, "undetermined", texts);
}

}  // namespace

void printLoops(std::ostream& out, const Mechanism& mechanism, const Scene& scene,
                ClosedLoopDynamics& dynamics) {
  printClosures(out, scene);
  printActuated(out, mechanism, dynamics);
  Motion assembled(dynamics.coordinates());
  assembled.q = dynamics.assembly();
  dynamics.compute(assembled);
  const Determinacy& found = dynamics.determinacy();
  const int conditions = conditionsOf(scene);
  const int independent = conditions - found.redundant_constraints;
  out << "as assembled:\n";
  for (std::size_t i = 0; i < mechanism.coordinateNames().size(); ++i) {
    out << "  " << mechanism.coordinateNames()[i] << " = "
        << assembled.q[static_cast<Eigen::Index>(i)] << "\n";
  }
  printCount(out, "degrees of freedom", static_cast<int>(dynamics.coordinates()) - independent);
  printCount(out, "conditions of the closures", conditions);
  printCount(out, "redundant constraints", found.redundant_constraints);
  printCount(out, "redundancy, unknown forces less rank", found.redundancy);
  if (found.free_motions > 0) {
    printCount(out, "a singular position, free motions", found.free_motions);
  }
  printUndetermined(out, mechanism, dynamics);
}

void explainLoops(std::ostream& out, const Mechanism& mechanism, const Scene& scene,
                  const ClosedLoopDynamics& dynamics) {
  Scene tree = scene;
  tree.closures.clear();
  tree.springs.clear();
  tree.actuated.reset();
  tree.assembly.clear();
  Request request = dynamics.request();
  for (Names* names : {&request.child_axes, &request.root_axes}) {
    const auto isClosure = [&](const std::string& name) {
      return name != kGround && mechanism.jointIndex(name) < 0;
    };
    names->erase(std::remove_if(names->begin(), names->end(), isClosure), names->end());
  }
  out << "the tree without its closures and springs:\n";
  for (const std::string& line : InverseDynamics(mechanism, tree, request).summary().lines()) {
    out << "  " << line << "\n";
  }
  out << "closed loops are solved, sample by sample: " << conditionsOf(scene) << " conditions of "
      << scene.closures.size() << (scene.closures.size() == 1 ? " closure" : " closures") << ", "
      << scene.springs.size() << (scene.springs.size() == 1 ? " spring" : " springs")
      << "; the tree is gone through twice, first for efforts alone; not counted above\n";
}

}  // namespace virtual_work_dynamics
