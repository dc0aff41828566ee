#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "loops/kinematics.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

// Roundings of a chain of some ten products of numbers up to a few hundred.
constexpr double kTolerance = 1e-13;

// A number with its first and second derivative in time: what is written for positions alone gives
// exact velocities and accelerations.
struct Jet {
  double v = 0, d = 0, dd = 0;
};
Jet operator+(const Jet& a, const Jet& b) {
  return {a.v + b.v, a.d + b.d, a.dd + b.dd};
}
Jet operator-(const Jet& a, const Jet& b) {
  return {a.v - b.v, a.d - b.d, a.dd - b.dd};
}
Jet operator*(const Jet& a, const Jet& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
}
Jet sine(const Jet& a) {
  const double s = std::sin(a.v), c = std::cos(a.v);
  return {s, c * a.d, c * a.dd - s * a.d * a.d};
}
Jet cosine(const Jet& a) {
  const double s = std::sin(a.v), c = std::cos(a.v);
  return {c, -s * a.d, -s * a.dd - c * a.d * a.d};
}
Jet root(const Jet& a) {
  const double r = std::sqrt(a.v);
  return {r, a.d / (2 * r), a.dd / (2 * r) - a.d * a.d / (4 * r * a.v)};
}

using Point = std::array<Jet, 3>;
using Rotation = std::array<Point, 3>;  // rows

Point constant(const Eigen::Vector3d& v) {
  return {{{v.x(), 0, 0}, {v.y(), 0, 0}, {v.z(), 0, 0}}};
}
Rotation constant(const Eigen::Matrix3d& R) {
  return {constant(Eigen::Vector3d(R.row(0))), constant(Eigen::Vector3d(R.row(1))),
          constant(Eigen::Vector3d(R.row(2)))};
}
Jet dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point sum(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point column(const Rotation& R, std::size_t j) {
  return {R[0][j], R[1][j], R[2][j]};
}
Point times(const Rotation& R, const Point& p) {
  return {dot(R[0], p), dot(R[1], p), dot(R[2], p)};
}
Rotation times(const Rotation& A, const Rotation& B) {
  Rotation C;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) C[i][j] = dot(A[i], column(B, j));
  }
  return C;
}
Rotation turn(const Eigen::Vector3d& u, const Jet& angle) {
  Eigen::Matrix3d cross;
  cross << 0, -u.z(), u.y(), u.z(), 0, -u.x(), -u.y(), u.x(), 0;
  const Eigen::Matrix3d along = u * u.transpose(), normal = Eigen::Matrix3d::Identity() - along;
  const Jet s = sine(angle), c = cosine(angle);
  Rotation R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      R[std::size_t(i)][std::size_t(j)] =
          Jet{along(i, j), 0, 0} + Jet{normal(i, j), 0, 0} * c + Jet{cross(i, j), 0, 0} * s;
    }
  }
  return R;
}

struct Frame {
  Rotation R;
  Point o;
};

std::vector<Frame> framesOf(const Mechanism& mechanism, const Motion& motion) {
  std::vector<Frame> frames{{constant(Eigen::Matrix3d(Eigen::Matrix3d::Identity())),
                             constant(Eigen::Vector3d(Eigen::Vector3d::Zero()))}};
  for (const Joint& joint : mechanism.joints()) {
    const Frame& parent = frames[static_cast<std::size_t>(joint.parent_link)];
    const Eigen::Vector3d axis = joint.axis_K.cast<double>();
    Frame frame{
        times(parent.R, constant(Eigen::Matrix3d(joint.R_PK.cast<double>()))),
        sum(parent.o, times(parent.R, constant(Eigen::Vector3d(joint.p_PoKo_P.cast<double>()))))};
    if (joint.coordinate >= 0) {
      const double m = joint.multiplier;
      const Eigen::Index i = joint.coordinate;
      const Jet q{m * motion.q[i] + joint.offset, m * motion.qd[i], m * motion.qdd[i]};
      if (joint.type == JointType::kPrismatic) {
        Point slide = constant(axis);
        for (Jet& entry : slide) entry = entry * q;
        frame.o = sum(frame.o, times(frame.R, slide));
      } else {
        frame.R = times(frame.R, turn(axis, q));
      }
    }
    frames.push_back(frame);
  }
  return frames;
}

Frame frameOf(const Mechanism& mechanism, const std::vector<Frame>& links, const LinkFrame& at) {
  const Frame& link = links[static_cast<std::size_t>(mechanism.linkIndex(at.link))];
  const auto fixed = [](int i, double angle) {
    return turn(Eigen::Vector3d::Unit(i), Jet{angle, 0, 0});
  };
  const Rotation R = times(fixed(2, at.rpy.z()), times(fixed(1, at.rpy.y()), fixed(0, at.rpy.x())));
  return {times(link.R, R), sum(link.o, times(link.R, constant(at.xyz)))};
}

// Entries of the child's origin and axes in the parent's frame that vanish when a joint is closed.
std::vector<Jet> conditionsOf(const Closure& closure, const Frame& P, const Frame& C) {
  Point p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = dot(column(P.R, i), {C.o[0] - P.o[0], C.o[1] - P.o[1], C.o[2] - P.o[2]});
  }
  const auto R = [&](std::size_t i, std::size_t j) { return dot(column(P.R, i), column(C.R, j)); };
  switch (closure.type) {
    case ClosureType::kFixed:
      return {p[0], p[1], p[2], R(0, 2), R(1, 2), R(0, 1)};
    case ClosureType::kRevolute:
      return {p[0], p[1], p[2], R(0, 2), R(1, 2)};
    case ClosureType::kPrismatic:
      return {p[0], p[1], R(0, 2), R(1, 2), R(0, 1)};
    case ClosureType::kCylindrical:
      return {p[0], p[1], R(0, 2), R(1, 2)};
    case ClosureType::kUniversal:
      return {p[0], p[1], p[2], R(2, 0)};
    case ClosureType::kSpherical:
      return {p[0], p[1], p[2]};
    case ClosureType::kPlanar:
      return {p[2], R(0, 2), R(1, 2)};
    default:  // a rod; other types have tests of their own
      EXPECT_EQ(closure.type, ClosureType::kDistance);
  }
  return {root(dot(p, p)) - Jet{*closure.length, 0, 0}};
}

// A tree with slides, a mimic joint and a fixed one, and a closure of each type between far links.
struct Case {
  explicit Case(unsigned seed) : builder(seed) {
    const auto add = [&](JointType type, int parent) {
      const Vector3l axis = builder.direction();
      const Matrix3l R_PK = builder.rotation();
      builder.add(type, parent, axis, R_PK, builder.vector(0.5));
    };
    add(JointType::kRevolute, 0);   // link 1
    add(JointType::kPrismatic, 1);  // 2
    add(JointType::kFixed, 2);      // 3
    add(JointType::kRevolute, 3);   // 4
    add(JointType::kRevolute, 1);   // 5
    add(JointType::kRevolute, 5);   // 6, mimics the first
    builder.mimicFirst(-1.7, 0.3);
    add(JointType::kPrismatic, 6);  // 7
    add(JointType::kRevolute, 7);   // 8
    const int ends[][2] = {{0, 8}, {4, 8}, {8, 3}, {7, 0}, {2, 6}, {5, 4}, {0, 4}, {8, 4}};
    for (int i = 0; i < 8; ++i) {
      Closure closure;
      closure.name = "closure_" + std::to_string(i);
      closure.type = static_cast<ClosureType>(i);
      closure.parent = frame(ends[i][0]);
      closure.child = frame(ends[i][1]);
      if (closure.type == ClosureType::kDistance) closure.length = 0.4;
      scene.closures.push_back(closure);
    }
  }
  LinkFrame frame(int link) {
    LinkFrame frame;
    frame.link = "link_" + std::to_string(link);
    frame.xyz = builder.vector(0.5).cast<double>();
    frame.rpy = builder.vector(2).cast<double>();
    return frame;
  }
  std::vector<Jet> conditions(const Mechanism& mechanism, const Motion& motion) const {
    std::vector<Jet> all;
    const std::vector<Frame> links = framesOf(mechanism, motion);
    for (const Closure& closure : scene.closures) {
      for (const Jet& condition : conditionsOf(closure, frameOf(mechanism, links, closure.parent),
                                               frameOf(mechanism, links, closure.child))) {
        all.push_back(condition);
      }
    }
    return all;
  }
  RobotBuilder builder;
  Scene scene;
};

TEST(LoopKinematics, ConditionsRatesAndAccelerationsAreDerivatives) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Case made(seed);
    const Mechanism mechanism = made.builder.build();
    LoopKinematics kinematics(mechanism, made.scene);
    const Motion motion = made.builder.motion();
    kinematics.setPosition(motion.q);
    kinematics.setMotion(motion);
    const std::vector<Jet> expected = made.conditions(mechanism, motion);
    ASSERT_EQ(kinematics.conditions(), static_cast<Eigen::Index>(expected.size()));
    for (std::size_t n = 0; n < expected.size(); ++n) {
      const Eigen::Index i = static_cast<Eigen::Index>(n);
      EXPECT_NEAR(kinematics.phi()[i], expected[n].v, kTolerance);
      EXPECT_NEAR(kinematics.rates()[i], expected[n].d, 10 * kTolerance);
      EXPECT_NEAR(kinematics.accelerations()[i], expected[n].dd, 1000 * kTolerance);
    }
  }
}

TEST(LoopKinematics, JacobianIsTheDerivativeByEachCoordinate) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Case made(seed);
    const Mechanism mechanism = made.builder.build();
    LoopKinematics kinematics(mechanism, made.scene);
    Motion motion = made.builder.motion();
    kinematics.setPosition(motion.q);
    motion.qdd.setZero();
    for (Eigen::Index j = 0; j < motion.q.size(); ++j) {
      motion.qd = Eigen::VectorXd::Unit(motion.q.size(), j);
      const std::vector<Jet> expected = made.conditions(mechanism, motion);
      for (std::size_t n = 0; n < expected.size(); ++n) {
        EXPECT_NEAR(kinematics.jacobian()(static_cast<Eigen::Index>(n), j), expected[n].d,
                    kTolerance);
      }
    }
  }
}

// A unit effort does work on the motion along or about the free axis.
TEST(LoopKinematics, UnitEffortDoesWorkOnTheFreeMotion) {
  RobotBuilder builder(3);
  builder.add(0);
  builder.add(1);
  const Mechanism mechanism = builder.build();
  Scene scene;
  for (const ClosureType type : {ClosureType::kRevolute, ClosureType::kPrismatic}) {
    Closure closure;
    closure.name = "closure";
    closure.type = type;
    closure.parent.link = "link_0";
    closure.child.link = "link_2";
    closure.child.xyz << 0.1, 0.2, 0.3;
    scene.closures = {closure};
    LoopKinematics kinematics(mechanism, scene);
    Motion motion = builder.motion();
    kinematics.setPosition(motion.q);
    kinematics.setMotion(motion);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(2);
    kinematics.addGeneralizedForce(0, kinematics.unitEffort(0), force);
    const Twist twist = kinematics.childTwist(0);
    const double speed = type == ClosureType::kPrismatic ? twist.linear.z() : twist.angular.z();
    EXPECT_NEAR(force[0] * motion.qd[0] + force[1] * motion.qd[1], speed, kTolerance);
    EXPECT_GT(std::abs(speed), 0.01);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
