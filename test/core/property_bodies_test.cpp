#include <gtest/gtest.h>

#include <string>

#include "link_balance.h"
#include "property_check.h"

// Bodies in two parts, and each body for itself.
namespace virtual_work_dynamics {
namespace {

const char kPart[] = "part";

// Second moment of a unit mass at `d`, as an inertia.
Matrix3l pointInertia(const Vector3l& d) {
  return d.squaredNorm() * Matrix3l::Identity() - d * d.transpose();
}

// A part of a body, in the body's frame; what remains of it is taken from `body`.
Link partOf(Link& body, RandomCases& random) {
  Link part;
  part.name = kPart;
  if (body.mass == 0) return part;
  const Link whole = body;
  part.mass = random.uniform(0.1, 0.9) * whole.mass;
  part.p_KoCm_K = whole.p_KoCm_K + random.vector(0.2);
  part.inertia_Cm_K = random.uniform(0, 1) * whole.inertia_Cm_K;
  body.mass = whole.mass - part.mass;
  body.p_KoCm_K = (whole.mass * whole.p_KoCm_K - part.mass * part.p_KoCm_K) / body.mass;
  body.inertia_Cm_K = whole.inertia_Cm_K - part.inertia_Cm_K -
                      part.mass * pointInertia(part.p_KoCm_K - whole.p_KoCm_K) -
                      body.mass * pointInertia(body.p_KoCm_K - whole.p_KoCm_K);
  return part;
}

// Splits a link in two that a fixed joint of that name holds together. Some of the joints that the
// link carries, and some of the wrenches on it, go with the part.
Case split(const Case& made, const std::string& weld, RandomCases& random) {
  Description tree(made.mechanism);
  Scene scene = made.scene;
  const int link = random.pick(static_cast<int>(tree.links.size()));
  const int part = static_cast<int>(tree.links.size());
  tree.links.push_back(partOf(tree.links[link], random));
  for (Joint& joint : tree.joints) {
    if (joint.parent_link == link && random.chance(0.5)) joint.parent_link = part;
  }
  for (AppliedWrench& applied : scene.applied_wrenches) {
    if (applied.link == tree.links[link].name && random.chance(0.5)) applied.link = kPart;
  }
  Joint joint;
  joint.name = weld;
  joint.parent_link = link;
  joint.child_link = part;
  joint.p_PoKo_P = random.vector(0.5);
  joint.R_PK = random.rotation();
  moveFrame(tree, scene, part, joint.p_PoKo_P, joint.R_PK);
  tree.joints.push_back(joint);
  const Mechanism mechanism = tree.arranged();
  return {mechanism, scene, reordered(made.mechanism, made.motion, mechanism)};
}

void requestEveryReaction(Case& made) {
  made.scene.include_active = true;
  made.scene.reactions = ReactionSelection::kNamed;
  made.scene.reaction_names = {kGround};
  for (const Joint& joint : made.mechanism.joints()) {
    made.scene.reaction_names.push_back(joint.name);
  }
}

void expectBalance(const Case& made, const Outcome& outcome, int link, Agreement& agreement) {
  const LinkBalance balance(made);
  agreement.compare("balance of " + made.mechanism.links()[link].name, balance.needed(link),
                    balance.published(link, outcome));
}

TEST(PropertyOfBodies, AFixedJointMaySplitThemOrBeLeftOut) {
  checkProperty(10000000, [](RandomCases& random, Agreement& agreement) {
    const Case a = random.next();
    const std::string weld = random.name(100);
    Case b = split(a, weld, random);
    if (b.scene.reactions == ReactionSelection::kNamed && random.chance(0.5)) {
      b.scene.reaction_names.push_back(weld);  // is not merged then
    }
    agreement.begin({a, b});
    const Outcome in_a(a), in_b(b);
    for (const std::string& name : in_a.coordinates()) {
      agreement.compare("effort of " + name, in_a.effort(name), in_b.effort(name));
    }
    for (const std::string& name : in_a.reactions()) {
      agreement.compare("child axes of " + name, in_a.child(name), in_b.child(name));
      agreement.compare("root axes of " + name, in_a.root(name), in_b.root(name));
    }
  });
}

TEST(PropertyOfBodies, AFixedJointHoldsThePartThatItCarries) {
  checkProperty(11000000, [](RandomCases& random, Agreement& agreement) {
    Case made = split(random.next(), random.name(100), random);
    requestEveryReaction(made);
    agreement.begin({made});
    expectBalance(made, Outcome(made), made.mechanism.linkIndex(kPart), agreement);
  });
}

TEST(PropertyOfBodies, PublishedReactionsMoveEachLink) {
  checkProperty(12000000, [](RandomCases& random, Agreement& agreement) {
    Case made = random.next();
    requestEveryReaction(made);
    agreement.begin({made});
    const Outcome outcome(made);
    for (std::size_t i = 0; i < made.mechanism.links().size(); ++i) {
      expectBalance(made, outcome, static_cast<int>(i), agreement);
    }
  });
}

// (3.7); what acts between actuator and mechanism is left out.
TEST(PropertyOfBodies, EffortsAreReactionsAlongTheAxes) {
  checkProperty(13000000, [](RandomCases& random, Agreement& agreement) {
    Case made = random.next(2 + random.pick(11));
    requestEveryReaction(made);
    made.scene.joints.clear();
    made.scene.use_urdf_dynamics = false;
    agreement.begin({made});
    const Outcome outcome(made);
    std::vector<Measured> sums(outcome.coordinates().size());
    for (const Joint& joint : made.mechanism.joints()) {
      if (joint.coordinate < 0) continue;
      const LongWrench wrench = outcome.child(joint.name);
      const Measured along = joint.type == JointType::kPrismatic
                                 ? Measured{joint.axis_K.dot(wrench.force), wrench.force_error}
                                 : Measured{joint.axis_K.dot(wrench.torque), wrench.torque_error};
      sums[joint.coordinate] = sums[joint.coordinate] + joint.multiplier * along;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::string& name = outcome.coordinates()[i];
      agreement.compare("effort of " + name, sums[i], outcome.effort(name));
    }
  });
}

}  // namespace
}  // namespace virtual_work_dynamics
