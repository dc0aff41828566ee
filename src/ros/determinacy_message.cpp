#include "ros/determinacy_message.h"

#include <ros/time.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/number_text.h"

namespace virtual_work_dynamics {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr const char* kComponents[] = {"fx", "fy", "fz", "tx", "ty", "tz"};

void add(DiagnosticStatus& status, const std::string& key, const std::string& value) {
  status.values.emplace_back();
  status.values.back().key = key;
  status.values.back().value = value;
}

const char* flag(bool determined) {
  return determined ? "1" : "0";
}

void summarize(DiagnosticStatus& status, std::size_t open, const std::string& position) {
  status.level = position.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN;
  status.message =
      (open == 0 ? std::string("all determined") : std::to_string(open) + " not determined") +
      position;
}

// Copies flags from their places; returns whether any changed.
bool take(const std::vector<Determined>& results, const std::vector<std::size_t>& places,
          std::vector<Determined>& flags) {
  bool changed = false;
  for (std::size_t i = 0; i < places.size(); ++i) {
    changed = changed || flags[i] != results[places[i]];
    flags[i] = results[places[i]];
  }
  return changed;
}

}  // namespace

DeterminacyMessage::DeterminacyMessage(const std::string& robot, std::vector<std::string> efforts,
                                       std::vector<std::string> reactions, double condition_warn)
    : efforts_(std::move(efforts)),
      reactions_(std::move(reactions)),
      condition_warn_(condition_warn),
      root_axes_(reactions_.size()),
      child_axes_(reactions_.size()) {
  determinacy_.rank = -1;  // differs from every real rank
  message_.status.resize(3);
  message_.status[0].name = "determinacy of efforts";
  message_.status[1].name = "determinacy of reactions, root axes";
  message_.status[2].name = "determinacy of reactions, child axes";
  for (DiagnosticStatus& status : message_.status) status.hardware_id = robot;
}

bool DeterminacyMessage::isClose(const Determinacy& determinacy) const {
  return determinacy.free_motions == 0 && determinacy.condition > condition_warn_;
}

bool DeterminacyMessage::update(std::int64_t stamp_ns, const LoopResults& results,
                                const std::vector<std::size_t>& root_places,
                                const std::vector<std::size_t>& child_places) {
  const Determinacy& now = results.determinacy;
  bool changed = now.rank != determinacy_.rank || now.redundancy != determinacy_.redundancy ||
                 now.redundant_constraints != determinacy_.redundant_constraints ||
                 now.free_motions != determinacy_.free_motions ||
                 isClose(now) != isClose(determinacy_) || results.effort_determined != effort_;
  determinacy_ = now;
  effort_ = results.effort_determined;
  changed = take(results.root_axes_determined, root_places, root_axes_) || changed;
  changed = take(results.child_axes_determined, child_places, child_axes_) || changed;
  if (!changed) return false;
  message_.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  write();
  return true;
}

void DeterminacyMessage::write() {
  for (DiagnosticStatus& status : message_.status) status.values.clear();
  std::string position;
  if (determinacy_.free_motions > 0) position = ", in a singular position";
  if (isClose(determinacy_)) {
    position = ", close to a singular position: condition " + numberText(determinacy_.condition);
  }
  DiagnosticStatus& efforts = message_.status[0];
  add(efforts, "rank", std::to_string(determinacy_.rank));
  add(efforts, "redundant constraints", std::to_string(determinacy_.redundant_constraints));
  add(efforts, "redundancy", std::to_string(determinacy_.redundancy));
  add(efforts, "free motions", std::to_string(determinacy_.free_motions));
  add(efforts, "rank gap", numberText(determinacy_.gap));
  add(efforts, "condition", numberText(determinacy_.condition));
  for (std::size_t i = 0; i < efforts_.size(); ++i) add(efforts, efforts_[i], flag(effort_[i]));
  const auto open = static_cast<std::size_t>(std::count(effort_.begin(), effort_.end(), false));
  summarize(efforts, open, position);
  for (const auto axes : {1, 2}) {
    const std::vector<Determined>& reactions = axes == 1 ? root_axes_ : child_axes_;
    DiagnosticStatus& status = message_.status[static_cast<std::size_t>(axes)];
    std::size_t components = 0;
    for (std::size_t i = 0; i < reactions.size(); ++i) {
      for (std::size_t j = 0; j < reactions[i].size(); ++j) {
        add(status, reactions_[i] + "." + kComponents[j], flag(reactions[i][j]));
        if (!reactions[i][j]) ++components;
      }
    }
    summarize(status, components, position);
  }
}

DeterminacyMessage assembledDeterminacy(const Mechanism& mechanism, const Dynamics& everything,
                                        const std::vector<std::string>& reactions,
                                        double condition_warn) {
  DeterminacyMessage message(mechanism.name(), everything.effortNames(), reactions, condition_warn);
  std::vector<std::size_t> places(reactions.size());
  std::iota(places.begin(), places.end(), 0);
  Motion motion(everything.coordinates());
  motion.q = everything.assembly();
  Dynamics::Workspace workspace = everything.makeWorkspace();
  everything.compute(motion, workspace);
  message.update(0, workspace.results().loops, places, places);
  return message;
}

}  // namespace virtual_work_dynamics
