#include "ros/trajectory_settings.h"

#include <cmath>
#include <set>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "motion/root_law.h"
#include "ros/message_text.h"
#include "ros/sample_times.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using XmlRpc::XmlRpcValue;

constexpr double kPi = 3.14159265358979323846;
// Limits within which whole nanoseconds resolve a step well and stamps do not overflow: Hz and s.
constexpr double kMaxRate = 1e6;
constexpr double kMinDuration = 1e-6;
constexpr double kMaxDuration = 1e9;
// Length of the longest messages for which roscpp does not drop the connection.
constexpr double kMaxMessageBytes = 1e9;

/// The parameters of all laws; those that the chosen law does not use are read, but not used.
struct LawParameters {
  std::string law;
  std::vector<double> amplitudes;
  double period;
  double start_frequency;
  double end_frequency;
  double duration;
  XmlRpcValue via_points;
  std::string file;
};

LawParameters readLawParameters(PrivateParameters& parameters) {
  LawParameters law;
  law.law = parameters.text("law", "cosine");
  law.amplitudes = parameters.numbers("amplitudes", {kPi / 12, kPi / 6});
  law.period = parameters.number("period", 12);
  law.start_frequency = parameters.number("start_frequency", 0.1);
  law.end_frequency = parameters.number("end_frequency", 1);
  law.duration = parameters.number("duration", 6);
  law.via_points = parameters.raw("via_points");
  law.file = parameters.text("file", "");
  return law;
}

void checkCount(std::size_t count, const std::vector<std::string>& joints,
                const std::string& name) {
  if (count == joints.size()) return;
  throw parameterError(name, "expected a number for each of the " + std::to_string(joints.size()) +
                                 " joints, got " + std::to_string(count));
}

void checkPositive(double value, const std::string& name, const std::string& unit) {
  if (value > 0) return;
  throw parameterError(name, "expected more than 0 " + unit + ", got " + numberText(value));
}

void checkNotNegative(double value, const std::string& name, const std::string& unit) {
  if (value >= 0) return;
  throw parameterError(name, "expected 0 " + unit + " or more, got " + numberText(value));
}

void checkJoints(const std::vector<std::string>& joints) {
  std::set<std::string> seen;
  if (joints.empty()) throw parameterError("joints", "expected at least one name, got none");
  for (const std::string& joint : joints) {
    if (joint.empty()) throw parameterError("joints", "a name is empty");
    if (!seen.insert(joint).second)
      throw parameterError("joints", inQuotes(joint) + " is named twice");
  }
}

MotionTable viaPoints(const XmlRpcValue& points, const std::vector<std::string>& joints) {
  const std::string expected = "expected a list of {time, positions}";
  if (points.getType() != XmlRpcValue::TypeArray) throw parameterError("via_points", expected);
  MotionTable table;
  table.joints = joints;
  table.positions.resize(points.size(), static_cast<Index>(joints.size()));
  for (int i = 0; i < points.size(); ++i) {
    const std::string name = "via_points[" + std::to_string(i) + "]";
    const XmlRpcValue& point = points[i];
    if (point.getType() != XmlRpcValue::TypeStruct || point.size() != 2 ||
        !point.hasMember("time") || !point.hasMember("positions")) {
      throw parameterError(name, "expected {time, positions} and nothing else");
    }
    const std::vector<double> positions = numbersOf(point["positions"], name + "/positions");
    checkCount(positions.size(), joints, name + "/positions");
    table.times.push_back(numberOf(point["time"], name + "/time"));
    for (std::size_t j = 0; j < positions.size(); ++j) {
      table.positions(i, static_cast<Index>(j)) = positions[j];
    }
  }
  return table;
}

/// Reads the table of the file, without the turns by which a driver wraps its positions.
MotionTable readTable(const std::string& file, const std::vector<std::string>& joints,
                      const RobotSource& source) {
  MotionTable table = readMotionCsv(file, joints);
  const std::optional<Mechanism> robot = source ? source() : std::nullopt;
  if (robot) {
    unwrapPositions(*robot, table);
  } else {
    unwrapPositions(table);
  }
  return table;
}

/// Makes the motion law that the parameters describe.
/// @param robot see readTrajectorySettings()
/// @param joints the parameter `joints`; when it is empty and the law is `table`, it receives the
///   joints of the file.
/// @param root receives the root's law where it has a source
std::shared_ptr<const MotionLaw> makeLaw(const LawParameters& parameters, const RobotSource& robot,
                                         std::vector<std::string>& joints, RootPlay& root) {
  if (root.source != RootSource::kNone && parameters.law != "table") {
    throw parameterError("root/source", "only the law `table` knows how a root moves");
  }
  if (parameters.law == "table") {
    if (parameters.file.empty()) throw parameterError("file", "the law `table` needs a file");
    try {
      const MotionTable table = readTable(parameters.file, joints, robot);
      joints = table.joints;
      checkJoints(joints);
      if (root.source != RootSource::kNone) root.law = std::make_shared<RootLaw>(table);
      return tableLaw(table);
    } catch (const ParameterError&) {
      throw;
    } catch (const Error& error) {
      throw parameterError("file", error.what());
    }
  }
  checkJoints(joints);
  if (parameters.law == "minimum_jerk") {
    const MotionTable points = viaPoints(parameters.via_points, joints);
    try {
      return minimumJerkLaw(points);
    } catch (const MotionError& error) {
      throw parameterError("via_points", error.what());
    }
  }
  if (parameters.law != "cosine" && parameters.law != "sine_sweep") {
    throw parameterError("law", "expected cosine, sine_sweep, minimum_jerk or table, got " +
                                    inQuotes(parameters.law));
  }
  checkCount(parameters.amplitudes.size(), joints, "amplitudes");
  const Eigen::VectorXd amplitudes = Eigen::Map<const Eigen::VectorXd>(
      parameters.amplitudes.data(), static_cast<Index>(parameters.amplitudes.size()));
  checkPositive(parameters.duration, "duration", "s");
  if (parameters.law == "cosine") {
    checkPositive(parameters.period, "period", "s");
    return cosineLaw(amplitudes, parameters.period, parameters.duration);
  }
  checkNotNegative(parameters.start_frequency, "start_frequency", "Hz");
  checkNotNegative(parameters.end_frequency, "end_frequency", "Hz");
  return sineSweepLaw(amplitudes, parameters.start_frequency, parameters.end_frequency,
                      parameters.duration);
}

RootPlay readRoot(PrivateParameters& parameters, const RobotSource& source) {
  RootPlay root;
  root.source = readRootSource(parameters);
  root.inertial_frame = parameters.text("root/inertial_frame", RootSettings().inertial_frame);
  root.link = parameters.text("root/link", "");
  const std::string prefix = parameters.text("frame_prefix", "");
  const std::vector<double> gravity = parameters.numbers("root/gravity", {0, 0, -9.81});
  if (gravity.size() != 3) {
    throw parameterError("root/gravity",
                         "expected three numbers, m/s^2, got " + std::to_string(gravity.size()));
  }
  root.gravity = Eigen::Vector3d(gravity.data());
  if (root.source == RootSource::kNone || !root.link.empty()) return root;
  const std::optional<Mechanism> robot = source ? source() : std::nullopt;
  if (!robot) {
    throw parameterError("root/link", "without a robot_description the root link has to be named");
  }
  root.link = prefix + robot->links().front().name;
  return root;
}

/// Reads a parameter that is one of two words, `no` by default. @returns whether it is `yes`.
bool choice(PrivateParameters& parameters, const std::string& name, const std::string& no,
            const std::string& yes) {
  const std::string text = parameters.text(name, no);
  if (text == yes) return true;
  if (text == no) return false;
  throw parameterError(name, "expected " + no + " or " + yes + ", got " + inQuotes(text) +
                                 nameHelp(text, {no, yes}));
}

double atLeastZero(PrivateParameters& parameters, const std::string& name, double fallback) {
  const double value = parameters.number(name, fallback);
  if (value >= 0 && value <= kMaxDuration) return value;
  throw parameterError(name, "expected 0 to 1e9 s, got " + numberText(value));
}

/// The parameter that says how long the motion of a law lasts.
std::string parameterOfDuration(const std::string& law) {
  if (law == "table") return "file";
  return law == "minimum_jerk" ? "via_points" : "duration";
}

void checkSampling(const TrajectorySettings& settings, const std::string& law) {
  if (!(settings.rate > 0 && settings.rate <= kMaxRate)) {
    throw parameterError("rate",
                         "expected more than 0 and up to 1e6 Hz, got " + numberText(settings.rate));
  }
  const double duration = settings.law->duration();
  if (duration > kMaxDuration || (duration > 0 && duration < kMinDuration)) {
    throw parameterError(
        parameterOfDuration(law),
        "the motion must last from 1e-6 to 1e9 s, its duration is " + numberText(duration) + " s");
  }
  if (settings.loop && duration == 0) {
    throw parameterError("loop", "a motion of a single instant cannot be repeated");
  }
  if (!settings.as_trajectory) {
    if (settings.zero_stamp) {
      throw parameterError("stamp", "only a joint_trajectory can have the stamp zero");
    }
    if (settings.loop_pause > 0) {
      throw parameterError("loop_pause", "only a joint_trajectory can pause: joint states go on");
    }
    return;
  }
  if (settings.root.source != RootSource::kNone &&
      settings.root.source != RootSource::kTrajectory) {
    throw parameterError(
        "root/source",
        "with message: joint_trajectory, expected trajectory: other messages would "
        "tell of the root when the trajectory is over");
  }
  const double points = static_cast<double>(SampleTimes(duration, settings.rate).last()) + 1;
  const double bytes = points * (24.0 * static_cast<double>(settings.joints.size()) + 24.0);
  if (bytes > kMaxMessageBytes) {
    throw parameterError("rate", "a trajectory of " + numberText(points) +
                                     " points is longer than a ROS message can be");
  }
}

}  // namespace

TrajectorySettings readTrajectorySettings(PrivateParameters& parameters, const RobotSource& robot) {
  TrajectorySettings settings;
  settings.joints = parameters.texts("joints", {"joint_1", "joint_2"});
  const LawParameters law = readLawParameters(parameters);
  settings.rate = parameters.number("rate", 1000);
  settings.as_trajectory = choice(parameters, "message", "joint_state", "joint_trajectory");
  settings.velocities = parameters.boolean("velocities", true);
  settings.zero_stamp = choice(parameters, "stamp", "now", "zero");
  settings.loop = parameters.boolean("loop", false);
  settings.loop_pause = atLeastZero(parameters, "loop_pause", 0);
  settings.wait_for_subscribers = parameters.integer("wait_for_subscribers", 1);
  settings.start_delay = atLeastZero(parameters, "start_delay", 0.5);
  settings.linger = atLeastZero(parameters, "linger", 1);
  settings.root = readRoot(parameters, robot);
  parameters.refuseUnknown();
  if (settings.wait_for_subscribers < 0) {
    throw parameterError("wait_for_subscribers", "expected a number from 0 on, got " +
                                                     std::to_string(settings.wait_for_subscribers));
  }
  settings.law = makeLaw(law, robot, settings.joints, settings.root);
  checkSampling(settings, law.law);
  return settings;
}

}  // namespace virtual_work_dynamics
