#include "virtual_work_dynamics/plan_summary.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "plain_results.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Multiplications and additions; the numbers of this file are counted by hand from the formulas.
struct Cost {
  int multiplications, additions;

  Cost operator+(const Cost& other) const {
    return {multiplications + other.multiplications, additions + other.additions};
  }
  Cost operator-(const Cost& other) const {
    return {multiplications - other.multiplications, additions - other.additions};
  }
  bool operator==(const Cost& other) const {
    return multiplications == other.multiplications && additions == other.additions;
  }
};

Cost operator*(int times, const Cost& cost) {
  return {times * cost.multiplications, times * cost.additions};
}

std::ostream& operator<<(std::ostream& stream, const Cost& cost) {
  return stream << cost.multiplications << " multiplications, " << cost.additions << " additions";
}

PlanSummary summaryOf(const Mechanism& mechanism, const Scene& scene, const Request& request) {
  return InverseDynamics(mechanism, scene, request).summary();
}

Cost costOf(const PlanSummary& summary) {
  return {static_cast<int>(summary.multiplications), static_cast<int>(summary.additions)};
}

Request requestOf(const Mechanism& mechanism, bool child_axes, bool root_axes, bool poses,
                  bool twists) {
  const Request all = requestAll(mechanism);
  Request request;
  if (child_axes) request.child_axes = all.child_axes;
  if (root_axes) request.root_axes = all.root_axes;
  request.poses = poses;
  request.twists = twists;
  return request;
}

// Products of vectors of three.
constexpr Cost kMatrixTimesVector{9, 6};
constexpr Cost kPlaneTimesVector{4, 2};  // with a turn about one of the axes
constexpr Cost kAddVector{0, 3};
constexpr Cost kScaleVector{3, 0};
constexpr Cost kAddMatrixTimesVector{9, 9};
constexpr Cost kAddCross{6, 6};

// A revolute joint with a body at its end: (2.5), (2.7), (3.5), (3.8), less R_PK.
constexpr Cost kTurnMotion{3 * 4 + 2, 3 * 2 + 4};  // by Rz: w, alpha, gamma; and qd, qdd
constexpr Cost kGradient{2 + 9, 9};                // U: two squares; each entry a product and a sum
constexpr Cost kInertia{3 + 18 + 9 + 6, 12 + 9 + 6 + 3};  // m gamma, G U, U h, h x gamma
constexpr Cost kTurnWrench = {8, 4};                      // by Rz

Cost revolute(const Cost& rotation) {
  return kAddMatrixTimesVector + 3 * rotation + kTurnMotion + kGradient + kInertia +
         2 * kAddVector + kTurnWrench + 2 * rotation + kAddCross;
}

// Cost of one more joint in the middle of a chain.
template <typename MakeChain>
Cost costOfOneMore(const MakeChain& chain, bool child_axes, bool root_axes, bool poses,
                   bool twists) {
  const Mechanism shorter = chain(5), longer = chain(6);
  const auto cost = [&](const Mechanism& mechanism) {
    return costOf(
        summaryOf(mechanism, Scene(), requestOf(mechanism, child_axes, root_axes, poses, twists)));
  };
  return cost(longer) - cost(shorter);
}

TEST(PlanSummary, CountsARevoluteJointInGeneralPosition) {
  const auto chain = [](int joints) { return chainOf(joints).build(); };
  const Cost efforts = costOfOneMore(chain, false, false, false, false);
  EXPECT_EQ(efforts, revolute(kMatrixTimesVector));
  EXPECT_EQ(efforts, (Cost{129, 104}));

  EXPECT_EQ(costOfOneMore(chain, true, false, false, false), efforts + 2 * kMatrixTimesVector);

  // R_0Z R_PZ, then Rz; the wrench in root axes.
  const Cost rotation = 3 * kMatrixTimesVector + Cost{12, 6};
  const Cost root_axes = efforts + rotation + 2 * kMatrixTimesVector;
  EXPECT_EQ(costOfOneMore(chain, false, true, false, false), root_axes);
  // The origin, and the axes of the child link.
  const Cost reported_pose = kMatrixTimesVector + kAddVector + 3 * kMatrixTimesVector;
  EXPECT_EQ(costOfOneMore(chain, false, true, true, false), root_axes + reported_pose);
  const Cost twist = kAddCross + kScaleVector + kAddVector;
  EXPECT_EQ(costOfOneMore(chain, false, true, true, true), root_axes + reported_pose + twist);
}

// A chain of joints of one kind whose axes lie as `frame` says.
auto chainAlong(const Matrix3l& frame, JointType type = JointType::kRevolute, int sign = 1) {
  return [=](int joints) {
    RobotBuilder builder(1);
    for (int i = 0; i < joints; ++i) {
      builder.add(type, i, Vector3l(sign * Vector3l::UnitZ()), frame, builder.vector(0.3));
    }
    return builder.build();
  };
}

Matrix3l turnAboutX(long double c, long double s) {
  Matrix3l R;
  R << 1, 0, 0, 0, c, -s, 0, s, c;
  return R;
}

TEST(PlanSummary, CountsAxesAlongAndAcrossTheParents) {
  const Cost none{0, 0};
  const auto efforts = [](const auto& chain) {
    return costOfOneMore(chain, false, false, false, false);
  };
  EXPECT_EQ(efforts(chainAlong(Matrix3l::Identity())), revolute(none));
  EXPECT_EQ(efforts(chainAlong(turnAboutX(0, 1))), revolute(none));
  EXPECT_EQ(efforts(chainAlong(turnAboutX(-1, 0))), revolute(none));
  EXPECT_EQ(efforts(chainAlong(turnAboutX(0.6L, 0.8L))), revolute(kPlaneTimesVector));
  EXPECT_EQ(revolute(none), (Cost{84, 74}));
  EXPECT_EQ(revolute(kPlaneTimesVector), (Cost{104, 84}));
  // A turn about the joint's own axis goes into its angle: Rz(q) Rz(phase).
  Matrix3l quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(efforts(chainAlong(quarter)), revolute(none) + (Cost{4, 2}));
  // The axes of the child link are those of the recursion, in another order; and with other signs.
  const auto chain = chainAlong(Matrix3l::Identity());
  EXPECT_EQ(costOfOneMore(chain, true, false, false, false), efforts(chain));
  const auto backwards = chainAlong(Matrix3l::Identity(), JointType::kRevolute, -1);
  EXPECT_EQ(costOfOneMore(backwards, true, false, false, false), efforts(backwards) + (Cost{6, 0}));
}

TEST(PlanSummary, CountsAPrismaticJoint) {
  RobotBuilder random(3);
  const Matrix3l frame = random.rotation();
  const Cost slide{3, 3};  // r contains it: on the way out and on the way back
  const Cost prismatic = 2 * slide + kAddMatrixTimesVector + 3 * kMatrixTimesVector + (Cost{2, 4}) +
                         kGradient + kInertia + 2 * kAddVector + 2 * kMatrixTimesVector + kAddCross;
  EXPECT_EQ(costOfOneMore(chainAlong(frame, JointType::kPrismatic), false, false, false, false),
            prismatic);

  // Alone on the root: m gamma and h x gamma of a body that does not turn, and gamma.z + qdd.
  const PlanSummary summary = summaryOf(chainAlong(frame, JointType::kPrismatic)(1), Scene(), {});
  EXPECT_EQ(costOf(summary), (Cost{3 + 6, 6 + 3}) + (Cost{0, 1}));
  EXPECT_EQ(summary.sines_and_cosines, 0u);
}

// No inertia, no products with it; but the wrench of what it carries goes through it.
TEST(PlanSummary, CountsNoInertiaOfBodiesWithout) {
  RobotBuilder builder = chainOf(5);
  const Cost all = costOf(summaryOf(builder.build(), Scene(), Request()));
  builder.removeInertia(3);
  EXPECT_EQ(costOf(summaryOf(builder.build(), Scene(), Request())), all - kInertia);
}

// Nobody asks for the sum at the root.
TEST(PlanSummary, BranchesOnTheRootCostNothingTogether) {
  RobotBuilder builder = chainOf(2);
  const Cost one = costOf(summaryOf(builder.build(), Scene(), Request()));
  builder.add(0);
  builder.add(3);
  EXPECT_EQ(costOf(summaryOf(builder.build(), Scene(), Request())), 2 * one);
}

// A joint on a fixed one that is kept starts from rest as on the root.
TEST(PlanSummary, KnowsWhatRests) {
  RobotBuilder builder(1);
  const Matrix3l R_PK = builder.rotation();
  builder.add(JointType::kFixed, 0, Vector3l::Zero(), R_PK, builder.vector(0.1));
  builder.add(1);
  const Mechanism mechanism = builder.build();
  Request request;
  const Cost merged = costOf(summaryOf(mechanism, Scene(), request));
  request.child_axes = {"joint_1"};
  const PlanSummary kept = summaryOf(mechanism, Scene(), request);
  EXPECT_EQ(kept.left_out[0], "motion of the parent, which rests (2): joint_1, joint_2");
  const Cost body = kScaleVector + (Cost{6, 9}), sum = 2 * kAddVector;
  const Cost carried = kTurnWrench + 2 * kMatrixTimesVector + kAddCross;
  EXPECT_EQ(costOf(kept), merged + body + carried + sum);
}

Scene pendulumScene() {
  Scene scene;
  scene.gravity = {9.81, 0, 0};
  return scene;
}

// Both rods turn about z, have no products of inertia, and lie along x.
constexpr Cost kRodAtRest{3 + 6, 6 + 3};        // m gamma, h x gamma
constexpr Cost kRod{3 + 6 + 9 + 6, 9 + 6 + 3};  // and G U, U h
constexpr Cost kTurnGamma{4, 2};
constexpr Cost kAlongX{3, 3};              // U r
constexpr Cost kHandOn{8 + 2, 4 + 2 + 6};  // by Rz, r x F, and the sum

TEST(PlanSummary, CountsThePendulumAtRest) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  Scene scene = pendulumScene();
  scene.static_motion = true;
  const PlanSummary summary = summaryOf(mechanism, scene, Request());
  EXPECT_EQ(costOf(summary), 2 * (kTurnGamma + kRodAtRest) + kHandOn);
  EXPECT_EQ(costOf(summary), (Cost{36, 34}));
  EXPECT_EQ(summary.sines_and_cosines, 2u);
  EXPECT_EQ(summary.bodies, 3u);
  EXPECT_EQ(summary.left_out,
            (std::vector<std::string>{"motion of the parent, which rests (1): joint_1",
                                      "velocities and accelerations: the scene is static",
                                      "reactions in link axes: not requested",
                                      "reactions in root axes: not requested",
                                      "poses: nothing requested needs them"}));
}

TEST(PlanSummary, CountsThePendulum) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  // The first rod: -qd qd; and U h, G U with the four entries of U that a turn about z has.
  const Cost first = (Cost{1, 0}) + kRodAtRest + (Cost{4 + 5, 4 + 5});
  const Cost second = kAlongX + kTurnMotion + kGradient + kRod + kHandOn;
  const PlanSummary summary = summaryOf(mechanism, pendulumScene(), Request());
  EXPECT_EQ(costOf(summary), kTurnGamma + first + second);
  EXPECT_EQ(costOf(summary), (Cost{85, 72}));
  EXPECT_EQ(summary.sines_and_cosines, 2u);

  // Without gravity nothing depends on the first angle, and the first joint does not accelerate.
  Scene weightless;
  weightless.gravity.setZero();
  const PlanSummary reduced = summaryOf(mechanism, weightless, Request());
  EXPECT_EQ(costOf(reduced), first - kRodAtRest + second);
  EXPECT_EQ(costOf(reduced), (Cost{72, 61}));
  EXPECT_EQ(reduced.sines_and_cosines, 1u);
  EXPECT_EQ(reduced.left_out[0], "positions that matter to no requested result (1): joint_1");
  EXPECT_EQ(reduced.left_out[2], "gravity: it is zero");
}

// link_1 on the root carries a welded link_2, a link_3 without inertia, and link_4; link_5 stands
// beside it. The names of what is left out for the sake of joint_4 alone.
TEST(PlanSummary, NamesWhatIsLeftOut) {
  RobotBuilder builder = chainOf(1);
  const Matrix3l R_PK = builder.rotation();
  builder.add(JointType::kFixed, 1, Vector3l::Zero(), R_PK, builder.vector(0.1));
  builder.removeInertia(builder.add(1));
  builder.add(1);
  builder.add(0);
  const Mechanism mechanism = builder.build();

  const PlanSummary all = summaryOf(mechanism, Scene(), requestAll(mechanism));
  EXPECT_EQ(all.left_out,
            (std::vector<std::string>{
                "fixed joints, merged into their parents (1): joint_2",
                "reactions that are zero, as nothing with mass and no applied wrench hangs on them "
                "(1): joint_3",
                "motion of the parent, which rests (2): joint_1, joint_5"}));
  EXPECT_EQ(all.bodies, 5u);

  Request request;
  request.efforts = false;
  request.child_axes = {"joint_4"};
  const PlanSummary wrist = summaryOf(mechanism, Scene(), request);
  EXPECT_EQ(wrist.left_out,
            (std::vector<std::string>{
                "fixed joints, merged into their parents (1): joint_2",
                "joints that reach no requested result (2): joint_3, joint_5",
                "motion of the parent, which rests (1): joint_1", "efforts: not requested",
                "reactions in root axes: not requested", "poses: nothing requested needs them"}));
  EXPECT_EQ(wrist.bodies, 3u);
  EXPECT_EQ(wrist.sines_and_cosines, 2u);
  EXPECT_LT(wrist.multiplications, all.multiplications / 2);

  request.child_axes = {"joint_2"};  // kept for its reaction; joint_1 moves it
  const PlanSummary welded = summaryOf(mechanism, Scene(), request);
  EXPECT_EQ(welded.left_out[0],
            "joints that reach no requested result (3): joint_3, joint_4, joint_5");
  EXPECT_EQ(welded.bodies, 3u);
  EXPECT_EQ(welded.sines_and_cosines, 1u);

  const std::vector<std::string> lines = wrist.lines();
  ASSERT_EQ(lines.size(), 1 + wrist.left_out.size());
  EXPECT_EQ(lines[0], "one sample: " + std::to_string(wrist.multiplications) +
                          " multiplications, " + std::to_string(wrist.additions) +
                          " additions, 2 sines and cosines; bodies, with the root: 3");
  EXPECT_EQ(lines[2], "left out: joints that reach no requested result (2): joint_3, joint_5");
}

// Names of joints behind some that are left out.
TEST(PlanSummary, NamesIdleJoints) {
  RobotBuilder builder = chainOf(1);
  builder.add(0);
  builder.add(2);
  Scene weightless;
  weightless.gravity.setZero();
  Request request;
  request.efforts = false;
  request.child_axes = {"joint_3"};
  const PlanSummary summary = summaryOf(builder.build(), weightless, request);
  EXPECT_EQ(summary.left_out[0], "joints that reach no requested result (1): joint_1");
  EXPECT_EQ(summary.left_out[1], "positions that matter to no requested result (1): joint_2");
}

// Every wish less is an operation less.
TEST(PlanSummary, CountsDropWithTheRequest) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot random(seed, 20);
    const Mechanism mechanism = readUrdf(random.urdf());
    const auto expectLess = [](const PlanSummary& less, const PlanSummary& more) {
      EXPECT_LT(less.multiplications, more.multiplications);
      EXPECT_LT(less.additions, more.additions);
      EXPECT_LE(less.sines_and_cosines, more.sines_and_cosines);
      EXPECT_LE(less.bodies, more.bodies);
    };
    const PlanSummary every = summaryOf(mechanism, Scene(), requestEveryJoint(mechanism));
    const PlanSummary movable = summaryOf(mechanism, Scene(), requestAll(mechanism));
    const PlanSummary efforts = summaryOf(mechanism, Scene(), Request());
    Scene at_rest;
    at_rest.static_motion = true;
    const PlanSummary statics = summaryOf(mechanism, at_rest, Request());
    expectLess(movable, every);
    expectLess(efforts, movable);
    expectLess(statics, efforts);
    Request nothing;
    nothing.efforts = false;
    const PlanSummary none = summaryOf(mechanism, Scene(), nothing);
    EXPECT_EQ(costOf(none), (Cost{0, 0}));
    EXPECT_EQ(none.bodies, 1u);
    EXPECT_EQ(none.sines_and_cosines, 0u);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
