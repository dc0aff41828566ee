#include "offline/arguments.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "offline/argument_checks.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kBag[] = ".bag";
constexpr char kNpz[] = ".npz";

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

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

void parseAxes(const std::string& text, Arguments& arguments) {
  if (text != "root" && text != "child" && text != "inertial") {
    throw UsageError("--axes: " + inQuotes(text) + " is neither root nor child nor inertial");
  }
  arguments.child_axes = text == "child";
  arguments.inertial_axes = text == "inertial";
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

void parseParameters(const std::string& text, Arguments& arguments) {
  arguments.parameters = split(text, ',');
  const auto& names = arguments.parameters;
  if (std::find(names.begin(), names.end(), "") != names.end()) {
    throw UsageError("--parameters: there is an empty name in " + inQuotes(text));
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

// The name of a node, as it stands before its topics.
std::string parseNode(const std::string& text) {
  const auto allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  const std::string name = text[0] == '/' ? text.substr(1) : text;
  bool good = !name.empty() && name.back() != '/';
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool first = i == 0 || name[i - 1] == '/';
    good = good && (first ? std::isalpha(static_cast<unsigned char>(name[i])) != 0
                          : allowed(name[i]) || name[i] == '/');
  }
  if (!good) throw UsageError("--node: " + inQuotes(text) + " is not the name of a node");
  return "/" + name;
}

// A topic that is read in place of another one, as rosrun takes it; an empty one: none is.
std::pair<std::string, std::string> parseRemap(const std::string& text) {
  const std::size_t sign = text.find(":=");
  if (sign == std::string::npos || sign == 0) {
    throw UsageError("--remap: " + inQuotes(text) + " is not NAME:=TOPIC");
  }
  const std::string topic = text.substr(sign + 2);
  return {text.substr(0, sign), topic.empty() || topic[0] == '/' ? topic : "/" + topic};
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
      {"--rename", [](const auto& value, auto& arguments) { arguments.motion.rename.add(value); }},
      {"--topic", [](const auto& value, auto& arguments) { arguments.motion.topic = value; }},
      {"--measured",
       [](const auto& value, auto& arguments) { arguments.measured.files.push_back(value); }},
      {"--measured-topic",
       [](const auto& value, auto& arguments) { arguments.measured.topic = value; }},
      {"--observer-gain",
       [](const auto& value, auto& arguments) {
         arguments.observer_gain = parsePositive("--observer-gain", value);
         arguments.residuals = true;
       }},
      {"--rosparam", [](const auto& value, auto& arguments) { arguments.rosparam = value; }},
      {"--root-source", [](const auto& value, auto& arguments) { arguments.root_source = value; }},
      {"--remap",
       [](const auto& value, auto& arguments) { arguments.remap.push_back(parseRemap(value)); }},
      {"--scene", [](const auto& value, auto& arguments) { arguments.scene = value; }},
      {"--output", [](const auto& value, auto& arguments) { arguments.output = value; }},
      {"--report", [](const auto& value, auto& arguments) { arguments.report = value; }},
      {"--gravity",
       [](const auto& value, auto& arguments) { arguments.gravity = parseGravity(value); }},
      {"--axes", parseAxes},
      {"--reactions", parseReactions},
      {"--regressor", [](const auto& value, auto& arguments) { arguments.regressor = value; }},
      {"--parameters", parseParameters},
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
      {"--generate", [](const auto& value, auto& arguments) { arguments.generate = value; }},
      {"--node", [](const auto& value, auto& arguments) { arguments.node = parseNode(value); }},
      {"--threads",
       [](const auto& value, auto& arguments) { arguments.threads = parseThreads(value); }},
  };
  return options;
}

using Switch = std::function<bool&(Arguments& arguments)>;

const std::map<std::string, Switch>& switches() {
  static const std::map<std::string, Switch> options{
      {"--certificates", [](Arguments& all) -> bool& { return all.certificates; }},
      {"--check", [](Arguments& all) -> bool& { return all.check; }},
      {"--copy-input", [](Arguments& all) -> bool& { return all.copy_input; }},
      {"--degrees", [](Arguments& all) -> bool& { return all.motion.degrees; }},
      {"--deviations", [](Arguments& all) -> bool& { return all.deviations; }},
      {"--effort-limits", [](Arguments& all) -> bool& { return all.effort_limits; }},
      {"--explain", [](Arguments& all) -> bool& { return all.explain; }},
      {"--help", [](Arguments& all) -> bool& { return all.help; }},
      {"--no-efforts", [](Arguments& all) -> bool& { return all.no_efforts; }},
      {"--positions", [](Arguments& all) -> bool& { return all.positions; }},
      {"--residuals", [](Arguments& all) -> bool& { return all.residuals; }},
      {"--version", [](Arguments& all) -> bool& { return all.version; }},
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
    if (arguments_.help || arguments_.version) return arguments_;
    if (!arguments_.generate.empty()) checkForGenerating();
    if (!arguments_.report.empty()) completeForReport();
    nameJointStates();
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
    if (!seen_.insert(option).second && option != "--rename" && option != "--remap")
      throw UsageError(option + " is given twice");
    if (without_value != switches().end()) {
      if (has_value) throw UsageError(option + " takes no value");
      without_value->second(arguments_) = true;
    } else {
      const std::string value = has_value ? word.substr(equals + 1) : nextValue(option);
      if (value.empty()) throw UsageError(option + " needs a value");
      with_value->second(value, arguments_);
    }
  }

  void checkForGenerating() const {
    if (arguments_.inertial_axes) {
      throw UsageError("--axes inertial cannot be used with --generate");
    }
    static const std::set<std::string> kTaken{
        "--axes",      "--generate", "--gravity", "--help", "--no-efforts", "--node",
        "--reactions", "--rosparam", "--scene",   "--urdf", "--version"};
    for (const std::string& option : seen_) {
      if (kTaken.count(option) == 0) throw UsageError(option + " cannot be used with --generate");
    }
  }

  // Where the joint states come from, by the names of the node.
  void nameJointStates() {
    const std::string& node = arguments_.node;
    arguments_.motion.usual_topic = node.substr(0, node.rfind('/')) + "/joint_states";
    arguments_.measured.usual_topic = arguments_.motion.usual_topic;
    auto& remap = arguments_.remap;
    const auto found = std::find_if(remap.begin(), remap.end(), [](const auto& remapped) {
      return remapped.first == "joint_states";
    });
    if (found == remap.end()) return;
    if (!arguments_.motion.topic.empty()) {
      throw UsageError("--remap joint_states:=TOPIC cannot be used with --topic");
    }
    if (found->second.empty()) throw UsageError("--remap joint_states:= needs a topic");
    arguments_.motion.topic = found->second;
    remap.erase(found);
  }

  // A report judges reactions along and across the axes of joints, which rest in child axes, and
  // how joints turn.
  void completeForReport() {
    if (seen_.count("--axes") > 0 && !arguments_.child_axes) {
      throw UsageError("--axes root: a report needs reactions in the axes of the child links");
    }
    arguments_.child_axes = true;
    arguments_.positions = true;
    if (arguments_.output.empty()) arguments_.output = arguments_.report + "/results" + kNpz;
  }

  // A shell makes `--motion run_0.bag run_1.bag` of `--motion run_*.bag`.
  bool isPart(const std::string& word) const {
    return latest_ == "--motion" && word[0] != '-' && endsWith(word, kBag);
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

MotionSource Arguments::measuredSource() const {
  MotionSource source = measured.empty() ? motion : measured;
  if (!measured.topic.empty()) source.topic = measured.topic;
  source.rename = motion.rename;
  return source;
}

bool Arguments::toNpz() const {
  return endsWith(output, kNpz);
}

bool Arguments::toBag() const {
  return endsWith(output, kBag) && !check && !explain;
}

Arguments parseArguments(const std::vector<std::string>& words) {
  Arguments arguments = Parser(words).parse();
  if (!arguments.measured.empty() || !arguments.measured.topic.empty()) arguments.residuals = true;
  if (!arguments.help && !arguments.version) requireAgreement(arguments);
  return arguments;
}

}  // namespace virtual_work_dynamics
