#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "command_line.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

// What a moving root costs beside one more revolute joint: chains of revolute joints with any axes,
// resting and moving, in one run.

namespace virtual_work_dynamics {
namespace {

constexpr char kHelp[] =
    R"(root_cost: what a root that moves costs beside one more revolute joint

Prints as CSV the time of a sample, ns, of chains of revolute joints whose roots rest and move: medians
over rounds in which all are timed in turn.
  --rounds N    rounds (101)
  --links N     with --moving or --resting: the chain of so many links, computed 64 times inside the
  --moving      function countedRun, for callgrind; see scripts/root_cost.sh
  --resting
  --reactions   with all reactions, in root axes
)";
constexpr int kLinks[] = {4, 8, 16, 32};
constexpr int kCounted = 64;

Mechanism chain(int count) {
  std::mt19937 generator(113);
  std::normal_distribution<double> normal;
  const auto vector = [&](double size) {
    const double x = size * normal(generator), y = size * normal(generator);
    return Eigen::Vector3d(x, y, size * normal(generator));
  };
  std::vector<Link> links(1);
  links[0].name = "base";
  links[0].mass = 5;
  links[0].inertia_Cm_K = 0.1L * Matrix3l::Identity();
  std::vector<Joint> joints;
  for (int i = 1; i <= count; ++i) {
    Link link;
    link.name = "link_" + std::to_string(i);
    link.parent_joint = i - 1;
    link.mass = 1.0L + 0.1L * i;
    link.p_KoCm_K = vector(0.1).cast<long double>();
    const Eigen::Matrix3d factor = 0.1 * Eigen::Matrix3d::Identity();
    link.inertia_Cm_K = (factor * factor).cast<long double>();
    link.inertia_Cm_K(0, 1) = link.inertia_Cm_K(1, 0) = 0.001L;
    links.push_back(link);
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = JointType::kRevolute;
    joint.axis_K = vector(1).normalized().cast<long double>();
    joint.p_PoKo_P = vector(0.3).cast<long double>();
    joint.R_PK =
        Eigen::AngleAxis<long double>(vector(1).norm(), vector(1).normalized().cast<long double>())
            .toRotationMatrix();
    joint.parent_link = i - 1;
    joint.child_link = i;
    joint.coordinate = i - 1;
    joints.push_back(joint);
  }
  return Mechanism("chain_" + std::to_string(count), links, joints);
}

// A chain with what it takes to compute samples.
class Chain {
 public:
  Chain(int links, bool moving, bool reactions)
      : links_(links), moving_(moving), mechanism_(chain(links)) {
    Scene scene;
    scene.root_moves = moving;
    Request request;
    if (reactions) request.root_axes = requestedReactions(mechanism_, scene);
    dynamics_ = std::make_unique<InverseDynamics>(mechanism_, scene, request);
    workspace_ = std::make_unique<Workspace>(dynamics_->makeWorkspace());
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    for (int i = 0; i < kCounted; ++i) {
      Motion motion(links);
      for (Eigen::VectorXd* values : {&motion.q, &motion.qd, &motion.qdd}) {
        for (double& value : *values) value = normal(generator);
      }
      RootMotion& root = motion.root;
      root.orientation =
          Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), 1)
              .normalized();
      for (Eigen::Vector3d* values :
           {&root.angular_velocity, &root.angular_acceleration, &root.acceleration}) {
        for (double& value : *values) value = normal(generator);
      }
      motions_.push_back(motion);
    }
  }

  void run() {
    for (const Motion& motion : motions_) dynamics_->compute(motion, *workspace_);
  }
  // Adds a round's time of a sample, ns.
  void time() {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    for (int i = 0; i < 8; ++i) run();
    const std::chrono::duration<double, std::nano> passed = Clock::now() - start;
    times_.push_back(passed.count() / (8 * kCounted));
  }
  void print() {
    std::sort(times_.begin(), times_.end());
    std::printf("%d,%s,%.1f\n", links_, moving_ ? "moving" : "resting", times_[times_.size() / 2]);
  }

 private:
  int links_;
  bool moving_;
  Mechanism mechanism_;
  std::unique_ptr<InverseDynamics> dynamics_;
  std::unique_ptr<Workspace> workspace_;
  std::vector<Motion> motions_;
  std::vector<double> times_;
};

int timeAll(int rounds, bool reactions) {
  std::vector<std::unique_ptr<Chain>> chains;
  for (const int links : kLinks) {
    for (const bool moving : {false, true})
      chains.push_back(std::make_unique<Chain>(links, moving, reactions));
  }
  for (int round = 0; round < rounds; ++round) {
    for (const auto& each : chains) each->time();
  }
  std::printf("links,root,ns_per_sample\n");
  for (const auto& each : chains) each->print();
  return 0;
}

}  // namespace
}  // namespace virtual_work_dynamics

extern "C" __attribute__((noinline)) void countedRun(void (*run)(void*), void* chain) {
  run(chain);
}

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  int rounds = 101, links = 0;
  bool moving = false, resting = false, reactions = false;
  return runProgram(
      "root_cost", kHelp, argc, argv,
      {count("--rounds", 5, rounds), count("--links", 4, links), flag("--moving", moving),
       flag("--resting", resting), flag("--reactions", reactions)},
      [&] {
        if (links == 0) return timeAll(rounds, reactions);
        Chain own(links, moving && !resting, reactions);
        own.run();
        countedRun([](void* chain) { static_cast<Chain*>(chain)->run(); }, &own);
        return 0;
      });
}
