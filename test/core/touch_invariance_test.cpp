#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "touching_bodies.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Two ways to the same numbers, relative to the largest force.
constexpr double kTolerance = 1e-12;

// A body that slides and turns in all directions, with a wheel and a blade on a ramp, in a motion
// that no condition allows: their forces are linear in the accelerations all the same.
struct OnARamp {
  double scale = 1;  // of lengths: the unit is m / scale

  Mechanism mechanism() const {
    BodiesOnAxes bodies;
    int link = 0;
    for (const Vector3l& axis : {bodies.x(), bodies.y(), bodies.z()}) {
      link = bodies.slide(link, axis);
    }
    link = bodies.turn(bodies.turn(link, bodies.z()), bodies.x());
    const long double k = scale;
    bodies.load(link, 3, {0.5L * k * k, 0.6L * k * k, 0.7L * k * k},
                {0.1L * k, 0.2L * k, 0.3L * k});
    bodies.load(bodies.turn(link, bodies.y(), {0.3L * k, 0, 0}), 1,
                {0.02L * k * k, 0.04L * k * k, 0.02L * k * k});
    return bodies.build();
  }

  Scene scene() const {
    Scene scene = sceneOf(R"(
rolling:
  - {name: wheel, link: link_6, axis: [0, 1, 0], radius: 0.2, tube_radius: 0.05,
     plane: {link: link_0, point: [0, 0, 0.1], normal: [0.1, -0.2, 1]}}
  - {name: roller, link: link_6, centre: [0, 0.1, 0], axis: [0, 1, 0], radius: 0.2,
     roller_angle: 0.6, normal: false,
     plane: {link: link_0, point: [0, 0, 0.1313], normal: [0.1, -0.2, 1]}}
knife_edges:
  - {name: blade, link: link_5, at: [-0.3, 0.1, -0.2], direction: [1, 0, 0], normal: false,
     plane: {link: link_0, point: [0, 0, 0.1], normal: [0.1, -0.2, 1]}}
gravity: [0, 0, -9.81]
actuated: [joint_6]
free_motion: true
assembly: [{name: joint_3, position: 0.3}]
)");
    for (Closure& closure : scene.closures) {
      closure.parent.xyz *= scale;
      closure.child.xyz *= scale;
      closure.touch.radius *= scale;
      closure.touch.tube_radius *= scale;
    }
    scene.gravity *= scale;
    scene.assembly[0].value *= scale;
    return scene;
  }

  Motion motion() const {
    Motion motion = motionOf({0.2, -0.1, 0.4, 0.5, 0.2, 0.9}, {0.3, 0.2, -0.5, 0.7, -0.3, 1.1},
                             {-0.6, 0.8, 0.2, 0.5, 1.3, -0.9});
    for (Eigen::VectorXd* rates : {&motion.q, &motion.qd, &motion.qdd}) rates->head<3>() *= scale;
    return motion;
  }

  NamedLoopResults results(const Mechanism& of, const Scene& scene) const {
    return NamedLoopResults(of, scene, motion());
  }
};

const std::vector<std::string> kTouches{"wheel", "roller", "blade"};

// Results agree in what both determine, and both determine the same.
void expectEqual(const NamedLoopResults& a, const NamedLoopResults& b) {
  double largest = 1;
  for (const std::string& name : kTouches) {
    largest = std::max(largest, a.rootAxes(name).force.cwiseAbs().maxCoeff());
  }
  ASSERT_EQ(a.names().size(), b.names().size());
  for (const std::string& name : a.names()) {
    EXPECT_EQ(a.rootAxesDetermined(name), b.rootAxesDetermined(name)) << name;
    for (int i = 0; i < 6; ++i) {
      if (!a.rootAxesDetermined(name)[static_cast<std::size_t>(i)]) continue;
      EXPECT_NEAR(component(a.rootAxes(name), i), component(b.rootAxes(name), i),
                  kTolerance * largest)
          << name << " " << i;
    }
  }
  EXPECT_NEAR(a.effort("joint_6"), b.effort("joint_6"), kTolerance * largest);
}

TEST(TouchInvariance, NothingDependsOnHowTheWheelAndThePlaneAreGiven) {
  const OnARamp ramp;
  const Mechanism mechanism = ramp.mechanism();
  const Scene scene = ramp.scene();
  const NamedLoopResults results = ramp.results(mechanism, scene);
  EXPECT_GT(results.rootAxes("wheel").force.norm(), 1);
  EXPECT_GT(results.rootAxes("roller").force.norm(), 1);
  EXPECT_GT(results.rootAxes("blade").force.norm(), 1);

  Scene reversed = scene;  // the axle the other way round
  for (Closure& closure : reversed.closures) closure.child.rpy.x() += M_PI;
  const NamedLoopResults of_reversed = ramp.results(mechanism, reversed);
  expectEqual(results, of_reversed);
  // Along the wheel it is the other way round, too.
  const Eigen::Vector3d one = results.childAxes("wheel").force,
                        other = of_reversed.childAxes("wheel").force;
  expectForce({-one.x(), -one.y(), one.z()}, other, kTolerance * one.norm());

  Scene turned = scene;  // other axes and another point of the same plane
  for (Closure& closure : turned.closures) {
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(closure.parent.rpy.y(), Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(closure.parent.rpy.x(), Eigen::Vector3d::UnitX()))
                                  .toRotationMatrix();
    closure.parent.xyz += 0.7 * R.col(0) - 1.1 * R.col(1);
  }
  expectEqual(results, ramp.results(mechanism, turned));

  Scene shuffled = scene;
  std::reverse(shuffled.closures.begin(), shuffled.closures.end());
  expectEqual(results, ramp.results(mechanism, shuffled));
}

TEST(TouchInvariance, NothingDependsOnTheUnitOfLength) {
  const OnARamp metres, millimetres{1000};
  const Mechanism in_metres = metres.mechanism(), in_millimetres = millimetres.mechanism();
  const NamedLoopResults a = metres.results(in_metres, metres.scene());
  const NamedLoopResults b = millimetres.results(in_millimetres, millimetres.scene());
  for (const std::string& name : kTouches) {
    EXPECT_EQ(a.rootAxesDetermined(name), b.rootAxesDetermined(name));
    const Eigen::Vector3d expected = a.rootAxes(name).force;
    expectForce(expected, b.rootAxes(name).force / 1000, kTolerance * expected.norm());
  }
  EXPECT_NEAR(a.effort("joint_6"), b.effort("joint_6") / 1e6, kTolerance * 100);
}

// Lagrange's equations, which know nothing of conditions, with the forces of the contacts as loads.
TEST(TouchInvariance, LagrangesEquationsFindTheSameEfforts) {
  const OnARamp ramp;
  const Mechanism mechanism = ramp.mechanism();
  Request request;
  request.root_axes = kTouches;
  ClosedLoops loops(mechanism, ramp.scene(), request);
  const Motion motion = ramp.motion();
  loops.compute(motion);
  LagrangeDynamics<double> lagrange(mechanism, loops.tree(), {});
  lagrange.compute(motion, loops.treeLoad());
  const Eigen::VectorXd& expected = lagrange.effort();
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(loops.effort()[i], expected[i], kTolerance * 100) << i;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
