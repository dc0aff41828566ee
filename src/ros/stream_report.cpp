#include "ros/stream_report.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/console.h>

#include <cmath>
#include <utility>

#include "base/printable.h"
#include "motion/stream_text.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {

using diagnostic_msgs::DiagnosticStatus;

StreamReport::StreamReport(const StreamRecord& record, std::vector<std::string> joints,
                           std::vector<std::string> units)
    : record_(record),
      joints_(std::move(joints)),
      units_(std::move(units)),
      warned_(joints_.size(), false),
      warned_of_far_positions_(joints_.size(), false) {}

std::string StreamReport::problem(std::size_t joint) const {
  const JointStream& stream = streams_[joint];
  if (stream.contradictory) {
    return "positions of " + inQuotes(joints_[joint]) +
           " jump to and fro: are there two publishers?";
  }
  if (stream.quality.velocity_ratio == 1) return "";
  return velocityProblem(joints_[joint], stream.quality.velocity_ratio);
}

/// Says once of each joint that its positions do what no motion does.
void StreamReport::warnOfFarPositions(std::size_t joint) {
  const StreamQuality& quality = streams_[joint].quality;
  if (warned_of_far_positions_[joint] || quality.jumps + quality.left_out == 0) return;
  warned_of_far_positions_[joint] = true;
  if (quality.jumps > 0) {
    ROS_WARN("position of %s jumps as no motion does: nothing is assumed of the motion across it",
             inQuotes(joints_[joint]).c_str());
  } else {
    ROS_WARN("a position of %s is far from those before and after, and is left out",
             inQuotes(joints_[joint]).c_str());
  }
}

void StreamReport::add(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!record_.read(streams_, root_)) return;
  std::vector<std::string> held;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const JointStream& stream = streams_[i];
    if (stream.held) {
      char age[32];
      std::snprintf(age, sizeof age, "%.2g s", stream.age);
      held.push_back(joints_[i] + (std::isfinite(stream.age) ? std::string(" (") + age + ")" : ""));
    }
    if (stream.quality.interval > 0) {
      status.add("samples of " + shortened(joints_[i]), streamText(stream.quality, units_[i]));
    }
    warnOfFarPositions(i);
    const std::string text = problem(i);
    if (text.empty()) continue;
    status.mergeSummary(DiagnosticStatus::WARN, text);
    if (!warned_[i]) ROS_WARN("%s", text.c_str());
    warned_[i] = true;
  }
  addRoot(status);
  status.add("joints held at their last position", held.empty() ? "none" : shortList(held));
}

void StreamReport::addRoot(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (std::size_t i = 0; i < root_.size(); ++i) {
    const RootStream& stream = root_[i];
    if (!(stream.quality.interval > 0)) continue;
    status.add(std::string("samples of ") + stream.name,
               streamText(stream.quality, stream.unit, stream.noise));
    if (stream.quality.velocity_ratio == 1) continue;
    const std::string text = velocityProblem(stream.name, stream.quality.velocity_ratio);
    status.mergeSummary(DiagnosticStatus::WARN, text);
    if (!root_warned_[i]) ROS_WARN("%s", text.c_str());
    root_warned_[i] = true;
  }
}

}  // namespace virtual_work_dynamics
