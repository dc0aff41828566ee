#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/tree.hpp>
#ifdef VWD_WITH_KDL_TREE
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#endif

#include "offers.h"
#include "peer_input.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

KDL::Vector toKdl(const Vector3l& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

KDL::Rotation toKdl(const Matrix3l& R) {
  return {toKdl(Vector3l(R.col(0))), toKdl(Vector3l(R.col(1))), toKdl(Vector3l(R.col(2)))};
}

// As kdl_parser makes it of a joint and its child link.
KDL::Segment segmentOf(const Mechanism& mechanism, int index) {
  const Joint& joint = mechanism.joints()[index];
  const Link& link = mechanism.links()[index + 1];
  KDL::Joint kdl_joint(joint.name);
  if (joint.type != JointType::kFixed) {
    kdl_joint = KDL::Joint(
        joint.name, toKdl(joint.p_PoKo_P), toKdl(Vector3l(joint.R_PK * joint.axis_K)),
        joint.type == JointType::kPrismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis);
  }
  const Eigen::Matrix3d I = link.inertia_Cm_K.cast<double>();
  return KDL::Segment(link.name, kdl_joint, KDL::Frame(toKdl(joint.R_PK), toKdl(joint.p_PoKo_P)),
                      KDL::RigidBodyInertia(static_cast<double>(link.mass), toKdl(link.p_KoCm_K),
                                            KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2),
                                                                   I(0, 1), I(0, 2), I(1, 2))));
}

struct JointArrays {
  KDL::JntArray q, qd, qdd;
};

KDL::JntArray toKdl(const Eigen::VectorXd& values) {
  KDL::JntArray array(static_cast<unsigned int>(values.size()));
  array.data = values;
  return array;
}

std::vector<JointArrays> toKdl(const std::vector<Motion>& motions) {
  std::vector<JointArrays> arrays;
  for (const Motion& motion : motions) {
    arrays.push_back({toKdl(motion.q), toKdl(motion.qd), toKdl(motion.qdd)});
  }
  return arrays;
}

// A solver of chains or trees, on the model and the outside forces it takes. KDL gives efforts
// only.
template <typename Solver, typename Model, typename Forces>
class KdlContender : public Contender {
 public:
  KdlContender(const BenchmarkScene& scene, Mechanism mechanism, Model model, Forces no_forces)
      : mechanism_(std::move(mechanism)),
        model_(std::move(model)),
        no_forces_(std::move(no_forces)),
        movable_(movableJoints(mechanism_)),
        states_(toKdl(jointMotions(mechanism_, scene.motions, movable_))),
        efforts_(static_cast<unsigned int>(movable_.size())),
        solver_(model_, toKdl(Vector3l(scene.gravity.cast<long double>()))) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      const JointArrays& state = states_[cycle_.next()];
      const int status = solver_.CartToJnt(state.q, state.qd, state.qdd, no_forces_, efforts_);
      if (status < 0) throw Error("KDL: " + std::string(solver_.strError(status)));
    }
  }

  SampleResults results(std::size_t) const override {
    return {coordinateEfforts(mechanism_, movable_, efforts_.data), {}};
  }

 private:
  Mechanism mechanism_;
  Model model_;  // the solver keeps a reference to it
  Forces no_forces_;
  std::vector<int> movable_;
  std::vector<JointArrays> states_;
  KDL::JntArray efforts_;
  Solver solver_;
  StateCycle cycle_;
};

std::unique_ptr<Contender> makeChain(const BenchmarkScene& scene, const Mechanism& mechanism) {
  KDL::Chain chain;
  for (const int joint : serialPath(mechanism)) chain.addSegment(segmentOf(mechanism, joint));
  const KDL::Wrenches no_forces(chain.getNrOfSegments(), KDL::Wrench::Zero());
  return std::make_unique<KdlContender<KDL::ChainIdSolver_RNE, KDL::Chain, KDL::Wrenches>>(
      scene, mechanism, chain, no_forces);
}

#ifdef VWD_WITH_KDL_TREE
std::unique_ptr<Contender> makeTree(const BenchmarkScene& scene) {
  const Mechanism& mechanism = scene.mechanism;
  KDL::Tree tree(mechanism.links()[0].name);
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) {
    const Link& parent = mechanism.links()[mechanism.joints()[k].parent_link];
    tree.addSegment(segmentOf(mechanism, static_cast<int>(k)), parent.name);
  }
  return std::make_unique<KdlContender<KDL::TreeIdSolver_RNE, KDL::Tree, KDL::WrenchMap>>(
      scene, mechanism, tree, KDL::WrenchMap());
}
#endif

}  // namespace

void offerKdl(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  const auto label = [](const char* method) {
    return Label{method, "double", "single", kEfforts, 1};
  };
  if (!serialPath(scene.mechanism).empty()) {
    offers.push_back({label("kdl_chain"), [&scene] { return makeChain(scene, scene.mechanism); }});
    offers.push_back({label("kdl_chain_lumped"),
                      [&scene] { return makeChain(scene, withoutFixedJoints(scene.mechanism)); }});
  }
#ifdef VWD_WITH_KDL_TREE
  offers.push_back({label("kdl_tree"), [&scene] { return makeTree(scene); }});
#endif
}

}  // namespace virtual_work_dynamics
