#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "closed_loop_results.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {

/// Roundings of some ten operations.
inline constexpr double kTenRoundings = 1e-13;

/// A finite number, within the tolerance times its size or 1.
inline void expectClose(double found, double expected, double tolerance = kTenRoundings) {
  ASSERT_TRUE(std::isfinite(found));
  EXPECT_NEAR(found, expected, tolerance * std::max(1.0, std::abs(expected)));
}

/// Balanced shafts side by side on the root link, which turn about z or slide along it, coupled by
/// what a test says. joint_1 is the first one. There is no gravity.
class CoupledShafts {
 public:
  struct Shaft {
    double inertia;  // kg m^2, or kg of one that slides
    bool slides;
  };

  /// @param first place of the first one
  /// @param apart from each to the next, m
  explicit CoupledShafts(const std::vector<Shaft>& shafts, const Vector3l& first = Vector3l::Zero(),
                         long double apart = 0.3L)
      : builder_(1) {
    scene.gravity.setZero();
    scene.actuated = std::vector<std::string>();
    for (const Shaft& shaft : shafts) {
      const int link = builder_.add(shaft.slides ? JointType::kPrismatic : JointType::kContinuous,
                                    0, Vector3l::UnitZ(), Matrix3l::Identity(),
                                    first + Vector3l(apart * links_++, 0, 0));
      builder_.removeInertia(link);
      builder_.link(link).mass = shaft.slides ? shaft.inertia : 1;
      builder_.link(link).inertia_Cm_K = shaft.inertia * Matrix3l::Identity();
    }
  }

  static std::string nameOf(int shaft) { return "joint_" + std::to_string(shaft); }

  /// Couples shafts, counted from 1, by factors. Returns the coupling, to be changed.
  Coupling& couple(const std::string& name, const std::vector<std::pair<int, double>>& terms) {
    Coupling coupling;
    coupling.name = name;
    for (const auto& [shaft, factor] : terms) coupling.terms.push_back({nameOf(shaft), factor});
    scene.couplings.push_back(coupling);
    return scene.couplings.back();
  }
  void actuate(int shaft) { scene.actuated->push_back(nameOf(shaft)); }

  /// An effort that the shaft needs besides that of its motion.
  void load(int shaft, double effort) {
    JointTerms terms;
    terms.joint = nameOf(shaft);
    terms.offset = effort;
    scene.joints.push_back(terms);
  }

  RobotBuilder& builder() { return builder_; }
  Mechanism mechanism() const { return builder_.build(); }

  Scene scene;

 private:
  RobotBuilder builder_;
  int links_ = 0;
};

}  // namespace virtual_work_dynamics
