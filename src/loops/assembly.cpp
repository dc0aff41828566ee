#include "loops/assembly.h"

#include <cmath>
#include <sstream>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"
#include "loops/nearest_closing.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// How far coordinates are moved to leave a singular position, rad or as a fraction of the length.
constexpr double kDisplacement = 0.01;
// Loops that are open by less are closed by Newton's method alone, when no coordinate moves further
// than the short way, rad or of the length.
constexpr double kNearlyClosed = 1e-2, kShortWay = 0.1;
// A coordinate that ends further from its start may be on another branch, rad.
constexpr double kFar = 1.5;
// Angles below this fraction of the remaining distance, over the length, are not reported.
constexpr double kMatters = 1e-3;

std::string shortText(double number) {
  std::ostringstream text;
  text.precision(4);
  text << number;
  return text.str();
}

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
  throw AssemblyError(kinematics.set(worst).place() +
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

// Closes the loops near `q`, which they leave only where they are nearly closed at once.
bool closeNear(LoopCompletion& completion, LoopKinematics& kinematics, NearestClosing& nearest,
               Eigen::VectorXd& q, const std::vector<bool>& given) {
  kinematics.setPosition(q);
  if (completion.misfit(kinematics) <= kNearlyClosed) {
    Eigen::VectorXd tried = q;
    if (completion.close(kinematics, tried, given) &&
        kinematics.largestBent(tried - q, completion.scales()) <= kShortWay) {
      q = tried;
      return true;
    }
  }
  return nearest.close(q, given) && completion.close(kinematics, q, given);
}

// Moves the given coordinates of a closed position to `start` in short steps, the others with them.
bool moveGiven(LoopCompletion& completion, LoopKinematics& kinematics, Eigen::VectorXd& q,
               const Eigen::VectorXd& start, const std::vector<bool>& given) {
  const Eigen::VectorXd from = q;
  const double way = kinematics.largestBent(start - from, completion.scales());
  const int steps = 1 + static_cast<int>(way / kShortWay);
  for (int step = 1; step <= steps; ++step) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (given[static_cast<std::size_t>(i)]) q[i] = from[i] + (start[i] - from[i]) * step / steps;
    }
    if (!completion.close(kinematics, q, given)) return false;
  }
  return true;
}

// Whether given coordinates have to move is decided where the loops are closed: where they are
// open, redundant conditions look like independent ones, which would leave no coordinate to be
// given.
Eigen::VectorXd closedPosition(const LoopScene& loops, LoopCompletion& completion,
                               LoopKinematics& kinematics) {
  kinematics.setPosition(loops.start);
  NearestClosing nearest(kinematics, completion.groups(), completion.scales(), completion.length());
  const std::vector<bool>& given = loops.given.coordinates;
  Eigen::VectorXd q = loops.start;
  if (closeNear(completion, kinematics, nearest, q, given)) return q;
  const Eigen::VectorXd open = q;
  const std::vector<bool> none(given.size(), false);
  q = loops.start;
  if (closeNear(completion, kinematics, nearest, q, none)) {
    if (completion.rank(kinematics, given) < completion.rank(kinematics, none)) return q;
    if (moveGiven(completion, kinematics, q, loops.start, given)) return q;
  }
  // Zero, where given coordinates start that the scene does not place, is no wish of the user's.
  std::vector<bool> placed = given;
  for (std::size_t i = 0; i < placed.size(); ++i) placed[i] = given[i] && loops.placed[i];
  q = loops.start;
  if (placed != given && closeNear(completion, kinematics, nearest, q, placed)) return q;
  // The conditions themselves do not tell frames that fit from those that are half a turn apart,
  // which is what assemble() then refuses.
  q = loops.start;
  if (completion.close(kinematics, q, given)) return q;
  kinematics.setPosition(open);
  refuseOpen(kinematics, completion.length());
}

}  // namespace

std::vector<std::string> farFromStart(const Mechanism& mechanism, const LoopKinematics& kinematics,
                                      const Eigen::VectorXd& start, const Eigen::VectorXd& assembly,
                                      double length) {
  std::vector<std::string> far;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const Unit unit = mechanism.unitOf(static_cast<int>(i));
    const double way = std::abs(assembly[i] - start[i]);
    if (way <= (unit == Unit::kMetre ? length : kFar)) continue;
    if (!kinematics.bends(static_cast<int>(i))) continue;  // it has no branches
    const std::string name = unit == Unit::kMetre ? " m" : " rad";
    far.push_back(
        "assembly: " + inQuotes(mechanism.coordinateNames()[static_cast<std::size_t>(i)]) +
        " ends " + shortText(way) + name + " from its start, at " + shortText(assembly[i]) + name +
        ": perhaps on another branch; start it closer");
  }
  return far;
}

Eigen::VectorXd assemble(const Scene& scene, const LoopScene& loops, LoopCompletion& completion,
                         LoopKinematics& kinematics) {
  const Eigen::VectorXd q = closedPosition(loops, completion, kinematics);
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    const double least = kCoincide * completion.length();
    if (const char* fault = kinematics.closure(c).fault(kinematics.links(), least)) {
      throw AssemblyError(kinematics.set(c).place() + ": " + fault);
    }
    if (kinematics.reversed(c)) {
      throw AssemblyError("closures: " + inQuotes(scene.closures[c].name) +
                          " is assembled the wrong way round: its frames are half a turn apart");
    }
    if (traitsOf(scene.closures[c].type).hasLength() &&
        (kinematics.parentOrigin(c) - kinematics.childOrigin(c)).norm() <=
            kCoincide * completion.length()) {
      throw AssemblyError("closures: " + inQuotes(scene.closures[c].name) +
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

int freestCoordinate(const Mechanism& mechanism, const LoopScene& loops,
                     const Eigen::VectorXd& assembly, LoopCompletion& completion,
                     LoopKinematics& kinematics, std::vector<LoopForces>& forces) {
  kinematics.setPosition(positionBeside(assembly, mechanism, completion, kinematics));
  const std::vector<std::size_t> free = unheld(loops, forces);
  // Of a coordinate outside of loops the motion is all its own.
  std::vector<double> part(loops.actuated.size(), 1);
  for (const LoopForces& group : forces) {
    const std::vector<int>& coordinates = group.group().coordinates;
    for (std::size_t row = 0; row < coordinates.size(); ++row) {
      part[static_cast<std::size_t>(coordinates[row])] =
          group.partInFreeMotions(static_cast<Eigen::Index>(row));
    }
  }
  int freest = -1;
  const auto isBefore = [&](std::size_t i, std::size_t other) {
    const std::vector<bool>& given = loops.given.coordinates;
    return given[i] != given[other] ? given[i] : part[i] > part[other];
  };
  for (const std::size_t i : free) {
    if (freest < 0 || isBefore(i, static_cast<std::size_t>(freest))) freest = static_cast<int>(i);
  }
  kinematics.setPosition(assembly);
  return freest;
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
                     names(mechanism, free) +
                     " (free_motion: true reports what that motion demands)");
  }
  kinematics.setPosition(assembly);
}

}  // namespace virtual_work_dynamics
