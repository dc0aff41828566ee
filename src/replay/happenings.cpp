#include "replay/happenings.h"

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

void Happenings::happen(Happening& happening, const std::string& text, std::size_t message) {
  if (++happening.count == 1) {
    happening.first = "message " + std::to_string(message) + ": " + text;
  }
}

std::string Happenings::report(const std::string& where) const {
  std::string text;
  const auto add = [&](const char* kind, const std::string& line) {
    text += kind + printable(where) + ": " + printable(line) + "\n";
  };
  for (const auto& [reason, happening] : dropped_) {
    const char* what = concernsResult(reason) ? "result" : "message";
    add("warning: ", counted(happening.count, what) + " dropped (" +
                         kDropReasonNames[index(reason)] + "), first " + happening.first);
  }
  for (const auto& doubt : doubts_) add("warning: ", doubt.second.first);
  if (restarts_.count > 0) {
    add("warning: ",
        counted(restarts_.count, "restart") + " of the estimator, first " + restarts_.first);
  }
  if (gaps_.count > 0) {
    add("note: ",
        counted(gaps_.count, "gap") + " that nothing is assumed across, first " + gaps_.first);
  }
  if (foreign_.count > 0) {
    add("note: ", counted(foreign_.count, "message") + " not used, first " + foreign_.first);
  }
  if (changes_.count > 0) {
    add("note: ", counted(changes_.count, "change") + " of the scene, first " + changes_.first);
  }
  return text;
}

}  // namespace virtual_work_dynamics
