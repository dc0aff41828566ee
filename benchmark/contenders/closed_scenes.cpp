#include "contenders/closed_scenes.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "contenders/linkages.h"
#include "scene/touch_rows.h"
#include "stability/random_numbers.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;

// How far, how fast and with what acceleration the actuated joints move about the assembly.
struct Range {
  double position, velocity, acceleration;
  int steps;  // on the way from one state to the next, so that Newton's method stays on one branch
};

struct Example {
  const char* name;
  Range range;
};

// Cranks turn all the way round; the manipulators stay clear of their singular positions.
constexpr Example kExamples[] = {
    {"four_bar", {kPi, 2, 5, 100}},         {"slider_crank", {kPi, 2, 5, 100}},
    {"andrews_squeezer", {kPi, 2, 5, 100}}, {"planar_3rrr", {0.15, 2, 5, 20}},
    {"stewart_gough", {0.06, 0.3, 1, 20}},  {"spatial_parallelogram", {0.8, 2, 5, 20}},
};

constexpr Range kRowRange{0.3, 2, 5, 10};
constexpr char kSeparate[] = "separate_four_bars_";
constexpr char kShared[] = "shared_rods_";
constexpr int kLoops[] = {1, 2, 5, 10, 20, 50, 100};
constexpr int kMostQuickLoops = 20;

bool startsWith(const std::string& name, const std::string& head) {
  return name.compare(0, head.size(), head) == 0;
}

// Of a row of linkages; 0: the scene is none.
int loopsInRow(const std::string& name) {
  for (const char* row : {kSeparate, kShared}) {
    if (startsWith(name, row)) return std::atoi(name.c_str() + std::string(row).size());
  }
  return 0;
}

Linkage linkageOf(const std::string& name) {
  const int loops = loopsInRow(name);
  if (loops > 0) return startsWith(name, kShared) ? sharedRods(loops) : separateFourBars(loops);
  const std::string folder = VWD_SOURCE_DIR;
  return {readUrdfFile(folder + "/urdf/" + name + ".urdf"),
          readSceneFile(folder + "/config/" + name + "_scene.yaml")};
}

Range rangeOf(const std::string& name) {
  for (const Example& example : kExamples) {
    if (name == example.name) return example.range;
  }
  return kRowRange;
}

std::vector<Motion> completedMotions(const std::string& name, const Linkage& linkage) {
  const Dynamics dynamics(linkage.mechanism, linkage.scene, {});
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const std::vector<bool>& actuated = dynamics.actuated();
  const Range range = rangeOf(name);
  RandomNumbers random(2010);
  Motion motion(dynamics.coordinates());
  motion.q = dynamics.assembly();
  std::vector<Motion> motions;
  for (std::size_t n = 0; n < kStates; ++n) {
    const Eigen::VectorXd start = motion.q;
    Eigen::VectorXd target = start;
    for (Eigen::Index i = 0; i < target.size(); ++i) {
      if (!actuated[static_cast<std::size_t>(i)]) continue;
      target[i] = dynamics.assembly()[i] + random.uniform(-range.position, range.position);
      motion.qd[i] = random.uniform(-range.velocity, range.velocity);
      motion.qdd[i] = random.uniform(-range.acceleration, range.acceleration);
    }
    for (int step = 1; step <= range.steps; ++step) {
      for (Eigen::Index i = 0; i < target.size(); ++i) {
        if (!actuated[static_cast<std::size_t>(i)]) continue;
        motion.q[i] = start[i] + (target[i] - start[i]) * step / range.steps;
      }
      if (!dynamics.complete(motion, workspace)) {
        throw Error(name + ": loops do not close on the way to state " + std::to_string(n));
      }
    }
    motions.push_back(motion);
  }
  return motions;
}

}  // namespace

std::vector<std::string> closedSceneNames() {
  std::vector<std::string> names;
  for (const Example& example : kExamples) names.emplace_back(example.name);
  for (const char* row : {kSeparate, kShared}) {
    for (const int loops : kLoops) names.push_back(row + std::to_string(loops));
  }
  return names;
}

bool isClosedScene(const std::string& name) {
  const std::vector<std::string> names = closedSceneNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool takesSeconds(const std::string& name) {
  return loopsInRow(name) > kMostQuickLoops;
}

BenchmarkScene makeClosedScene(const std::string& name) {
  if (!isClosedScene(name)) throw Error("there is no scene '" + name + "' with closed loops");
  Linkage linkage = linkageOf(name);
  std::vector<Motion> motions = completedMotions(name, linkage);
  const Eigen::Vector3d gravity = linkage.scene.gravity;
  return {name, std::move(linkage.mechanism), gravity, std::move(motions),
          std::move(linkage.scene)};
}

LoopCounts countLoops(const BenchmarkScene& scene) {
  const Dynamics dynamics(scene.mechanism, *scene.loops, {});
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  LoopCounts counts;
  counts.coordinates = dynamics.coordinates();
  for (const bool actuated : dynamics.actuated()) counts.actuated += actuated ? 1 : 0;
  counts.closures = scene.loops->closures.size();
  for (const Closure& closure : scene.loops->closures) {
    counts.conditions += conditionCount(closure);
  }
  for (std::size_t n = 0; n < scene.motions.size(); ++n) {
    dynamics.compute(scene.motions[n], workspace);
    const int redundant = workspace.results().loops.determinacy.redundant_constraints;
    if (n > 0 && redundant != counts.redundant_constraints) {
      throw Error(scene.name + ": " + std::to_string(redundant) +
                  " redundant constraints in state " + std::to_string(n) + ", " +
                  std::to_string(counts.redundant_constraints) + " in those before");
    }
    counts.redundant_constraints = redundant;
  }
  return counts;
}

}  // namespace virtual_work_dynamics
