#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <iostream>

#include "contenders/offers.h"
#include "contenders/peer_input.h"

namespace virtual_work_dynamics {
namespace {

using dart::dynamics::BodyNode;
using dart::dynamics::PrismaticJoint;
using dart::dynamics::RevoluteJoint;
using dart::dynamics::Skeleton;
using dart::dynamics::SkeletonPtr;

// DART writes several lines about every slender rod and computes with it all the same.
class SilentErrorStream {
 public:
  SilentErrorStream() : buffer_(std::cerr.rdbuf(nullptr)) {}
  ~SilentErrorStream() { std::cerr.rdbuf(buffer_); }
  SilentErrorStream(const SilentErrorStream&) = delete;
  SilentErrorStream& operator=(const SilentErrorStream&) = delete;

 private:
  std::streambuf* buffer_;
};

template <typename DartJoint>
BodyNode* addLink(Skeleton& skeleton, BodyNode* parent, const Joint& joint, const Link& link) {
  typename DartJoint::Properties properties;
  properties.mName = joint.name;
  properties.mAxis = joint.axis_K.cast<double>();
  properties.mT_ParentBodyToJoint.linear() = joint.R_PK.cast<double>();
  properties.mT_ParentBodyToJoint.translation() = joint.p_PoKo_P.cast<double>();
  BodyNode::Properties body;
  body.mName = link.name;
  body.mInertia =
      dart::dynamics::Inertia(static_cast<double>(link.mass), link.p_KoCm_K.cast<double>(),
                              link.inertia_Cm_K.cast<double>());
  return skeleton.createJointAndBodyNodePair<DartJoint>(parent, properties, body).second;
}

// The root link is the world, so body i is link i + 1; joints keep their order.
SkeletonPtr makeSkeleton(const Mechanism& mechanism, const Eigen::Vector3d& gravity) {
  const SilentErrorStream silent;
  SkeletonPtr skeleton = Skeleton::create(mechanism.name());
  skeleton->setGravity(gravity);
  std::vector<BodyNode*> bodies{nullptr};
  for (const Joint& joint : mechanism.joints()) {
    const auto add =
        joint.type == JointType::kPrismatic ? addLink<PrismaticJoint> : addLink<RevoluteJoint>;
    bodies.push_back(
        add(*skeleton, bodies[joint.parent_link], joint, mechanism.links()[joint.child_link]));
  }
  return skeleton;
}

// DART computes body forces with the efforts: the wrench of the parent about the joint, in the
// child's axes. With reactions, those are read as well.
class DartContender : public Contender {
 public:
  DartContender(const BenchmarkScene& scene, const std::string& outputs,
                const SkeletonPtr& skeleton)
      : mechanism_(withoutFixedJoints(scene.mechanism)),
        movable_(movableJoints(mechanism_)),
        states_(jointMotions(mechanism_, scene.motions, movable_)),
        skeleton_(skeleton),
        body_forces_(outputs == kEffortsAndReactions ? movable_.size() : 0) {}

  void run(std::size_t calls) override {
    Skeleton& skeleton = *skeleton_;
    for (; calls > 0; --calls) {
      const Motion& state = states_[cycle_.next()];
      skeleton.setPositions(state.q);
      skeleton.setVelocities(state.qd);
      skeleton.setAccelerations(state.qdd);
      skeleton.computeInverseDynamics();
      for (std::size_t i = 0; i < body_forces_.size(); ++i) {
        body_forces_[i] = skeleton.getBodyNode(i)->getBodyForce();
      }
    }
  }

  SampleResults results(std::size_t) const override {
    SampleResults results{coordinateEfforts(mechanism_, movable_, skeleton_->getForces()), {}};
    for (const Eigen::Vector6d& moment_and_force : body_forces_) {
      for (const int first : {3, 0}) {
        const double* part = moment_and_force.data() + first;
        results.reactions.insert(results.reactions.end(), part, part + 3);
      }
    }
    return results;
  }

 private:
  Mechanism mechanism_;
  std::vector<int> movable_;
  std::vector<Motion> states_;
  SkeletonPtr skeleton_;
  std::vector<Eigen::Vector6d> body_forces_;
  StateCycle cycle_;
};

}  // namespace

void offerDart(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  const auto skeleton = std::make_shared<SkeletonPtr>();  // takes seconds for long chains: once
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"dart", "double", "single", outputs, 1};
    offers.push_back({label, [&scene, outputs, skeleton] {
                        if (!*skeleton)
                          *skeleton =
                              makeSkeleton(withoutFixedJoints(scene.mechanism), scene.gravity);
                        return std::make_unique<DartContender>(scene, outputs, *skeleton);
                      }});
  }
}

}  // namespace virtual_work_dynamics
