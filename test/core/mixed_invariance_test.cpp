#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "changed_units.h"
#include "closed_loops.h"
#include "loop_geometry.h"
#include "stability/mixed_loops.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::uint32_t kScenesTried = 150;
// Roundings of some hundred operations, of the largest load, for a condition of one.
constexpr double kOfCondition = 1e-13;
// Beyond it, a change of the last digit may change what counts as determined.
constexpr double kRegular = 1e4;

Eigen::Matrix3d rotationMatrix(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d anglesOf(const Eigen::Matrix3d& R) {
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const Eigen::Matrix3d back = rotationMatrix({0, 0, -yaw}) * R;
  return {std::atan2(-back(1, 2), back(1, 1)), std::atan2(-R(2, 0), back(0, 0)), yaw};
}

// A frame turned about an axis of its own.
Eigen::Vector3d turned(const Eigen::Vector3d& rpy, const Eigen::Vector3d& axis, double angle) {
  return anglesOf(rotationMatrix(rpy) * Eigen::AngleAxisd(angle, axis).toRotationMatrix());
}

// What a scene finds by name, in root axes, so that no axes of a closure matter.
struct Found {
  struct Number {
    double value;
    bool determined, turns;
  };
  std::map<std::string, Number> numbers;
  Determinacy determinacy;
  double force = 0, torque = 0;  // the largest ones

  void add(const std::string& name, Number number) {
    (number.turns ? torque : force) =
        std::max(number.turns ? torque : force, std::abs(number.value));
    numbers[name] = number;
  }
};

Found foundIn(const Mechanism& mechanism, const Scene& scene, const Motion& motion) {
  Request request;
  request.root_axes = {kGround};
  for (const Joint& joint : mechanism.joints()) request.root_axes.push_back(joint.name);
  for (const Closure& closure : scene.closures) request.root_axes.push_back(closure.name);
  ClosedLoops dynamics(mechanism, scene, request);
  dynamics.compute(motion);
  Found found;
  found.determinacy = dynamics.determinacy();
  for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
    const Wrench& wrench = dynamics.rootAxes()[i];
    for (std::size_t k = 0; k < 6; ++k) {
      const auto row = static_cast<Eigen::Index>(k % 3);
      found.add(request.root_axes[i] + " " + std::to_string(k),
                {k < 3 ? wrench.force[row] : wrench.torque[row],
                 dynamics.rootAxesDetermined()[i][k], k >= 3});
    }
  }
  Eigen::Index next = 0;
  const auto addEffort = [&](const std::string& name, bool turns) {
    found.add("effort of " + name,
              {dynamics.effort()[next], dynamics.effortDetermined()[static_cast<std::size_t>(next)],
               turns});
    ++next;
  };
  for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
    addEffort(mechanism.coordinateNames()[i],
              mechanism.unitOf(static_cast<int>(i)) == Unit::kRadian);
  }
  for (const std::string& name : dynamics.actuatedClosures()) {
    const auto it = std::find_if(scene.closures.begin(), scene.closures.end(),
                                 [&](const Closure& closure) { return closure.name == name; });
    addEffort(name, it->type == ClosureType::kRevolute);
  }
  for (const Coupling& coupling : scene.couplings) {
    const int first = mechanism.jointIndex(coupling.terms.front().name);
    addEffort(coupling.name, mechanism.joint(first).type != JointType::kPrismatic);
  }
  return found;
}

// What of the changed scene is compared, and how.
struct Agreement {
  double force = 1, torque = 1;         // units, over the other ones
  std::map<std::string, double> signs;  // of reactions of closures
  std::function<bool(const std::string&)> accepts = [](const std::string&) { return true; };
};

class MixedInvariance : public testing::Test {
 protected:
  using Change = std::function<bool(ClosedCase&, Agreement&)>;

  /// Applies a change to the scenes, which says whether it changed anything.
  void expectUnchangedBy(const Change& change, int least) {
    int changed = 0;
    for (std::uint32_t seed = 1; seed <= kScenesTried; ++seed) {
      SCOPED_TRACE("scene " + std::to_string(seed));
      const ClosedCase loops = MixedLoops(seed).next();
      ClosedCase other = loops;
      Agreement agreement;
      if (!change(other, agreement)) continue;
      try {
        const Found a = foundIn(loops.mechanism, loops.scene, loops.motion);
        if (a.determinacy.condition > kRegular || a.determinacy.free_motions > 0) continue;
        compare(a, foundIn(other.mechanism, other.scene, other.motion), loops, agreement);
        ++changed;
      } catch (const SceneError&) {
        EXPECT_THROW(foundIn(other.mechanism, other.scene, other.motion), SceneError);
      }
    }
    EXPECT_GE(changed, least);
  }

  static void compare(const Found& a, const Found& b, const ClosedCase& loops,
                      const Agreement& agreement) {
    EXPECT_EQ(a.determinacy.rank, b.determinacy.rank);
    EXPECT_EQ(a.determinacy.redundancy, b.determinacy.redundancy);
    EXPECT_EQ(a.determinacy.free_motions, b.determinacy.free_motions);
    ASSERT_EQ(a.numbers.size(), b.numbers.size());
    double springs = 0;
    for (const PointSpring& spring : loops.scene.springs) {
      springs += spring.stiffness * (spring.rest_length + spring.at_a.norm() + spring.at_b.norm());
    }
    for (const auto& [name, expected] : a.numbers) {
      if (!agreement.accepts(name)) continue;
      const Found::Number& number = b.numbers.at(name);
      EXPECT_EQ(expected.determined, number.determined) << name;
      if (!expected.determined || !number.determined) continue;
      const double unit = expected.turns ? agreement.torque : agreement.force;
      const auto sign = agreement.signs.find(name.substr(0, name.find(' ')));
      const double right = (sign == agreement.signs.end() ? 1 : sign->second) * expected.value;
      const double largest = expected.turns ? a.torque : a.force + springs;
      ASSERT_TRUE(std::isfinite(number.value)) << name;
      EXPECT_NEAR(number.value / unit, right,
                  kOfCondition * std::max(1.0, a.determinacy.condition) * largest)
          << name;
    }
  }
};

TEST_F(MixedInvariance, OrderOfConditions) {
  expectUnchangedBy(
      [](ClosedCase& loops, Agreement&) {
        std::reverse(loops.scene.closures.begin(), loops.scene.closures.end());
        std::reverse(loops.scene.couplings.begin(), loops.scene.couplings.end());
        return loops.scene.closures.size() + loops.scene.couplings.size() > 1;
      },
      60);
}

TEST_F(MixedInvariance, MillimetresAndGrams) {
  const ChangedUnits units{1000, 1000};
  expectUnchangedBy(
      [&](ClosedCase& loops, Agreement& agreement) {
        agreement.force = units.force();
        agreement.torque = units.torque();
        loops.scene = units.of(loops.mechanism, loops.scene);
        loops.motion = units.of(loops.mechanism, loops.motion);
        loops.mechanism = units.of(loops.mechanism);
        return true;
      },
      60);
}

// Whose reaction is then that on the other body, about another point. Teeth mesh at the height of
// the child.
TEST_F(MixedInvariance, ParentAndChildExchanged) {
  expectUnchangedBy(
      [](ClosedCase& loops, Agreement& agreement) {
        std::vector<std::string> changed;
        const NewtonEulerOracle bodies(loops.mechanism, Scene(), loops.motion);
        for (Closure& closure : loops.scene.closures) {
          if (isTouch(closure) || closure.type == ClosureType::kUniversal ||
              closure.type == ClosureType::kRack) {
            continue;
          }
          if (isMesh(closure)) {
            const PlacedFrame parent(loops.mechanism, bodies, closure.parent);
            const PlacedFrame child(loops.mechanism, bodies, closure.child);
            const auto height = static_cast<double>(parent.R.col(2).dot(child.o - parent.o));
            closure.parent.xyz += height * rotationMatrix(closure.parent.rpy).col(2);
          }
          std::swap(closure.parent, closure.child);
          std::swap(closure.teeth.parent_radius, closure.teeth.child_radius);
          closure.teeth.helix_angle *= -1;  // the other wheel's hand
          agreement.signs[closure.name] = -1;
          for (int k = 3; k < 6; ++k) changed.push_back(closure.name + " " + std::to_string(k));
        }
        agreement.accepts = [changed](const std::string& name) {
          return std::find(changed.begin(), changed.end(), name) == changed.end();
        };
        return !changed.empty();
      },
      60);
}

TEST_F(MixedInvariance, WheelsAndBladesTheOtherWayRound) {
  expectUnchangedBy(
      [](ClosedCase& loops, Agreement&) {
        bool any = false;
        for (Closure& closure : loops.scene.closures) {
          const bool wheel = closure.type == ClosureType::kRolling;
          if (!wheel && closure.type != ClosureType::kKnifeEdge) continue;
          any = true;
          const Eigen::Vector3d half = wheel ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
          closure.child.rpy = turned(closure.child.rpy, half, M_PI);
        }
        return any;
      },
      40);
}

TEST_F(MixedInvariance, OtherPointsAndAxesOfPlanes) {
  expectUnchangedBy(
      [](ClosedCase& loops, Agreement&) {
        bool any = false;
        for (Closure& closure : loops.scene.closures) {
          if (!isTouch(closure)) continue;
          any = true;
          const double far = 0.5 * closure.child.xyz.norm();
          closure.parent.xyz +=
              rotationMatrix(closure.parent.rpy) * Eigen::Vector3d(far, -0.7 * far, 0);
          closure.parent.rpy = turned(closure.parent.rpy, Eigen::Vector3d::UnitZ(), 0.8);
        }
        return any;
      },
      40);
}

// Frames of closures, planes among them, on what a fixed joint holds: all that moves stays.
TEST_F(MixedInvariance, FramesOnTheOtherBodyOfAFixedJoint) {
  expectUnchangedBy(
      [](ClosedCase& loops, Agreement& agreement) {
        const Mechanism& mechanism = loops.mechanism;
        std::vector<std::string> fixed;
        bool any = false;
        for (Closure& closure : loops.scene.closures) {
          for (LinkFrame* frame : {&closure.parent, &closure.child}) {
            const int link = mechanism.linkIndex(frame->link);
            if (link == 0) continue;
            const Joint& joint = mechanism.joint(mechanism.link(link).parent_joint);
            if (joint.type != JointType::kFixed) continue;
            any = true;
            frame->link = mechanism.link(joint.parent_link).name;
            frame->xyz =
                (joint.p_PoKo_P + joint.R_PK * frame->xyz.cast<long double>()).cast<double>();
            frame->rpy = anglesOf(joint.R_PK.cast<double>() * rotationMatrix(frame->rpy));
          }
        }
        for (const Joint& joint : mechanism.joints()) {
          if (joint.type == JointType::kFixed) fixed.push_back(joint.name + " ");
        }
        agreement.accepts = [fixed](const std::string& name) {
          return std::none_of(fixed.begin(), fixed.end(), [&](const std::string& joint) {
            return name.compare(0, joint.size(), joint) == 0;
          });
        };
        return any;
      },
      15);
}

}  // namespace
}  // namespace virtual_work_dynamics
