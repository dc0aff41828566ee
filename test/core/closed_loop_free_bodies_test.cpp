#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "named_loop_results.h"
#include "planar_free_bodies.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms in double against long double, of forces of some 10 N.
constexpr double kClosedForm = 1e-12;
// Six legs or three chains, through a system of equations.
constexpr double kParallel = 1e-11;

const std::vector<double> kTimes{0.1, 0.55, 0.9, 1.7};

// Determined, and of that value relative to the largest expected or 1.
void expectDetermined(const NamedLoopResults& results, const std::string& joint, int i,
                      long double value, double tolerance) {
  const std::string label = joint + ", component " + std::to_string(i);
  EXPECT_TRUE(results.rootAxesDetermined(joint)[static_cast<std::size_t>(i)]) << label;
  const double expected = static_cast<double>(value);
  EXPECT_NEAR(component(results.rootAxes(joint), i), expected,
              tolerance * std::max(1.0, std::abs(expected)))
      << label;
}

void expectPin(const NamedLoopResults& results, const std::string& joint,
               const PlanarFreeBodies::Vector& x, int pin, double tolerance) {
  expectDetermined(results, joint, 0, x[pin], tolerance);
  expectDetermined(results, joint, 1, x[pin + 1], tolerance);
  for (const std::size_t out_of_plane : {2, 3, 4}) {
    EXPECT_FALSE(results.rootAxesDetermined(joint)[out_of_plane]) << joint;
    EXPECT_FALSE(results.childAxesDetermined(joint)[out_of_plane]) << joint;
  }
}

void expectEffort(const NamedLoopResults& results, const std::string& joint, long double value,
                  double tolerance) {
  EXPECT_TRUE(results.effortDetermined(joint)) << joint;
  const double expected = static_cast<double>(value);
  EXPECT_NEAR(results.effort(joint), expected, tolerance * std::max(1.0, std::abs(expected)))
      << joint;
}

// Centre of mass at `distance` from a pin on a bar that points along `angle`, with the angle.
Vector3l onBar(const Vector2l& pin, long double distance, long double angle) {
  const Vector2l c = pin + distance * along(angle);
  return {c.x(), c.y(), angle};
}

TEST(FourBar, InPlaneForcesMatchFreeBodies) {
  const LoopExample example("four_bar");
  const auto crank = [](long double t) { return crankAngle(t); };
  const auto a = [&](long double t) { return Vector2l(0.12L * along(crank(t))); };
  const auto o = [](long double) { return Vector2l(0, 0); };
  const auto c = [](long double) { return Vector2l(0.40L, 0); };
  const auto pin = [&](long double t) { return corner(a(t), c(t), 0.36L, 0.28L, 1); };
  for (const double t : kTimes) {
    PlanarFreeBodies bodies(t, {0, -9.81});
    const int base = PlanarFreeBodies::kBase;
    const int first =
        bodies.body(0.30, 0.00036, [&](long double s) { return onBar(o(s), 0.06L, crank(s)); });
    const int second = bodies.body(
        0.90, 0.00972, [&](long double s) { return onBar(a(s), 0.18L, angleOf(pin(s) - a(s))); });
    const int third = bodies.body(
        0.70, 0.00457, [&](long double s) { return onBar(c(s), 0.14L, angleOf(pin(s) - c(s))); });
    const int motor = bodies.motor(base, first);
    const int at_o = bodies.pin(base, first, o), at_a = bodies.pin(first, second, a);
    const int at_c = bodies.pin(base, third, c), at_pin = bodies.pin(second, third, pin);
    const auto x = bodies.solve();
    const NamedLoopResults results(example.mechanism, example.scene,
                                   motionAt(example.mechanism, fourBarAt, t));
    expectPin(results, "crank_joint", x, at_o, kClosedForm);
    expectPin(results, "coupler_joint", x, at_a, kClosedForm);
    expectPin(results, "rocker_joint", x, at_c, kClosedForm);
    expectPin(results, "rocker_pin", x, at_pin, kClosedForm);
    expectEffort(results, "crank_joint", x[motor], kClosedForm);
    expectDetermined(results, "crank_joint", 5, x[motor], kClosedForm);
  }
}

TEST(SliderCrank, MatchesItsClosedForm) {
  const LoopExample example("slider_crank");
  const Vector2l up{0, 9.81L};  // what holds against gravity
  const auto rodAngle = [](long double t) {
    return -std::asin(0.10L / 0.30L * std::sin(crankAngle(t)));
  };
  const auto cross = [](const Vector2l& r, const Vector2l& f) {
    return r.x() * f.y() - r.y() * f.x();
  };
  for (const double t : kTimes) {
    const auto crank = withDerivatives(
        [](long double s) { return onBar(Vector2l::Zero(), 0.03L, crankAngle(s)); }, t);
    const auto rod = withDerivatives(
        [&](long double s) { return onBar(0.10L * along(crankAngle(s)), 0.11L, rodAngle(s)); }, t);
    const auto slider = withDerivatives(
        [&](long double s) {
          return Vector2l(0.10L * along(crankAngle(s)) + 0.30L * along(rodAngle(s)));
        },
        t);
    // Force W of the rod on the slider: its x moves the slider, its y balances the rod's moments
    // about the crank pin; then P of the crank on the rod, C of the base on the crank, N of the
    // guide on the slider.
    const Vector2l u = along(rodAngle(t)), e = along(crankAngle(t));
    const Vector2l rod_load = 0.50L * (rod.acceleration.head<2>() + up);
    const Vector2l crank_load = 0.80L * (crank.acceleration.head<2>() + up);
    const long double turning = 0.0045L * rod.acceleration.z() + cross(0.11L * u, rod_load);
    const long double w_x = 0.60L * slider.acceleration.x();
    const long double w_y = (0.30L * u.y() * w_x - turning) / (0.30L * u.x());
    const Vector2l p = rod_load + Vector2l(w_x, w_y);
    const Vector2l c = crank_load + p;
    const long double torque =
        0.0012L * crank.acceleration.z() + cross(0.03L * e, crank_load) + cross(0.10L * e, p);
    const NamedLoopResults results(example.mechanism, example.scene,
                                   motionAt(example.mechanism, sliderCrankAt, t));
    const PlanarFreeBodies::Vector x = (PlanarFreeBodies::Vector(6) << w_x, w_y, p, c).finished();
    expectPin(results, "wrist_pin", x, 0, kClosedForm);
    expectPin(results, "rod_joint", x, 2, kClosedForm);
    expectPin(results, "crank_joint", x, 4, kClosedForm);
    expectEffort(results, "crank_joint", torque, kClosedForm);
    expectDetermined(results, "slider_joint", 1, 0.60L * 9.81L - w_y, kClosedForm);
    expectDetermined(results, "slider_joint", 5, 0, kClosedForm);
  }
}

TEST(Planar3Rrr, InPlaneForcesMatchFreeBodies) {
  const LoopExample example("planar_3rrr");
  struct Leg {
    int motor, at_motor, at_elbow, at_wrist;
  };
  for (const double t : kTimes) {
    PlanarFreeBodies bodies(t, {0, 0});
    const int base = PlanarFreeBodies::kBase;
    // The platform's centre of mass is 0.1 m from vertex 1 towards the centre: at the centre.
    const int platform = bodies.body(1.2, 0.005, planarPose);
    std::vector<Leg> legs;
    for (int i = 0; i < 3; ++i) {
      const long double place = kPi / 2 + i * 2 * kPi / 3;
      const Vector2l pivot = 0.35L * along(place);
      const auto vertex = [=](long double s) {
        const Vector3l pose = planarPose(s);
        return Vector2l(pose.head<2>() + 0.10L * along(place + pose.z()));
      };
      const auto elbow = [=](long double s) { return corner(pivot, vertex(s), 0.20L, 0.20L, 1); };
      // Angles from the direction of the motor's place, so that none jumps.
      const auto angle = [=](const Vector2l& v) {
        return angleOf(Eigen::Rotation2D<long double>(-place - kPi) * v);
      };
      const auto bar = [=](const Vector2l& from, const Vector2l& to) {
        const Vector2l c = (from + to) / 2;
        return Vector3l(c.x(), c.y(), angle(to - from));
      };
      const int arm =
          bodies.body(0.4, 0.00135, [=](long double s) { return bar(pivot, elbow(s)); });
      const int forearm =
          bodies.body(0.3, 0.00102, [=](long double s) { return bar(elbow(s), vertex(s)); });
      legs.push_back({bodies.motor(base, arm),
                      bodies.pin(base, arm, [=](long double) { return pivot; }),
                      bodies.pin(arm, forearm, elbow), bodies.pin(forearm, platform, vertex)});
    }
    const auto x = bodies.solve();
    const NamedLoopResults results(example.mechanism, example.scene,
                                   motionAt(example.mechanism, planar3rrrAt, t));
    for (int i = 0; i < 3; ++i) {
      const std::string n = std::to_string(i + 1);
      expectEffort(results, "motor_" + n, x[legs[i].motor], kParallel);
      expectPin(results, "motor_" + n, x, legs[i].at_motor, kParallel);
      expectPin(results, "elbow_" + n, x, legs[i].at_elbow, kParallel);
      expectPin(results, "wrist_" + n, x, legs[i].at_wrist, kParallel);
    }
  }
}

Mechanism withoutMassOf(const Mechanism& mechanism, const std::vector<std::string>& beginnings) {
  std::vector<Link> links = mechanism.links();
  for (Link& link : links) {
    for (const std::string& beginning : beginnings) {
      if (link.name.compare(0, beginning.size(), beginning) != 0) continue;
      link.mass = 0;
      link.inertia_Cm_K.setZero();
    }
  }
  return Mechanism(mechanism.name(), links, mechanism.joints());
}

TEST(StewartGough, MasslessLegsCarryThePlatformByForcesAlongThem) {
  const LoopExample example("stewart_gough");
  const Mechanism mechanism = withoutMassOf(example.mechanism, {"cylinder_", "rod_"});
  const Vector3l c_P{0.02L, -0.03L, 0.06L};
  const Matrix3l inertia = Vector3l(0.45L, 0.50L, 0.90L).asDiagonal();
  for (const double t : kTimes) {
    const auto centre = withDerivatives(
        [&](long double s) { return Vector3l(platformPose(s).p + platformPose(s).R * c_P); }, t);
    const auto turn = withDerivatives([](long double s) { return platformPose(s).R; }, t);
    const Matrix3l& R = turn.value;
    // Rdot = [w] R, Rddot = ([alpha] + [w][w]) R.
    const Matrix3l w_cross = turn.rate * R.transpose();
    const Matrix3l alpha_cross = turn.acceleration * R.transpose() - w_cross * w_cross;
    const Vector3l w{w_cross(2, 1), w_cross(0, 2), w_cross(1, 0)};
    const Vector3l alpha{alpha_cross(2, 1), alpha_cross(0, 2), alpha_cross(1, 0)};
    const Matrix3l I = R * inertia * R.transpose();
    Eigen::Matrix<long double, 6, 6> directions;
    Eigen::Matrix<long double, 6, 1> load;
    load << 12 * (centre.acceleration + Vector3l(0, 0, 9.81L)), I * alpha + w.cross(I * w);
    for (int i = 0; i < 6; ++i) {
      const Vector3l arm = R * (platformPoint(i) - c_P);
      const Vector3l leg = (centre.value + arm - basePoint(i)).normalized();
      directions.col(i) << leg, arm.cross(leg);
    }
    const Eigen::Matrix<long double, 6, 1> forces = directions.fullPivLu().solve(load);
    const NamedLoopResults results(mechanism, example.scene,
                                   motionAt(mechanism, stewartGoughAt, t));
    for (int i = 0; i < 6; ++i) {
      const std::string leg = "leg_" + std::to_string(i + 1);
      expectEffort(results, leg, forces[i], kParallel);
      const Eigen::Vector3d along_leg = results.childAxes(leg).force;
      EXPECT_NEAR(along_leg.x(), 0, kParallel * 100) << leg;
      EXPECT_NEAR(along_leg.y(), 0, kParallel * 100) << leg;
      for (int k = 0; k < 3 && i > 0; ++k) {
        expectDetermined(results, "ball_" + std::to_string(i + 1), k, forces[i] * directions(k, i),
                         kParallel);
      }
    }
  }
}

// The platform's three arms are parallel to a, their axes to y. A state of self-stress needs forces
// at the spherical joints in the planes of a and y (an arm on a revolute joint can hold no other)
// that balance at the platform: of arms 1 and 2 they are opposite and along the line of the joints,
// which is y, and arm 3 has none. So the force along y of arms 1 and 2, and with it the moment of
// y and a at their feet, are not determined; everything else is.
TEST(SpatialParallelogram, OneRedundantConstraintIsSharedByTwoArms) {
  const LoopExample example("spatial_parallelogram");
  for (const double t : kTimes) {
    const NamedLoopResults results(example.mechanism, example.scene,
                                   motionAt(example.mechanism, parallelogramAt, t));
    const Determinacy& determinacy = results.dynamics().determinacy();
    EXPECT_EQ(determinacy.redundant_constraints, 1);
    EXPECT_EQ(determinacy.redundancy, 1);
    const Determined all{true, true, true, true, true, true};
    const Determined foot{true, false, true, false, true, true};
    const Determined ball{true, false, true, true, true, true};
    for (const char* name : {"ground", "arm_joint_3", "ball_3_x", "ball_3_y", "ball_3_z"}) {
      EXPECT_EQ(results.childAxesDetermined(name), all) << name;
      EXPECT_EQ(results.rootAxesDetermined(name), all) << name;
    }
    for (const char* name : {"arm_joint_1", "arm_joint_2"}) {
      EXPECT_EQ(results.childAxesDetermined(name), foot) << name;
      // In root axes the moment has two components, unless the arm stands upright.
      EXPECT_EQ(results.rootAxesDetermined(name),
                (Determined{true, false, true, false, true, false}))
          << name;
    }
    for (const char* name : {"ball_1", "ball_2"}) {
      EXPECT_EQ(results.childAxesDetermined(name), ball) << name;
    }
    EXPECT_TRUE(results.effortDetermined("arm_joint_1"));
  }
}

// Nothing pushes the platform along y, so the three forces along y of its joints balance. The
// policy decides how arms 1 and 2 share what arm 3 leaves.
TEST(SpatialParallelogram, PolicyDecidesTheForceThatIsNotDetermined) {
  LoopExample example("spatial_parallelogram");
  const Motion motion = motionAt(example.mechanism, parallelogramAt, 0.9);
  const auto along_y = [](const NamedLoopResults& results, const std::string& name) {
    return results.rootAxes(name).force.y();
  };
  const NamedLoopResults least(example.mechanism, example.scene, motion);
  const double shared = -along_y(least, "ball_3_z");
  ASSERT_GE(std::abs(shared), 0.1);
  EXPECT_NEAR(along_y(least, "ball_1"), shared / 2, kClosedForm);
  EXPECT_NEAR(along_y(least, "ball_2"), shared / 2, kClosedForm);
  example.scene.redundancy.policy = RedundancyPolicy::kZeroAt;
  example.scene.redundancy.zero_at = {"ball_1"};
  const NamedLoopResults zero(example.mechanism, example.scene, motion);
  EXPECT_NEAR(along_y(zero, "ball_1"), 0, kClosedForm);
  EXPECT_NEAR(along_y(zero, "ball_2"), shared, kClosedForm);
  for (const std::string& name : least.names()) {
    for (std::size_t i = 0; i < 6; ++i) {
      if (!least.rootAxesDetermined(name)[i]) continue;
      const int k = static_cast<int>(i);
      EXPECT_NEAR(component(zero.rootAxes(name), k), component(least.rootAxes(name), k),
                  kClosedForm * 10)
          << name << ", component " << i;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
