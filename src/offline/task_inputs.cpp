#include "offline/task_inputs.h"

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <vector>

#include "bag/bag_reader.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "offline/bag_texts.h"
#include "offline/bag_topic.h"
#include "offline/parameter_dump.h"
#include "scene/yaml_document.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kLongestUrdf = std::size_t{1} << 28;       // bytes
constexpr std::size_t kLongestSceneText = std::size_t{1} << 26;  // bytes
constexpr char kDescriptionName[] = "robot_description";

YAML::Node sceneOf(const std::string& text, const std::string& name) {
  try {
    return readYamlDocument(text);
  } catch (const SceneError& error) {
    throw SceneError(name + ": " + error.what());
  } catch (const YAML::Exception& error) {
    throw FileError(name + ": is not valid YAML: " + printable(error.what()));
  }
}

// As the node takes a scene that was set on a command line: the whole may be text, or a list or map
// below one of its keys.
YAML::Node withTextsRead(const YAML::Node& value, const std::string& name) {
  if (value.IsScalar()) {
    const std::string& text = value.Scalar();
    const std::size_t first = text.find_first_not_of(" \t\n");
    const bool read = first != std::string::npos && (text[first] == '[' || text[first] == '{');
    return read ? sceneOf(text, name) : value;
  }
  if (!value.IsMap()) return value;
  YAML::Node map(YAML::NodeType::Map);
  for (const auto& entry : value) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    map.force_insert(entry.first, withTextsRead(entry.second, name + "/" + key));
  }
  return map;
}

// The names of a dump or a bag that may be meant by another --node.
std::string otherNodes(const std::vector<std::string>& names) {
  if (names.empty()) return "";
  return "; it has " + namesInQuotes(names) + ": --node says in which namespace";
}

class Inputs {
 public:
  explicit Inputs(const Arguments& arguments) : arguments_(arguments) {}

  TaskInputs read() {
    if (!arguments_.urdf.empty()) {
      found_.description = readTextFile(arguments_.urdf, kLongestUrdf);
      found_.description_name = found_.description_file = arguments_.urdf;
    }
    if (!arguments_.scene.empty()) {
      found_.scene = sceneOf(readTextFile(arguments_.scene, kLongestSceneText), arguments_.scene);
      found_.scene_name = found_.scene_file = arguments_.scene;
    }
    if (!arguments_.rosparam.empty()) {
      readDump();
    } else if (arguments_.urdf.empty()) {
      readBag();
    }
    return found_;
  }

 private:
  void readDump() {
    const std::string& path = arguments_.rosparam;
    const ParameterDump dump(path);
    if (arguments_.urdf.empty()) {
      const std::string name = dump.firstOf(searchedNames(arguments_.node, kDescriptionName));
      if (name.empty()) {
        throw FileError(path + ": has no " + kDescriptionName + " for " + arguments_.node +
                        otherNodes(dump.endingIn(kDescriptionName)));
      }
      const YAML::Node text = *dump.find(name);
      if (!text.IsScalar()) throw FileError(path + ": " + name + ": expected the text of a URDF");
      found_.description = text.Scalar();
      found_.description_file = path;
      found_.description_name = path + ": " + name;
    }
    if (const auto parameters = dump.find(arguments_.node)) found_.parameters = *parameters;
    if (!found_.parameters.IsNull() && !found_.parameters.IsMap()) {
      throw FileError(path + ": " + arguments_.node + ": expected a map of parameters");
    }
    if (arguments_.scene.empty()) readDumpedScene(dump);
    if (found_.parameters.IsNull()) {
      std::cerr << "note: " << printable(path) << ": has no parameters of " << arguments_.node
                << ", so that all are the default ones\n";
    }
  }

  void readDumpedScene(const ParameterDump& dump) {
    const std::string name = arguments_.node + "/scene";
    const auto scene = dump.find(name);
    if (!scene) {
      const std::vector<std::string> others = dump.endingIn("scene");
      if (!others.empty() && found_.parameters.IsNull()) {
        throw FileError(arguments_.rosparam + ": has no parameters of " + arguments_.node +
                        otherNodes(others));
      }
      return;
    }
    found_.scene_file = arguments_.rosparam;
    found_.scene_name = arguments_.rosparam + ": " + name;
    found_.scene = scene->IsScalar() ? sceneOf(scene->Scalar(), found_.scene_name)
                                     : withTextsRead(*scene, found_.scene_name);
  }

  void readBag() {
    const std::vector<std::string>& files = arguments_.motion.files;
    const bool bags = !files.empty() && std::all_of(files.begin(), files.end(), looksLikeBag);
    if (!bags) {
      throw UsageError(
          "--urdf FILE is missing (or --rosparam FILE, or a bag that has a robot_description)");
    }
    const std::vector<std::string> parts = bagParts(arguments_.motion);
    const std::string name = arguments_.motion.name();
    const auto text = findBagText(parts, searchedNames(arguments_.node, kDescriptionName));
    if (!text) {
      throw FileError(name + ": has no topic /" + kDescriptionName +
                      " of std_msgs/String, and --urdf FILE is missing" +
                      otherNodes(bagTextTopics(parts, kDescriptionName)));
    }
    found_.description = text->text;
    found_.description_file = text->file;
    found_.description_name = text->file + ": " + text->topic;
    std::string what = "the description is that of " + inQuotes(text->topic);
    if (arguments_.scene.empty()) {
      const auto scene = findBagText(parts, {arguments_.node + "/scene"});
      if (scene) {
        found_.scene_file = scene->file;
        found_.scene_name = scene->file + ": " + scene->topic;
        found_.scene = sceneOf(scene->text, found_.scene_name);
        what += ", the scene that of " + inQuotes(scene->topic);
      }
    }
    std::cerr << "note: " << printable(name) << ": " << what << "\n";
  }

  const Arguments& arguments_;
  TaskInputs found_;
};

}  // namespace

TaskInputs readTaskInputs(const Arguments& arguments) {
  return Inputs(arguments).read();
}

}  // namespace virtual_work_dynamics
