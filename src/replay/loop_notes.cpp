#include "replay/loop_notes.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

// In the order of Hold, and of LoopRecord::Levels.
constexpr const char* kFindings[LoopRecord::kHolds] = {
    nullptr,
    "would have to act the other way",
    "is outside its friction cone",
    "is not determined, so that nothing can be said of it",
    "is not determined, but can hold",
    "cannot hold, whatever is chosen that is not determined,"};
constexpr const char* kLevels[LoopRecord::kLevels] = {"positions", "velocities", "accelerations"};

std::string samples(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " sample" : " samples");
}

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string leftOut(const LoopRecord::Report& report, const Dynamics& dynamics,
                    const Names& reactions) {
  Names names;
  for (const std::size_t i : report.efforts) {
    names.push_back("effort of " + dynamics.effortNames()[i]);
  }
  for (const std::size_t i : report.reactions) names.push_back("reaction of " + reactions[i]);
  return names.empty() ? "" : "; left out: " + shortList(names);
}

std::string worstViolation(const LoopRecord::Report& report, const Dynamics& dynamics) {
  std::size_t closure = 0, level = 0;
  double worst = -1;
  for (std::size_t c = 0; c < report.relative.size(); ++c) {
    for (std::size_t i = 0; i < LoopRecord::kLevels; ++i) {
      if (report.relative[c][i] <= worst) continue;
      worst = report.relative[c][i];
      closure = c;
      level = i;
    }
  }
  if (worst < 0) return "";
  return std::string(", ") + kLevels[level] + " of " + dynamics.closureLabel(closure) +
         " the most, by " + digits(worst) + " relative";
}

}  // namespace

std::string loopNotes(const LoopRecord::Report& report, const Dynamics& dynamics,
                      const Mechanism& mechanism, const Names& reactions, const LoopLimits& limits,
                      const std::string& where) {
  std::string text;
  const auto add = [&](const char* kind, const std::string& line) {
    text += kind + printable(where) + ": " + line + "\n";
  };
  for (std::size_t i = 0; i < report.holds.size(); ++i) {
    for (std::size_t hold = 1; hold < LoopRecord::kHolds; ++hold) {
      const std::uint64_t count = report.holds[i][hold];
      if (count == 0) continue;
      const bool open = static_cast<Hold>(hold) == Hold::kNotDecidable ||
                        static_cast<Hold>(hold) == Hold::kCanHold;
      add(open ? "note: " : "warning: ", "the force of " + inQuotes(dynamics.oneSided()[i]) + " " +
                                             kFindings[hold] + " in " + samples(count));
    }
  }
  if (report.fit.fitted > 0) {
    add(report.fit.doubtful() ? "warning: " : "note: ",
        report.fit.text(mechanism, "sample", "samples"));
  }
  if (report.violations > 0) {
    add("warning: ", samples(report.violations) +
                         (report.violations == 1 ? " violates" : " violate") +
                         " a closed loop by more than " + numberText(limits.tolerance) +
                         worstViolation(report, dynamics));
  }
  if (report.singular > 0) {
    add("warning: ",
        samples(report.singular) + " in singular positions" + leftOut(report, dynamics, reactions));
  }
  if (report.undirected > 0) {
    add("warning: ", "the ends of a spring meet in " + samples(report.undirected) +
                         ", so that its force has no direction" +
                         leftOut(report, dynamics, reactions));
  }
  if (report.close_to_singular > 0) {
    const auto& conditions = report.conditions;
    const double largest =
        conditions.empty() ? 1 : *std::max_element(conditions.begin(), conditions.end());
    add("warning: ", samples(report.close_to_singular) +
                         " close to singular positions, condition " + digits(largest) +
                         " at worst: forces may exceed the load by this factor");
  }
  return text;
}

}  // namespace virtual_work_dynamics
