#include "offline/motion_file.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <set>
#include <sstream>
#include <unordered_set>
#include <utility>

#include "bag/bag_reader.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "motion/free_columns.h"
#include "motion/motion_text.h"
#include "motion/stream_text.h"
#include "offline/mechanism_json.h"
#include "offline/npz_motion.h"
#include "offline/progress.h"
#include "offline/slope_checks.h"
#include "offline/state_csv.h"
#include "offline/state_motion.h"
#include "offline/watched_file.h"
#include "robot/unit_doubts.h"
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
// Of recordings at 1 kHz and less whose times are milliseconds, and how fast, in rad/s or m/s, the
// fastest joint of a robot is then on average. What is slow indeed is faster, or hardly moves at
// all.
constexpr double kSlowSpacing = 1;
constexpr double kSlowest = 0.1;
constexpr double kFastest = 20;

using Names = std::vector<std::string>;

// Columns that are read from a file, but not used.
struct Unused {
  Names joints;  // that are not coordinates, each once
  Names others;  // columns that hold no motion
};

bool isMotion(const std::string& column) {
  const std::string kind = column.substr(0, column.find('.'));
  return kind == "position" || kind == "velocity" || kind == "acceleration";
}

// Sorts unused columns. @throws FileError for one of a coordinate that has no position.
Unused sorted(const std::string& path, const Names& columns, const Names& coordinates,
              bool efforts_are_read) {
  Unused unused;
  const std::set<std::string> known(coordinates.begin(), coordinates.end());
  std::set<std::string> seen;
  for (const std::string& column : columns) {
    const std::string joint = column.substr(column.find('.') + 1);
    if (!isMotion(column)) {
      if (!efforts_are_read || column.rfind("effort.", 0) != 0) unused.others.push_back(column);
    } else if (known.count(joint) > 0 && column.rfind("position.", 0) == 0) {
      throw FileError(path + ": column " + inQuotes(column) +
                      ": this joint turns freely, its orientation is given by " + kFreeColumns);
    } else if (known.count(joint) > 0) {
      throw FileError(path + ": column " + inQuotes(column) + " without " +
                      inQuotes("position." + joint));
    } else if (seen.insert(joint).second) {
      unused.joints.push_back(joint);
    }
  }
  return unused;
}

void noteUnused(const std::string& path, const Unused& unused, const Names& coordinates) {
  if (!unused.joints.empty()) {
    std::cerr << "note: " << printable(path)
              << ": ignored, not coordinates of the robot: " << namesInQuotes(unused.joints)
              << "; they are " << namesInQuotes(coordinates) << "\n";
  }
  if (!unused.others.empty()) {
    std::cerr << "note: " << printable(path)
              << ": ignored, no motion: " << namesInQuotes(unused.others) << "\n";
  }
}

bool cannotBeSeconds(const std::vector<double>& times) {
  if (times.size() < 2) return false;
  const double latest = std::max(std::abs(times.front()), std::abs(times.back()));
  const double spacing = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  return latest > kLatestTime || spacing > kLongestSpacing;
}

bool mayBeMilliseconds(const MotionTable& table, double spacing) {
  const Eigen::Index steps = table.positions.rows() - 1;
  if (spacing < kSlowSpacing || steps < 1 || table.positions.cols() == 0) return false;
  const auto moved = table.positions.bottomRows(steps) - table.positions.topRows(steps);
  const double speed = 1000 * moved.cwiseAbs().colwise().mean().maxCoeff() / spacing;
  return speed > kSlowest && speed < kFastest;
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
  if (cannotBeSeconds(times)) {
    std::ostringstream text;
    text << printable(motion.path) << ": times up to " << latest << " with " << spacing
         << " from row to row cannot be seconds, and derivatives have to be estimated: are they "
            "nanoseconds? Give seconds";
    throw FileError(text.str());
  }
  if (mayBeMilliseconds(motion.table, spacing)) {
    std::cerr
        << "warning: " << printable(motion.path) << ": " << numberText(spacing)
        << " s from row to row, and derivatives have to be estimated: are times milliseconds?\n";
  }
  const double resolution = latest * std::numeric_limits<double>::epsilon();
  if (times.size() > 1 && resolution > kFineTimes * spacing) {
    std::ostringstream text;
    text << "warning: " << printable(motion.path) << ": times near " << latest << " s are known to "
         << resolution << " s only, which spoils estimated derivatives; let them start near zero\n";
    std::cerr << text.str();
  }
}

// Positions so far beyond the limits of a joint are hardly radians or metres.
void warnOfUnits(const Mechanism& mechanism, const MotionFile& motion) {
  const MotionTable& table = motion.table;
  for (std::size_t i = 0; i < table.joints.size(); ++i) {
    const int index = mechanism.jointIndex(table.joints[i]);
    if (index < 0) continue;
    const Joint& joint = mechanism.joint(index);
    const double most = table.positions.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff();
    if (most <= largestPosition(joint)) continue;
    std::cerr << "warning: " << printable(motion.path) << ": " << positionQuestion(joint, most)
              << "\n";
  }
}

void warnOfSlopes(const MotionFile& motion) {
  for (const std::string& doubt : slopeDoubts(motion.table)) {
    std::cerr << "warning: " << printable(motion.path) << ": " << doubt << "\n";
  }
}

// Says which positions no motion leads to.
void warnOfFarPositions(const MotionFile& motion, const std::string& joint,
                        const std::vector<std::size_t>& jumps,
                        const std::vector<std::size_t>& left_out) {
  const auto others = [](std::size_t count) {
    return count > 1 ? " and in " + std::to_string(count - 1) + " more rows" : std::string();
  };
  if (!jumps.empty()) {
    std::cerr << "warning: " << printable(motion.at(jumps[0])) << others(jumps.size())
              << ": position of " << inQuotes(joint)
              << " jumps as no motion does; nothing is assumed of the motion across it\n";
  }
  if (!left_out.empty()) {
    std::cerr << "warning: " << printable(motion.at(left_out[0])) << others(left_out.size())
              << ": position of " << inQuotes(joint)
              << " is far from those before and after, and is left out\n";
  }
}

// Reads the arrays of an .npz like the columns of a CSV.
void readNpz(const MotionSource& source, const JointChoice& choose, Names& unused,
             MotionFile& motion) {
  NpzMotion file(motion.path);
  std::vector<std::string> others;
  for (const std::string& name : file.others()) {
    if (name != kMechanismFile) others.push_back(name);
  }
  if (!others.empty()) {
    std::cerr << "note: " << printable(motion.path)
              << ": ignored, no one-dimensional arrays of numbers: " << namesInQuotes(others)
              << "\n";
  }
  motion.table = readMotionText(file, motion.path, source.rename, choose, &unused, &motion.lines);
  motion.row_name = "index";
  for (std::size_t& line : motion.lines) line -= 2;  // behind the header, from 0 on
}

}  // namespace

void describeEstimate(const Mechanism& mechanism, const MotionFile& motion, const Names& joints,
                      const CompletionReport& report) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const StreamQuality& quality = report.qualities[i];
    if (quality.velocity_ratio != 1) {
      std::cerr << "warning: " << printable(motion.path) << ": "
                << velocityProblem(joints[i], quality.velocity_ratio) << "\n";
    }
    const int index = mechanism.jointIndex(joints[i]);
    const char* unit = index < 0 ? "m or rad" : symbolOf(unitOf(mechanism.joint(index)));
    warnOfFarPositions(motion, joints[i], report.jumps[i], report.left_out[i]);
    std::cerr << "note: " << printable(motion.path) << ": " << shortened(joints[i]) << ": "
              << (report.still[i] ? std::string("does not move") : streamText(quality, unit))
              << "\n";
  }
  std::cerr << "note: " << printable(motion.path) << ": " << report.one_sided << " of "
            << motion.table.times.size()
            << " rows are estimated from rows of one side, near the ends";
  if (report.gaps > 0) {
    std::cerr << " and near " << report.gaps
              << (report.gaps == 1 ? " gap, across which" : " gaps, across which")
              << " nothing is assumed";
  }
  std::cerr << "\n";
}

MotionFile readMotion(const MotionSource& source, const Mechanism& mechanism) {
  return readMotion(source, mechanism, [&](const auto&) { return mechanism.coordinateNames(); });
}

MotionFile readMotion(const MotionSource& source, const Mechanism& mechanism,
                      const JointChoice& choose) {
  const Names& coordinates = mechanism.coordinateNames();
  Names unused;
  if (source.files.size() > 1 || looksLikeBag(source.files.front())) {
    MotionFile motion = readBagMotion(source, choose, unused);
    noteUnused(motion.path, {unused, {}}, coordinates);
    return motion;
  }
  MotionFile motion;
  motion.path = source.files.front();
  if (!source.topic.empty()) {
    throw FileError(motion.path + ": is not a bag, and --topic is the topic of one");
  }
  if (isNpz(motion.path)) {
    readNpz(source, choose, unused, motion);
  } else {
    WatchedFile file(motion.path);
    BegunText text(file);
    if (StateCsv::isBegunBy(text.begin())) {
      motion = readStateCsv(text, source, choose, unused);
      noteUnused(motion.path, {unused, {}}, coordinates);
      return motion;
    }
    motion.table = readMotionText(text, motion.path, source.rename, choose, &unused, &motion.lines);
  }
  noteUnused(motion.path, sorted(motion.path, unused, coordinates, source.efforts), coordinates);
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
  warnOfUnits(mechanism, motion);
  if (missing.empty() || table.joints.empty()) {
    if (cannotBeSeconds(table.times)) {
      std::cerr << "warning: " << printable(motion.path) << ": times up to "
                << numberText(table.times.back()) << " cannot be seconds: are they nanoseconds?\n";
    }
    if (!scene.static_motion) warnOfSlopes(motion);
    return;
  }
  checkTimes(motion);
  CompletionReport report;
  try {
    Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "estimating " + missing);
    CompletionSettings shown = settings;
    shown.progress = [&](std::size_t done, std::size_t total) { progress.update(done, total); };
    table = completeMotion(mechanism, std::move(table), shown, &report);
  } catch (const MotionError& error) {
    throw FileError(motion.path + ": " + error.what());
  }
  std::cerr << "note: " << printable(motion.path) << ": estimated: " << missing
            << (report.even_clock ? "; the rows are those of an even clock, its times jitter" : "")
            << "\n";
  describeEstimate(mechanism, motion, table.joints, report);
  motion.one_sided = std::move(report.one_sided_rows);
  for (const StreamQuality& quality : report.qualities) {
    motion.noises.push_back(quality.position_noise);
  }
}

}  // namespace virtual_work_dynamics
