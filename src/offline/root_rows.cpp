#include "offline/root_rows.h"

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "base/printable.h"
#include "motion/orientation_length.h"
#include "motion/root_columns.h"
#include "motion/root_completion.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {}  // namespace

void checkRoots(const Scene& scene, const MotionFile& file) {
  const MotionTable& table = file.table;
  if (!scene.root_moves) {
    if (table.roots.empty()) return;
    std::cerr << "warning: " << printable(file.path)
              << ": columns root.… are not used: the scene does not say 'root: moving'\n";
    return;
  }
  std::vector<std::string> missing;
  if (!givesRoot(table, "orientation")) missing.push_back(rootColumnsText("orientation"));
  if (!scene.static_motion && !givesRoot(table, "acceleration") && !givesRoot(table, "position")) {
    missing.push_back(rootColumnsText("acceleration") + " or " + rootColumnsText("position"));
  }
  if (!missing.empty()) {
    throw FileError(file.path + ": columns are missing: " + joined(missing) +
                    ": the scene says 'root: moving'");
  }
  if (table.orientation_error > kOrientationDoubt) {
    std::ostringstream text;
    text.precision(2);
    text << "warning: " << printable(file.path) << ": lengths of root.orientation are up to "
         << table.orientation_error << " off 1; they are scaled to 1\n";
    std::cerr << text.str();
  }
}

void completeRoots(const Mechanism& mechanism, const Scene& scene,
                   const CompletionSettings& settings, MotionFile& file) {
  if (!scene.root_moves || scene.static_motion) return;
  std::vector<std::string> missing;
  for (const char* quantity : {"angular_velocity", "acceleration", "angular_acceleration"}) {
    if (!givesRoot(file.table, quantity)) missing.push_back(rootColumnsText(quantity));
  }
  if (missing.empty()) return;
  std::cerr << "note: " << printable(file.path) << ": estimated: " << joined(missing) << "\n";
  try {
    for (const RootEstimate& estimate : completeRoots(mechanism, file.table, settings))
      describeEstimate(mechanism, file, estimate.names, estimate.report);
  } catch (const MotionError& error) {
    throw FileError(file.path + ": " + error.what());
  }
}

}  // namespace virtual_work_dynamics
