#include "contenders/offers.h"

namespace virtual_work_dynamics {

std::vector<Offer> offersFor(const BenchmarkScene& scene) {
  std::vector<Offer> offers;
  if (scene.loops) {
    offerOwnLoops(scene, offers);
    offerDenseLoops(scene, offers);
    offerLoopFormalisms(scene, offers);
    return offers;
  }
  offerKdl(scene, offers);
#ifdef VWD_WITH_MUJOCO
  offerMujoco(scene, offers);
#endif
#ifdef VWD_WITH_DART
  offerDart(scene, offers);
#endif
  offerOwnSingle(scene, offers);
  offerOwnLongDouble(scene, offers);
  offerOwnBlocks(scene, offers);
  offerGenerated(scene, offers);
  offerOwnLagrange(scene, offers);
  return offers;
}

}  // namespace virtual_work_dynamics
