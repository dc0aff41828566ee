#include "stability/kdl_efforts.h"

#include <algorithm>
#include <string>

#include "virtual_work_dynamics/error.h"

#ifdef VWD_WITH_KDL

#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#ifdef VWD_WITH_KDL_TREE
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#endif

#include "contenders/kdl_model.h"
#include "contenders/peer_input.h"

namespace virtual_work_dynamics {
namespace {

template <typename Solver, typename Forces>
std::vector<std::vector<double>> solved(Solver& solver, const Scene& scene,
                                        const std::vector<Motion>& motions,
                                        const Forces& no_forces) {
  std::vector<std::vector<double>> all;
  for (Motion motion : motions) {
    if (scene.static_motion) {
      motion.qd.setZero();
      motion.qdd.setZero();
    }
    KDL::JntArray efforts(static_cast<unsigned int>(motion.q.size()));
    const int status = solver.CartToJnt(kdlArray(motion.q), kdlArray(motion.qd),
                                        kdlArray(motion.qdd), no_forces, efforts);
    if (status < 0) throw Error("KDL: " + std::string(solver.strError(status)));
    all.emplace_back(efforts.data.data(), efforts.data.data() + efforts.data.size());
  }
  return all;
}

}  // namespace

bool kdlComputes(const Mechanism& mechanism, const Scene& scene) {
  const std::vector<Joint>& joints = mechanism.joints();
  const auto mimics = [](const Joint& joint) { return joint.mimics; };
  if (!scene.joints.empty() || std::any_of(joints.begin(), joints.end(), mimics)) return false;
#ifdef VWD_WITH_KDL_TREE
  return true;
#else
  return !serialPath(mechanism).empty();
#endif
}

std::vector<std::vector<double>> kdlEfforts(const Mechanism& mechanism, const Scene& scene,
                                            const std::vector<Motion>& motions) {
  if (!kdlComputes(mechanism, scene)) throw Error("KDL cannot compute " + mechanism.name());
  const KDL::Vector gravity = kdlVector(scene.gravity.cast<long double>());
  const std::vector<int> path = serialPath(mechanism);
#ifdef VWD_WITH_KDL_TREE
  if (path.empty()) {
    const KDL::Tree tree = kdlTree(mechanism);
    KDL::TreeIdSolver_RNE solver(tree, gravity);
    return solved(solver, scene, motions, KDL::WrenchMap());
  }
#endif
  const KDL::Chain chain = kdlChain(mechanism, path);
  KDL::ChainIdSolver_RNE solver(chain, gravity);
  return solved(solver, scene, motions,
                KDL::Wrenches(chain.getNrOfSegments(), KDL::Wrench::Zero()));
}

}  // namespace virtual_work_dynamics

#else

namespace virtual_work_dynamics {

bool kdlComputes(const Mechanism&, const Scene&) {
  return false;
}

std::vector<std::vector<double>> kdlEfforts(const Mechanism& mechanism, const Scene&,
                                            const std::vector<Motion>&) {
  throw Error("built without KDL, which '" + mechanism.name() + "' needs");
}

}  // namespace virtual_work_dynamics

#endif
