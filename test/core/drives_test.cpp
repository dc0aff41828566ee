// Drives: what moves as functions of time say, and what is refused.
#include "virtual_work_dynamics/drives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <sstream>
#include <string>

#include "touching_bodies.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms in double against recursions in double.
constexpr double kClosedForm = 1e-12;

void expectNear(double found, double expected, double tolerance = kClosedForm) {
  ASSERT_TRUE(std::isfinite(found));
  EXPECT_LE(std::abs(found - expected), tolerance * std::max(1.0, std::abs(expected)));
}

Mechanism oneSlide() {
  BodiesOnAxes bodies;
  bodies.load(bodies.slide(0, bodies.z()), 2, {1, 1, 1});
  return bodies.build();
}

Scene driving(const std::string& law, const std::string& rest = "") {
  return sceneOf("drives: [{name: joint_1, " + law + "}]\n" + rest);
}

Given allOf(const Mechanism& mechanism) {
  Given given;
  given.coordinates.assign(mechanism.coordinates().size(), true);
  return given;
}

// The motion of the only coordinate at a time.
std::optional<Motion> slideAt(double t, const Scene& scene) {
  const Mechanism mechanism = oneSlide();
  Drives drives(mechanism, scene);
  Motion motion(1), driven(0);
  if (drives.evaluate(t, allOf(mechanism), motion, driven)) return std::nullopt;
  return motion;
}

void expectMotion(const Scene& scene, double t, double q, double qd, double qdd) {
  const auto motion = slideAt(t, scene);
  ASSERT_TRUE(motion);
  expectNear(motion->q[0], q);
  expectNear(motion->qd[0], qd);
  expectNear(motion->qdd[0], qdd);
}

TEST(Drives, LawsAreTheirFunctionsWithExactDerivatives) {
  expectMotion(driving("law: polynomial, coefficients: [1, 2, -3, 0.5]"), 2, 1 + 4 - 12 + 4,
               2 - 12 + 6, -6 + 6);
  expectMotion(driving("law: polynomial, offset: 5, coefficients: [1, 2]"), -1, 4, 2, 0);
  const double w = 2 * M_PI / 12;
  expectMotion(driving("law: cosine, amplitude: 0.3, period: 12"), 1.7,
               0.3 * (1 - std::cos(1.7 * w)), 0.3 * w * std::sin(1.7 * w),
               0.3 * w * w * std::cos(1.7 * w));
  const double a = 1.7 * w + 0.4;
  expectMotion(driving("law: sine, amplitude: 0.3, period: 12, phase: 0.4, offset: 1"), 1.7,
               1 + 0.3 * std::sin(a), 0.3 * w * std::cos(a), -0.3 * w * w * std::sin(a));
  // Rest to rest in 2 s: the quintic 10 s^3 - 15 s^4 + 6 s^5 of s = (t - 1) / 2, here at 1/4.
  const Scene jerk = driving("law: minimum_jerk, times: [1, 3], positions: [0.2, 1.2]");
  expectMotion(jerk, 1.5, 0.2 + 10 / 64. - 15 / 256. + 6 / 1024.,
               (30 / 16. - 60 / 64. + 30 / 256.) / 2, (60 / 4. - 180 / 16. + 120 / 64.) / 4);
  expectMotion(jerk, 0.3, 0.2, 0, 0);
  expectMotion(jerk, 7, 1.2, 0, 0);
  // A steady sweep is a sine.
  const double f = 2 * M_PI * 0.7;
  expectMotion(driving("law: sine_sweep, amplitude: 2, start_frequency: 0.7, end_frequency: 0.7, "
                       "duration: 5"),
               1.1, 2 * std::sin(f * 1.1), 2 * f * std::cos(f * 1.1),
               -2 * f * f * std::sin(f * 1.1));
}

TEST(Drives, PiecesOfAPolynomialStartWhereTheirTimesSay) {
  // Rest, then 2 (t - 1)^3, then on with the motion that this has at 2 s.
  const Scene scene = driving(
      "law: polynomial, times: [0, 1, 2], coefficients: [[0.5], [0.5, 0, 0, 2], [2.5, 6, 6]]");
  expectMotion(scene, -3, 0.5, 0, 0);
  expectMotion(scene, 1, 0.5, 0, 0);
  expectMotion(scene, 1.5, 0.75, 1.5, 6);
  expectMotion(scene, 2, 2.5, 6, 12);
  expectMotion(scene, 3, 14.5, 18, 12);
}

TEST(Drives, TablesHoldWhereTheyRestAndEndWhereTheyMove) {
  const Scene rests = driving(
      "law: table, times: [0, 1], positions: [1, 2], velocities: [0, 0], accelerations: [0, 0]");
  expectMotion(rests, -1, 1, 0, 0);
  expectMotion(rests, 2, 2, 0, 0);
  // Rows of a motion from rest to rest, which a spline finds at rest to some thousandths.
  std::string times, positions;
  for (int i = 0; i <= 50; ++i) {
    const double s = i / 50.;
    times += (i ? ", " : "") + std::to_string(s);
    positions += (i ? ", " : "") + std::to_string(s * s * s * (10 - 15 * s + 6 * s * s));
  }
  const Scene rows = driving("law: table, times: [" + times + "], positions: [" + positions + "]");
  expectMotion(rows, -0.1, 0, 0, 0);
  expectMotion(rows, 1.1, 1, 0, 0);
  const Scene moves = driving("law: table, times: [1, 2, 3, 4], positions: [3, 6, 9, 12]");
  expectMotion(moves, 1, 3, 3, 0);
  expectMotion(moves, 2.25, 6.75, 3, 0);
  EXPECT_FALSE(slideAt(0.999, moves));
  EXPECT_FALSE(slideAt(4.001, moves));
  const Mechanism mechanism = oneSlide();
  Drives drives(mechanism, moves);
  EXPECT_EQ(drives.whyNone(0, 5),
            "drives: 'joint_1' has no motion at 5 s: it still moves when its function ends, at 4 "
            "s");
  EXPECT_EQ(drives.whyNone(0, 0.5),
            "drives: 'joint_1' has no motion at 0.5 s: it moves when its function begins, at 1 s");
}

TEST(Drives, HaveNoRatesInStaticScenes) {
  expectMotion(driving("law: polynomial, coefficients: [1, 2, 3]", "motion: static\n"), 1, 6, 0, 0);
}

// What is wrong with a scene for one slide.
std::string refusalOf(const Scene& scene) {
  try {
    const Mechanism mechanism = oneSlide();
    const Dynamics dynamics(mechanism, scene, Request());
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

std::string readingOf(const std::string& drive) {
  try {
    sceneOf("drives: [{" + drive + "}]");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(Drives, RefuseWhatIsNoDrive) {
  EXPECT_EQ(readingOf("law: cosine, amplitude: 1, period: 2"), "drives[0]: name is missing");
  EXPECT_EQ(readingOf("name: joint_1"), "drives[0]: law is missing");
  EXPECT_EQ(readingOf("name: a, law: cosine, amplitude: 1"), "drives[0]: period is missing");
  EXPECT_EQ(readingOf("name: a, law: cosine, amplitude: 1, period: 2, phase: 1"),
            "drives[0].phase: the law cosine has none");
  EXPECT_EQ(readingOf("name: a, law: table, times: [], positions: [1]"),
            "drives[0].times: expected a list of numbers");
  EXPECT_NE(readingOf("name: a, law: cosin").find("drives[0].law"), std::string::npos);
  const std::string line = "law: polynomial, coefficients: [0, 1]";
  EXPECT_EQ(
      refusalOf(sceneOf("drives: [{name: joint_1, " + line + "}, {name: joint_1, " + line + "}]")),
      "drives: 'joint_1' is given twice");
  EXPECT_EQ(refusalOf(sceneOf("drives: [{name: join_1, " + line + "}]")),
            "drives[0].name: no joint 'join_1'; did you mean 'joint_1'?");
  EXPECT_EQ(refusalOf(driving("law: cosine, amplitude: 1, period: 0")),
            "drives: 'joint_1': period = 0 is not positive");
  EXPECT_EQ(refusalOf(driving("law: table, times: [0, 1], positions: [1]")),
            "drives: 'joint_1': 2 times but 1 positions");
  EXPECT_EQ(refusalOf(driving("law: table, times: [0, 2, 1], positions: [1, 2, 3]")),
            "drives: 'joint_1': times[2]: 1 s is not later than 2 s before it");
  EXPECT_EQ(refusalOf(driving("law: polynomial, times: [0, 1], coefficients: [0, 1]")),
            "drives: 'joint_1': 2 times where pieces start, but coefficients of 1 pieces");
  EXPECT_EQ(refusalOf(driving("law: minimum_jerk, times: [0], positions: [1]"))
                .find("drives: 'joint_1': a minimum-jerk motion needs at least two"),
            0u);
}

TEST(Drives, RefuseWhatNothingCanDrive) {
  BodiesOnAxes bodies;
  const int first = bodies.turn(0, bodies.y());
  bodies.load(first, 1, {1, 1, 1});
  bodies.load(bodies.turn(first, bodies.y(), {1, 0, 0}), 1, {1, 1, 1}, {0.5, 0, 0});
  const Mechanism mechanism = bodies.build();
  const auto refused = [&](const std::string& text) -> std::string {
    try {
      const Dynamics dynamics(mechanism, sceneOf(text), Request());
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  const std::string ball =
      "closures: [{name: ball, type: spherical, parent: {link: link_0, xyz: [2, 0, 0]}, "
      "child: {link: link_2, xyz: [1, 0, 0]}}]\nassembly: [{name: joint_1, position: 0.3}]\n";
  const std::string turn = "law: polynomial, coefficients: [0, 1]";
  EXPECT_EQ(refused(ball + "drives: [{name: ball, " + turn + "}]"),
            "drives: 'ball': only a closure of type revolute or prismatic and a cylinder have an "
            "axis that can be driven");
  const std::string ram =
      "cylinders: [{name: ram, link_a: link_0, at_a: [0.3, 0, -0.4], link_b: link_1, "
      "at_b: [0.3, 0, 0]}]\n";
  EXPECT_EQ(refused(ram + "actuated: [joint_2]\ngiven: [ram, joint_2]\ndrives: [{name: ram, " +
                    turn + "}]"),
            "given: 'ram' has a drive, which says how it moves");
  // With every joint actuated, too, those that follow from the ram's length are not asked for.
  EXPECT_EQ(refused(ram + "drives: [{name: ram, " + turn + "}]"), "");
}

TEST(Drives, JumpsAreRefusedWithTheirTime) {
  const auto pieces = [](const std::string& second) {
    return refusalOf(
        driving("law: polynomial, times: [0, 2], coefficients: [[0, 1], " + second + "]"));
  };
  EXPECT_EQ(pieces("[2, 1]"), "");
  EXPECT_EQ(pieces("[2.5, 1]"), "drives: 'joint_1': position jumps by 0.5 rad or m at 2 s");
  EXPECT_EQ(pieces("[2, 0.75]"), "drives: 'joint_1': velocity jumps by -0.25 rad/s or m/s at 2 s");
  EXPECT_EQ(pieces("[2, 1, 3]"),
            "drives: 'joint_1': acceleration jumps by 6 rad/s^2 or m/s^2 at 2 s");
  EXPECT_EQ(refusalOf(driving("law: table, times: [0, 1, 1, 2], positions: [0, 1, 2, 3]")),
            "drives: 'joint_1': times[2]: 1 s stands there twice, as where a function jumps");
}

// A table of a function of time, with six digits as people write them.
std::string tableOf(const std::function<double(double)>& f, int rows, double step, int digits) {
  std::ostringstream times, positions;
  times.precision(digits);
  positions.setf(std::ios::fixed);
  positions.precision(digits);
  for (int i = 0; i < rows; ++i) {
    times << (i ? ", " : "") << i * step;
    positions << (i ? ", " : "") << f(i * step);
  }
  return refusalOf(
      driving("law: table, times: [" + times.str() + "], positions: [" + positions.str() + "]"));
}

TEST(Drives, TablesThatJumpAreRefused) {
  const auto jump = [](double t) { return t < 0.5 ? 0.1 * t : 0.1 * t + 0.4; };
  const auto corner = [](double t) { return 0.73171 * (t < 0.5 ? t : 1 - t); };
  const auto push = [](double t) { return t < 0.5 ? 0 : 2.93717 * (t - 0.5) * (t - 0.5); };
  EXPECT_EQ(tableOf(jump, 100, 0.01, 9), "drives: 'joint_1': position jumps at 0.5 s");
  // Differences are those of the middle of two rows.
  EXPECT_EQ(tableOf(corner, 100, 0.01, 9), "drives: 'joint_1': velocity jumps at 0.505 s");
  EXPECT_EQ(tableOf(push, 100, 0.01, 9), "drives: 'joint_1': acceleration jumps at 0.51 s");
}

std::string refusedTable(const std::string& rows) {
  return refusalOf(driving("law: table, " + rows));
}

// Their decimals are not the noise of an encoder.
TEST(Drives, TablesOfRoundNumbersThatJumpAreRefused) {
  const auto refused = [](const std::function<double(double)>& f, int digits = 6) {
    return tableOf(f, 101, 0.01, digits).substr(19);
  };
  EXPECT_EQ(refused([](double t) { return t < 0.495 ? 0 : 1; }), "position jumps at 0.5 s");
  EXPECT_EQ(refused([](double t) { return t < 0.005 ? 0 : 1; }), "position jumps at 0.01 s");
  EXPECT_EQ(refused([](double t) { return t < 0.995 ? 0 : 1; }), "position jumps at 1 s");
  EXPECT_EQ(refused([](double t) { return std::max(0.0, t - 0.5); }), "velocity jumps at 0.505 s");
  const auto trapezoid = [](double t) {
    const double u = std::min(t, 1 - t);  // symmetric about the middle
    const double half = u < 0.2 ? 0 : u < 0.4 ? 5 * (u - 0.2) * (u - 0.2) : 0.2 + 2 * (u - 0.4);
    return t < 0.5 ? half : 0.8 - half;
  };
  EXPECT_NE(refused(trapezoid).find("acceleration jumps at 0.2"), std::string::npos);
  const auto cubic = [](double t) {
    const double s = std::min(1.0, std::max(0.0, (t - 0.3) / 0.4));
    return s * s * (3 - 2 * s);
  };
  EXPECT_NE(refused(cubic, 12).find("acceleration jumps at 0.3"), std::string::npos);
  EXPECT_EQ(refusedTable("times: [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1], "
                         "positions: [0, 0, 0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5, 0.5]"),
            "drives: 'joint_1': position jumps at 0.6 s");
}

TEST(Drives, VelocitiesThatAreNotThoseOfThePositionsAreRefused) {
  EXPECT_EQ(refusedTable("times: [0, 1, 2, 3], positions: [0, 0, 0, 0], velocities: [5, 5, 5, 5]"),
            "drives: 'joint_1': velocities are not those of the positions, which do not go along "
            "with them from 0 s to 1 s");
  EXPECT_EQ(refusedTable("times: [0, 1], positions: [0, 1], velocities: [0, 0]"), "");
  EXPECT_EQ(refusedTable("times: [0, 1, 2], positions: [0, 1, 2], velocities: [1, 1, 1]"), "");
}

TEST(Drives, PeriodsWithoutAccelerationAreRefused) {
  EXPECT_EQ(refusalOf(driving("law: sine, amplitude: 1, period: 1e-320"))
                .find("drives: 'joint_1': period = "),
            0);
  EXPECT_EQ(refusalOf(driving("law: cosine, amplitude: 1, period: 1e-160")),
            "drives: 'joint_1': period = 1e-160 s is too short: accelerations are not finite");
}

TEST(Drives, TablesThatDoNotJumpAreTaken) {
  const auto rest_to_rest = [](double t) {
    const double s = std::min(1.0, std::max(0.0, (t - 0.2) / 0.6));
    return 0.3 * s * s * s * (10 - 15 * s + 6 * s * s);
  };
  const auto waves = [](double t) { return 0.8 * std::sin(9 * t) + 0.05 * std::sin(40 * t); };
  for (const double step : {0.001, 0.004, 0.02, 0.1}) {
    for (const int digits : {4, 6, 9, 12}) {
      const int rows = static_cast<int>(1 / step);
      EXPECT_EQ(tableOf(rest_to_rest, rows, step, digits), "") << step << " " << digits;
      EXPECT_EQ(tableOf(waves, rows, step, digits), "") << step << " " << digits;
    }
  }
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    std::normal_distribution<double> noise(0, i % 2 ? 1e-4 : 1e-3);
    EXPECT_EQ(tableOf([&](double t) { return waves(t) + noise(random); }, 100, 0.01, 12), "") << i;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
