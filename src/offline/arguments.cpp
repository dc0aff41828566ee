#include "offline/arguments.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kHelp[] =
    R"(inverse_dynamics_offline: active efforts and joint reactions of a recorded motion

  inverse_dynamics_offline --urdf ROBOT.urdf --motion MOTION.csv|BAG... [options]
  inverse_dynamics_offline --urdf ROBOT.urdf --check [options]
  inverse_dynamics_offline --urdf ROBOT.urdf --explain [options]

Input
  --urdf FILE           robot description
  --motion FILE         motion as CSV: a header with the columns time, position.<joint>,
                        velocity.<joint>, acceleration.<joint> in any order (s, rad or m); lines
                        that start with # are comments. Missing accelerations, or velocities, are
                        estimated by a smoother that finds the noise of the recording. Where the
                        scene closes loops, the columns are of all joints, or of as many as move the
                        others: the actuated ones, or any other choice, free axes of closures
                        (position.<closure>) and poses of links (position.pose.<link>.x, y, z, qx,
                        qy, qz, qw, in axes of the root link) included. - reads standard input.
  --motion BAG...       motion as a bag of ROS 1, or the parts that rosbag split it into: a row for
                        each sensor_msgs/JointState that has all joints. The result has their stamps
                        in a column stamp (s, all nanoseconds), and times from the first one on. A bag
                        that is damaged or was not closed gives what can be read of it.
  --topic NAME          topic of the joint states in the bag (default: the only one, or /joint_states)
  --scene FILE          scene file (YAML); the options below override it

How missing derivatives are estimated
  --position-noise X    standard deviation of the positions, rad or m (default: found)
  --velocity-noise X    standard deviation of the velocities, rad/s or m/s (default: found)
  --stamp-noise X       standard deviation of the times, s (default: found)
  --bandwidth HZ        what swings so fast keeps half of its amplitude (default: found)
  --lag S               estimates each row from the rows up to S seconds after it, as
                        inverse_dynamics_node does (default: from all rows)
  --max-gap S           nothing is assumed of the motion across longer gaps (default: 0.25)
  --rest JOINT=X        position, rad or m, of a joint that the motion does not have, or that a bag
                        has in messages of its own; several separated by commas

What is computed
  --gravity "X Y Z"     gravity in axes of a root link that rests, m/s^2 (default: 0 0 -9.81)
  --axes root|child     axes of the reactions: of the root link (default) or of the child link
  --reactions LIST      all (every movable joint; the default), none, or joints separated by
                        commas; fixed joints and "ground" by name only
  --no-efforts          reactions only
  --method NAME         virtual_work (the default), or lagrange: Lagrange's equations with a
                        fictitious mobility at each joint, in long double; it is slow, shares no
                        formula with virtual_work and serves to check it
  --certificates        adds the columns certificate.{power,ground_force,ground_moment}: how far
                        each row violates the balance of power, and the wrench of ground the rates
                        of change of momentum, relative to the sum of all terms' magnitudes; they
                        judge the arithmetic, not the motion or the description that it starts from
  --deviations          adds the columns deviation.effort.<joint>, deviation.<name>.{fx,...,tz}:
                        standard deviations of the results by the error of the estimated motion; and,
                        where the scene has tolerances, tolerance.effort.<joint>,
                        tolerance.<name>.{fx,...,tz}: by the errors of masses and inertias
  --positions           adds the columns position.<joint>, velocity.<joint> and acceleration.<joint>
                        of all joints: the motion that the results belong to, which can be read as a
                        motion again
  --deviation-warn X    notes efforts whose deviation is more than X times the effort, both as rms of
                        all rows, and the cause (default: 0.1)
  --loop-tolerance X    how far the motion may violate closed loops, relative to the loops' size
                        and to the largest rate and acceleration (default: 1e-6)
  --threads N           divides the rows among N threads (default: 1)

Output
  --output FILE         result as CSV (default: standard output); FILE is written as a whole or not
                        at all
  --check               only describes the robot and says what is doubtful about it; for closed
                        loops with --motion, also how close it comes to singular positions
  --explain             only says what a sample costs and what its computation leaves out because
                        no result that is asked for needs it
  --help                this text
  --version             the version of the package

The result has the columns time, effort.<joint> (N m or N) and, for each reaction,
reaction.<name>.{fx,fy,fz,tx,ty,tz}: force (N) and moment about the joint's origin (N m) that the
parent link exerts on the child link. An empty cell is a value that overflowed or
does not exist.

Where the scene closes loops, closures have effort and reaction columns like joints. Further columns
are determined.effort.<joint>, determined.<name>.{fx,fy,fz,tx,ty,tz}: 1 where rigid-body mechanics
determines the value, 0 where the scene's policy does. In singular positions cells of results without
a value are empty. The columns residual.{position,velocity,acceleration}.<closure> say by how much the motion
violates the closure, in m or rad, m/s or rad/s, m/s^2 or rad/s^2.

Exit status: 0 done, 1 something is wrong with the input or output, 2 wrong usage.

Example
  inverse_dynamics_offline --urdf arm.urdf --motion swing.csv --gravity "0 0 -9.81" \
    --reactions shoulder,ground --axes child --output swing_loads.csv
)";

constexpr char kBag[] = ".bag";

// Cuts a text at each separator; blanks around the pieces are removed.
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> pieces;
  std::istringstream stream(text + separator);
  for (std::string piece; std::getline(stream, piece, separator);) {
    const std::size_t first = piece.find_first_not_of(" \t");
    const std::size_t last = piece.find_last_not_of(" \t");
    pieces.push_back(first == std::string::npos ? "" : piece.substr(first, last - first + 1));
  }
  return pieces;
}

Eigen::Vector3d parseGravity(const std::string& text) {
  std::istringstream stream(text);
  Eigen::Vector3d gravity;
  std::string number;
  int count = 0;
  while (stream >> number) {
    double value = 0;
    if (!parseNumber(number, value)) {
      throw UsageError("--gravity: " + inQuotes(number) + " is not a finite number");
    }
    if (count < 3) gravity[count] = value;
    ++count;
  }
  if (count != 3) {
    throw UsageError("--gravity: " + inQuotes(text) +
                     " is not three numbers, as in --gravity \"0 0 -9.81\"");
  }
  return gravity;
}

bool parseChildAxes(const std::string& text) {
  if (text != "root" && text != "child") {
    throw UsageError("--axes: " + inQuotes(text) + " is neither root nor child");
  }
  return text == "child";
}

void parseReactions(const std::string& text, Arguments& arguments) {
  if (text == "all") {
    arguments.reactions = ReactionSelection::kAll;
  } else if (text == "none") {
    arguments.reactions = ReactionSelection::kNone;
  } else {
    arguments.reactions = ReactionSelection::kNamed;
    arguments.reaction_names = split(text, ',');
    const auto& names = arguments.reaction_names;
    if (std::find(names.begin(), names.end(), "") != names.end()) {
      throw UsageError("--reactions: there is an empty name in " + inQuotes(text));
    }
  }
}

Method parseMethod(const std::string& text) {
  if (text != "virtual_work" && text != "lagrange") {
    throw UsageError("--method: " + inQuotes(text) + " is neither virtual_work nor lagrange");
  }
  return text == "lagrange" ? Method::kLagrange : Method::kVirtualWork;
}

int parseThreads(const std::string& text) {
  constexpr double kMost = 1024;
  double value = 0;
  if (!parseNumber(text, value) || value != std::floor(value) || value < 1 || value > kMost) {
    throw UsageError("--threads: " + inQuotes(text) + " is not a whole number from 1 to 1024");
  }
  return static_cast<int>(value);
}

double parsePositive(const std::string& option, const std::string& text) {
  double value = 0;
  if (!parseNumber(text, value) || value <= 0) {
    throw UsageError(option + ": " + inQuotes(text) + " is not a positive number");
  }
  return value;
}

double parseNotNegative(const std::string& option, const std::string& text) {
  double value = 0;
  if (!parseNumber(text, value) || value < 0) {
    throw UsageError(option + ": " + inQuotes(text) + " is not a number from 0 on");
  }
  return value;
}

void parseRest(const std::string& text, Arguments& arguments) {
  for (const std::string& piece : split(text, ',')) {
    const std::size_t equals = piece.rfind('=');
    double position = 0;
    if (equals == std::string::npos || equals == 0 ||
        !parseNumber(piece.substr(equals + 1), position)) {
      throw UsageError("--rest: " + inQuotes(piece) + " is not JOINT=POSITION");
    }
    arguments.recording.rest.emplace_back(piece.substr(0, equals), position);
  }
}

NoiseSettings& noiseOf(Arguments& arguments) {
  return arguments.recording.completion.noise;
}

using Setter = std::function<void(const std::string& value, Arguments& arguments)>;

const std::map<std::string, Setter>& optionsWithValue() {
  static const std::map<std::string, Setter> options{
      {"--urdf", [](const auto& value, auto& arguments) { arguments.urdf = value; }},
      {"--motion",
       [](const auto& value, auto& arguments) {
         arguments.motion.files.push_back(value == "-" ? "/dev/stdin" : value);
       }},
      {"--topic", [](const auto& value, auto& arguments) { arguments.motion.topic = value; }},
      {"--scene", [](const auto& value, auto& arguments) { arguments.scene = value; }},
      {"--output", [](const auto& value, auto& arguments) { arguments.output = value; }},
      {"--gravity",
       [](const auto& value, auto& arguments) { arguments.gravity = parseGravity(value); }},
      {"--axes",
       [](const auto& value, auto& arguments) { arguments.child_axes = parseChildAxes(value); }},
      {"--reactions", parseReactions},
      {"--method",
       [](const auto& value, auto& arguments) { arguments.method = parseMethod(value); }},
      {"--loop-tolerance",
       [](const auto& value, auto& arguments) {
         arguments.loop_tolerance = parsePositive("--loop-tolerance", value);
       }},
      {"--position-noise",
       [](const auto& value, auto& arguments) {
         noiseOf(arguments).position_noise = parsePositive("--position-noise", value);
       }},
      {"--velocity-noise",
       [](const auto& value, auto& arguments) {
         noiseOf(arguments).velocity_noise = parsePositive("--velocity-noise", value);
       }},
      {"--stamp-noise",
       [](const auto& value, auto& arguments) {
         noiseOf(arguments).stamp_noise = parseNotNegative("--stamp-noise", value);
       }},
      {"--bandwidth",
       [](const auto& value, auto& arguments) {
         noiseOf(arguments).bandwidth = parsePositive("--bandwidth", value);
       }},
      {"--lag",
       [](const auto& value, auto& arguments) {
         arguments.recording.completion.lag = parseNotNegative("--lag", value);
       }},
      {"--max-gap",
       [](const auto& value, auto& arguments) {
         arguments.recording.completion.max_gap = parsePositive("--max-gap", value);
       }},
      {"--rest", parseRest},
      {"--deviation-warn",
       [](const auto& value, auto& arguments) {
         arguments.deviation_warn = parsePositive("--deviation-warn", value);
       }},
      {"--threads",
       [](const auto& value, auto& arguments) { arguments.threads = parseThreads(value); }},
  };
  return options;
}

const std::map<std::string, bool Arguments::*>& switches() {
  static const std::map<std::string, bool Arguments::*> options{
      {"--certificates", &Arguments::certificates},
      {"--check", &Arguments::check},
      {"--deviations", &Arguments::deviations},
      {"--explain", &Arguments::explain},
      {"--help", &Arguments::help},
      {"--no-efforts", &Arguments::no_efforts},
      {"--positions", &Arguments::positions},
      {"--version", &Arguments::version},
  };
  return options;
}

std::string optionHelp(const std::string& option) {
  std::vector<std::string> known;
  for (const auto& entry : optionsWithValue()) known.push_back(entry.first);
  for (const auto& entry : switches()) known.push_back(entry.first);
  const std::string nearest = nearestName(option, known);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

// Goes through the words of a command line.
class Parser {
 public:
  explicit Parser(const std::vector<std::string>& words) : words_(words) {}

  Arguments parse() {
    while (next_ < words_.size() && !arguments_.help && !arguments_.version) parseOption();
    return arguments_;
  }

 private:
  void parseOption() {
    const std::string word = words_[next_++];
    const std::size_t equals = word.find('=');
    const std::string option = word.substr(0, equals);
    const bool has_value = equals != std::string::npos;
    const auto with_value = optionsWithValue().find(option);
    const auto without_value = switches().find(option);
    if (with_value == optionsWithValue().end() && without_value == switches().end()) {
      if (isPart(word)) return arguments_.motion.files.push_back(word);
      if (word.compare(0, 1, "-") != 0) throw UsageError("unexpected argument " + inQuotes(word));
      throw UsageError("unknown option " + inQuotes(option) + optionHelp(option));
    }
    latest_ = option;
    if (!seen_.insert(option).second) throw UsageError(option + " is given twice");
    if (without_value != switches().end()) {
      if (has_value) throw UsageError(option + " takes no value");
      arguments_.*(without_value->second) = true;
    } else {
      const std::string value = has_value ? word.substr(equals + 1) : nextValue(option);
      if (value.empty()) throw UsageError(option + " needs a value");
      with_value->second(value, arguments_);
    }
  }

  // A shell makes `--motion run_0.bag run_1.bag` of `--motion run_*.bag`.
  bool isPart(const std::string& word) const {
    constexpr std::size_t kLength = sizeof kBag - 1;
    return latest_ == "--motion" && word.size() > kLength && word[0] != '-' &&
           word.compare(word.size() - kLength, kLength, kBag) == 0;
  }

  std::string nextValue(const std::string& option) {
    // A value may start with one dash, as negative numbers do.
    if (next_ == words_.size() || words_[next_].compare(0, 2, "--") == 0) {
      throw UsageError(option + " needs a value");
    }
    return words_[next_++];
  }

  const std::vector<std::string>& words_;
  std::size_t next_ = 0;
  std::set<std::string> seen_;
  std::string latest_;  // option
  Arguments arguments_;
};

}  // namespace

Arguments parseArguments(const std::vector<std::string>& words) {
  const Arguments arguments = Parser(words).parse();
  if (arguments.help || arguments.version) return arguments;
  if (arguments.urdf.empty()) throw UsageError("--urdf FILE is missing");
  if (arguments.motion.empty() && !arguments.check && !arguments.explain) {
    throw UsageError("--motion FILE is missing (only --check and --explain need none)");
  }
  if (!arguments.motion.topic.empty() && arguments.motion.empty()) {
    throw UsageError("--topic is of use with --motion BAG only");
  }
  if (arguments.deviation_warn && !arguments.deviations) {
    throw UsageError("--deviation-warn is of use with --deviations only");
  }
  if (arguments.method == Method::kLagrange) {
    if (arguments.threads != 1) {
      throw UsageError("--threads: --method lagrange runs in one thread, not in " +
                       std::to_string(arguments.threads));
    }
    if (arguments.explain) throw UsageError("--explain cannot be used with --method lagrange");
  }
  return arguments;
}

std::string helpText() {
  return kHelp;
}

}  // namespace virtual_work_dynamics
