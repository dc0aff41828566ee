#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <string>
#include <vector>

#include "link_motions.h"
#include "newton_euler_oracle.h"
#include "property_check.h"

// The same bodies held at another link. A tree whose link n rests in space may as well be described
// from there: n becomes the root, the joints between n and the old root are seen from their other
// sides, and what ground exerted on the old root is a wrench that is applied to it. The new ground
// has nothing left to hold.
namespace virtual_work_dynamics {
namespace {

// Joints from the root to a link, in that order.
std::vector<int> pathTo(const Mechanism& mechanism, int link) {
  std::vector<int> path;
  for (; link > 0; link = mechanism.joints()[path.front()].parent_link) {
    path.insert(path.begin(), mechanism.links()[link].parent_joint);
  }
  return path;
}

Scene withEveryReaction(Scene scene, const Mechanism& mechanism) {
  scene.include_active = true;
  scene.reactions = ReactionSelection::kNamed;
  scene.reaction_names = {kGround};
  for (const Joint& joint : mechanism.joints()) scene.reaction_names.push_back(joint.name);
  return scene;
}

AppliedWrench groundAsApplied(const Mechanism& mechanism, const LongWrench& ground) {
  AppliedWrench applied;
  applied.link = mechanism.links()[0].name;
  applied.force = ground.force.cast<double>();
  applied.torque = ground.torque.cast<double>();
  return applied;
}

// Turns the joints of the path over. On the path, the frame of a link moves to where the next joint
// is at q = 0; the new root keeps its own, whose orientation in the old root axes is R_0N.
Case rerooted(const Case& made, int new_root, const LongWrench& ground, const Matrix3l& R_0N) {
  Description tree(made.mechanism);
  Scene scene = made.scene;
  scene.applied_wrenches.push_back(groundAsApplied(made.mechanism, ground));
  const std::vector<int> path = pathTo(made.mechanism, new_root);
  const std::vector<Joint>& old = made.mechanism.joints();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Joint& was = old[path[i]];
    moveFrame(tree, scene, was.parent_link, was.p_PoKo_P, was.R_PK);
    Joint& joint = tree.joints[path[i]];  // stands at its new parent's origin, until that moves
    joint.parent_link = was.child_link;
    joint.child_link = was.parent_link;
    joint.axis_K = -was.axis_K;
    joint.p_PoKo_P.setZero();
    joint.R_PK.setIdentity();
  }
  turnRootAxes(scene, R_0N.transpose());
  const Mechanism mechanism = tree.arranged();
  return {mechanism, scene, reordered(made.mechanism, made.motion, mechanism)};
}

// Sets the joints on the path to rest, and with them those that share their coordinates.
void holdStill(const Mechanism& mechanism, const std::vector<int>& path, Motion& motion) {
  for (const int k : path) {
    const int c = mechanism.joints()[k].coordinate;
    if (c >= 0) motion.qd[c] = motion.qdd[c] = 0;
  }
}

// Results of the mechanism that is held at another link, with the errors of the wrench that
// replaces the old ground's: it reaches everything that now carries the old root.
class RerootedOutcome {
 public:
  RerootedOutcome(const Case& b, const LongWrench& ground, const NewtonEulerOracle& poses_a,
                  const Mechanism& a, const std::vector<int>& path)
      : outcome_(b), ground_(ground), poses_(poses_a), a_(a), path_(path) {}

  bool turnedOver(int joint) const {
    return std::find(path_.begin(), path_.end(), joint) != path_.end();
  }

  LongWrench child(const std::string& name) const { return loaded(outcome_.child(name), name); }
  LongWrench root(const std::string& name) const { return loaded(outcome_.root(name), name); }

  LongWrench ground(int new_root) const {
    return loaded(outcome_.root(kGround), poses_.origin(new_root).norm());
  }

  Measured effort(const std::string& name) const {
    Measured effort = outcome_.effort(name);
    for (const int k : path_) {
      const Joint& joint = a_.joints()[k];
      if (joint.coordinate != a_.joints()[a_.jointIndex(name)].coordinate) continue;
      const LongWrench part = loaded(LongWrench(), joint.name);
      effort.error += std::abs(joint.multiplier) *
                      (joint.type == JointType::kPrismatic ? part.force_error : part.torque_error);
    }
    return effort;
  }

 private:
  LongWrench loaded(const LongWrench& wrench, const std::string& name) const {
    const int k = a_.jointIndex(name);
    return turnedOver(k) ? loaded(wrench, poses_.origin(k + 1).norm()) : wrench;
  }
  LongWrench loaded(LongWrench wrench, long double distance) const {
    wrench.force_error += ground_.force_error;
    wrench.torque_error += ground_.torque_error + distance * ground_.force_error;
    return wrench;
  }

  Outcome outcome_;
  LongWrench ground_;
  const NewtonEulerOracle& poses_;
  const Mechanism& a_;
  const std::vector<int>& path_;
};

void compareRerooted(const Case& a, int new_root, Agreement& agreement) {
  agreement.begin({a});
  const Outcome in_a(a);
  const NewtonEulerOracle poses(a.mechanism, a.scene, a.motion);
  const Matrix3l& R_0N = poses.orientation(new_root);
  const LongWrench ground = in_a.root(kGround);
  const Case b = rerooted(a, new_root, ground, R_0N);
  agreement.begin({a, b});
  const std::vector<int> path = pathTo(a.mechanism, new_root);
  const RerootedOutcome in_b(b, ground, poses, a.mechanism, path);

  for (const Joint& joint : a.mechanism.joints()) {
    const std::string& name = joint.name;
    LongWrench root = in_a.root(name), child = in_a.child(name);
    if (in_b.turnedOver(joint.child_link - 1)) {
      // The other side's frame is the one that the joint has in its old parent at q = 0.
      const Matrix3l& R_0P = poses.orientation(joint.parent_link);
      const Vector3l o = poses.origin(joint.parent_link) + R_0P * joint.p_PoKo_P;
      root = -1 * root.about(o - poses.origin(joint.child_link));
      child = root.turned((R_0P * joint.R_PK).transpose());
    }
    agreement.compare("child axes of " + name, child, in_b.child(name));
    agreement.compare("root axes of " + name, root.turned(R_0N.transpose()), in_b.root(name));
  }
  agreement.compare("new ground", LongWrench(), in_b.ground(new_root));
  for (const std::string& name : in_a.coordinates()) {
    agreement.compare("effort of " + name, in_a.effort(name), in_b.effort(name));
  }
}

// The joints between the two roots stand still, the others move.
TEST(PropertyOfRerooting, ATreeMayBeHeldAtAnyLinkThatRests) {
  checkProperty(5000000, [](RandomCases& random, Agreement& agreement) {
    Case a = random.next(2 + random.pick(11));
    const int new_root = 1 + random.pick(static_cast<int>(a.mechanism.joints().size()));
    holdStill(a.mechanism, pathTo(a.mechanism, new_root), a.motion);
    a.scene = withEveryReaction(a.scene, a.mechanism);
    compareRerooted(a, new_root, agreement);
  });
}

// --- all joints move, and the new root does not ------------------------------------------------
using MatrixXl = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using VectorXl = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using Vector6l = Eigen::Matrix<long double, 6, 1>;

// A chain of at least eight coordinates, so that its end can rest while they move.
Case longChain(RandomCases& random) {
  for (;;) {
    Case made = random.next(10 + random.pick(3));
    if (made.mechanism.coordinates().size() < 8 || made.scene.static_motion) continue;
    const std::vector<Joint>& joints = made.mechanism.joints();
    if (std::all_of(joints.begin(), joints.end(),
                    [](const Joint& joint) { return joint.parent_link == joint.child_link - 1; })) {
      return made;
    }
  }
}

// Rates of change of the pose of a link's frame, root axes, for one velocity after the other.
MatrixXl jacobian(const Mechanism& mechanism, int link, const Motion& motion) {
  const std::size_t n = mechanism.coordinates().size();
  const std::vector<long double> q(motion.q.data(), motion.q.data() + motion.q.size());
  MatrixXl J(6, n);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<long double> qd(n, 0);
    qd[i] = 1;
    const LinkMotion<long double> move = linkMotions<long double>(mechanism, q, qd)[link];
    J.col(static_cast<Eigen::Index>(i)) << move.v, move.w;
  }
  return J;
}

// Joints that cannot move while the link rests, such as three that turn among others that slide,
// are left with the rounding errors of long double.
Eigen::VectorXd withoutNoise(const VectorXl& v, long double size) {
  return (v.array().abs() < kEps * size).select(VectorXl::Zero(v.size()), v).cast<double>();
}

// Puts velocities and accelerations where they do not move the link. False where the chain is
// singular, which velocities may leave so that no acceleration holds the link.
bool keepAtRest(const Mechanism& mechanism, int link, Motion& motion) {
  const MatrixXl J = jacobian(mechanism, link, motion);
  const Eigen::FullPivLU<MatrixXl> solver(J);
  if (solver.rank() < 6) return false;
  const MatrixXl kernel = solver.kernel();
  const VectorXl qd = kernel * (kernel.transpose() * motion.qd.cast<long double>());
  const VectorXl free = kernel * (kernel.transpose() * motion.qdd.cast<long double>());
  const long double speed = qd.cwiseAbs().maxCoeff();
  motion.qd = withoutNoise(qd, speed);
  motion.qdd.setZero();
  const LinkMotion<Rated> move = linkMotions(mechanism, motion)[link];
  Vector6l drift;  // what velocities alone change of the link's twist
  drift << rateOf(move.v), rateOf(move.w);
  motion.qdd = withoutNoise(free - solver.solve(drift), free.cwiseAbs().maxCoeff() + speed * speed);
  return true;
}

TEST(PropertyOfRerooting, AChainMayMoveBetweenEndsThatRest) {
  checkProperty(
      6000000,
      [](RandomCases& random, Agreement& agreement) {
        Case a = longChain(random);
        const auto last = [&] { return static_cast<int>(a.mechanism.joints().size()); };
        while (!keepAtRest(a.mechanism, last(), a.motion)) a = longChain(random);
        a.scene = withEveryReaction(a.scene, a.mechanism);
        compareRerooted(a, last(), agreement);
      },
      casesPerProperty() / 5);
}

}  // namespace
}  // namespace virtual_work_dynamics
