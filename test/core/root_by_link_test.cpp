#include "dynamics/root_by_link.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "tumbling_roots.h"
#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// A ball joint, a mimicking hinge, a slide and a fixed one on the way to `hand`.
const Mechanism& chain() {
  static const Mechanism mechanism = readUrdf(R"(<robot name="r"><link name="base"/>
    <link name="a"/><link name="b"/><link name="c"/><link name="hand"/><link name="other"/>
    <joint name="ball" type="floating"><parent link="base"/><child link="a"/>
      <origin xyz="0.3 -0.2 0.5" rpy="0.4 -0.3 0.8"/></joint>
    <joint name="hinge" type="continuous"><parent link="a"/><child link="b"/>
      <origin xyz="0.1 0.4 -0.2" rpy="1 0.2 -0.5"/><axis xyz="1 2 -1"/>
      <mimic joint="lead" multiplier="-1.5" offset="0.2"/></joint>
    <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/>
      <origin xyz="0.2 0 0.1" rpy="-0.7 0.1 0.2"/><axis xyz="0 3 4"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="mount" type="fixed"><parent link="c"/><child link="hand"/>
      <origin xyz="0 0.1 0.2" rpy="0.3 0.6 0.9"/></joint>
    <joint name="lead" type="continuous"><parent link="base"/><child link="other"/>
      <axis xyz="0 0 1"/></joint></robot>)");
  return mechanism;
}

// The joints' motion, in closed form.
struct Course {
  Eigen::Vector3d shift(double t) const {
    return {0.3 * std::sin(2 * t), 0.2 * std::cos(1.3 * t), 0.4 * std::sin(t + 1)};
  }
  double lead(double t) const { return 0.8 * std::sin(1.7 * t + 0.4); }
  double slide(double t) const { return 0.3 * std::cos(2.1 * t); }
  // The ball turns as a root does that tumbles.
  TumblingRoot ball{{1, -0.4, 0.2}, 0.9};
};

// Fifth-order differences of a function of time: 0, 1 or 2.
template <typename Value>
Value derivative(const std::function<Value(double)>& of, double t, int order) {
  const double h = 4e-3;
  const Value a = of(t - 3 * h), b = of(t - 2 * h), c = of(t - h), d = of(t), e = of(t + h),
              f = of(t + 2 * h), g = of(t + 3 * h);
  if (order == 1) return (-a + 9 * b - 45 * c + 45 * e - 9 * f + g) / (60 * h);
  return (2 * a - 27 * b + 270 * c - 490 * d + 270 * e - 27 * f + 2 * g) / (180 * h * h);
}

Eigen::Isometry3d placed(const Joint& joint) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = joint.R_PK.cast<double>();
  pose.translation() = joint.p_PoKo_P.cast<double>();
  return pose;
}

const Joint& jointNamed(const std::string& name) {
  return chain().joint(chain().jointIndex(name));
}

// The pose of the hand by a product of transforms, against the inertial frame.
Eigen::Isometry3d handAt(double t) {
  const Course course;
  const RootMotion root = TumblingRoot().at(t);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = root.orientation.toRotationMatrix();
  pose.translation() = root.position;
  Eigen::Isometry3d ball = Eigen::Isometry3d::Identity();
  ball.translate(Eigen::Vector3d(0.3, -0.2, 0.5));
  ball.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
  ball.translate(course.shift(t));
  ball.rotate(course.ball.at(t).orientation);
  Eigen::Isometry3d hinge = placed(jointNamed("hinge"));
  hinge.rotate(
      Eigen::AngleAxisd(-1.5 * course.lead(t) + 0.2, Eigen::Vector3d(1, 2, -1).normalized()));
  Eigen::Isometry3d slide = placed(jointNamed("slide"));
  slide.translate(course.slide(t) * Eigen::Vector3d(0, 0.6, 0.8));
  return pose * ball * hinge * slide * placed(jointNamed("mount"));
}

Motion jointsAt(double t) {
  const Mechanism& mechanism = chain();
  const Course course;
  Motion motion(static_cast<Eigen::Index>(mechanism.coordinates().size()),
                mechanism.orientations());
  const auto set = [&](const std::string& name, const std::function<double(double)>& of) {
    const int i = mechanism.coordinateIndex(name);
    ASSERT_GE(i, 0) << name;
    motion.q[i] = of(t);
    motion.qd[i] = derivative<double>(of, t, 1);
    motion.qdd[i] = derivative<double>(of, t, 2);
  };
  for (int axis = 0; axis < 3; ++axis)
    set(std::string("ball.") + "xyz"[axis], [&](double at) { return course.shift(at)[axis]; });
  set("lead", [&](double at) { return course.lead(at); });
  set("slide", [&](double at) { return course.slide(at); });
  const RootMotion ball = course.ball.at(t);
  const Eigen::Quaterniond back = ball.orientation.conjugate();
  setFreeTurn(mechanism, 0,
              {ball.orientation, back * ball.angular_velocity, back * ball.angular_acceleration},
              motion);
  return motion;
}

Eigen::Vector3d vectorOf(const Eigen::Matrix3d& antisymmetric) {
  const Eigen::Matrix3d m = (antisymmetric - antisymmetric.transpose()) / 2;
  return {m(2, 1), m(0, 2), m(1, 0)};
}

// The hand's motion by differences of its pose: R' R^T and R'' R^T + R' R'^T.
RootMotion handMotionAt(double t) {
  const std::function<Eigen::Matrix3d(double)> turn = [](double at) {
    return Eigen::Matrix3d(handAt(at).linear());
  };
  const std::function<Eigen::Vector3d(double)> place = [](double at) {
    return Eigen::Vector3d(handAt(at).translation());
  };
  const Eigen::Matrix3d R = turn(t), first = derivative(turn, t, 1),
                        second = derivative(turn, t, 2);
  RootMotion hand;
  hand.position = place(t);
  hand.velocity = derivative(place, t, 1);
  hand.acceleration = derivative(place, t, 2);
  hand.orientation = R;
  hand.angular_velocity = vectorOf(first * R.transpose());
  hand.angular_acceleration = vectorOf(second * R.transpose() + first * first.transpose());
  return hand;
}

void expectSame(const RootMotion& one, const RootMotion& other) {
  // Of differences whose rounding is 1e-16 / h^2, at accelerations of some 10.
  constexpr double kDifferences = 2e-9;
  EXPECT_LT((one.position - other.position).norm(), 1e-13);
  EXPECT_LT(angleBetween(one, other), 1e-13);
  EXPECT_LT((one.velocity - other.velocity).norm(), kDifferences);
  EXPECT_LT((one.angular_velocity - other.angular_velocity).norm(), kDifferences);
  EXPECT_LT((one.acceleration - other.acceleration).norm(), 10 * kDifferences);
  EXPECT_LT((one.angular_acceleration - other.angular_acceleration).norm(), 10 * kDifferences);
}

TEST(RootByLink, MatchesDifferencesOfPoses) {
  RootByLink by_link(chain());
  for (const double t : {0.3, 1.1, 2.7, 4.2}) {
    SCOPED_TRACE(t);
    by_link.place(jointsAt(t), chain().linkIndex("hand"));
    const RootMotion root = TumblingRoot().at(t), hand = handMotionAt(t);
    ASSERT_GT((hand.acceleration - root.acceleration).norm(), 0.5);
    expectSame(by_link.linkOf(root), hand);
    expectSame(by_link.rootOf(hand), root);
  }
}

TEST(RootByLink, OfTheRootItselfChangesNothing) {
  RootByLink by_link(chain());
  by_link.place(jointsAt(1), 0);
  const RootMotion root = TumblingRoot().at(1);
  EXPECT_LT((by_link.rootOf(root).acceleration - root.acceleration).norm(), 1e-15);
  EXPECT_LT(angleBetween(by_link.rootOf(root), root), 1e-15);
}

}  // namespace
}  // namespace virtual_work_dynamics
