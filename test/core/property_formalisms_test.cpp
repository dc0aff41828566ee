#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "property_check.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

// The paper's two formalisms, which share no recursion, find the same forces.
namespace virtual_work_dynamics {
namespace {

// Lagrange's equations add up products of velocities of which the recursion knows only the
// differences: a wheel's momentum times its turning, though its centre moves straight on. Where
// nothing else is left, their rounding errors are all there is. Roundings of long double that these
// products may be off:
constexpr long double kWitnessRoundings = 64;

// Sums over the whole mechanism.
struct VelocityProducts {
  long double mass = 0;   // kg
  long double reach = 0;  // lengths of all links, m
  long double turn = 0;   // rad/s
  long double slide = 0;  // m/s

  explicit VelocityProducts(const Case& made) {
    for (const Link& link : made.mechanism.links()) {
      mass += link.mass;
      reach += link.p_KoCm_K.norm() + std::sqrt(radiusSquared(link));
    }
    for (const Joint& joint : made.mechanism.joints()) {
      reach += joint.p_PoKo_P.norm();
      if (joint.coordinate < 0) continue;
      const long double rate = std::abs(joint.multiplier * made.motion.qd[joint.coordinate]);
      const bool slides = joint.type == JointType::kPrismatic;
      (slides ? slide : turn) += rate;
      if (!slides) continue;
      reach +=
          std::abs(joint.multiplier * made.motion.q[joint.coordinate]) + std::abs(joint.offset);
    }
  }

  long double force() const { return mass * (slide + turn * reach) * turn; }
  long double moment() const { return mass * (slide + turn * reach) * (slide + turn * reach); }

 private:
  static long double radiusSquared(const Link& link) {
    return link.mass > 0 ? link.inertia_Cm_K.norm() / link.mass : 0;
  }
};

// A result of Lagrange's equations in long double, rounded to double; the rounding is among those
// of the other's input.
class Witness {
 public:
  Witness(const Case& made, const Request& request)
      : lagrange_(made.mechanism, made.scene, request), products_(made) {
    lagrange_.compute(made.motion);
  }

  LongWrench child(std::size_t i) const { return measured(lagrange_.childAxes()[i]); }
  LongWrench root(std::size_t i) const { return measured(lagrange_.rootAxes()[i]); }
  /// Effort of a coordinate that moves these joints.
  Measured effort(std::size_t i, const Mechanism& mechanism) const {
    Measured effort{lagrange_.effort()[static_cast<Eigen::Index>(i)], 0};
    for (const Joint& joint : mechanism.joints()) {
      if (joint.coordinate != static_cast<int>(i)) continue;
      const bool slides = joint.type == JointType::kPrismatic;
      effort.error +=
          std::abs(joint.multiplier) * noise(slides ? products_.force() : products_.moment());
    }
    return effort;
  }

 private:
  static long double noise(long double products) {
    return kWitnessRoundings * std::numeric_limits<long double>::epsilon() * products;
  }
  LongWrench measured(const Wrench& wrench) const {
    return {wrench.force.cast<long double>(), wrench.torque.cast<long double>(),
            noise(products_.force()), noise(products_.moment())};
  }

  LagrangeDynamics<long double> lagrange_;
  VelocityProducts products_;
};

TEST(PropertyOfFormalisms, VirtualWorkAndLagrangeAgree) {
  checkProperty(30000000, [](RandomCases& random, Agreement& agreement) {
    const Case made = random.next();
    agreement.begin({made});
    const Outcome virtual_work(made);
    const Witness lagrange(made, virtual_work.request());
    for (std::size_t i = 0; i < virtual_work.coordinates().size(); ++i) {
      const std::string& name = virtual_work.coordinates()[i];
      agreement.compare("effort of " + name, lagrange.effort(i, made.mechanism),
                        virtual_work.effort(name));
    }
    for (std::size_t i = 0; i < virtual_work.reactions().size(); ++i) {
      const std::string& name = virtual_work.reactions()[i];
      agreement.compare("child axes of " + name, lagrange.child(i), virtual_work.child(name));
      agreement.compare("root axes of " + name, lagrange.root(i), virtual_work.root(name));
    }
  });
}

}  // namespace
}  // namespace virtual_work_dynamics
