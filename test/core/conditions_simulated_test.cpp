// Couplings and rods against numbers at the end of simulations that other programs publish. What
// moves a mechanism here is inverse dynamics only, which is linear in accelerations, so that a few
// of them tell the motion of given efforts.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "published_model.h"

namespace virtual_work_dynamics {
namespace {

/// The motion of a model under given efforts, in the coordinates that its scene gives.
class LetGo {
 public:
  LetGo(PublishedModel& model, const std::vector<std::string>& given,
        const std::vector<std::string>& efforts, const Eigen::VectorXd& wanted)
      : q(Eigen::VectorXd::Zero(wanted.size())),
        qd(q),
        model_(model),
        efforts_(efforts),
        wanted_(wanted) {
    for (const std::string& name : given) places_.push_back(model.coordinate(name));
    for (std::size_t i = 0; i < given.size(); ++i) q[Eigen::Index(i)] = model.motion.q[places_[i]];
  }

  Eigen::VectorXd effortsAt(const Eigen::VectorXd& at, const Eigen::VectorXd& rates,
                            const Eigen::VectorXd& accelerations) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      model_.motion.q[places_[i]] = at[Eigen::Index(i)];
      model_.motion.qd[places_[i]] = rates[Eigen::Index(i)];
      model_.motion.qdd[places_[i]] = accelerations[Eigen::Index(i)];
    }
    if (!model_.complete())
      throw std::runtime_error(model_.dynamics.whyOpen(model_.motion, model_.workspace));
    model_.compute();
    Eigen::VectorXd found(wanted_.size());
    for (std::size_t i = 0; i < efforts_.size(); ++i) {
      found[Eigen::Index(i)] = model_.effort(efforts_[i]);
    }
    return found;
  }
  Eigen::VectorXd acceleration(const Eigen::VectorXd& at, const Eigen::VectorXd& rates) {
    const Eigen::Index n = wanted_.size();
    const Eigen::VectorXd without = effortsAt(at, rates, Eigen::VectorXd::Zero(n));
    Eigen::MatrixXd mass(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      mass.col(i) = effortsAt(at, rates, Eigen::VectorXd::Unit(n, i)) - without;
    }
    return mass.partialPivLu().solve(wanted_ - without);
  }
  /// A step by Runge and Kutta.
  void step(double h) {
    const Eigen::VectorXd k1 = acceleration(q, qd);
    const Eigen::VectorXd k2 = acceleration(q + h / 2 * qd, qd + h / 2 * k1);
    const Eigen::VectorXd k3 = acceleration(q + h / 2 * qd + h * h / 4 * k1, qd + h / 2 * k2);
    const Eigen::VectorXd k4 = acceleration(q + h * qd + h * h / 2 * k2, qd + h * k3);
    q += h * qd + h * h / 6 * (k1 + k2 + k3);
    qd += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }

  Eigen::VectorXd q, qd;

 private:
  PublishedModel& model_;
  std::vector<Eigen::Index> places_;
  std::vector<std::string> efforts_;
  Eigen::VectorXd wanted_;
};

// Project Chrono, utest_CH_shafts.cpp, shaft_body: a torque of 3 N m on a body that a shaft turns
// with, which a spring holds. Its numbers, of six digits, are those of steps of 1 ms by Euler, with
// the acceleration at the begin of the last one.
TEST(SimulatedConditions, ShaftOnABodyAsInChrono) {
  PublishedModel model("<link name='ground_link'/>" + planarLink("body", 1, 0, 1) +
                           planarLink("shaft", 1, 0, 9) +
                           planarJoint("continuous", "ground_link", "body", "0 0 1") +
                           planarJoint("continuous", "ground_link", "shaft", "0 0 1"),
                       "{joints: [{name: shaft, stiffness: 40}], actuated: [body], couplings: "
                       "[{name: shaft_on_body, terms: [{name: shaft, factor: 1}, {name: body, "
                       "factor: -1}]}]}");
  LetGo turning(model, {"body"}, {"body"}, Eigen::VectorXd::Constant(1, 3));
  Eigen::VectorXd acceleration;
  double on_shaft = 0;
  for (int i = 0; i < 500; ++i) {
    acceleration = turning.acceleration(turning.q, turning.qd);
    turning.effortsAt(turning.q, turning.qd, acceleration);
    on_shaft = model.effort("shaft_on_body");
    turning.qd += 1e-3 * acceleration;
    turning.q += 1e-3 * turning.qd;
  }
  EXPECT_NEAR(turning.q[0], 0.0345404, 5e-8);
  EXPECT_NEAR(turning.qd[0], 0.126221, 5e-7);
  EXPECT_NEAR(acceleration[0], 0.162343, 5e-7);
  EXPECT_NEAR(on_shaft, 2.83766, 5e-6);
  // The spring's torque is that of the end: what the shaft needs at rest there.
  turning.effortsAt(turning.q, 0 * turning.qd, 0 * turning.qd);
  EXPECT_NEAR(model.effort("shaft_on_body"), 1.38162, 5e-6);
}

// EXUDYN, TestModels/driveTrainTest.py: four pistons on a crank with springs for a bearing, and
// four gears and a flywheel on it.
class DriveTrain {
 public:
  DriveTrain() {
    add(planarLink("ground_link", 0, 0, 0) + planarLink("slide_x", 0, 0, 0) +
        planarLink("slide_y", 0, 0, 0) + bar("crank", kCrank, 0) +
        planarJoint("prismatic", "ground_link", "slide_x", "1 0 0") +
        planarJoint("prismatic", "slide_x", "slide_y", "0 1 0") +
        planarJoint("continuous", "slide_y", "crank", "0 0 1"));
    for (int i = 0; i < 4; ++i) addPiston(i);
    addRotor("gear_0", disc(0.15), "crank", 1);
    addRotor("gear_1", disc(0.05), "gear_0", -3);
    addRotor("gear_2", disc(0.15), "gear_1", 1);
    addRotor("gear_3", disc(0.05), "gear_2", -3);
    addRotor("flywheel", 5 * disc(0.15), "crank", 1);
  }
  std::string urdf() const { return urdf_.str(); }
  std::string scene() const {
    return "{gravity: [0, 0, 0], free_motion: true, actuated: [gear_3], given: [slide_x, slide_y, "
           "crank], joints: [{name: slide_x, stiffness: 2.e+4, damping: 400}, {name: slide_y, "
           "stiffness: 2.e+4, damping: 400}], closures: [" +
           closures_.str() + "], couplings: [" + couplings_.str() + "]}";
  }

 private:
  static constexpr double kCrank = 0.2, kRod = 0.5, kWidth = 0.025, kDensity = 7850;

  void add(const std::string& text) { urdf_ << text; }
  static std::string bar(const std::string& name, double length, double centre) {
    const double mass = kDensity * length * kWidth * kWidth;
    return planarLink(name, mass, centre, mass / 12 * (length * length + kWidth * kWidth));
  }
  static double disc(double radius) {
    return 0.5 * kDensity * M_PI * std::pow(radius, 4) * 2 * kWidth;
  }
  void addRotor(const std::string& name, double inertia, const std::string& other, double ratio) {
    add(planarLink(name, 1, 0, inertia) + planarJoint("continuous", "ground_link", name, "0 0 1"));
    couple("on_" + name, name, other, -ratio);
  }
  void couple(const std::string& name, const std::string& first, const std::string& second,
              double factor) {
    couplings_ << (couplings_.str().empty() ? "" : ", ") << "{name: " << name
               << ", terms: [{name: " << first << ", factor: 1}, {name: " << second
               << ", factor: " << factor << "}]}";
  }
  // The rods of the second and fourth piston do not meet crank and piston where they start, by 5
  // mm, and their joints hold velocities only: the gaps stay as they are, in axes of the ground. An
  // arm of that length which the crank carries and does not turn does that.
  void addPiston(int i) {
    const std::string number = std::to_string(i);
    const Eigen::Rotation2Dd turn(i * M_PI / 2);
    const bool across = i % 2 == 1;
    const double lean = across ? std::atan2(0.5 * kCrank, kRod) : 0;
    const Eigen::Vector2d pin(i < 2 ? 0.5 * kCrank : -0.5 * kCrank, 0);
    Eigen::Vector2d middle(0.5 * kCrank + 0.5 * kRod, 0);
    if (across) middle -= Eigen::Vector2d(0.5 * kCrank, 0.25 * kCrank);
    middle = turn * middle;
    const Eigen::Rotation2Dd along(turn.angle() + lean);
    const Eigen::Vector2d half = along * Eigen::Vector2d(0.5 * kRod, 0);
    const Eigen::Vector2d gap = middle - half - pin;
    const double out = across ? kRod * std::cos(lean) : 0.5 * kCrank + kRod;
    const Eigen::Vector2d piston = turn * Eigen::Vector2d(out, 0);
    const Eigen::Vector2d tip = turn.inverse() * (middle + half - piston);
    add(planarLink("arm_" + number, 0, 0, 0) + bar("rod_" + number, kRod, 0.5 * kRod) +
        planarLink("piston_" + number, i == 3 ? 0.3 : 0.2, 0, 1) +
        planarJoint("continuous", "crank", "arm_" + number, "0 0 1", pin.x(), pin.y()) +
        planarJoint("continuous", "arm_" + number, "rod_" + number, "0 0 1", gap.x(), gap.y(),
                    along.angle()) +
        planarJoint("prismatic", "ground_link", "piston_" + number, "1 0 0", piston.x(), piston.y(),
                    turn.angle()));
    couple("arm_stays_" + number, "arm_" + number, "crank", 1);
    closures_ << (i == 0 ? "" : ", ") << "{name: pin_" << number
              << ", type: revolute, parent: {link: piston_" << number << ", xyz: [" << tip.x()
              << ", " << tip.y() << ", 0]}, child: {link: rod_" << number << ", xyz: [" << kRod
              << ", 0, 0]}}";
  }

  std::ostringstream urdf_ = precise(), closures_ = precise(), couplings_ = precise();
  static std::ostringstream precise() {
    std::ostringstream text;
    text.precision(17);
    return text;
  }
};

// Angles of the crank and of the flywheel at 0.1 s under 100 N m on the last gear, by steps of 0.1
// ms there. A condition makes them equal, and in print they differ by 9.3e-8 rad: by so much the
// crank's is off, and the flywheel's by less.
TEST(SimulatedConditions, DriveTrainTurnsAsInExudyn) {
  const DriveTrain train;
  PublishedModel model(train.urdf(), train.scene());
  LetGo turning(model, {"slide_x", "slide_y", "crank"},
                {"residual.motion.slide_x", "residual.motion.slide_y", "gear_3"},
                Eigen::Vector3d(0, 0, 100));
  for (int i = 0; i < 100; ++i) turning.step(1e-3);
  turning.effortsAt(turning.q, turning.qd, Eigen::Vector3d::Zero());
  const double crank = 0.8813172426357362, flywheel = 0.8813173353288565;
  EXPECT_NEAR(turning.q[2], crank, 2 * (flywheel - crank));
  EXPECT_NEAR(model.motion.q[model.coordinate("flywheel")], flywheel, 0.1 * (flywheel - crank));
  EXPECT_NEAR(model.motion.q[model.coordinate("gear_3")], 9 * turning.q[2], 9e-14);
}

// EXUDYN, TestModels/coordinateVectorConstraint.py: two points of 2.5 kg in a plane, on rods of 0.8
// m, let go level. Coordinates are x and y of both; rods are conditions.
class PointsOnRods {
 public:
  PointsOnRods() {
    std::string urdf = planarLink("ground_link", 0, 0, 0);
    for (const std::string i : {"0", "1"}) {
      urdf += planarLink("x" + i, 0, 0, 0) + planarLink("y" + i, 2.5, 0, 0) +
              planarJoint("prismatic", "ground_link", "x" + i, "1 0 0") +
              planarJoint("prismatic", "x" + i, "y" + i, "0 1 0");
    }
    const std::string rest =
        "], gravity: [0, -9.81, 0], actuated: [], free_motion: true, closures: [{name: rod_0, "
        "type: distance, length: 0.8, parent: {link: ground_link}, child: {link: y0}}, {name: "
        "rod_1, type: distance, length: 0.8, parent: {link: y0}, child: {link: y1}}], assembly: "
        "[{name: x0, position: 0.6}, {name: y0, position: -0.6}, {name: x1, position: 1.2}, {name: "
        "y1, position: -1.2}]}";
    for (const std::string first : {"x0", "y0"}) {
      for (const std::string second : {"x1", "y1"}) {
        models_.push_back(
            std::make_unique<PublishedModel>(urdf, "{given: [" + first + ", " + second + rest));
      }
    }
  }

  /// What a motion demands beyond its rods' forces, N, and by how much rods are too long, m. The
  /// coordinates that stand for the free motions are those that a rod does not hold.
  Eigen::Vector4d wrong(const Eigen::Vector4d& q, const Eigen::Vector4d& qdd) {
    const Eigen::Vector2d first = q.head<2>(), second = q.tail<2>() - first;
    const auto level = [](const Eigen::Vector2d& rod) {
      return std::abs(rod.x()) > std::abs(rod.y());
    };
    const std::string free[2] = {level(first) ? "y0" : "x0", level(second) ? "y1" : "x1"};
    PublishedModel& model = *models_[(level(first) ? 2 : 0) + (level(second) ? 1 : 0)];
    model.motion.q = q;
    model.motion.qdd = qdd;
    model.compute();
    return {model.effort("residual.motion." + free[0]), model.effort("residual.motion." + free[1]),
            first.norm() - 0.8, second.norm() - 0.8};
  }

 private:
  std::vector<std::unique_ptr<PublishedModel>> models_;
};

// The number is that of the generalized alpha method with a spectral radius of 0.8 and steps of 1
// ms, 1e-5 off the motion itself. Step by step in the same way it is met to what its iterations
// leave.
TEST(SimulatedConditions, PointsOnRodsSwingAsInExudyn) {
  PointsOnRods points;
  const double rho = 0.8, h = 1e-3;
  const double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1), gamma = 0.5 - am + af,
               beta = (gamma + 0.5) * (gamma + 0.5) / 4;
  const double weight = h * h * beta * (1 - af) / (1 - am);
  Eigen::Vector4d q(0.8, 0, 1.6, 0), qd = Eigen::Vector4d::Zero();
  Eigen::Vector4d acceleration(0, -9.81, 0, -9.81), auxiliary = acceleration;  // rods bear nothing
  for (int step = 0; step < 1000; ++step) {
    Eigen::Vector4d next_auxiliary, next_q;
    const auto equations = [&](const Eigen::Vector4d& next) {
      next_auxiliary = ((1 - af) * next + af * acceleration - am * auxiliary) / (1 - am);
      next_q = q + h * qd + h * h * ((0.5 - beta) * auxiliary + beta * next_auxiliary);
      Eigen::Vector4d wrong = points.wrong(next_q, next);
      wrong.tail<2>() /= weight;
      return wrong;
    };
    Eigen::Vector4d next = acceleration;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector4d wrong = equations(next);
      Eigen::Matrix4d change;
      for (int k = 0; k < 4; ++k) {
        change.col(k) = equations(next + Eigen::Vector4d::Unit(k)) - wrong;
      }
      const Eigen::Vector4d correction = change.partialPivLu().solve(wrong);
      next -= correction;
      if (correction.norm() < 1e-8) break;
    }
    equations(next);
    qd += h * ((1 - gamma) * auxiliary + gamma * next_auxiliary);
    q = next_q;
    acceleration = next;
    auxiliary = next_auxiliary;
  }
  EXPECT_NEAR(q[0] + q[1], -1.0825265797698322, 1e-9);
}

}  // namespace
}  // namespace virtual_work_dynamics
