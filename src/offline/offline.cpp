#include "offline/offline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "dynamics/given_joints.h"
#include "dynamics/motion_start.h"
#include "offline/check_report.h"
#include "offline/completed_motion.h"
#include "offline/computation.h"
#include "offline/extra_columns.h"
#include "offline/generated_files.h"
#include "offline/inputs.h"
#include "offline/interval_columns.h"
#include "offline/lagrange_rows.h"
#include "offline/load_report.h"
#include "offline/loop_report.h"
#include "offline/measured_file.h"
#include "offline/mechanism_json.h"
#include "offline/npz_result_writer.h"
#include "offline/recorded_motion.h"
#include "offline/regressor_files.h"
#include "offline/result_writer.h"
#include "offline/root_rows.h"
#include "offline/row_loads.h"
#include "offline/rows.h"
#include "offline/task_inputs.h"
#include "virtual_work_dynamics/closure_axes.h"
#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

// Puts before what is wrong with a scene where that stands.
template <typename Make>
auto naming(const std::string& where, Make make) {
  try {
    return make();
  } catch (const SceneError& error) {
    throw SceneError(where + error.what());
  }
}

ReactionAxes axesOf(const Arguments& arguments) {
  if (arguments.inertial_axes) return ReactionAxes::kInertial;
  return arguments.child_axes ? ReactionAxes::kChild : ReactionAxes::kRoot;
}

// The request of what is written.
Request requestOf(const Mechanism& mechanism, const Scene& scene, const Arguments& arguments) {
  Request request;
  request.efforts = !arguments.no_efforts;
  (arguments.child_axes ? request.child_axes : request.root_axes) =
      naming(arguments.reactions ? "--" : scenePrefix(arguments),
             [&] { return requestedReactions(mechanism, scene); });
  request.can_hold = request.intervals = scene.contact_intervals;
  return request;
}

Dynamics dynamicsOf(const Mechanism& mechanism, const Scene& scene, const Request& request,
                    const Arguments& arguments) {
  return naming(scenePrefix(arguments), [&] { return Dynamics(mechanism, scene, request); });
}

// The request of what is computed: certificates need results of their own, after the others.
Request computedFor(const Request& written, const Arguments& arguments) {
  return arguments.certificates ? Certifier::extended(written) : written;
}

// The columns of the table that is written.
Columns columnsOf(const Dynamics& dynamics, const Request& written, const Arguments& arguments) {
  Columns columns;
  if (written.efforts) {
    columns.efforts = dynamics.effortNames();
    columns.residuals = dynamics.residuals();
  }
  columns.reactions = arguments.child_axes ? written.child_axes : written.root_axes;
  if (dynamics.closed()) columns.more = loopColumns(columns, dynamics.closureNames());
  if (written.intervals) columns.bounds = intervalColumns(columns);
  return columns;
}

// Refuses options that open chains do not have.
void refuseByLoops(const Arguments& arguments, bool loops) {
  if (arguments.loop_tolerance && !loops) {
    throw UsageError("--loop-tolerance: the scene has no closures");
  }
}

void printReactions(const Request& request) {
  const bool child = !request.child_axes.empty();
  const auto& names = child ? request.child_axes : request.root_axes;
  printNames(std::cout, "reactions", names);
  if (names.empty()) return;
  printNames(std::cout, "axes", {child ? "of the child link" : "of the root link"});
  std::cout << std::flush;  // before an error goes to the other stream
}

std::string placeOf(const MomentPoint& point) {
  const std::string frame =
      point.link ? "link " + printable(*point.link)
                 : std::string(point.frame == JointFrame::kParent ? "parent" : "child") + " frame";
  return printable(point.name) + ": " + frame + " at " + numberText(point.at.x()) + " " +
         numberText(point.at.y()) + " " + numberText(point.at.z());
}

// Of reactions that are asked for.
void printMomentPoints(const Scene& scene, const Request& request) {
  const Names& asked = request.child_axes.empty() ? request.root_axes : request.child_axes;
  Names places;
  for (const MomentPoint& point : scene.moments_about) {
    if (std::count(asked.begin(), asked.end(), point.name) > 0) places.push_back(placeOf(point));
  }
  if (!places.empty()) printNames(std::cout, "moments at", places);
}

void printMotion(const MotionFile& motion) {
  const std::vector<double>& times = motion.table.times;
  const auto extremes = std::minmax_element(times.begin(), times.end());
  const char* rows = times.size() == 1 ? " row from " : " rows from ";
  printNames(std::cout, "motion",
             {std::to_string(times.size()) + rows + numberText(*extremes.first) + " s to " +
              numberText(*extremes.second) + " s"});
}

// Starts the loops. Of a motion that gives too much or too little without them, the actuators of
// transmissions follow from the joints where it gives all of these.
Scene startedByRecord(const Mechanism& mechanism, const Scene& scene, RecordedMotion& recorded) {
  try {
    return startedBy(mechanism, scene, recorded.start(mechanism));
  } catch (const GivenError&) {
    if (!recorded.letMotorsFollow(mechanism, scene)) throw;
  }
  return startedBy(mechanism, scene, recorded.start(mechanism));
}

// The node's parameter ~drive_start, where a dump has it.
std::int64_t driveStartNs(const Arguments& arguments, const Scene& scene) {
  constexpr double kLatest = 9e9;  // s, whose nanoseconds are a stamp
  const YAML::Node& parameters = arguments.inputs->parameters;
  if (scene.drives.empty() || !parameters.IsMap()) return 0;
  const YAML::Node start = parameters["drive_start"];
  const double stamp = start ? start.as<double>(-1) : 0;
  if (stamp >= 0 && stamp <= kLatest) return std::llround(stamp * 1e9);
  throw UsageError(arguments.rosparam + ": drive_start: is not a stamp in s");
}

// Reads the motion and starts the scene's loops by it.
RecordedMotion readStart(const Arguments& arguments, const Mechanism& mechanism, Scene& scene) {
  MotionSource source = arguments.motion;
  source.efforts = arguments.residuals;
  RecordingOptions options = arguments.recording;
  options.drive_start_ns = driveStartNs(arguments, scene);
  RecordedMotion recorded = naming(scenePrefix(arguments), [&] {
    return readRecordedMotion(source, mechanism, scene, options);
  });
  checkRoots(scene, recorded.file);
  if (!needsClosedLoops(scene)) return recorded;
  try {
    scene = startedByRecord(mechanism, scene, recorded);
  } catch (const GivenError& error) {
    throw FileError(arguments.motion.name() + ": " + error.problem());
  } catch (const AssemblyError& error) {
    if (!GivenJoints::givesAll(recorded.given)) {
      throw AssemblyError(scenePrefix(arguments) + error.what());
    }
    throw FileError(recorded.file.at(0) + ": " + error.what());
  } catch (const SceneError& error) {
    throw SceneError(scenePrefix(arguments) + error.what());
  }
  return recorded;
}

// The efforts that were measured, if they are asked for.
MeasuredEfforts readMeasured(const Arguments& arguments) {
  if (!arguments.residuals) return {};
  const MotionSource source = arguments.measuredSource();
  const bool of_motion = arguments.measured.empty();
  if (of_motion && !std::filesystem::is_regular_file(source.files.front())) {
    throw FileError(source.name() +
                    ": can be read only once, for the motion: --measured FILE says where the "
                    "measured efforts are");
  }
  return readMeasuredEfforts(source, !of_motion);
}

double toleranceOf(const Arguments& arguments) {
  return arguments.loop_tolerance.value_or(kLoopTolerance);
}

void printAssemblyDoubts(std::ostream& out, const Dynamics& dynamics) {
  for (const std::string& doubt : dynamics.assemblyDoubts()) out << "warning: " << doubt << "\n";
}

void checkMotion(const Arguments& arguments, RecordedMotion recorded, const Mechanism& mechanism,
                 const Scene& scene, const Dynamics& dynamics) {
  CompletedMotion motion(std::move(recorded), mechanism, scene, dynamics, toleranceOf(arguments),
                         arguments.recording);
  const RowLoads loads(scene, motion.file());
  Conditions conditions;
  if (dynamics.closed()) {
    Computation(dynamics, motion, loads, arguments.threads)
        .run([&](std::size_t row, const Motion&, const Load&, const Results& results) {
          conditions.note(row, results);
        });
  }
  std::cerr << motion.fitNote(mechanism);
  printMotion(motion.file());
  if (dynamics.closed()) printNames(std::cout, "closed loops", {conditions.worst(motion.file())});
}

// The robot with the joint types, transmissions and axes of closures that the scene asks for.
SceneOfMechanism robotOf(const Mechanism& described, const Scene& scene,
                         const Arguments& arguments) {
  return naming(scenePrefix(arguments), [&] { return mechanismFor(described, scene); });
}

void check(const Arguments& arguments, const Mechanism& mechanism, Scene scene) {
  printMechanism(std::cout, mechanism);
  printDoubts(std::cout, mechanism);
  printSceneDoubts(std::cout, scenePrefix(arguments), mechanism, scene);
  std::cout << std::flush;
  refuseByLoops(arguments, needsClosedLoops(scene));
  std::optional<RecordedMotion> recorded;
  if (!arguments.motion.empty()) recorded = readStart(arguments, mechanism, scene);
  const Dynamics dynamics =
      dynamicsOf(mechanism, scene, requestOf(mechanism, scene, arguments), arguments);
  printGravity(std::cout, scene);
  if (scene.root_moves) printNames(std::cout, "root", {"moves as columns root.… say"});
  if (!scene.drives.empty()) {
    printNames(std::cout, "driven", Drives(mechanism, scene).names());
  }
  if (dynamics.closed()) printLoops(std::cout, mechanism, scene, dynamics);
  printAssemblyDoubts(std::cout, dynamics);
  printReactions(dynamics.request());
  printMomentPoints(scene, dynamics.request());
  if (recorded) checkMotion(arguments, std::move(*recorded), mechanism, scene, dynamics);
  std::cout << "The robot can run.\n" << std::flush;
}

void explain(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene) {
  refuseByLoops(arguments, needsClosedLoops(scene));
  const Request written = requestOf(mechanism, scene, arguments);
  printCost(std::cout, scene,
            dynamicsOf(mechanism, scene, computedFor(written, arguments), arguments));
  std::cout << std::flush;
}

// Identification needs the regressor in place of results.
void writeRegressor(const Arguments& arguments, const Mechanism& mechanism, Scene scene) {
  Names asked = arguments.parameters;
  if (asked.empty()) asked = {"joints", "links"};
  const std::vector<Parameter> parameters =
      naming("--", [&] { return askedParameters(mechanism, scene, asked); });
  const RegressorFiles files(arguments.regressor, mechanism, scene, arguments.threads);
  RecordedMotion recorded = readStart(arguments, mechanism, scene);
  Request request;
  request.determinacy = false;
  const Dynamics dynamics = dynamicsOf(mechanism, scene, request, arguments);
  printAssemblyDoubts(std::cerr, dynamics);
  CompletedMotion motion(std::move(recorded), mechanism, scene, dynamics, toleranceOf(arguments),
                         arguments.recording);
  files.write(dynamics, motion, RowLoads(scene, motion.file()), parameters);
  std::cerr << motion.fitNote(mechanism);
}

std::unique_ptr<ResultTable> tableOf(const Arguments& arguments, OutputFile& file,
                                     const std::string& header, const Columns& columns,
                                     std::size_t rows, const std::string& described) {
  if (!arguments.toNpz()) return std::make_unique<ResultWriter>(file, header);
  try {
    return std::make_unique<NpzResultWriter>(file, columns, rows, described);
  } catch (const FileError& error) {
    throw FileError(arguments.output + ": " + error.what());
  }
}

// Refuses what tables of results cannot have.
void refuseForTables(const Arguments& arguments, const Scene& scene) {
  if (arguments.inertial_axes && !scene.root_moves) {
    throw UsageError(
        "--axes inertial: the scene does not say 'root: moving', and root axes are "
        "inertial axes");
  }
  if (arguments.inertial_axes && scene.contact_intervals) {
    throw UsageError("--axes inertial: contact_intervals are found in root axes and child axes");
  }
  for (const Closure& closure : scene.closures) {
    if (!closure.touch.gap) continue;
    throw SceneError(scenePrefix(arguments) + "contacts: " + inQuotes(closure.name) +
                     ": by its gap the node and bags of results (--output BAG) close it; a table "
                     "has one plan for all rows");
  }
}

void compute(const Arguments& arguments, const Mechanism& mechanism, Scene scene) {
  refuseForTables(arguments, scene);
  const Request written = requestOf(mechanism, scene, arguments);
  RecordedMotion recorded = readStart(arguments, mechanism, scene);
  if (arguments.deviations && recorded.given.drivenNumbers() > recorded.drivenColumns()) {
    throw UsageError(
        "--deviations: an axis of a closure has a drive, and they are those of joints");
  }
  if (arguments.deviations && recorded.drivenColumns() > 0) {
    throw UsageError("--deviations: the motion gives more than joints, whose errors are not known");
  }
  const Dynamics dynamics =
      dynamicsOf(mechanism, scene, computedFor(written, arguments), arguments);
  printAssemblyDoubts(std::cerr, dynamics);
  std::optional<LagrangeRows> lagrange;
  if (arguments.method == Method::kLagrange) lagrange.emplace(mechanism, dynamics);
  Columns columns = columnsOf(dynamics, written, arguments);
  columns.stamps = !recorded.file.stamps_ns.empty();
  MeasuredEfforts measured = readMeasured(arguments);
  RecordingOptions recording = arguments.recording;
  recording.completion.covariances = arguments.deviations;
  CompletedMotion motion(std::move(recorded), mechanism, scene, dynamics, toleranceOf(arguments),
                         recording);
  const RowLoads loads(scene, motion.file());
  ExtraColumns extra = naming(scenePrefix(arguments), [&] {
    return ExtraColumns(arguments, mechanism, scene, dynamics, written, motion.file(),
                        std::move(measured), columns);
  });
  const bool reports = !arguments.report.empty();
  if (reports && columns.efforts.empty() && columns.reactions.empty()) {
    throw UsageError("--report: neither efforts nor reactions are asked for");
  }
  const std::string described = reports || arguments.toNpz()
                                    ? mechanismJson(arguments, mechanism, scene, dynamics, columns)
                                    : "";
  if (reports) makeReportFolder(arguments);
  const std::string header = arguments.toNpz() ? "" : resultHeader(columns);
  OutputFile file(arguments.output);
  const std::unique_ptr<ResultTable> table =
      tableOf(arguments, file, header, columns, motion.file().lines.size(), described);
  std::string warning;
  {
    Rows rows(motion.file(), columns, axesOf(arguments), dynamics.closed(), extra, *table);
    Computation(dynamics, motion, loads, arguments.threads)
        .run([&](std::size_t row, const Motion& at, const Load& load, const Results& results) {
          rows.write(row, at, load, lagrange ? lagrange->compute(at, load, results) : results);
        });
    warning = rows.warning();
  }
  std::cerr << warning << motion.fitNote(mechanism) << extra.notes();
  table->finish();
  if (reports) makeLoadReport(arguments, described);
}

}  // namespace

void runOffline(Arguments arguments) {
  if (arguments.toBag()) {
    throw UsageError(
        "--output: bags are written by a build with ROS only, and this is one without");
  }
  refuseToOverwriteInput(arguments);
  if (!arguments.generate.empty()) requireSourceName(arguments);
  arguments.inputs = std::make_shared<const TaskInputs>(readTaskInputs(arguments));
  const Mechanism described = askedRobot(arguments);
  const SceneOfMechanism robot = robotOf(described, askedScene(arguments), arguments);
  const Mechanism& mechanism = robot.mechanism;
  const Scene& scene = robot.scene;
  if (arguments.check) check(arguments, mechanism, scene);
  if (arguments.explain) explain(arguments, mechanism, scene);
  if (arguments.check || arguments.explain) return;
  printDoubts(std::cerr, mechanism);
  printSceneDoubts(std::cerr, scenePrefix(arguments), mechanism, scene);
  if (!arguments.generate.empty()) {
    if (!scene.drives.empty()) {
      std::cerr << "note: --generate: the code takes the motion of all joints, driven ones, too\n";
    }
    const Request request = requestOf(mechanism, scene, arguments);
    return naming(scenePrefix(arguments),
                  [&] { writeGeneratedFiles(arguments, mechanism, scene, request); });
  }
  refuseByLoops(arguments, needsClosedLoops(scene));
  if (!arguments.regressor.empty()) return writeRegressor(arguments, mechanism, scene);
  compute(arguments, mechanism, scene);
}

}  // namespace virtual_work_dynamics
