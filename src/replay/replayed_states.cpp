#include "replay/replayed_states.h"

#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/message_copies.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {

using Outcome = SampleComputation::Outcome;

namespace {

constexpr double kWrenchTimeout = 0.1;  // s; of a scene without live wrenches nothing depends on it

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

ReplayedStates::ReplayedStates(const RobotTask& task, const MotionSource& source,
                               const LoopLimits& limits, const Audience& audience,
                               std::function<void(const ActivePlan&)> publish)
    : task_(task),
      source_(source),
      publish_(std::move(publish)),
      loops_(task.everything, task.reactions.size(), limits),
      estimator_(task.mechanism, task.estimator),
      completer_(task.mechanism, task.scene, task.everything, limits.tolerance),
      wrenches_(task.mechanism, task.scene, kWrenchTimeout),
      samples_(task.everything, task.scene, completer_, wrenches_,
               {counters_, certificates_, loops_}),
      plan_(task.mechanism, task.scene, task.outputs, task.reactions, audience, PlanChecks()),
      computation_(task.mechanism, task.estimator, estimator_, completer_, samples_, counters_,
                   *this) {
  if (task.everything.closed()) estimator_.waitFor(completer_.needed());
  for (const auto& [coordinate, position] : task.rest) estimator_.setRest(coordinate, position);
  loops_.setPassiveGiven(completer_.allGiven());
  computation_.measureEfforts(*task.efforts);
}

void ReplayedStates::take(const JointStateContent& content, std::size_t number) {
  number_ = number;
  message_.header.stamp = timeOf(content.stamp_ns);
  translate(content);
  computation_.take(message_);
}

void ReplayedStates::translate(const JointStateContent& content) {
  message_.position = content.positions;
  message_.velocity = content.velocities;
  message_.effort = content.efforts;
  if (source_.rename.empty() && !source_.degrees) {
    message_.name = content.names;
    return;
  }
  if (given_ != content.names) {
    given_ = content.names;
    message_.name.clear();
    factors_.clear();
    for (const std::string& given : given_) {
      message_.name.push_back(source_.rename(given));
      const int joint = task_.mechanism.jointIndex(message_.name.back());
      const bool turns = joint >= 0 && unitOf(task_.mechanism.joint(joint)) == Unit::kRadian;
      factors_.push_back(source_.degrees && turns ? kDegree : 1);
    }
  }
  for (std::vector<double>* values : {&message_.position, &message_.velocity}) {
    if (values->size() != factors_.size()) continue;  // a message that will be dropped
    for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] *= factors_[i];
  }
}

void ReplayedStates::refuse(std::size_t number, const std::string& why) {
  number_ = number;
  happen(dropped_[DropReason::kInternal], why);
}

void ReplayedStates::happen(Happening& happening, const std::string& text) {
  if (++happening.count == 1) happening.first = "message " + std::to_string(number_) + ": " + text;
}

void ReplayedStates::publish(const ActivePlan& plan) {
  ++results_;
  publish_(plan);
}

void ReplayedStates::dropJointState(DropReason reason, const std::string& text) {
  happen(dropped_[reason], text);
}

void ReplayedStates::leaveForeign(const std::string& text) {
  happen(foreign_, text);
}

void ReplayedStates::dropSample(Outcome outcome, ActivePlan& plan, std::int64_t stamp_ns) {
  const std::string stamp = "stamp " + stampText(stamp_ns);
  if (outcome == Outcome::kOpenLoop) {
    happen(dropped_[DropReason::kOpenLoop],
           completer_.problem(plan.dynamics, plan.workspace) + ", at " + stamp);
  } else {
    happen(dropped_[DropReason::kOverflow], "not finite at " + stamp);
  }
}

void ReplayedStates::warn(const std::string& text) {
  happen(doubts_[text], text);
}

void ReplayedStates::noteGap() {
  const auto joint = static_cast<std::size_t>(estimator_.latestGapCoordinate());
  happen(gaps_, inQuotes(task_.mechanism.coordinateNames()[joint]) + " had a gap of " +
                    numberText(static_cast<double>(estimator_.latestGap()) / 1e9) + " s");
}

void ReplayedStates::noteRestart(std::int64_t stamp_ns) {
  happen(restarts_, "time went back to stamp " + stampText(stamp_ns));
}

std::string ReplayedStates::report(const std::string& where) const {
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
  return text;
}

}  // namespace virtual_work_dynamics
