#include "virtual_work_dynamics/unwrap.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;

constexpr double kTurn = 6.283185307179586476925286766559;
// Longest jump that is unwrapped, rad: in a longer one a double does not resolve the turns well.
constexpr double kLongestJump = 1e9;
// By how much a position may be beyond its limits, positions spread over more than a turn, or what
// is left of a jump be more than the motion, because descriptions and encoders are not exact, rad.
constexpr double kSlack = 0.1;

void checkShape(const MotionTable& table) {
  const auto rows = static_cast<Index>(table.times.size());
  const auto columns = static_cast<Index>(table.joints.size());
  const bool none = table.positions.size() == 0 && rows * columns == 0;
  if (none || (table.positions.rows() == rows && table.positions.cols() == columns)) return;
  throw MotionError("motion: positions are " + std::to_string(table.positions.rows()) + " x " +
                    std::to_string(table.positions.cols()) + ", expected " + std::to_string(rows) +
                    " rows x " + std::to_string(columns) + " joints");
}

/// Returns whether a turn was added.
bool unwrapColumn(TurnCounter counter, Index column, MotionTable& table) {
  bool changed = false;
  for (Index row = 0; row < table.positions.rows(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    double& q = table.positions(row, column);
    const double since = at > 0 ? table.times[at] - table.times[at - 1] : 0;
    const double turns = counter.turns(q, since);
    if (turns == 0) continue;
    q += kTurn * turns;
    changed = true;
  }
  return changed;
}

}  // namespace

TurnCounter::TurnCounter(const Joint& joint, Source source) {
  const bool turns = joint.type == JointType::kRevolute || joint.type == JointType::kContinuous;
  if (!turns) {
    rule_ = Rule::kNone;
  } else if (joint.type == JointType::kContinuous && source == Source::kSamples) {
    rule_ = Rule::kShorterWay;
  }
  if (joint.type == JointType::kRevolute) {
    lower_ = joint.lower;
    upper_ = joint.upper;
  }
}

double TurnCounter::turns(double position, double since_previous) {
  if (!started_) {
    started_ = true;
    turns_ = 0;
    previous_ = lowest_ = highest_ = position;
    return 0;
  }
  const double jump = position - previous_;
  const double length = std::abs(jump);
  if (!(length < kLongestJump)) {
    turns_ = 0;
  } else if (rule_ != Rule::kNone && length > kTurn / 2 &&
             (rule_ == Rule::kShorterWay || evident(position, jump, since_previous))) {
    turns_ -= std::round(jump / kTurn);
  }
  previous_ = position;
  lowest_ = std::min(lowest_, position);
  highest_ = std::max(highest_, position);
  return turns_;
}

void TurnCounter::restart() {
  started_ = false;
}

bool TurnCounter::evident(double position, double jump, double since_previous) const {
  const double length = std::abs(jump);
  const double farthest = kFastest * since_previous;
  if (!(since_previous > 0 && length > farthest)) return false;
  if (std::abs(length - kTurn) > std::min(kTurn / 4, farthest + kSlack)) return false;
  const double spread = std::max(highest_, position) - std::min(lowest_, position);
  if (spread > kTurn + kSlack) return false;
  const double after = turns_ - std::round(jump / kTurn);
  return leavesLimits(previous_, turns_) || !leavesLimits(position, after);
}

bool TurnCounter::leavesLimits(double position, double turns) const {
  if (!(lower_ < upper_)) return false;
  const double q = position + kTurn * turns;
  return q < lower_ - kSlack || q > upper_ + kSlack;
}

std::vector<std::string> unwrapPositions(const Mechanism& mechanism, MotionTable& table,
                                         TurnCounter::Source source) {
  checkShape(table);
  std::vector<std::string> changed;
  for (std::size_t column = 0; column < table.joints.size(); ++column) {
    const std::string& name = table.joints[column];
    const int index = mechanism.jointIndex(name);
    if (index < 0 || mechanism.joint(index).mimics) continue;
    const TurnCounter counter(mechanism.joint(index), source);
    if (unwrapColumn(counter, static_cast<Index>(column), table)) changed.push_back(name);
  }
  return changed;
}

std::vector<std::string> unwrapPositions(MotionTable& table) {
  checkShape(table);
  std::vector<std::string> changed;
  for (std::size_t column = 0; column < table.joints.size(); ++column) {
    if (unwrapColumn(TurnCounter(), static_cast<Index>(column), table))
      changed.push_back(table.joints[column]);
  }
  return changed;
}

}  // namespace virtual_work_dynamics
