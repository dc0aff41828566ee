#include "offline/mechanism_json.h"

#include <algorithm>
#include <vector>

#include "base/json_text.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "offline/report_columns.h"
#include "offline/task_inputs.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

std::string jsonVector(const Eigen::Vector3d& vector) {
  return "[" + numberText(vector.x()) + ", " + numberText(vector.y()) + ", " +
         numberText(vector.z()) + "]";
}

// An object whose members are added one by one.
class JsonObject {
 public:
  void add(const char* name, const std::string& json) {
    text_ += (text_.empty() ? "" : ", ") + jsonText(name) + ": " + json;
  }
  void addText(const char* name, const std::string& text) { add(name, jsonText(text)); }
  // Zero is what is not known, and is left out.
  void addKnown(const char* name, double number) {
    if (number != 0) add(name, numberText(number));
  }
  std::string text() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

const char* nameOfJoint(JointType type) {
  switch (type) {
    case JointType::kRevolute:
      return "revolute";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kPrismatic:
      return "prismatic";
    case JointType::kFixed:
    case JointType::kOriented:
      break;
  }
  return "fixed";
}

bool hasOneAxis(ClosureType type) {
  return type == ClosureType::kRevolute || type == ClosureType::kPrismatic ||
         type == ClosureType::kCylindrical || type == ClosureType::kPlanar;
}

bool hasOneAxis(CompoundType type) {
  return type == CompoundType::kPlanar || type == CompoundType::kCylindrical ||
         type == CompoundType::kScrew;
}

// What turns about its axis, by the column that says how fast.
void addTurn(JsonObject& object, const std::string& column, double factor) {
  JsonObject turn;
  turn.addText("velocity", column);
  turn.add("factor", numberText(factor));
  object.add("turn", turn.text());
}

void addJoint(JsonObject& object, const Mechanism& mechanism, int index) {
  const Joint& joint = mechanism.joint(index);
  const CompoundJoint* const compound = mechanism.compoundOf(index);
  object.addText("kind", "joint");
  object.addText("type", compound ? nameOf(compound->type) : nameOfJoint(joint.type));
  object.addText(
      "parent",
      mechanism.link(compound ? mechanism.joint(compound->first).parent_link : joint.parent_link)
          .name);
  object.addText("child", mechanism.link(joint.child_link).name);
  if (compound ? !hasOneAxis(compound->type) : joint.type == JointType::kFixed) return;
  object.add("axis", jsonVector(joint.axis_K.cast<double>()));
  if (joint.coordinate < 0 || unitOf(joint) != Unit::kRadian) return;
  addTurn(object, "velocity." + mechanism.jointOf(joint.coordinate).name, joint.multiplier);
}

void addClosure(JsonObject& object, const Mechanism& mechanism, const Closure& closure) {
  object.addText("kind", "closure");
  object.addText("type", traitsOf(closure.type).name);
  object.addText("parent", closure.parent.link);
  object.addText("child", closure.child.link);
  if (hasOneAxis(closure.type)) object.add("axis", jsonVector(Eigen::Vector3d::UnitZ()));
  const std::string column = ReportColumns::turningColumn(mechanism, closure);
  if (!column.empty()) addTurn(object, column, 1);
}

std::string reactionJson(const Mechanism& mechanism, const Scene& scene, const std::string& name) {
  JsonObject object;
  object.addText("name", name);
  const auto closure = std::find_if(scene.closures.begin(), scene.closures.end(),
                                    [&](const Closure& other) { return other.name == name; });
  const int index = mechanism.reactionIndex(name);
  if (closure != scene.closures.end()) {
    addClosure(object, mechanism, *closure);
  } else if (index >= 0) {
    addJoint(object, mechanism, index);
  } else {
    object.addText("kind", "ground");
    object.addText("type", "fixed");
    object.addText("child", mechanism.links().front().name);
  }
  const bool elsewhere = std::any_of(scene.moments_about.begin(), scene.moments_about.end(),
                                     [&](const MomentPoint& point) { return point.name == name; });
  if (elsewhere) object.add("moment_elsewhere", "true");
  return object.text();
}

std::string effortJson(const Mechanism& mechanism, const Scene& scene, const Dynamics& dynamics,
                       const Columns& columns, std::size_t effort) {
  JsonObject object;
  const std::string& name = columns.efforts[effort];
  object.addText("name", name);
  object.addText("column", columns.effortColumn(effort));
  const std::size_t coordinates = mechanism.coordinates().size();
  if (effort >= coordinates) {
    const auto closure = std::find_if(scene.closures.begin(), scene.closures.end(),
                                      [&](const Closure& other) { return other.name == name; });
    const auto coupling = std::find_if(scene.couplings.begin(), scene.couplings.end(),
                                       [&](const Coupling& other) { return other.name == name; });
    const bool slides =
        closure != scene.closures.end()
            ? traitsOf(closure->type).free_axis == Unit::kMetre
            : coupling != scene.couplings.end() &&
                  unitOf(mechanism.joint(mechanism.jointIndex(coupling->terms[0].name))) ==
                      Unit::kMetre;
    object.addText("unit", slides ? "m" : "rad");
    return object.text();
  }
  const Joint& joint = mechanism.jointOf(static_cast<int>(effort));
  object.addText("unit", symbolOf(unitOf(joint)));
  if (!dynamics.actuated()[effort]) object.add("passive", "true");
  object.addText("motion", joint.name);
  object.addKnown("effort_limit", joint.effort_limit);
  object.addKnown("velocity_limit", joint.velocity_limit);
  if (joint.lower < joint.upper) {
    object.add("lower", numberText(joint.lower));
    object.add("upper", numberText(joint.upper));
  }
  return object.text();
}

std::string listed(const std::vector<std::string>& objects) {
  std::string text = "[";
  for (const std::string& object : objects) text += (text == "[" ? "\n    " : ",\n    ") + object;
  return text + "]";
}

}  // namespace

std::string mechanismJson(const Arguments& arguments, const Mechanism& mechanism,
                          const Scene& scene, const Dynamics& dynamics, const Columns& columns) {
  std::vector<std::string> reactions, efforts;
  for (const std::string& name : columns.reactions) {
    reactions.push_back(reactionJson(mechanism, scene, name));
  }
  for (std::size_t i = 0; i < columns.efforts.size(); ++i) {
    efforts.push_back(effortJson(mechanism, scene, dynamics, columns, i));
  }
  std::string text = "{\n  \"format\": 1";
  const auto add = [&](const char* name, const std::string& json) {
    text += ",\n  " + jsonText(name) + ": " + json;
  };
  add("robot", jsonText(printable(mechanism.name())));
  add("description", jsonText(printable(arguments.inputs->description_name)));
  add("scene", jsonText(printable(arguments.inputs->scene_name)));
  add("motion", jsonText(printable(arguments.motion.name())));
  add("axes", jsonText(arguments.child_axes      ? "child"
                       : arguments.inertial_axes ? "inertial"
                                                 : "root"));
  add("gravity", jsonVector(scene.gravity));
  add("max_gap", numberText(arguments.recording.completion.max_gap));
  add("reactions", listed(reactions));
  add("efforts", listed(efforts));
  return text + "\n}\n";
}

}  // namespace virtual_work_dynamics
