#include "virtual_work_dynamics/generated_code.h"

#include <memory>

#include "base/number_text.h"
#include "base/printable.h"
#include "generate/c_names.h"
#include "generate/c_source.h"
#include "generate/loop_model.h"
#include "generate/loop_recorder.h"
#include "generate/program.h"
#include "generate/recorder.h"
#include "scene/payloads.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

using Names = std::vector<std::string>;

void requireIdentifier(const std::string& name) {
  if (identifierOf(name) != name) {
    throw Error("no code can be generated under the name " + inQuotes(name) +
                ": a letter is needed, then letters, digits and single underscores");
  }
}

void count(const RecordedPlan& recording, const Program& program, GeneratedCode& code) {
  for (const ProgramPart& part : program.parts) {
    for (const std::uint32_t index : part.nodes) {
      switch (recording.graph.nodes()[index].operation) {
        case Operation::kMulAdd:
        case Operation::kSubMul:
        case Operation::kMulSub:
        case Operation::kMinusMulSub:
        case Operation::kProductRest:
          ++code.fused;
          ++code.additions;
          ++code.multiplications;
          break;
        case Operation::kAdd:
        case Operation::kSubtract:
          ++code.additions;
          break;
        case Operation::kMultiply:
          ++code.multiplications;
          break;
        case Operation::kDivide:
        case Operation::kRoot:
          ++code.divisions_and_roots;
          break;
        default:
          break;
      }
    }
  }
  code.sines_and_cosines = recording.graph.angles().size();
  code.functions = program.parts.size();
}

// The lines of a comment on what the numbers are.
class Comment {
 public:
  Comment(const Mechanism& mechanism, const Scene& scene, const Request& request,
          const GeneratedCode& code, const LoopModel* loops)
      : mechanism_(mechanism), scene_(scene), request_(request), code_(code), loops_(loops) {}

  Names lines() {
    if (loops_) {
      ofLoops(*loops_);
    } else {
      add("Efforts and reactions are those of InverseDynamics::compute(), to the last bit but the "
          "sign of zeros.");
    }
    add("Units: s, m, rad, kg, N, N m. Order of the coordinates and efforts: see the names below.");
    gravity();
    if (scene_.static_motion) add("Motion: static; velocities and accelerations are not read.");
    reactions("child", request_.child_axes);
    reactions("root", request_.root_axes);
    for (std::size_t i = 0; i < scene_.applied_wrenches.size(); ++i) applied(i);
    add("Operations of a sample: " + std::to_string(code_.multiplications) + " multiplications, " +
        std::to_string(code_.additions) + " additions (" + std::to_string(code_.fused) +
        " pairs of them fused), " +
        (loops_ ? std::to_string(code_.divisions_and_roots) + " divisions and roots, " : "") +
        std::to_string(code_.sines_and_cosines) + " sines and cosines.");
    return std::move(lines_);
  }

 private:
  void add(const std::string& line) { lines_.push_back(line); }

  void ofLoops(const LoopModel& loops) {
    add("The motion gives all joints, also those that loops move. How far it leaves loops open is "
        "not");
    add("judged, but where conditions are redundant the status is 2 from about 1e-10 on.");
    add("Where the status is 0 or 1, efforts and reactions are those of "
        "ClosedLoopDynamics::compute(),");
    add("to the last bit but the sign of zeros where products are fused; without fused products "
        "they");
    add("agree within rounding times the condition, as sums are in another order.");
    add("Status 0: the position is regular. 1: it is close to a singular one (condition above " +
        numberText(kCloseToSingular) + "),");
    add("so that small errors of positions change forces much. 2: it is singular, or so close to "
        "it that");
    add("the rank is in doubt (condition above " +
        numberText(MultifrontalQr::sureCondition(loops.loops.rank_tolerance)) +
        "), efforts are not determined, a spring has no");
    add("direction, or numbers are not finite: all results are zero.");
    for (const std::string& name : loops.undetermined()) {
      add("Not determined by mechanics, but chosen of least norm: " + name + ".");
    }
    for (const std::string& name : loops.dynamics.oneSided()) {
      add("Whether the force can act so is not judged: " + name + ".");
    }
  }

  void gravity() {
    std::string text = "Gravity:";
    for (int i = 0; i < 3; ++i) text += " " + numberText(scene_.gravity[i]);
    add(text + (scene_.root_moves ? " m/s^2 in inertial axes; the root link moves as `root` says."
                                  : " m/s^2 in axes of the root link, which rests."));
  }

  void reactions(const std::string& axes, const Names& names) {
    if (names.empty()) return;
    add("Reactions in axes of the " + axes + " link" + (axes == "child" ? "s" : "") +
        ": what the parent link exerts on the child link,");
    add("moments about the origin of the child link" +
        std::string(scene_.moments_about.empty() ? "" : ", or where the scene says otherwise") +
        "." + (scene_.include_active ? "" : " The active components are zero."));
  }

  void applied(std::size_t i) {
    const AppliedWrench& wrench = scene_.applied_wrenches[i];
    add("Applied wrench " + std::to_string(i) + (wrench.name.empty() ? "" : ", " + wrench.name) +
        ": on link " + wrench.link + ", in axes of " +
        (wrench.axes == Axes::kLink ? "that link." : "the root link."));
  }

  const Mechanism& mechanism_;
  const Scene& scene_;
  const Request& request_;
  const GeneratedCode& code_;
  const LoopModel* loops_;  // null in open chains
  Names lines_;
};

std::string commentOf(const Names& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += (text.empty() ? "/* " : "   ") + inComment(line) + "\n";
  }
  return text.insert(text.size() - 1, " */");
}

// Constants for the places of names in an array, and the names.
std::string placesOf(const std::string& prefix, const std::string& array, const Names& names) {
  if (names.empty()) return "";
  const Names constants = constantNames(prefix, names);
  std::string text = "enum {\n", list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool last = i + 1 == names.size();
    text += "  " + constants[i] + " = " + std::to_string(i) + (last ? "" : ",") + " /* " +
            inComment(names[i]) + " */\n";
    list += "  " + cString(names[i]) + (last ? "" : ", \\\n");
  }
  return "\n" + text + "};\n#define " + array + " { \\\n" + list + " }\n";
}

std::string appliedOf(const std::string& capitals, const Plan<double>& plan, std::size_t count) {
  if (count == 0) return "";
  std::string values;
  for (std::size_t i = 0; i < count; ++i) {
    const PlainWrench<double>& given = plan.applied[i].given;
    for (const Vec3<double>* part : {&given.force, &given.torque}) {
      for (const double number : {part->x, part->y, part->z}) {
        values += (values.empty() ? "" : ", ") + cNumber(number);
      }
    }
  }
  return "\n/* The scene's own values of `applied`. */\n#define " + capitals +
         "_APPLIED_OF_SCENE { " + values + " }\n";
}

std::string headerOf(const std::string& comment, const std::string& name,
                     const Mechanism& mechanism, const Request& request, const Plan<double>& plan,
                     const Names& efforts, std::size_t applied, const RecordedPlan& recording) {
  const std::string capitals = inCapitals(name);
  const auto number = [&](const std::string& what, std::size_t value) {
    return "#define " + capitals + "_" + what + " " + std::to_string(value) + "\n";
  };
  const bool both = !request.child_axes.empty() && !request.root_axes.empty();
  std::string text =
      comment + "#ifndef " + capitals + "_H\n#define " + capitals + "_H\n#include <stddef.h>\n\n";
  text += number("COORDINATES", mechanism.coordinates().size());
  text += number(
      both ? "CHILD_REACTIONS" : "REACTIONS",
      both ? request.child_axes.size() : request.child_axes.size() + request.root_axes.size());
  if (both) text += number("ROOT_REACTIONS", request.root_axes.size());
  text += number("APPLIED", applied);
  text += placesOf(capitals + "_Q", capitals + "_COORDINATE_NAMES", mechanism.coordinateNames());
  text += placesOf(capitals + (both ? "_CHILD" : "_R"),
                   capitals + (both ? "_CHILD" : "") + "_REACTION_NAMES", request.child_axes);
  text += placesOf(capitals + (both ? "_ROOT" : "_R"),
                   capitals + (both ? "_ROOT" : "") + "_REACTION_NAMES", request.root_axes);
  if (recording.judged) {
    text += placesOf(capitals + "_EFFORT", capitals + "_EFFORT_NAMES", efforts);
  }
  text += appliedOf(capitals, plan, applied);
  return text + "\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n" + cDeclarations(name, recording) +
         "\n#ifdef __cplusplus\n}\n#endif\n#endif\n";
}

Plan<double> planOf(const Mechanism& mechanism, const Scene& scene, const Request& request) {
  return roundPlan<double>(compilePlan(LoadedMechanism(mechanism, scene).get(), scene, request));
}

}  // namespace

GeneratedCode generateCode(const Mechanism& mechanism, const Scene& scene, const Request& request,
                           const GeneratedCodeOptions& options) {
  requireIdentifier(options.name);
  if (options.operations_of_function == 0) {
    throw Error("no code can be generated in functions of 0 operations");
  }
  if (mechanism.coordinates().empty()) {
    throw SceneError("no code can be generated, as no joint moves");
  }
  std::unique_ptr<const LoopModel> loops;
  if (needsClosedLoops(scene)) loops = std::make_unique<LoopModel>(mechanism, scene, request);
  const Plan<double> plan = loops ? loops->tree : planOf(mechanism, scene, request);
  const RecordedPlan recording = loops ? recordLoops(*loops) : record(plan);
  if (recording.outputs.size() == (loops ? 1 : 0)) {
    throw SceneError("no code can be generated, as neither efforts nor reactions are asked for");
  }
  const Program program = programOf(recording.graph, options.operations_of_function);
  GeneratedCode code;
  count(recording, program, code);
  Names lines = {"Inverse dynamics of the robot " + inQuotes(mechanism.name()) + " in one scene."};
  lines.insert(lines.end(), options.origin.begin(), options.origin.end());
  const Names rest = Comment(mechanism, scene, request, code, loops.get()).lines();
  lines.insert(lines.end(), rest.begin(), rest.end());
  const std::string comment = commentOf(lines);
  code.header =
      headerOf(comment, options.name, mechanism, request, plan,
               loops ? loops->effortNames() : Names(), scene.applied_wrenches.size(), recording);
  code.source = cSource({options.name, comment, recording, program});
  return code;
}

}  // namespace virtual_work_dynamics
