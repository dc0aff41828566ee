#include "offline/root_rows.h"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "base/printable.h"
#include "motion/root_columns.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Digits of single precision are no reason to warn.
constexpr double kSinglePrecision = 1e-6;

std::vector<std::string> needed(const Scene& scene) {
  if (scene.static_motion) return {"orientation"};
  return {"orientation", "angular_velocity", "acceleration", "angular_acceleration"};
}

}  // namespace

void checkRoots(const Scene& scene, const MotionFile& file) {
  const MotionTable& table = file.table;
  if (!scene.root_moves) {
    if (table.roots.empty()) return;
    std::cerr << "warning: " << printable(file.path)
              << ": columns root.… are not used: the scene does not say 'root: moving'\n";
    return;
  }
  std::string missing;
  for (const std::string& quantity : needed(scene)) {
    const auto& lack = table.roots_lack;
    const bool given =
        !table.roots.empty() && std::find(lack.begin(), lack.end(), quantity) == lack.end();
    if (!given) missing += (missing.empty() ? "" : ", ") + rootColumnsText(quantity);
  }
  if (!missing.empty()) {
    throw FileError(file.path + ": columns are missing: " + missing +
                    ": the scene says 'root: moving', and the root's motion is not estimated");
  }
  if (table.orientation_error > kSinglePrecision) {
    std::ostringstream text;
    text.precision(2);
    text << "warning: " << printable(file.path) << ": lengths of root.orientation are up to "
         << table.orientation_error << " off 1; they are scaled to 1\n";
    std::cerr << text.str();
  }
}

}  // namespace virtual_work_dynamics
