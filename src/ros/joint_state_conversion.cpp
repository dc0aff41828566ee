#include "ros/joint_state_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "base/printable.h"
#include "motion/largest_motion.h"
#include "ros/joint_lookup.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

// Difference up to which coupled joints agree, as their encoders do not agree to the last digit;
// rad or m.
constexpr double kMimicTolerance = 1e-3;
constexpr double kTurn = 6.283185307179586;

Rejection wrongLength(std::size_t names, std::size_t values, const char* what) {
  return {DropReason::kArrayLength,
          std::to_string(names) + " names but " + std::to_string(values) + " " + what};
}

}  // namespace

JointStateConversion::JointStateConversion(const Mechanism& mechanism,
                                           const std::vector<std::string>& lengths)
    : mechanism_(mechanism),
      names_(mechanism.coordinateNames()),
      coordinate_of_(coordinatesByName(mechanism)),
      mimic_reported_(mechanism.joints().size(), 0) {
  for (const std::string& length : lengths) {
    coordinate_of_.emplace(length, static_cast<int>(names_.size()));
    names_.push_back(length);
  }
  for (auto* values : {&q_, &qd_, &effort_}) values->resize(names_.size());
  velocity_reported_.assign(names_.size(), 0);
  for (Layout& layout : layouts_) resolve({}, layout);
}

std::optional<Rejection> JointStateConversion::convert(const sensor_msgs::JointState& message,
                                                       JointSample& sample) {
  const std::size_t names = message.name.size();
  const std::size_t velocities = message.velocity.size();
  if (message.position.size() != names) {
    return wrongLength(names, message.position.size(), "positions");
  }
  if (velocities != 0 && velocities != names) return wrongLength(names, velocities, "velocities");
  Layout& layout = layoutOf(message.name);
  if (layout.rejection) return layout.rejection;
  if (message.header.stamp.isZero()) return Rejection{DropReason::kZeroStamp, "its stamp is zero"};
  if (auto rejection = gatherPositions(layout, message.position)) return rejection;
  sample.velocity_not_finite = false;
  sample.velocity_problem.clear();
  if (velocities != 0) gatherVelocities(layout, message.velocity, sample);
  sample.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
  sample.count = static_cast<int>(layout.columns.size());
  sample.coordinates = layout.coordinates.data();
  sample.q = q_.data();
  sample.qd = velocities != 0 ? qd_.data() : nullptr;
  // A list of another length, as some drivers send, says nothing of efforts.
  sample.effort = names > 0 && message.effort.size() == names ? effort_.data() : nullptr;
  for (std::size_t i = 0; sample.effort && i < layout.columns.size(); ++i) {
    effort_[i] = message.effort[static_cast<std::size_t>(layout.columns[i])];
  }
  sample.mimic_disagreement.clear();
  checkMimics(layout, message.position, sample.mimic_disagreement);
  return std::nullopt;
}

JointStateConversion::Layout& JointStateConversion::layoutOf(
    const std::vector<std::string>& names) {
  if (layouts_[latest_].names == names) return layouts_[latest_];
  const auto known = std::find_if(layouts_.begin(), layouts_.end(),
                                  [&](const Layout& layout) { return layout.names == names; });
  if (known != layouts_.end()) {
    latest_ = static_cast<std::size_t>(known - layouts_.begin());
  } else {
    latest_ = next_;
    next_ = (next_ + 1) % kLayouts;
    resolve(names, layouts_[latest_]);
  }
  return layouts_[latest_];
}

void JointStateConversion::resolve(const std::vector<std::string>& names, Layout& layout) const {
  layout = Layout();
  layout.names = names;
  std::vector<char> found(names_.size(), 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto coordinate = coordinate_of_.find(names[i]);
    if (coordinate == coordinate_of_.end()) continue;
    char& is_found = found[static_cast<std::size_t>(coordinate->second)];
    if (is_found) {
      layout.rejection =
          Rejection{DropReason::kJointTwice, "it names " + inQuotes(names[i]) + " twice"};
      return;
    }
    is_found = 1;
    layout.columns.push_back(static_cast<int>(i));
    layout.coordinates.push_back(coordinate->second);
  }
  if (layout.columns.empty()) {
    layout.rejection = Rejection{
        DropReason::kNoKnownJoint,
        "it names no joint of robot " + inQuotes(mechanism_.name()) + " that moves by itself" +
            (names.empty() ? "" : ": " + shortList(names) + "; they are " + shortList(names_))};
    return;
  }
  resolveMimics(layout);
}

void JointStateConversion::resolveMimics(Layout& layout) const {
  std::vector<int> column_of(names_.size(), -1);
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    column_of[static_cast<std::size_t>(layout.coordinates[i])] = layout.columns[i];
  }
  for (std::size_t i = 0; i < layout.names.size(); ++i) {
    const int joint = mechanism_.jointIndex(layout.names[i]);
    if (joint < 0 || !mechanism_.joints()[static_cast<std::size_t>(joint)].mimics) continue;
    const int coordinate = mechanism_.joints()[static_cast<std::size_t>(joint)].coordinate;
    const int master_column = column_of[static_cast<std::size_t>(coordinate)];
    if (master_column >= 0) layout.mimics.push_back({static_cast<int>(i), master_column, joint});
  }
}

std::optional<Rejection> JointStateConversion::gatherPositions(
    const Layout& layout, const std::vector<double>& positions) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const auto column = static_cast<std::size_t>(layout.columns[i]);
    q_[i] = positions[column];
    if (!(std::abs(q_[i]) <= kLargestMotion)) {
      return Rejection{DropReason::kNotFinite, "the position of " + inQuotes(layout.names[column]) +
                                                   " is " + numberText(q_[i])};
    }
  }
  return std::nullopt;
}

/// Makes NaN of velocities that are not finite, or are beyond any robot's. Drivers fill what they
/// do not measure with NaN.
void JointStateConversion::gatherVelocities(const Layout& layout,
                                            const std::vector<double>& velocities,
                                            JointSample& sample) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    qd_[i] = velocities[static_cast<std::size_t>(layout.columns[i])];
    if (std::abs(qd_[i]) <= kLargestMotion) continue;
    sample.velocity_not_finite = true;
    char& reported = velocity_reported_[static_cast<std::size_t>(layout.coordinates[i])];
    if (!reported) {
      sample.velocity_problem +=
          (sample.velocity_problem.empty() ? "the velocity of " : ", that of ") +
          inQuotes(layout.names[static_cast<std::size_t>(layout.columns[i])]) + " is " +
          numberText(qd_[i]);
    }
    reported = 1;
    qd_[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

void JointStateConversion::checkMimics(Layout& layout, const std::vector<double>& positions,
                                       std::string& disagreement) {
  for (const MimicColumn& mimic : layout.mimics) {
    const Joint& joint = mechanism_.joints()[static_cast<std::size_t>(mimic.joint)];
    char& reported = mimic_reported_[static_cast<std::size_t>(mimic.joint)];
    const double given = positions[static_cast<std::size_t>(mimic.column)];
    const double master = positions[static_cast<std::size_t>(mimic.master_column)];
    const double expected = joint.multiplier * master + joint.offset;
    double difference = given - expected;
    if (joint.type == JointType::kContinuous) difference = std::remainder(difference, kTurn);
    // NaN disagrees, too, as it is not below the tolerance.
    if (reported || std::abs(difference) <= kMimicTolerance) continue;
    reported = 1;
    disagreement += (disagreement.empty() ? "" : "; ") + ("mimic joint " + inQuotes(joint.name)) +
                    " is given at " + numberText(given) + " but follows " +
                    inQuotes(layout.names[static_cast<std::size_t>(mimic.master_column)]) + " to " +
                    numberText(expected);
  }
}

}  // namespace virtual_work_dynamics
