// A robot description from bytes, compiled and computed once in the position zero, and once more
// with its transmissions.
#include "fuzz_target.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/transmissions.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

namespace {

void compute(const Mechanism& mechanism, const Scene& scene) {
  const Dynamics dynamics(mechanism, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(Motion(dynamics.coordinates()), workspace);
  const std::size_t results = dynamics.effortNames().size();
  if (workspace.results().effort.size() != static_cast<Eigen::Index>(results)) {
    failFuzz("number of efforts");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  acceptOrRefuse([&] {
    const Mechanism mechanism = readUrdf(textOf(data, size));
    compute(mechanism, Scene());
    if (mechanism.transmissions().empty()) return;
    Scene scene;
    scene.transmissions = TransmissionSelection::kAll;
    const SceneOfMechanism robot = withTransmissions(mechanism, scene);
    compute(robot.mechanism, robot.scene);
  });
  return 0;
}
