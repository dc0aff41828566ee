#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "newton_euler_oracle.h"
#include "property_check.h"

// The same bodies described in other frames and under other names have the same efforts, and
// reactions that are the same vectors.
namespace virtual_work_dynamics {
namespace {

const char kNewRoot[] = "new_root";
const char kHook[] = "hook";

Case withActive(Case made) {
  made.scene.include_active = true;
  return made;
}

// The rest of a reaction with include_active: false; `axis` is that of the joint in the wrench's
// axes.
LongWrench withoutActive(const LongWrench& wrench, const Joint& joint, const Vector3l& axis) {
  LongWrench rest = wrench;
  Vector3l& part = joint.type == JointType::kPrismatic ? rest.force : rest.torque;
  part -= axis.dot(part) * axis;
  return rest;
}

void compareEfforts(const Outcome& a, const Outcome& b, Agreement& agreement) {
  for (const std::string& name : a.coordinates()) {
    agreement.compare("effort of " + name, a.effort(name), b.effort(name));
  }
}

// --- a rigid move of the root
// ---------------------------------------------------------------------- Hangs the mechanism on a
// new root. What its root axes were are turned by R in the new.
Case hung(const Case& made, RandomCases& random, const Vector3l& p, const Matrix3l& R) {
  Description tree(made.mechanism);
  Joint hook;
  hook.name = kHook;
  hook.parent_link = static_cast<int>(tree.links.size());
  hook.p_PoKo_P = p;
  hook.R_PK = R;
  tree.joints.push_back(hook);
  Link root;
  root.name = kNewRoot;
  if (random.chance(0.5)) root.mass = random.uniform(0.1, 5);
  tree.links.push_back(root);
  const Mechanism mechanism = tree.arranged();

  Scene scene = made.scene;
  turnRootAxes(scene, R);
  const bool named = scene.reactions == ReactionSelection::kNamed;
  for (std::string& name : scene.reaction_names) {
    if (name == kGround) name = kHook;
  }
  if (named && random.chance(0.5)) scene.reaction_names.push_back(kGround);
  return {mechanism, scene, reordered(made.mechanism, made.motion, mechanism)};
}

TEST(PropertyOfFrames, ARigidMoveOfTheRootTurnsReactionsAlong) {
  checkProperty(1000000, [](RandomCases& random, Agreement& agreement) {
    const Case a = random.next();
    const Vector3l p = random.vector(2);
    const Matrix3l R = random.rotation();
    const Case b = hung(a, random, p, R);
    agreement.begin({a, b});
    const Outcome in_a(a), in_b(b);
    compareEfforts(in_a, in_b, agreement);
    for (const std::string& name : in_a.reactions()) {
      const std::string there = name == kGround ? kHook : name;
      agreement.compare("child axes of " + name, in_a.child(name), in_b.child(there));
      agreement.compare("root axes of " + name, in_a.root(name).turned(R), in_b.root(there));
    }
  });
}

TEST(PropertyOfFrames, ANewRootPassesTheOldGroundWrenchOn) {
  checkProperty(2000000, [](RandomCases& random, Agreement& agreement) {
    Case a = random.next();
    a.scene.reactions = ReactionSelection::kNamed;
    a.scene.reaction_names = {kGround};
    const Vector3l p = random.vector(2);
    const Matrix3l R = random.rotation();
    Case b = hung(a, random, p, R);
    b.scene.reaction_names = {kGround};
    agreement.begin({a, b});
    const Outcome in_a(a), in_b(b);
    LongWrench expected = in_a.root(kGround).turned(R).about(-p);
    expected.force -= b.mechanism.links()[0].mass * b.scene.gravity.cast<long double>();
    agreement.compare("ground", expected, in_b.root(kGround));
    agreement.compare("ground", in_b.child(kGround), in_b.root(kGround));
  });
}

// --- renaming
// --------------------------------------------------------------------------------------
using NewNames = std::map<std::string, std::string>;

Case renamed(const Case& made, RandomCases& random, NewNames& joints) {
  Description tree(made.mechanism);
  NewNames links;
  int serial = 0;
  for (Link& link : tree.links) link.name = links[link.name] = random.name(serial++);
  for (Joint& joint : tree.joints) joint.name = joints[joint.name] = random.name(serial++);
  const Mechanism mechanism = tree.arranged();

  Scene scene = made.scene;
  for (std::string& name : scene.reaction_names) {
    if (name != kGround) name = joints.at(name);
  }
  for (AppliedWrench& applied : scene.applied_wrenches) applied.link = links.at(applied.link);
  for (JointTerms& terms : scene.joints) terms.joint = joints.at(terms.joint);

  Motion motion(made.motion.q.size());
  for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
    const std::string& name = joints.at(made.mechanism.coordinateNames()[i]);
    const int c = mechanism.joints()[mechanism.jointIndex(name)].coordinate;
    motion.q[c] = made.motion.q[i];
    motion.qd[c] = made.motion.qd[i];
    motion.qdd[c] = made.motion.qdd[i];
  }
  joints[kGround] = kGround;
  return {mechanism, scene, motion};
}

TEST(PropertyOfFrames, NamesChangeNothing) {
  checkProperty(3000000, [](RandomCases& random, Agreement& agreement) {
    const Case a = random.next();
    NewNames names;
    const Case b = renamed(a, random, names);
    agreement.begin({a, b});
    const Outcome in_a(a), in_b(b);
    for (const std::string& name : in_a.coordinates()) {
      agreement.compare("effort of " + name, in_a.effort(name), in_b.effort(names.at(name)));
    }
    ASSERT_EQ(in_a.reactions().size(), in_b.reactions().size());
    for (const std::string& name : in_a.reactions()) {
      agreement.compare("child axes of " + name, in_a.child(name), in_b.child(names.at(name)));
      agreement.compare("root axes of " + name, in_a.root(name), in_b.root(names.at(name)));
    }
  });
}

// --- other frames of the same links -------------------------------------------------------------
struct FrameMove {
  Vector3l p = Vector3l::Zero();  // new origin in the old frame
  Matrix3l R = Matrix3l::Identity();
};

// Gives every link but the root another frame. Its origin stays on the axis of a joint that turns.
Case reframed(const Case& made, RandomCases& random, std::vector<FrameMove>& moves) {
  Description tree(made.mechanism);
  Scene scene = made.scene;
  moves.assign(tree.joints.size(), FrameMove());
  for (std::size_t k = 0; k < tree.joints.size(); ++k) {
    Joint& joint = tree.joints[k];
    FrameMove& move = moves[k];
    const bool turns = joint.type != JointType::kFixed && joint.type != JointType::kPrismatic;
    if (random.chance(0.8)) {
      move.p = turns ? Vector3l(random.uniform(-0.5, 0.5) * joint.axis_K) : random.vector(0.5);
    }
    if (random.chance(0.8)) move.R = random.rotation();
    moveFrame(tree, scene, joint.child_link, move.p, move.R);
    joint.p_PoKo_P += joint.R_PK * move.p;
    joint.R_PK = joint.R_PK * move.R;
    joint.axis_K = move.R.transpose() * joint.axis_K;
  }
  return {tree.arranged(), scene, made.motion};
}

TEST(PropertyOfFrames, OtherLinkFramesOfTheSameBodiesChangeNoVector) {
  checkProperty(4000000, [](RandomCases& random, Agreement& agreement) {
    const Case a = random.next();
    std::vector<FrameMove> moves;
    const Case b = reframed(a, random, moves);
    agreement.begin({a, b});
    const Outcome in_a(withActive(a)), in_b(b);
    const NewtonEulerOracle poses_a(a.mechanism, a.scene, a.motion);
    compareEfforts(in_a, in_b, agreement);
    for (const std::string& name : in_a.reactions()) {
      const int k = a.mechanism.jointIndex(name);
      const FrameMove move = k < 0 ? FrameMove() : moves[k];
      const Matrix3l& R_0K = poses_a.orientation(k + 1);
      LongWrench child = in_a.child(name).about(move.p).turned(move.R.transpose());
      LongWrench root = in_a.root(name).about(R_0K * move.p);
      if (k >= 0 && !b.scene.include_active) {
        const Joint& joint = a.mechanism.joints()[k];
        child = withoutActive(child, joint, b.mechanism.joints()[k].axis_K);
        root = withoutActive(root, joint, R_0K * joint.axis_K);
      }
      agreement.compare("child axes of " + name, child, in_b.child(name));
      agreement.compare("root axes of " + name, root, in_b.root(name));
    }
  });
}

}  // namespace
}  // namespace virtual_work_dynamics
