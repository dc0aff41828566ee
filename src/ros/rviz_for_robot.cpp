#include "ros/rviz_for_robot.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "ros/described_robot.h"
#include "ros/private_parameters.h"
#include "ros/rviz_configuration.h"
#include "ros/rviz_for_robot_usage.h"
#include "ros/scene_parameter.h"
#include "ros/topic_names.h"
#include "virtual_work_dynamics/closure_axes.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Bytes, beyond configurations with thousands of displays.
constexpr std::size_t kLongestTemplate = std::size_t{64} << 20;
constexpr char kDefaultTemplate[] = "config/inverse_dynamics.rviz";

class UsageError : public Error {
 public:
  using Error::Error;
};

struct Options {
  std::string robot;  // empty: that of the node's parameters
  std::map<std::string, std::string> texts = {{"scene", ""},
                                              {"frame", ""},
                                              {"frame-prefix", ""},
                                              {"node", "inverse_dynamics"},
                                              {"template", ""}};
  bool print = false;
  std::vector<std::string> for_rviz;

  const std::string& operator[](const char* name) const { return texts.at(name); }
};

// Reads the option at `words[i]`, and leaves `i` at its last word. Returns false for any other
// word.
bool readOption(const std::vector<std::string>& words, std::size_t& i, Options& options) {
  if (words[i] == "--print") {
    options.print = true;
    return true;
  }
  const std::size_t equals = words[i].find('=');
  const std::string name = words[i].substr(0, equals);
  if (name.compare(0, 2, "--") != 0) return false;
  const auto text = options.texts.find(name.substr(2));
  if (text == options.texts.end()) return false;
  if (equals == std::string::npos && i + 1 == words.size()) {
    throw UsageError(name + " is not followed by its value");
  }
  const std::string value = equals == std::string::npos ? words[++i] : words[i].substr(equals + 1);
  if (!value.empty() || text->first != "node") text->second = value;
  return true;
}

Options readOptions(const std::vector<std::string>& words) {
  Options options;
  std::size_t i = 0;
  for (; i < words.size() && words[i] != "--"; ++i) {
    if (readOption(words, i, options)) continue;
    if (!options.robot.empty()) break;
    if (words[i].empty()) continue;
    if (words[i][0] == '-') {
      throw UsageError("unknown option " + words[i] +
                       "; arguments of RViz follow ROBOT.urdf or --");
    }
    options.robot = words[i];
  }
  if (i < words.size() && words[i] == "--") ++i;
  options.for_rviz.assign(words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
  return options;
}

struct Inputs {
  Mechanism mechanism;
  Scene scene;
  std::string robot_description, frame_prefix;
};

Mechanism named(const std::string& source, const std::string& urdf) {
  try {
    return readUrdf(urdf);
  } catch (const UrdfError& error) {
    throw UrdfError(source + ": " + error.what());
  }
}

Inputs filesOf(const Options& options) {
  const std::string& scene = options["scene"];
  return {readUrdfFile(options.robot),
          scene.empty() || scene == "none" ? Scene() : readSceneFile(scene),
          ros::names::resolve(kRobotDescription), options["frame-prefix"]};
}

// As inverse_dynamics_node reads them.
Inputs parametersOf(const Options& options, const std::string& node) {
  if (!ros::master::check()) {
    throw ParameterError("no ROBOT.urdf is given, and no ROS master answers at " +
                         ros::master::getURI() + ", whose " + kRobotDescription +
                         " would be shown");
  }
  std::string key, urdf;
  if (!ros::param::search(node, kRobotDescription, key)) {
    throw ParameterError(std::string("parameter ") + kRobotDescription + ": not set, neither in " +
                         node + " nor in any namespace above it, and no ROBOT.urdf is given");
  }
  if (!ros::param::get(key, urdf)) {
    throw ParameterError("parameter " + key + ": expected the text of a URDF");
  }
  const std::string& file = options["scene"];
  XmlRpc::XmlRpcValue parameters;
  if (file.empty()) ros::param::get(node + "/scene", parameters);
  std::string prefix = options["frame-prefix"];
  if (prefix.empty()) ros::param::get(node + "/frame_prefix", prefix);
  return {named("parameter " + key, urdf),
          file.empty()     ? readScene(sceneDocument(parameters))
          : file == "none" ? Scene()
                           : readSceneFile(file),
          key, prefix};
}

std::string configurationFor(const Options& options) {
  const std::string node = ros::names::resolve(options["node"]);
  const Inputs inputs = options.robot.empty() ? parametersOf(options, node) : filesOf(options);
  const SceneOfMechanism robot = mechanismFor(inputs.mechanism, inputs.scene);
  const Mechanism& mechanism = robot.mechanism;
  RvizScene scene;
  scene.reactions = requestedReactions(mechanism, robot.scene);
  scene.view = modelView(mechanism, robot.scene, scene.reactions);
  scene.reaction_topics = reactionTopics(scene.reactions);
  for (std::string& topic : scene.reaction_topics) topic = node + "/reaction/" + topic;
  scene.marker_topic = node + "/markers";
  scene.robot_description = inputs.robot_description;
  scene.frame_prefix = inputs.frame_prefix;
  scene.root_frame = inputs.frame_prefix + mechanism.links().front().name;
  const std::string& frame = options["frame"];
  scene.fixed_frame = frame.empty() || frame == "auto" ? scene.root_frame : frame;
  if (!inputs.frame_prefix.empty() && inputs.frame_prefix.back() != '/') {
    std::fprintf(stderr,
                 "rviz_for_robot: RViz shows a robot only where its frame prefix ends with /, "
                 "and '%s' does not\n",
                 inputs.frame_prefix.c_str());
  }
  const std::string& path = options["template"];
  return path.empty() ? rvizConfiguration(rvizTemplate(), kDefaultTemplate, scene)
                      : rvizConfiguration(readTextFile(path, kLongestTemplate), path, scene);
}

FileError systemError(const std::string& what) {
  return FileError(what + ": " + std::strerror(errno));
}

void writeAll(int descriptor, const std::string& text, const char* name) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw systemError(std::string(name) + " cannot be written");
    done += static_cast<std::size_t>(count);
  }
}

// Replaces this process, so that signals, names and the exit code are RViz's own. The configuration
// is a file in memory, which ends with RViz however that ends.
[[noreturn]] void becomeRviz(const std::string& configuration,
                             const std::vector<std::string>& arguments) {
  const int memory = ::memfd_create("robot.rviz", 0);
  if (memory < 0) throw systemError("the configuration cannot be kept in memory");
  writeAll(memory, configuration, "the configuration");
  std::vector<std::string> words = {
      "rviz", "-d", "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(memory)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(pointers[0], pointers.data());
  throw systemError("rviz cannot be started");
}

}  // namespace

int rvizForRobot(int argc, char** argv) {
  try {
    std::vector<std::string> names;  // remappings, for RViz as well
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--") break;
      if (word == "--help" || word == "-h") {
        std::fputs(kRvizForRobotUsage, stdout);
        return 0;
      }
      if (word[0] != '-' && word.find(":=") != std::string::npos) names.push_back(word);
    }
    ros::init(argc, argv, "rviz_for_robot", ros::init_options::NoSigintHandler);
    Options options = readOptions({argv + 1, argv + argc});
    const std::string configuration = configurationFor(options);
    if (options.print) {
      writeAll(STDOUT_FILENO, configuration, "the configuration");
      return 0;
    }
    options.for_rviz.insert(options.for_rviz.end(), names.begin(), names.end());
    becomeRviz(configuration, options.for_rviz);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "rviz_for_robot: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rviz_for_robot: %s\n", error.what());
    return 1;
  }
}

}  // namespace virtual_work_dynamics
