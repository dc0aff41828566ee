#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "coupled_shafts.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

using Change = std::function<void(Scene&)>;

// Two shafts with a gear, a third that mimics the first, and a fixed joint.
struct Geared {
  Geared() : shafts({{1, false}, {2, false}, {1, false}}) {
    shafts.builder().mimicFirst(2, 0.5);
    shafts.builder().add(JointType::kFixed, 0, Vector3l::UnitZ(), Matrix3l::Identity(),
                         Vector3l::Zero());
    shafts.couple("gear", {{1, 1}, {2, -3}}).offset = 0.1;
    shafts.actuate(1);
  }
  CoupledShafts shafts;
};

void expectRefusal(const Change& change, const std::string& text) {
  Geared geared;
  const Mechanism mechanism = geared.shafts.mechanism();
  EXPECT_NO_THROW(ClosedLoopResults(mechanism, geared.shafts.scene));
  change(geared.shafts.scene);
  try {
    ClosedLoopResults(mechanism, geared.shafts.scene);
    ADD_FAILURE() << "nothing thrown: " << text;
  } catch (const SceneError& error) {
    EXPECT_EQ(error.what(), text);
  }
}

Coupling& gearOf(Scene& scene) {
  return scene.couplings[0];
}

TEST(CouplingRefusals, Names) {
  expectRefusal([](Scene& scene) { gearOf(scene).name = ""; }, "couplings: a coupling has no name");
  expectRefusal([](Scene& scene) { gearOf(scene).name = "ground"; },
                "couplings: 'ground': that name is reserved");
  expectRefusal([](Scene& scene) { gearOf(scene).name = "joint_2"; },
                "couplings: 'joint_2': a joint has the same name");
  expectRefusal([](Scene& scene) { scene.couplings.push_back(gearOf(scene)); },
                "couplings: 'gear' is given twice");
  expectRefusal(
      [](Scene& scene) {
        Closure closure;
        closure.name = "gear";
        closure.parent.link = "link_1";
        closure.child.link = "link_2";
        closure.type = ClosureType::kDistance;
        scene.closures = {closure};
      },
      "couplings: 'gear': a closure has the same name");
}

TEST(CouplingRefusals, Terms) {
  expectRefusal([](Scene& scene) { gearOf(scene).terms.clear(); },
                "couplings: 'gear': it has no terms");
  expectRefusal([](Scene& scene) { gearOf(scene).terms[1].name = "joint_9"; },
                "couplings[0].terms[1].name: no joint 'joint_9'; known are 'joint_1', 'joint_2', "
                "'joint_3' and 'joint_4'");
  expectRefusal([](Scene& scene) { gearOf(scene).terms[1].name = "joint_1"; },
                "couplings: 'gear': 'joint_1' is given twice");
  expectRefusal([](Scene& scene) { gearOf(scene).terms[1].name = "joint_4"; },
                "couplings: 'gear': 'joint_4' is a fixed joint");
  expectRefusal([](Scene& scene) { gearOf(scene).terms[0].value = 0; },
                "couplings: 'gear': 'joint_1': factor = 0 is zero or not finite");
  const double infinity = std::numeric_limits<double>::infinity();
  expectRefusal([&](Scene& scene) { gearOf(scene).terms[0].value = infinity; },
                "couplings: 'gear': 'joint_1': factor = inf is zero or not finite");
  expectRefusal([&](Scene& scene) { gearOf(scene).offset = infinity; },
                "couplings: 'gear': the offset is not finite");
  expectRefusal([](Scene& scene) { gearOf(scene).rate_only = true; },
                "couplings: 'gear': rate_only: what ties velocities alone has no offset");
}

// joint_3 = 2 joint_1 + 0.5 by the description.
TEST(CouplingRefusals, WhatMimicJointsSayAlready) {
  const auto mimic = [](double offset) {
    return [offset](Scene& scene) {
      Coupling coupling;
      coupling.name = "again";
      coupling.terms = {{"joint_3", 1}, {"joint_1", -2}};
      coupling.offset = offset;
      scene.couplings.push_back(coupling);
    };
  };
  expectRefusal(
      mimic(0.5),
      "couplings: 'again': mimic joints of the description say the same already; leave it "
      "out");
  expectRefusal(
      mimic(0.75),
      "couplings: 'again': it contradicts the mimic joints of the description by 0.25 rad");
}

TEST(CouplingRefusals, CouplingsThatContradictEachOther) {
  // joint_1 = 3 joint_2 + 0.1.
  expectRefusal(
      [](Scene& scene) {
        Coupling coupling;
        coupling.name = "belt";
        coupling.terms = {{"joint_2", 6}, {"joint_1", -2}};
        coupling.offset = 0.3;
        scene.couplings.push_back(coupling);
      },
      "couplings: 'belt' contradicts 'gear' by 0.5 rad");
  // By way of a mimic joint: joint_3 = 6 joint_2 + 0.7.
  expectRefusal(
      [](Scene& scene) {
        Coupling coupling;
        coupling.name = "belt";
        coupling.terms = {{"joint_3", 1}, {"joint_2", -6}};
        coupling.offset = 0.6;
        scene.couplings.push_back(coupling);
      },
      "couplings: 'belt' contradicts 'gear' by 0.1 rad");
  // A chain of them, where a redundant one in between says nothing wrong.
  expectRefusal(
      [](Scene& scene) {
        for (const auto& [name, factor, offset] :
             {std::tuple("same", 2.0, 0.2), std::tuple("brake", 0.0, 0.4)}) {
          Coupling coupling;
          coupling.name = name;
          if (factor > 0) coupling.terms = {{"joint_1", factor}, {"joint_2", -3 * factor}};
          if (factor == 0) coupling.terms = {{"joint_2", 1}};
          coupling.offset = offset;
          scene.couplings.push_back(coupling);
        }
        Coupling last;
        last.name = "lock";
        last.terms = {{"joint_1", 1}};
        last.offset = 1.4;
        scene.couplings.push_back(last);
      },
      "couplings: 'lock' contradicts 'gear' and 'brake' by 0.1 rad");
}

TEST(CouplingRefusals, JointsOfSeveralFreedoms) {
  CoupledShafts shafts({{1, false}, {1, false}});
  shafts.couple("gear", {{1, 1}, {2, 1}});
  JointTypeEntry entry;
  entry.joint = "joint_2";
  entry.type = CompoundType::kSpherical;
  shafts.scene.joint_types = {entry};
  const Mechanism mechanism = withJointTypes(shafts.mechanism(), shafts.scene);
  const auto refusal = [&] {
    try {
      ClosedLoopResults(mechanism, shafts.scene);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal().find("couplings[0].terms[1].name: joint 'joint_2' has several freedoms"), 0u)
      << refusal();
  shafts.scene.couplings[0].terms[1].name = "joint_2.rz";
  EXPECT_EQ(refusal(),
            "couplings: 'gear': 'joint_2.rz' turns freely, so that it has no angle that lasts");
}

TEST(CouplingRefusals, OpenChainsHaveNone) {
  Geared geared;
  try {
    InverseDynamics(geared.shafts.mechanism(), geared.shafts.scene);
    ADD_FAILURE();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(), "couplings: 'gear': an open chain has no couplings");
  }
}

// What no coupling and no actuator holds is named, as in loops.
TEST(CouplingRefusals, TooFewActuators) {
  expectRefusal([](Scene& scene) { scene.actuated->clear(); },
                "actuated: too few for the degrees of freedom: nothing holds the motion of "
                "'joint_1', 'joint_2' (free_motion: true reports what that motion demands)");
}

}  // namespace
}  // namespace virtual_work_dynamics
