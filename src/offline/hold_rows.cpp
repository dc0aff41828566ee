#include "offline/hold_rows.h"

#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {

namespace {

// In the order of Hold.
constexpr const char* kFindings[] = {nullptr,
                                     "would have to act the other way",
                                     "is outside its friction cone",
                                     "is not determined, so that nothing can be said of it",
                                     "is not determined, but can hold",
                                     "cannot hold, whatever is chosen that is not determined,"};

}  // namespace

HoldRows::HoldRows(std::vector<std::string> names)
    : names_(std::move(names)), found_(names_.size()) {}

void HoldRows::add(std::size_t row, const Results& results) {
  for (std::size_t i = 0; i < found_.size(); ++i) {
    Found& found = found_[i][static_cast<std::size_t>(results.loops.holds[i])];
    if (found.rows++ == 0) found.first = row;
  }
}

std::string HoldRows::text(const MotionFile& file) const {
  std::string text;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    for (std::size_t hold = 1; hold < found_[i].size(); ++hold) {
      const Found& found = found_[i][hold];
      if (found.rows == 0) continue;
      const bool open = static_cast<Hold>(hold) == Hold::kNotDecidable ||
                        static_cast<Hold>(hold) == Hold::kCanHold;
      text += (open ? "note: " : "warning: ") + printable(file.path) + ": the force of " +
              inQuotes(names_[i]) + " " + kFindings[hold] + " in " + std::to_string(found.rows) +
              (found.rows == 1 ? " row" : " rows") + ", first in " + file.place(found.first) + "\n";
    }
  }
  return text;
}

}  // namespace virtual_work_dynamics
