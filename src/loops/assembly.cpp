#include "loops/assembly.h"

#include <cmath>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// How far coordinates are moved to leave a singular position, rad or as a fraction of the length.
constexpr double kDisplacement = 0.01;
// Ends of a rod closer than this fraction of the loops' length give it no direction.
constexpr double kCoincide = 1e-9;
// Angles below this fraction of the remaining distance, over the length, are not reported.
constexpr double kMatters = 1e-3;

std::string names(const Mechanism& mechanism, const std::vector<std::size_t>& coordinates) {
  std::string text;
  for (const std::size_t i : coordinates) {
    text += (text.empty() ? "" : ", ") + inQuotes(mechanism.coordinateNames()[i]);
  }
  return text;
}

[[noreturn]] void refuseOpen(const LoopKinematics& kinematics, double length) {
  std::size_t worst = 0;
  LoopKinematics::Norms largest{0, 0};
  for (std::size_t s = 0; s < kinematics.sets(); ++s) {
    const LoopKinematics::Norms norms = kinematics.normsOf(s, kinematics.phi());
    if (norms.lengths / length + norms.directions <=
        largest.lengths / length + largest.directions) {
      continue;
    }
    largest = norms;
    worst = s;
  }
  std::string open = numberText(largest.lengths) + " m";
  if (largest.directions > largest.lengths / length * kMatters) {
    open += " and " + numberText(largest.directions) + " rad";
  }
  throw SceneError(kinematics.set(worst).place() +
                   " cannot be assembled from the given start: it stays open by " + open);
}

// Finds the coordinates that no actuated joint and no closure holds at the present position.
std::vector<std::size_t> unheld(const LoopScene& loops, std::vector<LoopForces>& forces) {
  std::vector<bool> free;
  for (const bool actuated : loops.actuated) free.push_back(!actuated);
  for (LoopForces& group : forces) {
    group.setPosition();
    const std::vector<int>& coordinates = group.group().coordinates;
    for (std::size_t row = 0; row < coordinates.size(); ++row) {
      free[static_cast<std::size_t>(coordinates[row])] =
          group.isFree(static_cast<Eigen::Index>(row));
    }
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i]) indices.push_back(i);
  }
  return indices;
}

}  // namespace

Eigen::VectorXd assemble(const Scene& scene, const LoopScene& loops, LoopCompletion& completion,
                         LoopKinematics& kinematics) {
  Eigen::VectorXd q = loops.start;
  kinematics.setPosition(q);
  std::vector<bool> given = loops.actuated;
  const std::vector<bool> none(given.size(), false);
  if (completion.rank(kinematics, given) < completion.rank(kinematics, none)) given = none;
  if (!completion.close(kinematics, q, given)) refuseOpen(kinematics, completion.length());
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    if (kinematics.reversed(c)) {
      throw SceneError("closures: " + inQuotes(scene.closures[c].name) +
                       " is assembled the wrong way round: its frames are half a turn apart");
    }
    if (traitsOf(scene.closures[c].type).hasLength() &&
        (kinematics.parentOrigin(c) - kinematics.childOrigin(c)).norm() <=
            kCoincide * completion.length()) {
      throw SceneError("closures: " + inQuotes(scene.closures[c].name) +
                       ": its ends coincide in the assembly");
    }
  }
  kinematics.adoptConstants();
  kinematics.setPosition(q);
  return q;
}

namespace {

// Closes the loops beside the assembly. Returns false when that fails, with `q` at the best
// position met.
bool closeBeside(const Mechanism& mechanism, LoopCompletion& completion, LoopKinematics& kinematics,
                 Eigen::VectorXd& q) {
  for (int i = 0; i < q.size(); ++i) {
    // Unequal steps, as a symmetrical displacement can lead from one singular position to another.
    const double step = kDisplacement * (1 + 0.37 * std::sin(1.0 + 2.1 * i));
    q[i] += step * scaleOf(mechanism.unitOf(i), completion.length());
  }
  return completion.close(kinematics, q, std::vector<bool>(mechanism.coordinates().size(), false));
}

}  // namespace

Eigen::VectorXd positionBeside(const Eigen::VectorXd& assembly, const Mechanism& mechanism,
                               LoopCompletion& completion, LoopKinematics& kinematics) {
  Eigen::VectorXd q = assembly;
  return closeBeside(mechanism, completion, kinematics, q) ? q : assembly;
}

void requireHeld(const Mechanism& mechanism, const LoopScene& loops,
                 const Eigen::VectorXd& assembly, LoopCompletion& completion,
                 LoopKinematics& kinematics, std::vector<LoopForces>& forces) {
  if (unheld(loops, forces).empty()) return;
  Eigen::VectorXd q = assembly;
  closeBeside(mechanism, completion, kinematics, q);
  const std::vector<std::size_t> free = unheld(loops, forces);
  if (!free.empty()) {
    throw SceneError("actuated: too few for the degrees of freedom: nothing holds the motion of " +
                     names(mechanism, free));
  }
  kinematics.setPosition(assembly);
}

}  // namespace virtual_work_dynamics
