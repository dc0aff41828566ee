#include "offline/loop_report.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/wrench_components.h"
#include "dynamics/effort_groups.h"
#include "offline/check_report.h"
#include "scene/closure_types.h"
#include "scene/touch_rows.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

int conditionsOf(const Scene& scene) {
  int conditions = 0;
  for (const Closure& closure : scene.closures) conditions += conditionCount(closure);
  return conditions + static_cast<int>(scene.couplings.size());
}

void printClosures(std::ostream& out, const Scene& scene) {
  Names closures, springs, couplings;
  for (const Closure& closure : scene.closures) {
    closures.push_back(closure.name + " (" + traitsOf(closure.type).name + ", " +
                       closure.parent.link + " to " + closure.child.link + ")");
  }
  for (const PointSpring& spring : scene.springs) {
    springs.push_back(spring.name + " (" + spring.link_a + " to " + spring.link_b + ")");
  }
  for (const Coupling& coupling : scene.couplings) {
    std::string joints;
    for (const NamedNumber& term : coupling.terms)
      joints += (joints.empty() ? "" : " ") + term.name;
    couplings.push_back(coupling.name + " (" + joints + ")");
  }
  printNames(out, "closures", closures);
  printNames(out, "springs", springs);
  if (!couplings.empty()) printNames(out, "couplings", couplings);
}

void printActuated(std::ostream& out, const Dynamics& dynamics) {
  const EffortGroups efforts(dynamics);
  printNames(out, "actuated", efforts.actuated);
  printNames(out, "passive", efforts.passive);
  if (!efforts.residuals.empty()) printNames(out, "free motions", efforts.residuals);
}

void printCount(std::ostream& out, const std::string& what, int count) {
  out << "  " << what << ": " << count << "\n";
}

// Lists each reaction with components that are not determined, as "pin (fz tx ty)".
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

void printUndetermined(std::ostream& out, const Dynamics& dynamics, const Results& results) {
  const Request& request = dynamics.request();
  const LoopResults& loops = results.loops;
  Names texts;
  if (request.efforts) {
    for (std::size_t i = 0; i < dynamics.effortNames().size(); ++i) {
      const std::string& name = dynamics.effortNames()[i];
      if (!loops.effort_determined[i]) {
        texts.push_back((dynamics.residuals()[i] ? "" : "effort of ") + name);
      }
    }
  }
  for (const Names& found :
       {undeterminedReactions(request.child_axes, loops.child_axes_determined),
        undeterminedReactions(request.root_axes, loops.root_axes_determined)}) {
    texts.insert(texts.end(), found.begin(), found.end());
  }
  printNames(out, "undetermined", texts);
}

}  // namespace

void printLoops(std::ostream& out, const Mechanism& mechanism, const Scene& scene,
                const Dynamics& dynamics) {
  printClosures(out, scene);
  printActuated(out, dynamics);
  Motion assembled(dynamics.coordinates());
  assembled.q = dynamics.assembly();
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(assembled, workspace);
  const Determinacy& found = workspace.results().loops.determinacy;
  const int conditions = conditionsOf(scene);
  const int independent = conditions - found.redundant_constraints;
  out << "as assembled:\n";
  for (std::size_t i = 0; i < mechanism.coordinateNames().size(); ++i) {
    out << "  " << mechanism.coordinateNames()[i] << " = "
        << assembled.q[static_cast<Eigen::Index>(i)] << "\n";
  }
  printCount(out, "degrees of freedom", static_cast<int>(dynamics.coordinates()) - independent);
  printCount(out,
             scene.couplings.empty() ? "conditions of the closures"
                                     : "conditions of the closures and couplings",
             conditions);
  printCount(out, "redundant constraints", found.redundant_constraints);
  printCount(out, "redundancy, unknown forces less rank", found.redundancy);
  if (found.free_motions > 0) {
    printCount(out, "a singular position, free motions", found.free_motions);
  }
  printUndetermined(out, dynamics, workspace.results());
}

void printCost(std::ostream& out, const Scene& scene, const Dynamics& dynamics) {
  const char* indent = dynamics.closed() ? "  " : "";
  if (dynamics.closed()) out << "the tree without its closures and springs:\n";
  for (const std::string& line : dynamics.summary().lines()) out << indent << line << "\n";
  if (!dynamics.closed()) return;
  out << "closed loops are solved, sample by sample: " << conditionsOf(scene) << " conditions of "
      << scene.closures.size() << (scene.closures.size() == 1 ? " closure" : " closures") << ", "
      << scene.springs.size() << (scene.springs.size() == 1 ? " spring" : " springs");
  if (!scene.couplings.empty()) {
    out << ", " << scene.couplings.size()
        << (scene.couplings.size() == 1 ? " coupling" : " couplings");
  }
  out << "; the tree is computed twice, first for efforts alone; this is not counted above\n";
}

}  // namespace virtual_work_dynamics
