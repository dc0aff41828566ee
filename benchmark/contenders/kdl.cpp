#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#ifdef VWD_WITH_KDL_TREE
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#endif

#include "contenders/kdl_model.h"
#include "contenders/offers.h"
#include "contenders/peer_input.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

struct JointArrays {
  KDL::JntArray q, qd, qdd;
};

std::vector<JointArrays> toKdl(const std::vector<Motion>& motions) {
  std::vector<JointArrays> arrays;
  for (const Motion& motion : motions) {
    arrays.push_back({kdlArray(motion.q), kdlArray(motion.qd), kdlArray(motion.qdd)});
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
        solver_(model_, kdlVector(Vector3l(scene.gravity.cast<long double>()))) {}

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
  const KDL::Chain chain = kdlChain(mechanism, serialPath(mechanism));
  const KDL::Wrenches no_forces(chain.getNrOfSegments(), KDL::Wrench::Zero());
  return std::make_unique<KdlContender<KDL::ChainIdSolver_RNE, KDL::Chain, KDL::Wrenches>>(
      scene, mechanism, chain, no_forces);
}

#ifdef VWD_WITH_KDL_TREE
std::unique_ptr<Contender> makeTree(const BenchmarkScene& scene) {
  return std::make_unique<KdlContender<KDL::TreeIdSolver_RNE, KDL::Tree, KDL::WrenchMap>>(
      scene, scene.mechanism, kdlTree(scene.mechanism), KDL::WrenchMap());
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
