#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "command_line.h"
#include "four_bar.h"
#include "loop_examples.h"
#include "open_loops.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

const char kHelp[] = R"(Usage: assembly_starts [--mechanisms N] [--seed S]

Assembles mechanisms with closed loops, of ten in turn: six loops in space, of all types of closures, two
four-bars, a bar on two to five equal cranks, and a planar 3-RRR manipulator. Their passive joints start off
the closed position by up to 0.1, 0.3, 0.5 and 0.8 rad. Prints how many are assembled, at the position that
was left or a nearer one, without moving a motor, and at the same one with parent and child of all closures
exchanged; then the same for a five-bar leg from 121 starts.
  --mechanisms  number of mechanisms (1000)
  --seed        of the mechanisms and starts (1)
Exit status: 0 all right, 1 fewer than 99 % are so (within 0.3 rad: any is not) or something failed,
2 wrong usage.
)";

constexpr std::array<double, 4> kOff = {0.1, 0.3, 0.5, 0.8};  // rad
constexpr double kAllWithin = 0.3;                            // rad
constexpr double kShare = 0.99;
constexpr double kNearer = 1e-9;  // rad, of distances that count as equal
constexpr double kSame = 1e-6;    // rad, of positions that two ways lead to

/// A mechanism with a position that closes its loops.
struct ClosedMechanism {
  Mechanism mechanism;
  Scene scene;
  Eigen::VectorXd closed;
};

ClosedMechanism spatialLoop(unsigned seed, std::size_t kind) {
  const auto& type = kConditionsOfTypes[kind % kConditionsOfTypes.size()];
  SpatialLoop loop(type.first, type.second, seed);
  return {std::move(*loop.mechanism), loop.scene, loop.closed};
}

ClosedMechanism fourBar(RobotBuilder& random) {
  FourBar linkage;
  linkage.lengths[0] = random.uniform(0.1, 0.4);  // the longest crank that turns round: 0.45
  FourBar::Cut cut = linkage.cut("BCD"[static_cast<int>(random.uniform(0, 2.99))]);
  const Eigen::VectorXd closed = cut.motion(linkage.turnings(random.uniform(-3, 3), 0, 0)).q;
  return {std::move(cut.mechanism), cut.scene, closed};
}

ClosedMechanism equalCranks(RobotBuilder& random) {
  Cranks cranks(2 + static_cast<int>(random.uniform(0, 3.99)));
  const Eigen::VectorXd closed = cranks.closed(random.uniform(0.5, 2.5));
  return {std::move(cranks.mechanism), cranks.scene, closed};
}

/// The example of that name: its motors stand 0.35 m from the middle, its limbs are 0.2 m long, and
/// the platform's corners are 0.1 m from its middle.
ClosedMechanism planar3rrr(RobotBuilder& random) {
  RobotBuilder builder(1);
  const Vector3l z = Vector3l::UnitZ(), limb(0.2L, 0, 0);
  const auto inPlane = [](const Vector2l& v) { return Vector3l(v.x(), v.y(), 0); };
  const auto placeOf = [](int leg) { return kPi / 2 + leg * 2 * kPi / 3; };
  const Positions at = planar3rrrAt(random.uniform(0, 10));
  Scene scene;
  std::vector<double> closed;
  std::vector<std::string> motors, tips;
  const auto add = [&](const std::string& name, int parent, const Vector3l& place) {
    const int link = builder.add(JointType::kContinuous, parent, z, Matrix3l::Identity(), place);
    closed.push_back(static_cast<double>(at.at(name)));
    return link;
  };
  for (int leg = 0; leg < 3; ++leg) {
    const std::string number = std::to_string(leg + 1);
    const int thigh = add("motor_" + number, 0, inPlane(0.35L * along(placeOf(leg))));
    motors.push_back("joint_" + std::to_string(thigh));
    const int shin = add("elbow_" + number, thigh, limb);
    tips.push_back("link_" + std::to_string(shin));
    if (leg == 0) add("wrist_1", shin, limb);
  }
  const Vector2l corner_1 = 0.1L * along(placeOf(0));
  for (int leg = 1; leg < 3; ++leg) {
    const Vector3l corner = inPlane(0.1L * along(placeOf(leg)) - corner_1);
    Closure pin = closureOf(ClosureType::kRevolute, frameAt("link_3", corner.cast<double>()),
                            frameAt(tips[static_cast<std::size_t>(leg)], {0.2, 0, 0}));
    pin.name = "pin_" + std::to_string(leg);
    scene.closures.push_back(pin);
  }
  scene.actuated = motors;
  return {builder.build(), scene,
          Eigen::Map<Eigen::VectorXd>(closed.data(), static_cast<Eigen::Index>(closed.size()))};
}

ClosedMechanism mechanismOf(unsigned seed, std::size_t index, RobotBuilder& random) {
  const std::size_t turn = index % 10;
  if (turn < 6) return spatialLoop(seed, index / 10 * 6 + turn);
  if (turn < 8) return fourBar(random);
  return turn == 8 ? equalCranks(random) : planar3rrr(random);
}

/// How many starts ended as they should.
struct Counts {
  int starts = 0, assembled = 0, nearest = 0, motors_stay = 0, same_exchanged = 0;

  bool allAtLeast(double share) const {
    return std::min({assembled, nearest, motors_stay, same_exchanged}) >= share * starts;
  }
  void print(const std::string& name) const {
    std::printf("%-22s %7d %10d %8d %12d %10d\n", name.c_str(), starts, assembled, nearest,
                motors_stay, same_exchanged);
  }
};

void assemble(const ClosedMechanism& loops, const Eigen::VectorXd& start, Counts& counts) {
  ++counts.starts;
  const Scene scene = startingAt(loops.scene, loops.mechanism, start);
  try {
    const ClosedLoopDynamics dynamics(loops.mechanism, scene, {});
    const Eigen::VectorXd& found = dynamics.assembly();
    ++counts.assembled;
    counts.nearest += (found - start).norm() <= (loops.closed - start).norm() + kNearer;
    bool stay = true;
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      const bool motor = dynamics.actuated()[static_cast<std::size_t>(i)];
      stay = stay && (!motor || found[i] == start[i]);
    }
    counts.motors_stay += stay;
    const ClosedLoopDynamics other(loops.mechanism, exchanged(scene), {});
    counts.same_exchanged += (other.assembly() - found).norm() <= kSame;
  } catch (const SceneError&) {
    // The counts tell.
  }
}

std::vector<bool> motorsOf(const ClosedMechanism& loops) {
  std::vector<bool> motors;
  for (const std::string& name : loops.mechanism.coordinateNames()) {
    motors.push_back(std::count(loops.scene.actuated->begin(), loops.scene.actuated->end(), name));
  }
  return motors;
}

Counts assembleLeg() {
  constexpr int kSteps = 11;
  constexpr double kStep = 0.15;  // rad
  Leg leg;
  const ClosedMechanism loops{leg.mechanism, leg.scene,
                              Eigen::Vector4d(0, Leg::closedKnee(), 0, -Leg::closedKnee())};
  Counts counts;
  for (int left = 0; left < kSteps; ++left) {
    for (int right = 0; right < kSteps; ++right) {
      assemble(loops, Eigen::Vector4d(0, kStep * left, 0, -kStep * right), counts);
    }
  }
  return counts;
}

struct Options {
  int mechanisms = 1000, seed = 1;
};

int run(const Options& options) {
  std::array<Counts, kOff.size()> counts;
  RobotBuilder random(static_cast<unsigned>(options.seed));
  for (int i = 0; i < options.mechanisms; ++i) {
    const unsigned seed = static_cast<unsigned>(options.seed * options.mechanisms + i);
    const ClosedMechanism loops = mechanismOf(seed, static_cast<std::size_t>(i), random);
    const std::vector<bool> motors = motorsOf(loops);
    for (std::size_t k = 0; k < kOff.size(); ++k) {
      Eigen::VectorXd start = loops.closed;
      for (Eigen::Index j = 0; j < start.size(); ++j) {
        if (!motors[static_cast<std::size_t>(j)]) start[j] += random.uniform(-kOff[k], kOff[k]);
      }
      assemble(loops, start, counts[k]);
    }
    showProgress("mechanisms", static_cast<std::size_t>(i) + 1,
                 static_cast<std::size_t>(options.mechanisms));
  }
  clearProgress();
  const Counts leg = assembleLeg();
  std::printf("%-22s %7s %10s %8s %12s %10s\n", "start off by", "starts", "assembled", "nearest",
              "motors stay", "exchanged");
  bool right = leg.allAtLeast(1);
  for (std::size_t k = 0; k < kOff.size(); ++k) {
    counts[k].print(numberText(kOff[k]) + " rad");
    right = right && counts[k].allAtLeast(kOff[k] <= kAllWithin ? 1 : kShare);
  }
  leg.print("leg, up to 1.5 rad");
  return right ? 0 : 1;
}

}  // namespace
}  // namespace virtual_work_dynamics

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  Options options;
  return runProgram(
      "assembly_starts", kHelp, argc, argv,
      {count("--mechanisms", 5, options.mechanisms), count("--seed", 4, options.seed)},
      [&] { return run(options); });
}
