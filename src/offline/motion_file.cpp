#include "offline/motion_file.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <sstream>
#include <unordered_set>
#include <utility>

#include "base/number_text.h"
#include "motion/motion_text.h"
#include "motion/stream_text.h"
#include "offline/watched_file.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Resolution of times up to which estimates do not suffer, as a part of their mean spacing.
constexpr double kFineTimes = 1e-6;
// Times, and spacings of times, beyond those of recordings in seconds: 3000 years, and some hours
// from row to row. Clocks that count nanoseconds, microseconds or milliseconds from 1970 on are
// beyond them.
constexpr double kLatestTime = 1e11;
constexpr double kLongestSpacing = 1e4;

// Lists the joints of columns, each once: "position.j", "velocity.j", "position.k" become "j, k".
std::string jointsOfColumns(const std::vector<std::string>& columns) {
  std::unordered_set<std::string> joints;
  std::string text;
  for (const std::string& column : columns) {
    const std::string joint = column.substr(column.find('.') + 1);
    if (!joints.insert(joint).second) continue;
    text += (text.empty() ? "" : ", ") + joint;
  }
  return text;
}

void checkTimes(const MotionFile& motion) {
  const std::vector<double>& times = motion.table.times;
  const std::size_t row = firstTimeThatDoesNotIncrease(times);
  if (row < times.size()) {
    throw FileError(motion.at(row) + ": time " + numberText(times[row]) + " is not later than " +
                    numberText(times[row - 1]) +
                    " in the row before, and derivatives have to be estimated");
  }
  const double latest = std::max(std::abs(times.front()), std::abs(times.back()));
  const double spacing = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  if (times.size() > 1 && (latest > kLatestTime || spacing > kLongestSpacing)) {
    std::ostringstream text;
    text << motion.path << ": times up to " << latest << " with " << spacing
         << " from row to row cannot be seconds, and derivatives have to be estimated: are they "
            "nanoseconds? Give seconds";
    throw FileError(text.str());
  }
  const double resolution = latest * std::numeric_limits<double>::epsilon();
  if (times.size() > 1 && resolution > kFineTimes * spacing) {
    std::ostringstream text;
    text << "warning: " << motion.path << ": times near " << latest << " s are known to "
         << resolution << " s only, which spoils estimated derivatives; let them start near zero\n";
    std::cerr << text.str();
  }
}

// Positions so far beyond the limits of a joint are hardly radians.
void warnOfDegrees(const Mechanism& mechanism, const MotionFile& motion) {
  constexpr double kFar = 5;
  const MotionTable& table = motion.table;
  for (std::size_t i = 0; i < table.joints.size(); ++i) {
    const Joint& joint = mechanism.joint(mechanism.jointIndex(table.joints[i]));
    if (joint.type != JointType::kRevolute || !(joint.lower < joint.upper)) continue;
    const double limit = std::max(std::abs(joint.lower), std::abs(joint.upper));
    const double most = table.positions.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff();
    if (most <= kFar * limit) continue;
    std::cerr << "warning: " << motion.path << ": positions of '" << table.joints[i] << "' reach "
              << numberText(most) << ", its limit is " << numberText(limit)
              << " rad: are they degrees?\n";
  }
}

// Says what was found about the joints of an estimated motion.
void describe(const Mechanism& mechanism, const MotionFile& motion,
              const CompletionReport& report) {
  const std::vector<std::string>& joints = motion.table.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const StreamQuality& quality = report.qualities[i];
    if (quality.velocity_ratio != 1) {
      std::cerr << "warning: " << motion.path << ": "
                << velocityProblem(joints[i], quality.velocity_ratio) << "\n";
    }
    const Joint& joint = mechanism.joint(mechanism.jointIndex(joints[i]));
    std::cerr << "note: " << motion.path << ": " << joints[i] << ": "
              << (report.still[i] ? std::string("does not move")
                                  : streamText(quality, symbolOf(unitOf(joint))))
              << "\n";
  }
  std::cerr << "note: " << motion.path << ": " << report.one_sided << " of "
            << motion.table.times.size()
            << " rows are estimated from rows of one side, near the ends";
  if (report.gaps > 0) {
    std::cerr << " and near " << report.gaps
              << (report.gaps == 1 ? " gap, across which" : " gaps, across which")
              << " nothing is assumed";
  }
  std::cerr << "\n";
}

}  // namespace

MotionFile readMotion(const std::string& path, const Mechanism& mechanism) {
  return readMotion(path, mechanism, [&](const auto&) { return mechanism.coordinateNames(); });
}

MotionFile readMotion(const std::string& path, const Mechanism& mechanism,
                      const JointChoice& choose) {
  MotionFile motion;
  motion.path = path;
  std::vector<std::string> unused;
  {
    WatchedFile file(path);
    motion.table = readMotionText(file, path, choose, &unused, &motion.lines);
  }
  for (const std::string& column : unused) {
    const std::string joint = column.substr(column.find('.') + 1);
    if (mechanism.coordinateIndex(joint) >= 0) {
      throw FileError(path + ": column '" + column + "' without 'position." + joint + "'");
    }
  }
  if (!unused.empty()) {
    std::cerr << "note: " << path
              << ": ignored, not coordinates of the robot: " << jointsOfColumns(unused) << "\n";
  }
  return motion;
}

void completeDerivatives(const Mechanism& mechanism, const Scene& scene,
                         const CompletionSettings& settings, MotionFile& motion) {
  MotionTable& table = motion.table;
  if (scene.static_motion) {
    table.velocities = Eigen::MatrixXd::Zero(table.positions.rows(), table.positions.cols());
    table.accelerations = table.velocities;
  }
  std::string missing;
  if (!table.hasVelocities()) missing = "velocities";
  if (!table.hasAccelerations()) missing += missing.empty() ? "accelerations" : ", accelerations";
  if (missing.empty() || table.joints.empty()) return;
  checkTimes(motion);
  warnOfDegrees(mechanism, motion);
  CompletionReport report;
  try {
    table = completeMotion(mechanism, std::move(table), settings, &report);
  } catch (const MotionError& error) {
    throw FileError(motion.path + ": " + error.what());
  }
  std::cerr << "note: " << motion.path << ": estimated: " << missing
            << (report.even_clock ? "; the rows are those of an even clock, its times jitter" : "")
            << "\n";
  describe(mechanism, motion, report);
}

}  // namespace virtual_work_dynamics
