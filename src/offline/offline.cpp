#include "offline/offline.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "offline/certified_rows.h"
#include "offline/check_report.h"
#include "offline/output_file.h"
#include "offline/progress.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/number_text.h"
#include "virtual_work_dynamics/sample_block.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Times may be known this coarsely, in parts of their mean spacing, before estimates suffer.
constexpr double kFineTimes = 1e-6;
// Rows of a thread between two hand-overs.
constexpr std::size_t kRowsAtOnce = 512;

struct MotionFile {
  MotionTable table;
  std::vector<std::size_t> lines;  // of the rows
};

Scene loadScene(const Arguments& arguments) {
  Scene scene = arguments.scene.empty() ? Scene() : readSceneFile(arguments.scene);
  if (arguments.gravity) scene.gravity = *arguments.gravity;
  if (arguments.reactions) {
    scene.reactions = *arguments.reactions;
    scene.reaction_names = arguments.reaction_names;
  }
  return scene;
}

// What is written.
Request requestOf(const Mechanism& mechanism, const Scene& scene, const Arguments& arguments) {
  Request request;
  request.efforts = !arguments.no_efforts;
  (arguments.child_axes ? request.child_axes : request.root_axes) =
      requestedReactions(mechanism, scene);
  return request;
}

// What is computed for it: certificates take results of their own, behind the others.
Request computedFor(const Request& written, const Arguments& arguments) {
  return arguments.certificates ? Certifier::extended(written) : written;
}

void refuseToOverwriteInput(const Arguments& arguments) {
  if (arguments.output.empty()) return;
  for (const std::string& input : {arguments.urdf, arguments.motion, arguments.scene}) {
    if (input.empty()) continue;
    std::error_code missing;  // a file that is not there is no input
    if (std::filesystem::equivalent(input, arguments.output, missing) ||
        std::filesystem::equivalent(input, partPath(arguments.output), missing)) {
      throw UsageError("--output: '" + arguments.output + "' would overwrite the input '" + input +
                       "'");
    }
  }
}

// "position.j", "velocity.j", "position.k" -> "j, k"
std::string jointsOfColumns(const std::vector<std::string>& columns) {
  std::vector<std::string> joints;
  std::string text;
  for (const std::string& column : columns) {
    const std::string joint = column.substr(column.find('.') + 1);
    if (std::find(joints.begin(), joints.end(), joint) != joints.end()) continue;
    text += (joints.empty() ? "" : ", ") + joint;
    joints.push_back(joint);
  }
  return text;
}

MotionFile readMotion(const std::string& path, const Mechanism& mechanism) {
  MotionFile motion;
  std::vector<std::string> unused;
  motion.table = readMotionCsv(path, mechanism.coordinateNames(), &unused, &motion.lines);
  if (mechanism.coordinates().empty()) {
    // No names ask the reader for every joint, but a robot that cannot move wants none.
    for (const std::string& joint : motion.table.joints) unused.push_back("position." + joint);
    motion.table.joints.clear();
    motion.table.positions.resize(motion.table.positions.rows(), 0);
    motion.table.velocities.resize(0, 0);
    motion.table.accelerations.resize(0, 0);
  }
  if (!unused.empty()) {
    std::cerr << "note: " << path
              << ": ignored, no coordinates of the robot: " << jointsOfColumns(unused) << "\n";
  }
  return motion;
}

void checkTimes(const std::string& path, const MotionFile& motion) {
  const std::vector<double>& times = motion.table.times;
  const std::size_t row = firstTimeThatDoesNotIncrease(times);
  if (row < times.size()) {
    throw FileError(path + ": line " + std::to_string(motion.lines[row]) + ": time " +
                    numberText(times[row]) + " is not later than " + numberText(times[row - 1]) +
                    " in the row before, and derivatives have to be estimated");
  }
  const double latest = std::max(std::abs(times.front()), std::abs(times.back()));
  const double spacing = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  const double resolution = latest * std::numeric_limits<double>::epsilon();
  if (times.size() > 1 && resolution > kFineTimes * spacing) {
    std::ostringstream text;
    text << "warning: " << path << ": times near " << latest << " s are known to " << resolution
         << " s only, which spoils estimated derivatives; let them start near zero\n";
    std::cerr << text.str();
  }
}

// Gives the motion every derivative that the plan takes.
void complete(const std::string& path, const Mechanism& mechanism, const Scene& scene,
              MotionFile& motion) {
  MotionTable& table = motion.table;
  if (scene.static_motion) {
    table.velocities = Eigen::MatrixXd::Zero(table.positions.rows(), table.positions.cols());
    table.accelerations = table.velocities;
  }
  std::string missing;
  if (!table.hasVelocities()) missing = "velocities";
  if (!table.hasAccelerations()) missing += missing.empty() ? "accelerations" : ", accelerations";
  if (missing.empty() || table.joints.empty()) return;
  checkTimes(path, motion);
  try {
    table = completeMotion(mechanism, std::move(table));
  } catch (const MotionError& error) {
    throw FileError(path + ": " + error.what());
  }
  std::cerr << "note: " << path << ": estimated from the rows around each row: " << missing << "\n";
}

// Writes rows in their order, and tells of those that overflowed.
class Rows {
 public:
  // `certified` is null when no certificates are asked for.
  Rows(const MotionFile& file, const Arguments& arguments, const Request& written,
       CertifiedRows* certified, ResultWriter& writer)
      : file_(file),
        arguments_(arguments),
        certified_(certified),
        writer_(writer),
        motion_(file.table.positions.cols()),
        effort_(written.efforts ? motion_.q.size() : 0),
        reactions_((arguments.child_axes ? written.child_axes : written.root_axes).size()) {}

  std::size_t count() const { return file_.table.times.size(); }

  const Motion& motion(std::size_t row) {
    if (motion_.q.size() > 0) {
      const auto index = static_cast<Eigen::Index>(row);
      motion_.q = file_.table.positions.row(index);
      motion_.qd = file_.table.velocities.row(index);
      motion_.qdd = file_.table.accelerations.row(index);
    }
    return motion_;
  }

  // Of a Workspace, or of LagrangeDynamics.
  template <typename Results>
  void write(std::size_t row, const Results& results) {
    take(results.effort(), arguments_.child_axes ? results.childAxes() : results.rootAxes());
    if (!finite() && ++overflowed_ == 1) first_line_ = file_.lines[row];
    Certificates certificates;
    if (certified_) certificates = certified_->check(motion(row), results, file_.lines[row]);
    writer_.writeRow(file_.table.times[row], effort_, reactions_,
                     certified_ ? &certificates : nullptr);
    progress_.update(row + 1, count());
  }

  std::string warning() const {
    if (overflowed_ == 0) return "";
    return "warning: " + arguments_.motion + ": results of " + std::to_string(overflowed_) +
           " row" + (overflowed_ == 1 ? "" : "s") + " overflow, first of line " +
           std::to_string(first_line_) + "; their cells are empty\n";
  }

 private:
  // Those that are written; certificates' own come behind them.
  void take(const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions) {
    effort_ = effort.head(effort_.size());
    std::copy_n(reactions.begin(), reactions_.size(), reactions_.begin());
  }

  bool finite() const {
    return effort_.allFinite() &&
           std::all_of(reactions_.begin(), reactions_.end(), [](const Wrench& wrench) {
             return wrench.force.allFinite() && wrench.torque.allFinite();
           });
  }

  const MotionFile& file_;
  const Arguments& arguments_;
  CertifiedRows* certified_;
  ResultWriter& writer_;
  Motion motion_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> reactions_;
  Progress progress_{std::cerr, isatty(STDERR_FILENO) == 1};
  std::size_t overflowed_ = 0;
  std::size_t first_line_ = 0;
};

void compute(const InverseDynamics& dynamics, const MotionFile& file, int threads, Rows& rows) {
  SampleBlock block(dynamics, kRowsAtOnce * static_cast<std::size_t>(threads), threads);
  Workspace results = dynamics.makeWorkspace();
  for (std::size_t first = 0; first < rows.count(); first += block.capacity()) {
    const std::size_t count = std::min(block.capacity(), rows.count() - first);
    block.compute(file.table, first, count);
    for (std::size_t i = 0; i < count; ++i) {
      block.read(i, results);
      rows.write(first + i, results);
    }
  }
}

void compute(LagrangeDynamics<long double>& dynamics, Rows& rows) {
  for (std::size_t i = 0; i < rows.count(); ++i) {
    dynamics.compute(rows.motion(i));
    rows.write(i, dynamics);
  }
}

void printReactions(const Request& request) {
  const bool child = !request.child_axes.empty();
  const auto& names = child ? request.child_axes : request.root_axes;
  printNames(std::cout, "reactions", names);
  if (names.empty()) return;
  printNames(std::cout, "axes", {child ? "of the child link" : "of the root link"});
}

void check(const Arguments& arguments, const Mechanism& mechanism) {
  printMechanism(std::cout, mechanism);
  printDoubts(std::cout, mechanism);
  std::cout << std::flush;  // before what is wrong ends up on the other stream
  const Scene scene = loadScene(arguments);
  const InverseDynamics dynamics(mechanism, scene, requestOf(mechanism, scene, arguments));
  printReactions(dynamics.request());
  std::cout << std::flush;
  if (!arguments.motion.empty()) {
    MotionFile motion = readMotion(arguments.motion, mechanism);
    complete(arguments.motion, mechanism, scene, motion);
    const std::vector<double>& times = motion.table.times;
    const auto extremes = std::minmax_element(times.begin(), times.end());
    const char* rows = times.size() == 1 ? " row from " : " rows from ";
    printNames(std::cout, "motion",
               {std::to_string(times.size()) + rows + numberText(*extremes.first) + " s to " +
                numberText(*extremes.second) + " s"});
  }
  std::cout << "The robot can run.\n" << std::flush;
}

void explain(const Arguments& arguments, const Mechanism& mechanism) {
  const Scene scene = loadScene(arguments);
  const Request written = requestOf(mechanism, scene, arguments);
  const InverseDynamics dynamics(mechanism, scene, computedFor(written, arguments));
  for (const std::string& line : dynamics.summary().lines()) std::cout << line << "\n";
  std::cout << std::flush;
}

}  // namespace

void runOffline(const Arguments& arguments) {
  refuseToOverwriteInput(arguments);
  const Mechanism mechanism = readUrdfFile(arguments.urdf);
  if (arguments.check) check(arguments, mechanism);
  if (arguments.explain) explain(arguments, mechanism);
  if (arguments.check || arguments.explain) return;
  printDoubts(std::cerr, mechanism);
  const Scene scene = loadScene(arguments);
  const Request written = requestOf(mechanism, scene, arguments);
  const Request request = computedFor(written, arguments);
  std::optional<CertifiedRows> certified;
  if (arguments.certificates) certified.emplace(mechanism, scene, request);
  std::optional<InverseDynamics> virtual_work;
  std::optional<LagrangeDynamics<long double>> lagrange;
  if (arguments.method == Method::kLagrange) {
    lagrange.emplace(mechanism, scene, request);
  } else {
    virtual_work.emplace(mechanism, scene, request);
  }
  const std::vector<std::string> no_names;
  const std::string header = resultHeader(
      written.efforts ? mechanism.coordinateNames() : no_names,
      arguments.child_axes ? written.child_axes : written.root_axes, arguments.certificates);
  MotionFile motion = readMotion(arguments.motion, mechanism);
  complete(arguments.motion, mechanism, scene, motion);
  OutputFile file(arguments.output);
  ResultWriter writer(file, header);
  std::string warning;
  {
    Rows rows(motion, arguments, written, certified ? &*certified : nullptr,
              writer);  // wipes its progress out at its end
    if (lagrange) {
      compute(*lagrange, rows);
    } else {
      compute(*virtual_work, motion, arguments.threads, rows);
    }
    warning = rows.warning();
  }
  std::cerr << warning;
  if (certified) {
    std::cerr << "note: " << arguments.motion << ": " << certified->summary() << "\n";
  }
  writer.finish();
}

}  // namespace virtual_work_dynamics
