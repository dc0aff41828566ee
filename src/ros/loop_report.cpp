#include "ros/loop_report.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/effort_groups.h"
#include "ros/determinacy_message.h"
#include "ros/message_text.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using Names = std::vector<std::string>;

struct Level {
  const char* name;
  const char* many;
  const char* unit;
};

constexpr Level kLevels[LoopRecord::kLevels] = {
    {"position", "positions", "m or rad"},
    {"velocity", "velocities", "m/s or rad/s"},
    {"acceleration", "accelerations", "m/s^2 or rad/s^2"}};

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string listOf(const Names& names) {
  return names.empty() ? "none" : shortList(names);
}

double largestOf(const std::vector<double>& conditions) {
  return conditions.empty() ? 1 : *std::max_element(conditions.begin(), conditions.end());
}

std::string count(std::size_t number, const char* one, const char* many) {
  return std::to_string(number) + " " + (number == 1 ? one : many);
}

// How messages name closures and couplings.
Names labelsOf(const Dynamics& dynamics) {
  Names labels;
  for (std::size_t i = 0; i < dynamics.closureNames().size(); ++i) {
    labels.push_back(dynamics.closureLabel(i));
  }
  return labels;
}

}  // namespace

Names loopLines(const Mechanism& mechanism, const Scene& scene, const Dynamics& everything,
                double condition_warn) {
  const EffortGroups efforts(everything);
  const DeterminacyMessage assembled = assembledDeterminacy(
      mechanism, everything, requestedReactions(mechanism, scene), condition_warn);
  const diagnostic_msgs::DiagnosticArray& found = assembled.message();
  std::string numbers;
  for (std::size_t i = 0; i < 4; ++i) {
    const diagnostic_msgs::KeyValue& entry = found.status[0].values[i];
    numbers += (i == 0 ? "" : ", ") + entry.key + " " + entry.value;
  }
  return {"closed loops: " + count(scene.closures.size(), "closure", "closures") + ", " +
              count(scene.springs.size(), "spring", "springs") +
              (scene.couplings.empty()
                   ? ""
                   : ", " + count(scene.couplings.size(), "coupling", "couplings")) +
              "; actuated: " + listOf(efforts.actuated) + "; passive: " + listOf(efforts.passive) +
              (efforts.residuals.empty() ? "" : "; free motions: " + listOf(efforts.residuals)),
          "as assembled: " + numbers + "; efforts: " + found.status[0].message +
              "; components of reactions: " + found.status[2].message};
}

LoopReport::LoopReport(const Mechanism& mechanism, const Dynamics& dynamics, Names reactions,
                       LoopRecord& record)
    : mechanism_(mechanism),
      closures_(dynamics.closureNames()),
      labels_(labelsOf(dynamics)),
      one_sided_(dynamics.oneSided()),
      efforts_(dynamics.effortNames()),
      reactions_(std::move(reactions)),
      closed_(dynamics.closed()),
      record_(record),
      limits_(record.limits()) {}

void LoopReport::add(DiagnosticStatusWrapper& status) {
  if (!closed_) return;
  const LoopRecord::Report report = record_.take();
  status.add("passive joints", report.passive_given ? "given" : "from the closures");
  if (report.news) latest_ = report;
  status.add("samples that violate a loop", report.violations);
  status.add("samples in singular positions", report.singular);
  status.add("samples close to singular positions", report.close_to_singular);
  if (latest_.news) addResiduals(status, latest_);
  addFit(status, report.fit);
  if (report.violations > violations_) addViolations(status, report);
  if (report.news) addConditions(status, report.conditions);
  if (report.news) addHolds(status, report);
  if (report.singular > singular_) {
    addLeftOut(status, report,
               count(report.singular - singular_, "sample", "samples") +
                   " in singular positions; not determined there, and left out: ");
  }
  if (report.undirected > undirected_) {
    addLeftOut(status, report,
               count(report.undirected - undirected_, "sample", "samples") +
                   " in which the ends of a spring meet, so that its force has no direction; left "
                   "out: ");
  }
  violations_ = report.violations;
  singular_ = report.singular;
  undirected_ = report.undirected;
}

void LoopReport::addResiduals(DiagnosticStatusWrapper& status,
                              const LoopRecord::Report& report) const {
  const Determinacy& found = report.determinacy;
  status.add("rank", found.rank);
  status.add("redundant constraints", found.redundant_constraints);
  status.add("redundancy", found.redundancy);
  status.add("free motions", found.free_motions);
  status.add("rank gap", shortNumber(found.gap));
  status.add("condition", shortNumber(found.condition));
  status.add("condition, largest", shortNumber(largestOf(report.conditions)));
  double largest = 0;
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    for (std::size_t i = 0; i < LoopRecord::kLevels; ++i) {
      largest = std::max(largest, report.relative[c][i]);
      status.add(std::string("residual.") + kLevels[i].name + "." + shortened(closures_[c]),
                 shortNumber(report.residuals[c][i]));
    }
  }
  status.add("residual, largest (relative)", shortNumber(largest));
}

// Says of each force that can act one way only how many samples are at odds with that.
void LoopReport::addHolds(DiagnosticStatusWrapper& status, const LoopRecord::Report& report) const {
  static const char* const kWrong[LoopRecord::kHolds] = {
      nullptr,
      "would have to act the other way",
      "is outside its friction cone",
      "is not determined, so that nothing can be said of it",
      "is not determined, but can hold",
      "cannot hold, whatever is chosen that is not determined,"};
  for (std::size_t i = 0; i < one_sided_.size(); ++i) {
    std::string found;
    for (std::size_t hold = 1; hold < LoopRecord::kHolds; ++hold) {
      const std::uint64_t samples = report.holds[i][hold];
      if (samples == 0) continue;
      const std::string text =
          std::string(kWrong[hold]) + " in " + count(samples, "sample", "samples");
      found += (found.empty() ? "" : "; ") + text;
      const auto judged = static_cast<Hold>(hold);
      if (judged == Hold::kNotDecidable || judged == Hold::kCanHold) continue;
      status.mergeSummary(DiagnosticStatus::WARN,
                          "the force of " + inQuotes(one_sided_[i]) + " " + text);
    }
    status.add("holds." + shortened(one_sided_[i]), found.empty() ? "yes" : found);
  }
}

void LoopReport::addViolations(DiagnosticStatusWrapper& status,
                               const LoopRecord::Report& report) const {
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    for (std::size_t i = 0; i < LoopRecord::kLevels; ++i) {
      if (report.relative[c][i] <= limits_.tolerance) continue;
      status.mergeSummary(DiagnosticStatus::WARN,
                          std::string(kLevels[i].many) + " violate " + labels_[c] + " by " +
                              shortNumber(report.residuals[c][i]) + " " + kLevels[i].unit + ", " +
                              shortNumber(report.relative[c][i]) + " relative; " +
                              privateName("loop_tolerance") + " is " +
                              numberText(limits_.tolerance));
    }
  }
}

// Says how far motions were moved to meet the loops, and what no noise explains.
void LoopReport::addFit(DiagnosticStatusWrapper& status, const FitSummary& fit) {
  fitted_ += fit.fitted;
  unexplained_ += fit.unexplained;
  if (fitted_ == 0) return;
  status.add("samples fitted to the loops", fitted_);
  status.add("samples whose fit noise does not explain", unexplained_);
  if (fit.fitted == 0) return;
  const std::string text = fit.text(mechanism_, "sample", "samples");
  status.add("fit", text);
  if (fit.doubtful()) status.mergeSummary(DiagnosticStatus::WARN, text);
}

void LoopReport::addConditions(DiagnosticStatusWrapper& status,
                               const std::vector<double>& conditions) const {
  Names loops;
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    if (conditions[c] > limits_.condition) loops.push_back(closures_[c]);
  }
  if (loops.empty()) return;
  status.mergeSummary(DiagnosticStatus::WARN,
                      "close to a singular position of the loops through " + shortList(loops) +
                          ", condition " + shortNumber(largestOf(conditions)) +
                          ": forces may exceed the load by this factor; " +
                          privateName("condition_warn") + " is " + numberText(limits_.condition));
}

void LoopReport::addLeftOut(DiagnosticStatusWrapper& status, const LoopRecord::Report& report,
                            const std::string& why) const {
  Names left_out;
  for (const std::size_t i : report.efforts) left_out.push_back("effort of " + efforts_[i]);
  for (const std::size_t i : report.reactions) left_out.push_back("reaction of " + reactions_[i]);
  status.mergeSummary(DiagnosticStatus::WARN, why + listOf(left_out));
}

}  // namespace virtual_work_dynamics
