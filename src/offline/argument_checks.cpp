#include "offline/argument_checks.h"

#include <string>
#include <utility>

namespace virtual_work_dynamics {
namespace {

// What a bag cannot have, or always has.
void checkForBag(const Arguments& arguments) {
  const bool lagrange = arguments.method == Method::kLagrange;
  const std::pair<bool, const char*> kRefused[] = {
      {!arguments.report.empty(), "--report: it is made of results as .npz or CSV, not of a bag"},
      {arguments.child_axes || arguments.inertial_axes, "--axes: a bag has reactions in both axes"},
      {arguments.no_efforts, "--no-efforts: a bag has the topics of the node"},
      {lagrange, "--method lagrange: its results are written as CSV only"},
      {arguments.certificates, "--certificates: they are written as CSV only"},
      {!arguments.measured.empty(),
       "--measured: measured efforts of a bag are those of its joint states"},
      {!arguments.measured.topic.empty(),
       "--measured-topic: measured efforts of a bag are those of its joint states"},
      {arguments.effort_limits, "--effort-limits: they are listed of rows of CSV only"},
      {arguments.positions, "--positions: the topic motion of a bag has them"},
      {arguments.threads != 1, "--threads: a bag is computed as the node does it, in one thread"}};
  for (const auto& [given, text] : kRefused) {
    if (given) throw UsageError(text);
  }
}

// What only a bag that is written needs.
void checkWithoutBag(const Arguments& arguments) {
  const std::pair<bool, const char*> kRefused[] = {
      {arguments.copy_input, "--copy-input"},
      {!arguments.root_source.empty(), "--root-source"},
      {!arguments.remap.empty(), "--remap"}};
  for (const auto& [given, option] : kRefused) {
    if (given) throw UsageError(std::string(option) + " is of use with --output BAG only");
  }
}

// What has no place beside a folder that is written instead of a result.
void checkForRegressor(const Arguments& arguments) {
  const std::pair<bool, const char*> kRefused[] = {
      {!arguments.report.empty(), "--report"},  // which says --output, --axes and --positions, too
      {!arguments.output.empty(), "--output"},
      {arguments.check, "--check"},
      {arguments.explain, "--explain"},
      {arguments.child_axes || arguments.inertial_axes, "--axes"},
      {arguments.residuals, "--residuals"},  // which --measured and --observer-gain say, too
      {arguments.effort_limits, "--effort-limits"},
      {arguments.reactions.has_value(), "--reactions"},
      {arguments.no_efforts, "--no-efforts"},
      {arguments.method == Method::kLagrange, "--method lagrange"},
      {arguments.certificates, "--certificates"},
      {arguments.deviations, "--deviations"},
      {arguments.positions, "--positions"}};
  for (const auto& [given, option] : kRefused) {
    if (given) throw UsageError(std::string(option) + " is of no use with --regressor");
  }
}

}  // namespace

void requireAgreement(const Arguments& arguments) {
  if (arguments.urdf.empty() && arguments.rosparam.empty() && arguments.motion.empty()) {
    throw UsageError("--urdf FILE is missing");
  }
  if (arguments.motion.empty() && !arguments.check && !arguments.explain &&
      arguments.generate.empty()) {
    throw UsageError("--motion FILE is missing (only --check, --explain and --generate need none)");
  }
  if (!arguments.motion.topic.empty() && arguments.motion.empty()) {
    throw UsageError("--topic is of use with --motion BAG only");
  }
  if (!arguments.regressor.empty()) {
    checkForRegressor(arguments);
  } else if (!arguments.parameters.empty()) {
    throw UsageError("--parameters is of use with --regressor only");
  }
  if (arguments.toBag()) {
    checkForBag(arguments);
  } else {
    checkWithoutBag(arguments);
  }
  if (arguments.residuals && arguments.no_efforts) {
    throw UsageError("--residuals: need the efforts that --no-efforts leaves out");
  }
  if (!arguments.report.empty() && (arguments.check || arguments.explain)) {
    throw UsageError("--report cannot be used with --check or --explain");
  }
  if (arguments.effort_limits && arguments.no_efforts) {
    throw UsageError("--effort-limits: need the efforts that --no-efforts leaves out");
  }
  if (arguments.deviation_warn && !arguments.deviations) {
    throw UsageError("--deviation-warn is of use with --deviations only");
  }
  if (arguments.inertial_axes && arguments.deviations) {
    throw UsageError("--axes inertial: --deviations are of root or child axes");
  }
  if (arguments.method == Method::kLagrange) {
    if (arguments.threads != 1) {
      throw UsageError("--threads: --method lagrange runs in one thread, not in " +
                       std::to_string(arguments.threads));
    }
    if (arguments.explain) throw UsageError("--explain cannot be used with --method lagrange");
  }
}

}  // namespace virtual_work_dynamics
