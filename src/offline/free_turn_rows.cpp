#include "offline/free_turn_rows.h"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "base/printable.h"
#include "motion/free_columns.h"
#include "motion/free_turn_completion.h"
#include "motion/orientation_length.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

const FreeTurns* turnsOf(const MotionTable& table, const std::string& joint) {
  const auto found = std::find_if(table.turns.begin(), table.turns.end(),
                                  [&](const FreeTurns& turns) { return turns.joint == joint; });
  return found == table.turns.end() ? nullptr : &*found;
}

bool gives(const FreeTurns& turns, const char* quantity) {
  return std::find(turns.lack.begin(), turns.lack.end(), quantity) == turns.lack.end();
}

void warnOfLength(const MotionFile& file, const FreeTurns& turns) {
  if (turns.orientation_error <= kOrientationDoubt) return;
  std::ostringstream text;
  text.precision(2);
  text << "warning: " << printable(file.path) << ": lengths of orientation."
       << printable(turns.joint) << " are up to " << turns.orientation_error
       << " off 1; they are scaled to 1\n";
  std::cerr << text.str();
}

}  // namespace

void checkFreeTurns(const Mechanism& mechanism, const Given& given, const MotionFile& file) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    const std::string& joint = mechanism.freeJoint(i).name;
    known.push_back(joint);
    const FreeTurns* const turns = turnsOf(file.table, joint);
    if (turns) warnOfLength(file, *turns);
    if (turns && gives(*turns, "orientation")) continue;
    if (!turns && !given.coordinates[static_cast<std::size_t>(mechanism.anglesOf(i))]) continue;
    throw FileError(file.path + ": columns are missing: " + freeColumnsText("orientation", joint));
  }
  for (const FreeTurns& turns : file.table.turns) {
    if (std::find(known.begin(), known.end(), turns.joint) != known.end()) continue;
    std::cerr << "note: " << printable(file.path)
              << ": ignored, not a joint that turns freely: " << inQuotes(turns.joint) << "\n";
  }
}

void completeFreeTurns(const Mechanism& mechanism, const Scene& scene,
                       const CompletionSettings& settings, MotionFile& file) {
  if (mechanism.orientations() == 0) return;
  MotionTable& table = file.table;
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    const std::string& joint = mechanism.freeJoint(i).name;
    for (FreeTurns& turns : table.turns) {
      if (turns.joint != joint) continue;
      if (scene.static_motion) {
        for (FreeTurn& turn : turns.rows) turn = {turn.orientation, {0, 0, 0}, {0, 0, 0}};
        turns.lack.clear();
      }
      if (turns.lack.empty()) continue;
      std::string missing;
      for (const std::string& quantity : turns.lack) {
        missing += (missing.empty() ? "" : ", ") + freeColumnsText(quantity, joint);
      }
      std::cerr << "note: " << printable(file.path) << ": estimated: " << printable(missing)
                << "\n";
      try {
        for (const RootEstimate& estimate : estimateFreeTurns(mechanism, table, settings, turns))
          describeEstimate(mechanism, file, estimate.names, estimate.report);
      } catch (const MotionError& error) {
        throw FileError(file.path + ": " + error.what());
      }
    }
  }
  placeFreeTurns(mechanism, table);
}

}  // namespace virtual_work_dynamics
