#include "offline/offline.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>

#include "base/number_text.h"
#include "offline/certified_rows.h"
#include "offline/check_report.h"
#include "offline/loop_computation.h"
#include "offline/loop_lagrange.h"
#include "offline/loop_motion.h"
#include "offline/loop_report.h"
#include "offline/loop_rows.h"
#include "offline/motion_file.h"
#include "offline/output_file.h"
#include "offline/result_writer.h"
#include "offline/rows.h"
#include "tree/sample_block.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

// Rows of a thread between two hand-overs.
constexpr std::size_t kRowsAtOnce = 512;

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

void addCertificates(const Arguments& arguments, Columns& columns) {
  if (!arguments.certificates) return;
  columns.more.insert(columns.more.end(), std::begin(kCertificateColumns),
                      std::end(kCertificateColumns));
}

// `with_efforts`: names of what has an effort.
Columns columnsOf(const Names& with_efforts, const Request& written, const Arguments& arguments) {
  Columns columns;
  if (written.efforts) columns.efforts = with_efforts;
  columns.reactions = arguments.child_axes ? written.child_axes : written.root_axes;
  return columns;
}

// What the command line asks for and open chains do not have.
void refuseByLoops(const Arguments& arguments, bool loops) {
  if (arguments.loop_tolerance && !loops) {
    throw UsageError("--loop-tolerance: the scene has no closures");
  }
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

// `lagrange`: null for virtual work.
void compute(LoopComputation& computation, LoopLagrange* lagrange, Rows& rows) {
  computation.run([&](std::size_t row, const LoopSample& sample) {
    if (lagrange) {
      lagrange->compute(sample);
      rows.write(row, sample, *lagrange);
    } else {
      rows.write(row, sample, sample);
    }
  });
}

void printReactions(const Request& request) {
  const bool child = !request.child_axes.empty();
  const auto& names = child ? request.child_axes : request.root_axes;
  printNames(std::cout, "reactions", names);
  if (names.empty()) return;
  printNames(std::cout, "axes", {child ? "of the child link" : "of the root link"});
  std::cout << std::flush;  // before what is wrong ends up on the other stream
}

void printMotion(const MotionFile& motion) {
  const std::vector<double>& times = motion.table.times;
  const auto extremes = std::minmax_element(times.begin(), times.end());
  const char* rows = times.size() == 1 ? " row from " : " rows from ";
  printNames(std::cout, "motion",
             {std::to_string(times.size()) + rows + numberText(*extremes.first) + " s to " +
              numberText(*extremes.second) + " s"});
}

void checkTree(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene) {
  const InverseDynamics dynamics(mechanism, scene, requestOf(mechanism, scene, arguments));
  printReactions(dynamics.request());
  if (arguments.motion.empty()) return;
  MotionFile motion = readMotion(arguments.motion, mechanism);
  completeDerivatives(mechanism, scene, motion);
  printMotion(motion);
}

void checkLoops(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene) {
  ClosedLoopDynamics dynamics(mechanism, scene, requestOf(mechanism, scene, arguments));
  printLoops(std::cout, mechanism, scene, dynamics);
  printReactions(dynamics.request());
  if (arguments.motion.empty()) return;
  LoopMotion motion(arguments.motion, mechanism, scene, dynamics,
                    arguments.loop_tolerance.value_or(kLoopTolerance));
  Conditions conditions;
  LoopComputation(mechanism, scene, dynamics, motion, arguments.threads)
      .run([&](std::size_t row, const LoopSample& sample) { conditions.note(row, sample); });
  printMotion(motion.file());
  printNames(std::cout, "closed loops", {conditions.worst(motion.file())});
}

void check(const Arguments& arguments, const Mechanism& mechanism) {
  printMechanism(std::cout, mechanism);
  printDoubts(std::cout, mechanism);
  std::cout << std::flush;
  const Scene scene = loadScene(arguments);
  refuseByLoops(arguments, needsClosedLoops(scene));
  (needsClosedLoops(scene) ? checkLoops : checkTree)(arguments, mechanism, scene);
  std::cout << "The robot can run.\n" << std::flush;
}

void explain(const Arguments& arguments, const Mechanism& mechanism) {
  const Scene scene = loadScene(arguments);
  refuseByLoops(arguments, needsClosedLoops(scene));
  const Request written = requestOf(mechanism, scene, arguments);
  if (needsClosedLoops(scene)) {
    explainLoops(std::cout, mechanism, scene,
                 ClosedLoopDynamics(mechanism, scene, computedFor(written, arguments)));
  } else {
    const InverseDynamics dynamics(mechanism, scene, computedFor(written, arguments));
    for (const std::string& line : dynamics.summary().lines()) std::cout << line << "\n";
  }
  std::cout << std::flush;
}

// Writes the rows that `compute` puts into them.
template <typename Compute>
void writeResult(const Arguments& arguments, const MotionFile& motion, const Columns& columns,
                 CertifiedRows* certified, Compute compute) {
  const std::string header = resultHeader(columns);
  OutputFile file(arguments.output);
  ResultWriter writer(file, header);
  std::string warning;
  {
    Rows rows(motion, columns, arguments.child_axes, certified, writer);
    compute(rows);
    warning = rows.warning();
  }
  std::cerr << warning;
  if (certified) {
    std::cerr << "note: " << arguments.motion << ": " << certified->summary() << "\n";
  }
  writer.finish();
}

void computeTree(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene) {
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
  Columns columns = columnsOf(mechanism.coordinateNames(), written, arguments);
  addCertificates(arguments, columns);
  MotionFile motion = readMotion(arguments.motion, mechanism);
  completeDerivatives(mechanism, scene, motion);
  writeResult(arguments, motion, columns, certified ? &*certified : nullptr, [&](Rows& rows) {
    if (lagrange) {
      compute(*lagrange, rows);
    } else {
      compute(*virtual_work, motion, arguments.threads, rows);
    }
  });
}

void computeLoops(const Arguments& arguments, const Mechanism& mechanism, const Scene& scene) {
  const Request written = requestOf(mechanism, scene, arguments);
  const Request request = computedFor(written, arguments);
  ClosedLoopDynamics dynamics(mechanism, scene, request);
  std::optional<CertifiedRows> certified;
  if (arguments.certificates) certified.emplace(mechanism, dynamics.tree(), request);
  std::optional<LoopLagrange> lagrange;
  if (arguments.method == Method::kLagrange) lagrange.emplace(mechanism, dynamics);
  Columns columns = columnsOf(namesOfEfforts(mechanism, dynamics), written, arguments);
  columns.more = loopColumns(columns, scene.closures);
  addCertificates(arguments, columns);
  LoopMotion motion(arguments.motion, mechanism, scene, dynamics,
                    arguments.loop_tolerance.value_or(kLoopTolerance));
  LoopComputation computation(mechanism, scene, dynamics, motion, arguments.threads);
  writeResult(arguments, motion.file(), columns, certified ? &*certified : nullptr,
              [&](Rows& rows) { compute(computation, lagrange ? &*lagrange : nullptr, rows); });
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
  refuseByLoops(arguments, needsClosedLoops(scene));
  (needsClosedLoops(scene) ? computeLoops : computeTree)(arguments, mechanism, scene);
}

}  // namespace virtual_work_dynamics
