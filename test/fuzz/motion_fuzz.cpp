// A motion from bytes of CSV, for all joints and for chosen ones, with the derivatives it lacks.
#include <cmath>
#include <sstream>

#include "fuzz_target.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

namespace {

void requireRectangular(const MotionTable& table, const std::vector<std::size_t>& lines) {
  const auto rows = static_cast<Eigen::Index>(table.times.size());
  const auto joints = static_cast<Eigen::Index>(table.joints.size());
  if (lines.size() != table.times.size()) failFuzz("lines and rows differ");
  for (const Eigen::MatrixXd* columns :
       {&table.positions, &table.velocities, &table.accelerations}) {
    const bool absent = columns != &table.positions && columns->size() == 0;
    if (!absent && (columns->rows() != rows || columns->cols() != joints)) failFuzz("ragged table");
    if (!columns->allFinite()) failFuzz("a table with values that are not finite");
  }
  if (!table.roots.empty() && table.roots.size() != table.times.size()) failFuzz("ragged roots");
  for (const RootMotion& root : table.roots) {
    if (!root.finite()) failFuzz("a motion of the root that is not finite");
    if (std::abs(root.orientation.norm() - 1) > 1e-12) failFuzz("no orientation");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Mechanism robot = readUrdfFile(VWD_SOURCE_DIR "/urdf/composed_pendulum.urdf");
  const std::string text = textOf(data, size);
  std::vector<std::size_t> lines;
  for (const auto& joints : {std::vector<std::string>(), robot.coordinateNames()}) {
    acceptOrRefuse([&] {
      std::istringstream stream(text);
      const MotionTable table = readMotionCsv(stream, "motion.csv", joints, nullptr, &lines);
      requireRectangular(table, lines);
      if (joints.empty() || table.times.size() > 64) return;
      requireRectangular(completeMotion(robot, table, CompletionSettings()), lines);
    });
  }
  return 0;
}
