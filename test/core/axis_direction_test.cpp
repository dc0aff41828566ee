#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "newton_euler_oracle.h"
#include "plain_results.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "tree/plan.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest result of the kind in the motion: about ten roundings in chains of four
// joints.
constexpr double kRounding = 1e-15;
// Efforts are components of moments, which may be larger.
constexpr double kEffort = 2e-15;
// A few more roundings to the quaternion of a Workspace and back.
constexpr double kQuaternion = 2e-15;

// Results of single samples against Newton's and Euler's equations in long double; errors relative
// to the largest effort, force, moment and distance of the motion. Moments count at least as much
// as the force with the body's distance from the root as its lever: such products cancel in them.
class Comparison {
 public:
  explicit Comparison(const Mechanism& mechanism) : mechanism_(mechanism) {}

  void run(const std::vector<Motion>& motions, InstructionSet set) {
    const Request request = requestEveryJoint(mechanism_);
    const InverseDynamics dynamics(mechanism_, scene_, request, set);
    Workspace workspace = dynamics.makeWorkspace();
    for (const Motion& motion : motions) {
      dynamics.compute(motion, workspace);
      const NewtonEulerOracle oracle(mechanism_, scene_, motion);
      const std::vector<long double> efforts = oracle.efforts();
      for (std::size_t i = 0; i < efforts.size(); ++i) {
        effort_.take(workspace.effort()[static_cast<Eigen::Index>(i)] - efforts[i], efforts[i]);
      }
      for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
        const int joint = mechanism_.jointIndex(request.root_axes[i]);
        const long double lever = oracle.origin(joint + 1).norm();
        compare(workspace.childAxes()[i], oracle.childReaction(joint), lever);
        compare(workspace.rootAxes()[i], oracle.reaction(joint), lever);
        comparePose(workspace, i, joint + 1, oracle);
      }
    }
  }

  void expectSmallErrors() const {
    EXPECT_LE(effort_.relative(), kEffort);
    EXPECT_LE(force_.relative(), kRounding);
    EXPECT_LE(moment_.relative(), kRounding);
    EXPECT_LE(position_.relative(), kRounding);
    EXPECT_LE(velocity_.relative(), kRounding);
    EXPECT_LE(turning_.relative(), kRounding);
    EXPECT_LE(orientation_.relative(), kQuaternion);
  }

 private:
  struct Kind {
    long double error = 0, largest = 0;

    void take(long double difference, long double size) {
      // std::max would lose NaN.
      if (!(std::abs(difference) <= error)) error = std::abs(difference);
      largest = std::max(largest, std::abs(size));
    }
    double relative() const { return error == 0 ? 0 : static_cast<double>(error / largest); }
  };

  void compare(const Wrench& wrench, const NewtonEulerOracle::RootWrench& expected,
               long double lever) {
    const long double force = expected.force.norm();
    force_.take((wrench.force.cast<long double>() - expected.force).norm(), force);
    moment_.take((wrench.torque.cast<long double>() - expected.torque).norm(),
                 std::max(expected.torque.norm(), lever * force));
  }

  void comparePose(const Workspace& workspace, std::size_t i, int link,
                   const NewtonEulerOracle& oracle) {
    const Pose& pose = workspace.poses()[i];
    const Twist& twist = workspace.twists()[i];
    const Matrix3l R = pose.orientation.cast<long double>().toRotationMatrix();
    const auto take = [](Kind& kind, const Eigen::Vector3d& v, const Vector3l& expected) {
      kind.take((v.cast<long double>() - expected).norm(), expected.norm());
    };
    orientation_.take((R - oracle.orientation(link)).cwiseAbs().maxCoeff(), 1);
    take(position_, pose.position, oracle.origin(link));
    take(velocity_, twist.linear, oracle.originVelocity(link));
    take(turning_, twist.angular, oracle.angularVelocity(link));
  }

  const Mechanism& mechanism_;
  Scene scene_;
  Kind effort_, force_, moment_, position_, orientation_, velocity_, turning_;
};

// Packs of samples treat some angles in ways of their own.
void expectBlocksAgree(const InverseDynamics& dynamics, const std::vector<Motion>& motions,
                       InstructionSet set) {
  const auto block =
      blockResults<double>(dynamics, motions, BlockLayout::kStructureOfArrays, 1, set);
  for (std::size_t n = 0; n < motions.size(); ++n) {
    PlainResults<double> single = singleResults(dynamics, motions[n]);
    single.poses = block[n].poses;
    EXPECT_EQ(differences(block[n], single), "") << "sample " << n;
  }
}

void expectOracle(const Mechanism& mechanism, const std::vector<Motion>& motions) {
  for (const InstructionSet set : supportedInstructionSets()) {
    SCOPED_TRACE(toString(set));
    Comparison comparison(mechanism);
    comparison.run(motions, set);
    comparison.expectSmallErrors();
    expectBlocksAgree(InverseDynamics(mechanism, Scene(), requestEveryJoint(mechanism), set),
                      motions, set);
  }
}

// Directions of a joint's axis in the z-aligned frame of its parent: one for each AxisDirection,
// and some that are nearly aligned.
std::vector<Vector3l> directions() {
  return {{1, 0, 0},
          {-1, 0, 0},
          {0, 1, 0},
          {0, -1, 0},
          {0, 0, 1},
          {0, 0, -1},
          {0, 0.6L, 0.8L},
          {0, -0.8L, 0.6L},
          {0.6L, 0, -0.8L},
          {-0.28L, 0, -0.96L},
          {0.8L, 0.6L, 0},
          {-0.6L, 0.8L, 0},
          {0.48L, 0.6L, 0.64L},
          {-0.48L, 0.64L, -0.6L},
          {1, 1e-11L, 0},
          {-1e-11L, 1, 0},
          {0, 1e-11L, -1},
          {1e-11L, 0, 1},
          {1e-11L, 1, 1e-17L},
          {1, 1e-30L, 0},
          {1e-30L, 1e-20L, -1}};
}

// Frames whose z axis is `axis`: by turns about x, y or z where those do, and by half a turn more
// about the axis; and two that are turned about it by other angles.
std::vector<Matrix3l> framesAlong(const Vector3l& axis) {
  const Vector3l z = axis.normalized();
  std::vector<Matrix3l> frames;
  Matrix3l R;
  if (z.x() == 0) {
    R << 1, 0, 0, 0, z.z(), z.y(), 0, -z.y(), z.z();
    frames.push_back(R);
  } else if (z.y() == 0) {
    R << z.z(), 0, z.x(), 0, 1, 0, -z.x(), 0, z.z();
    frames.push_back(R);
  } else if (z.z() == 0) {
    R << 0, -z.y(), z.x(), 0, z.x(), z.y(), -1, 0, 0;
    frames.push_back(R);
  }
  if (!frames.empty()) frames.push_back(R * Vector3l(-1, -1, 1).asDiagonal());
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  R.col(0) = Vector3l::Unit(least).cross(z).normalized();
  R.col(1) = z.cross(R.col(0));
  R.col(2) = z;
  frames.push_back(R);
  frames.push_back(R * Eigen::AngleAxis<long double>(-2, Vector3l::UnitZ()).toRotationMatrix());
  return frames;
}

// Revolute joint, the joint in question, two more behind it. The frame is in its parent's, which is
// z-aligned: the parent's joint turns about its own z.
RobotBuilder withJoint(JointType type, const Matrix3l& frame, unsigned seed) {
  RobotBuilder builder(seed);
  const Matrix3l first = builder.rotation();
  builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), first, builder.vector(0.3));
  builder.add(type, 1, Vector3l::UnitZ(), frame, builder.vector(0.3));
  builder.add(2);
  const Matrix3l last = builder.rotation();
  builder.add(JointType::kPrismatic, 3, builder.direction(), last, builder.vector(0.3));
  return builder;
}

class AxisOfAJoint : public ::testing::TestWithParam<JointType> {};

TEST_P(AxisOfAJoint, MayPointAnywhere) {
  unsigned seed = 0;
  for (const Vector3l& axis : directions()) {
    for (const Matrix3l& frame : framesAlong(axis)) {
      SCOPED_TRACE(testing::Message() << "frame\n" << frame.cast<double>());
      RobotBuilder builder = withJoint(GetParam(), frame, ++seed);
      expectOracle(builder.build(), builder.motions(20));
    }
  }
}

// The joint is on the root, where motion starts, alone or as a branch beside another body.
TEST_P(AxisOfAJoint, MayPointAnywhereOnTheRoot) {
  unsigned seed = 1000;
  for (const Vector3l& axis : directions()) {
    for (const Matrix3l& frame : framesAlong(axis)) {
      SCOPED_TRACE(testing::Message() << "frame\n" << frame.cast<double>());
      RobotBuilder builder(++seed);
      builder.add(GetParam(), 0, Vector3l::UnitZ(), frame, builder.vector(0.3));
      builder.add(1);
      builder.add(1);
      builder.add(0);
      expectOracle(builder.build(), builder.motions(20));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, AxisOfAJoint,
                         ::testing::Values(JointType::kRevolute, JointType::kPrismatic,
                                           JointType::kFixed));

// The tests above cover every kind: each direction has products of its own.
TEST_P(AxisOfAJoint, HasAKind) {
  using Kind = AxisDirection;
  const std::vector<Kind> expected = {
      Kind::kPlusX,     Kind::kMinusX,    Kind::kPlusY,     Kind::kMinusY,    Kind::kPlusZ,
      Kind::kMinusZ,    Kind::kNormalToX, Kind::kNormalToX, Kind::kNormalToY, Kind::kNormalToY,
      Kind::kNormalToZ, Kind::kNormalToZ, Kind::kOblique,   Kind::kOblique,   Kind::kNormalToZ,
      Kind::kNormalToZ, Kind::kNormalToX, Kind::kNormalToY};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::vector<Matrix3l> frames = framesAlong(directions()[i]);
    const Mechanism mechanism = withJoint(GetParam(), frames.front(), 1).build();
    const auto plan = compilePlan(mechanism, Scene(), requestEveryJoint(mechanism));
    EXPECT_EQ(plan.bodies[2].axis, expected[i]) << "direction " << i;
    // A joint that does not turn cannot take a turn about its axis along.
    const Mechanism turned = withJoint(GetParam(), frames.back(), 1).build();
    const auto turned_plan = compilePlan(turned, Scene(), requestEveryJoint(turned));
    EXPECT_EQ(turned_plan.bodies[2].axis,
              GetParam() == JointType::kRevolute ? expected[i] : Kind::kOblique);
  }
}

// Axes as descriptions give them: along the axes of the child link, whose frame is turned by exact
// quarter turns or by the nearest doubles to them.
TEST(AxisDirection, QuarterTurnsOfOriginsAndAxes) {
  const std::vector<std::string> axes = {"1 0 0",  "-1 0 0",    "0 1 0",     "0 -1 0", "0 0 1",
                                         "0 0 -1", "1 1e-11 0", "0.6 0 0.8", "1 1 1"};
  const std::vector<std::string> turns = {"0", "1.5707963267948966", "-1.5707963267948966",
                                          "3.141592653589793", "1.5708"};
  static const char* const kTypes[] = {"revolute", "prismatic", "fixed"};
  unsigned count = 0;
  for (const std::string& roll : turns) {
    for (const std::string& pitch : turns) {
      for (const std::string& yaw : turns) {
        std::string urdf = "<robot name='r'><link name='l0'/>";
        const std::string rpy = roll + ' ' + pitch + ' ' + yaw;
        SCOPED_TRACE(rpy);
        for (int i = 1; i <= 4; ++i, ++count) {
          const std::string name = std::to_string(i);
          urdf += "<link name='l" + name +
                  "'><inertial><origin xyz='0.1 -0.2 0.3'/><mass value='2'/><inertia ixx='0.3' "
                  "iyy='0.2' izz='0.4' ixy='0.01' ixz='0.02' iyz='-0.03'/></inertial></link>"
                  "<joint name='j" +
                  name + "' type='" + kTypes[(count / 2) % 3] + "'><parent link='l" +
                  std::to_string(i - 1) + "'/><child link='l" + name +
                  "'/><origin xyz='0.3 0.2 -0.1' rpy='" + rpy + "'/><axis xyz='" +
                  axes[count % axes.size()] +
                  "'/><limit lower='-3' upper='3' effort='1' velocity='1'/></joint>";
        }
        const Mechanism mechanism = readUrdf(urdf + "</robot>");
        std::vector<Motion> motions;
        RandomRobot random_motion(count, 2);
        for (int n = 0; n < 5; ++n) motions.push_back(random_motion.motion(mechanism));
        expectOracle(mechanism, motions);
      }
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
