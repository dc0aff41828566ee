#include "ros/trajectory_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/joint_lookup.h"
#include "ros/message_text.h"
#include "ros/private_name.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/spline.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

using trajectory_msgs::JointTrajectory;
using trajectory_msgs::JointTrajectoryPoint;
using Values = std::vector<double> JointTrajectoryPoint::*;

constexpr std::int64_t kNanosecondsPerSecond = 1000000000;

std::string secondsText(std::int64_t nanoseconds) {
  return numberText(static_cast<double>(nanoseconds) / kNanosecondsPerSecond) + " s";
}

std::size_t rows(const JointTrajectory& message) {
  return message.points.size();
}

bool allHave(const JointTrajectory& message, Values values) {
  return std::none_of(message.points.begin(), message.points.end(),
                      [&](const JointTrajectoryPoint& point) { return (point.*values).empty(); });
}

std::optional<Rejection> checkLengths(const JointTrajectory& message) {
  const std::size_t names = message.joint_names.size();
  const auto wrong = [&](std::size_t point, std::size_t count, const char* what) {
    return Rejection{DropReason::kArrayLength, pointText(point) + " has " + std::to_string(count) +
                                                   " " + what + " for " + std::to_string(names) +
                                                   " names"};
  };
  for (std::size_t i = 0; i < rows(message); ++i) {
    const JointTrajectoryPoint& point = message.points[i];
    const std::size_t velocities = point.velocities.size();
    const std::size_t accelerations = point.accelerations.size();
    if (point.positions.size() != names) return wrong(i, point.positions.size(), "positions");
    if (velocities != 0 && velocities != names) return wrong(i, velocities, "velocities");
    if (accelerations != 0 && accelerations != names) {
      return wrong(i, accelerations, "accelerations");
    }
    const std::size_t efforts = point.effort.size();
    if (efforts != 0 && efforts != names) return wrong(i, efforts, "efforts");
  }
  return std::nullopt;
}

std::optional<Rejection> readTimes(const JointTrajectory& message, std::int64_t start_ns,
                                   TrajectoryMotion& motion) {
  motion.stamps_ns.clear();
  motion.table.times.clear();
  const std::int64_t first = message.points.front().time_from_start.toNSec();
  std::int64_t previous = -1;
  for (std::size_t i = 0; i < rows(message); ++i) {
    const std::int64_t time = message.points[i].time_from_start.toNSec();
    const char* problem = time < 0                       ? "less than zero"
                          : time <= previous             ? "not later than the point before"
                          : time > kLastStamp - start_ns ? "beyond the last instant of ROS time"
                                                         : nullptr;
    if (problem) {
      return Rejection{DropReason::kTimes, "time_from_start of " + pointText(i) + " is " +
                                               secondsText(time) + ", " + problem};
    }
    previous = time;
    motion.stamps_ns.push_back(start_ns + time);
    motion.table.times.push_back(static_cast<double>(time - first) / kNanosecondsPerSecond);
  }
  return std::nullopt;
}

// Copies columns of the message into the table's columns of the same coordinates; the others stay
// zero.
std::optional<Rejection> gather(const JointTrajectory& message, Values values, const char* what,
                                const TrajectoryMotion& motion, Eigen::MatrixXd& table) {
  for (std::size_t i = 0; i < rows(message); ++i) {
    const std::vector<double>& row = message.points[i].*values;
    if (row.empty()) continue;
    for (std::size_t j = 0; j < motion.columns.size(); ++j) {
      const auto column = static_cast<std::size_t>(motion.columns[j]);
      if (!std::isfinite(row[column])) {
        return Rejection{DropReason::kNotFinite, std::string("the ") + what + " of " +
                                                     inQuotes(message.joint_names[column]) +
                                                     " at " + pointText(i) + " is " +
                                                     numberText(row[column])};
      }
      table(static_cast<Eigen::Index>(i), motion.coordinates[j]) = row[column];
    }
  }
  return std::nullopt;
}

void select(const std::vector<int>& columns, const std::vector<double>& values,
            std::vector<double>& selected) {
  if (values.empty()) return;
  for (const int column : columns) selected.push_back(values[static_cast<std::size_t>(column)]);
}

// The points with what all of them have.
MotionTable knotsOf(const JointTrajectory& message, const MotionTable& points) {
  MotionTable knots = points;
  const bool velocities = allHave(message, &JointTrajectoryPoint::velocities);
  if (!velocities) knots.velocities.resize(0, 0);
  if (!velocities || !allHave(message, &JointTrajectoryPoint::accelerations)) {
    knots.accelerations.resize(0, 0);
  }
  return knots;
}

Eigen::VectorXd startOf(const MotionTable& points) {
  return points.velocities.row(0).transpose();
}

Eigen::VectorXd endOf(const MotionTable& points) {
  return points.velocities.bottomRows(1).transpose();
}

// Takes the motion at the points from the curve through them.
void takeFrom(const TrajectoryCurve& curve, MotionTable& points) {
  Motion motion;
  for (std::size_t i = 0; i < points.times.size(); ++i) {
    curve.evaluate(points.times[i], motion);
    points.velocities.row(static_cast<Eigen::Index>(i)) = motion.qd.transpose();
    points.accelerations.row(static_cast<Eigen::Index>(i)) = motion.qdd.transpose();
  }
}

}  // namespace

TrajectoryConversion::TrajectoryConversion(const Mechanism& mechanism, bool static_motion,
                                           std::vector<bool> passive, double sampling)
    : mechanism_(mechanism),
      static_motion_(static_motion),
      passive_(std::move(passive)),
      sampling_(sampling),
      coordinate_of_(coordinatesByName(mechanism)) {}

std::optional<Rejection> TrajectoryConversion::convert(const JointTrajectory& message,
                                                       std::int64_t start_ns,
                                                       const MotionEstimator& joint_states,
                                                       TrajectoryMotion& motion) const {
  if (message.points.empty()) return Rejection{DropReason::kNoPoints, "it has no points"};
  if (auto rejection = resolveNames(message, motion)) return rejection;
  if (auto rejection = checkLengths(message)) return rejection;
  if (auto rejection = readTimes(message, start_ns, motion)) return rejection;

  const auto coordinates = static_cast<Eigen::Index>(mechanism_.coordinates().size());
  MotionTable& table = motion.table;
  table.joints = mechanism_.coordinateNames();
  table.positions.setZero(static_cast<Eigen::Index>(rows(message)), coordinates);
  table.velocities = table.positions;
  table.accelerations = table.positions;
  auto rejection =
      gather(message, &JointTrajectoryPoint::positions, "position", motion, table.positions);
  if (!rejection) {
    rejection =
        gather(message, &JointTrajectoryPoint::velocities, "velocity", motion, table.velocities);
  }
  if (!rejection) {
    rejection = gather(message, &JointTrajectoryPoint::accelerations, "acceleration", motion,
                       table.accelerations);
  }
  if (rejection) return rejection;
  unwrapPositions(mechanism_, table, TurnCounter::Source::kPoints);
  return holdOthers(joint_states, motion);
}

std::optional<Rejection> TrajectoryConversion::resolveNames(const JointTrajectory& message,
                                                            TrajectoryMotion& motion) const {
  motion.columns.clear();
  motion.coordinates.clear();
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < message.joint_names.size(); ++i) {
    const std::string& name = message.joint_names[i];
    if (!names.insert(name).second) {
      return Rejection{DropReason::kJointTwice, "it names " + inQuotes(name) + " twice"};
    }
    const auto coordinate = coordinate_of_.find(name);
    if (coordinate == coordinate_of_.end()) continue;
    motion.columns.push_back(static_cast<int>(i));
    motion.coordinates.push_back(coordinate->second);
  }
  if (motion.columns.empty()) {
    return Rejection{
        DropReason::kNoKnownJoint,
        "it names no joint of robot " + inQuotes(mechanism_.name()) + " that moves by itself" +
            (message.joint_names.empty() ? ""
                                         : ": " + shortList(message.joint_names) + "; they are " +
                                               shortList(mechanism_.coordinateNames()))};
  }
  return std::nullopt;
}

std::optional<Rejection> TrajectoryConversion::holdOthers(const MotionEstimator& joint_states,
                                                          TrajectoryMotion& motion) const {
  std::vector<char> given(mechanism_.coordinates().size(), 0);
  for (const int coordinate : motion.coordinates) given[static_cast<std::size_t>(coordinate)] = 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] || (!passive_.empty() && passive_[i])) continue;
    double position = 0;
    if (!joint_states.latestPosition(static_cast<int>(i), position)) {
      return Rejection{DropReason::kNeverSeen, "it leaves out " +
                                                   inQuotes(mechanism_.coordinateNames()[i]) +
                                                   ", which no joint state has shown yet"};
    }
    motion.table.positions.col(static_cast<Eigen::Index>(i)).setConstant(position);
  }
  return std::nullopt;
}

std::optional<Rejection> TrajectoryConversion::complete(const JointTrajectory& message,
                                                        TrajectoryMotion& motion) const {
  motion.completion.clear();
  motion.open.clear();
  motion.problem.clear();
  motion.samples.reset();
  const bool velocities = allHave(message, &JointTrajectoryPoint::velocities);
  motion.has_velocities = velocities;
  try {
    if (sampling_ > 0) {
      if (auto rejection = sample(message, motion)) return rejection;
    }
    if (static_motion_ || (velocities && allHave(message, &JointTrajectoryPoint::accelerations))) {
      return std::nullopt;
    }
    if (motion.samples) {
      takeFrom(motion.samples->curve(), motion.table);
    } else {
      // The row of an end that has no velocities is zero.
      motion.table =
          Spline(knotsOf(message, motion.table), startOf(motion.table), endOf(motion.table))
              .knots();
    }
  } catch (const MotionError& error) {
    return Rejection{DropReason::kTimes, printable(error.what())};
  }
  motion.completion = !velocities      ? "velocities and accelerations are those of a cubic spline "
                                         "through its positions"
                      : motion.samples ? "accelerations are those of cubics from point to point"
                                       : "accelerations are those of a quintic spline through its "
                                         "positions and velocities";
  return std::nullopt;
}

std::optional<Rejection> TrajectoryConversion::sample(const JointTrajectory& message,
                                                      TrajectoryMotion& motion) const {
  motion.samples.emplace(
      TrajectoryCurve(knotsOf(message, motion.table), startOf(motion.table), endOf(motion.table)),
      sampling_, motion.stamps_ns.front());
  if (motion.samples->count() <= TrajectorySamples::kMost) return std::nullopt;
  return Rejection{DropReason::kTimes,
                   "it lasts " + numberText(motion.table.times.back()) + " s, more than the " +
                       std::to_string(TrajectorySamples::kMost) + " samples of " +
                       privateName("trajectory_sampling") + " = " + numberText(sampling_) + " Hz"};
}

JointTrajectory withEfforts(const JointTrajectory& message, const TrajectoryMotion& motion,
                            const Eigen::MatrixXd& efforts) {
  JointTrajectory result;
  result.header = message.header;
  for (const int column : motion.columns) {
    result.joint_names.push_back(message.joint_names[static_cast<std::size_t>(column)]);
  }
  result.points.resize(rows(message));
  for (std::size_t i = 0; i < rows(message); ++i) {
    const JointTrajectoryPoint& from = message.points[i];
    JointTrajectoryPoint& to = result.points[i];
    select(motion.columns, from.positions, to.positions);
    select(motion.columns, from.velocities, to.velocities);
    select(motion.columns, from.accelerations, to.accelerations);
    to.time_from_start = from.time_from_start;
    for (const int coordinate : motion.coordinates) {
      to.effort.push_back(efforts(static_cast<Eigen::Index>(i), coordinate));
    }
    const auto exists = [](double effort) { return std::isfinite(effort); };
    if (!std::all_of(to.effort.begin(), to.effort.end(), exists)) to.effort.clear();
  }
  return result;
}

}  // namespace virtual_work_dynamics
