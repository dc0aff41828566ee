#include "ros/rviz_configuration.h"

#include <yaml-cpp/yaml.h>

#include "base/number_text.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Of the model's size: width of arrows, distance of the camera.
constexpr double kWidth = 0.045;
constexpr double kDistance = 1.3;
constexpr double kNearClip = 0.003;
constexpr double kPixels = 540;  // of the model in a view from above
// RViz draws an arrow's head beyond the length that the scale gives.
constexpr double kHead = 0.3;
constexpr char kWrench[] = "rviz/WrenchStamped";

void set(YAML::Node node, const char* key, double value) {
  node[key] = numberText(value);
}

YAML::Node cameraOf(const RvizScene& scene) {
  const ModelView& view = scene.view;
  const Eigen::Vector3d centre = view.box.center();
  YAML::Node camera;
  camera["Class"] = view.from_above ? "rviz/TopDownOrtho" : "rviz/Orbit";
  camera["Name"] = "Current View";
  camera["Value"] = view.from_above ? "TopDownOrtho (rviz)" : "Orbit (rviz)";
  camera["Target Frame"] =
      scene.fixed_frame == scene.root_frame ? std::string("<Fixed Frame>") : scene.root_frame;
  if (view.from_above) {
    set(camera, "Angle", view.turn);
    set(camera, "Scale", kPixels / view.size);
    set(camera, "X", centre.x());
    set(camera, "Y", centre.y());
    return camera;
  }
  set(camera, "Distance", kDistance * view.size);
  set(camera, "Field of View", 0.785398);
  YAML::Node focus(YAML::NodeType::Map);
  set(focus, "X", centre.x());
  set(focus, "Y", centre.y());
  set(focus, "Z", centre.z());
  camera["Focal Point"] = focus;
  set(camera, "Focal Shape Size", 0.05 * view.size);
  camera["Invert Z Axis"] = view.upside_down;
  set(camera, "Near Clip Distance", kNearClip * view.size);
  set(camera, "Pitch", view.pitch);
  set(camera, "Yaw", view.yaw);
  return camera;
}

// RViz puts a slash behind the prefix.
std::string withoutSlash(const std::string& prefix) {
  return !prefix.empty() && prefix.back() == '/' ? prefix.substr(0, prefix.size() - 1) : prefix;
}

void fill(YAML::Node display, const RvizScene& scene) {
  const std::string kind = display["Class"].as<std::string>("");
  if (kind == "rviz/Grid") {
    display["Reference Frame"] = "<Fixed Frame>";
    set(display, "Cell Size", scene.view.cell);
  } else if (kind == "rviz/RobotModel") {
    display["Robot Description"] = scene.robot_description;
    display["TF Prefix"] = withoutSlash(scene.frame_prefix);
  }
}

YAML::Node group(const char* name, const YAML::Node& displays) {
  YAML::Node node;
  node["Class"] = "rviz/Group";
  node["Displays"] = displays;
  node["Enabled"] = true;
  node["Name"] = name;
  return node;
}

YAML::Node arrowsOf(const YAML::Node& sample, const RvizScene& scene) {
  const ModelView& view = scene.view;
  YAML::Node displays(YAML::NodeType::Sequence);
  for (std::size_t i = 0; i < scene.reactions.size(); ++i) {
    YAML::Node display = YAML::Clone(sample);
    display["Name"] = scene.reactions[i];
    display["Topic"] = scene.reaction_topics[i];
    // Those of ~markers move with the robot. These show the sample before, where the joint was
    // then: RViz draws a message one picture after its tf.
    display["Enabled"] = display["Value"] = false;
    set(display, "Arrow Width", kWidth * view.size);
    set(display, "Force Arrow Scale", view.force_scale / (1 + kHead));
    set(display, "Torque Arrow Scale", view.torque_scale / (1 + kHead));
    displays.push_back(display);
  }
  return group("Reactions", displays);
}

YAML::Node markersOf(const RvizScene& scene) {
  // RViz counts the markers of arrays one by one while they wait for tf.
  constexpr std::size_t kArrays = 20, kMarkersOfReaction = 3, kMarkersOfLegend = 4;

  YAML::Node display;
  display["Class"] = "rviz/MarkerArray";
  display["Enabled"] = true;
  display["Marker Topic"] = scene.marker_topic;
  display["Name"] = "Arrows and numbers";
  display["Namespaces"] = YAML::Node(YAML::NodeType::Map);
  display["Queue Size"] =
      kArrays * (kMarkersOfReaction * scene.reactions.size() + kMarkersOfLegend);
  display["Value"] = true;
  return display;
}

YAML::Node parsedTemplate(const std::string& text, const std::string& source) {
  try {
    YAML::Node config = YAML::Load(text);
    const YAML::Node displays = config["Visualization Manager"]["Displays"];
    if (!displays.IsSequence()) throw FileError(source + ": is not a configuration of RViz");
    return config;
  } catch (const YAML::Exception& error) {
    throw FileError(source + ": is not a configuration of RViz: " + error.what());
  }
}

}  // namespace

std::string rvizConfiguration(const std::string& rviz_template, const std::string& source,
                              const RvizScene& scene) {
  YAML::Node config = parsedTemplate(rviz_template, source);
  try {
    YAML::Node manager = config["Visualization Manager"];
    YAML::Node displays(YAML::NodeType::Sequence), sample;
    bool sampled = false;
    for (YAML::Node display : manager["Displays"]) {
      fill(display, scene);
      if (sampled || display["Class"].as<std::string>("") != kWrench) {
        displays.push_back(display);
      } else {
        sample.reset(display);
        sampled = true;
      }
    }
    if (!sampled) throw FileError(source + ": has no display of the class " + kWrench);
    displays.push_back(arrowsOf(sample, scene));
    displays.push_back(markersOf(scene));
    manager["Displays"] = displays;
    manager["Global Options"]["Fixed Frame"] = scene.fixed_frame;
    manager["Views"]["Current"] = cameraOf(scene);
    YAML::Emitter text;
    text << config;
    return std::string(text.c_str()) + "\n";
  } catch (const YAML::Exception& error) {
    throw FileError(source + ": is not a configuration of RViz: " + error.what());
  }
}

}  // namespace virtual_work_dynamics
