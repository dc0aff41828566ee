// A scene from bytes, compiled for robots whose names the corpus has, completed and computed once.
#include <array>

#include "base/printable.h"
#include "fuzz_target.h"
#include "scene/yaml_document.h"
#include "virtual_work_dynamics/closure_axes.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

namespace {

const std::array<Mechanism, 2>& robots() {
  static const std::string folder = VWD_SOURCE_DIR "/urdf/";
  static const std::array<Mechanism, 2> robots{readUrdfFile(folder + "four_bar.urdf"),
                                               readUrdfFile(folder + "spatial_parallelogram.urdf")};
  return robots;
}

// Only YAML's own exceptions say that a text is not YAML; readSceneFile() makes errors of them.
YAML::Node documentOf(const std::string& text) {
  try {
    return readYamlDocument(text);
  } catch (const YAML::Exception& error) {
    throw SceneError(printable(error.what()));  // as readSceneFile() does
  }
}

void compute(const Mechanism& described, const Scene& scene) {
  const SceneOfMechanism robot = mechanismFor(described, scene);
  const Dynamics dynamics(robot.mechanism, robot.scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(dynamics.coordinates());
  motion.q = dynamics.assembly();
  if (dynamics.complete(motion, workspace)) {
    dynamics.compute(motion, workspace);
  } else if (dynamics.whyOpen(motion, workspace).empty()) {
    failFuzz("open without a reason");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  acceptOrRefuse([&] {
    const Scene scene = readScene(documentOf(textOf(data, size)));
    for (const Mechanism& mechanism : robots()) {
      acceptOrRefuse([&] { compute(mechanism, scene); });
    }
  });
  return 0;
}
