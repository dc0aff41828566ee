#include "virtual_work_dynamics/deviations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "dynamics/compiled_dynamics.h"
#include "dynamics/description_shares.h"
#include "dynamics/shifted_samples.h"
#include "scene/input_checks.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
// Least shift of positions, rad or m, and of velocities, relative to what they are or to 1: half of
// a double's digits are left for the difference. Largest shift of positions, rad or m.
constexpr double kLeastShift = 1e-6;
constexpr double kLargestShift = 1e-3;

Request withoutPoses(Request request) {
  request.poses = request.twists = false;
  request.determinacy = true;
  return request;
}

double shiftOf(MotionLevel level, double value, double deviation) {
  const double size = std::max(1.0, std::abs(value));
  if (level == MotionLevel::kAcceleration) return size;  // results are linear in accelerations
  if (!std::isfinite(deviation)) return kLeastShift;
  if (level == MotionLevel::kPosition) return std::clamp(deviation, kLeastShift, kLargestShift);
  return std::copysign(std::max(deviation, kLeastShift * size), -value);
}

void requireSound(const Tolerances& tolerances) {
  const auto require = [](const char* name, double value) {
    if (value >= 0 && value < 1) return;
    throw SceneError(std::string("tolerances.") + name + ": " + numberText(value) +
                     " is not from 0 to below 1");
  };
  require("mass", tolerances.mass);
  require("inertia", tolerances.inertia);
}

}  // namespace

struct Deviations::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& request)
      : dynamics(mechanism, scene, withoutPoses(request)),
        levels(scene.static_motion ? 1 : kMotionLevels),
        has_tolerances(scene.tolerances.any()),
        independent(static_cast<std::size_t>(dynamics.coordinates()), true),
        description(mechanism, scene, dynamics.request()) {
    requireSound(scene.tolerances);
    if (dynamics.closed()) independent = independentCoordinates(*dynamics.impl_->loops);
  }

  std::unique_ptr<ShiftedSamples> makeSamples() const {
    const Dynamics::Impl& plan = *dynamics.impl_;
    if (plan.chain) return std::make_unique<ShiftedChain>(*plan.chain, plan.own_load, levels);
    return std::make_unique<ShiftedLoops>(*plan.loops, plan.own_load, independent, levels);
  }

  Dynamics dynamics;
  int levels;  // that results depend on
  bool has_tolerances;
  std::vector<bool> independent;
  DescriptionShares description;
};

struct Deviations::Workspace::Impl {
  explicit Impl(const Deviations::Impl& compiled)
      : plan(&compiled),
        samples(compiled.makeSamples()),
        workspaces(compiled.description.makeWorkspaces()),
        numbers(compiled.dynamics.makeWorkspace().results()),
        variances(numbers.all()),
        known(numbers.all(), true),
        shifts(compiled.dynamics.coordinates(), compiled.levels),
        factors(shifts),
        changes(shifts),
        correlations(shifts.rows(), 3) {
    motion.effort.setZero(static_cast<Eigen::Index>(numbers.efforts));
    motion.child_axes.resize(numbers.child_axes);
    motion.root_axes.resize(numbers.root_axes);
    description = motion;
    parts.setZero(motion.effort.size(), kMotionLevels * shifts.rows());
  }

  void setShifts(const Motion& at, const MotionCovariance& covariance);
  void addMotion();
  void take(const std::vector<bool>& which, StandardDeviations& to) const;

  const Deviations::Impl* plan;
  std::unique_ptr<ShiftedSamples> samples;
  std::vector<Dynamics::Workspace> workspaces;  // of the description's plans
  ResultNumbers numbers;
  std::vector<double> variances;  // by number
  std::vector<bool> known;        // of the description's share, by number
  // Coordinates x levels: shifts, deviations over shifts, changes of a result by the deviations.
  Eigen::MatrixXd shifts, factors, changes;
  Eigen::MatrixXd correlations;  // of q and qd, q and qdd, qd and qdd; by coordinate
  StandardDeviations motion, description;
  Eigen::MatrixXd parts;
};

void Deviations::Workspace::Impl::setShifts(const Motion& at, const MotionCovariance& covariance) {
  const Eigen::VectorXd* const values[] = {&at.q, &at.qd, &at.qdd};
  for (Eigen::Index i = 0; i < shifts.rows(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    const Eigen::Matrix3d& C = covariance.coordinates[place];
    const Eigen::Vector3d deviations = C.diagonal().cwiseSqrt();
    for (Eigen::Index level = 0; level < shifts.cols(); ++level) {
      const double deviation = deviations[level];
      shifts(i, level) = shiftOf(static_cast<MotionLevel>(level), (*values[level])[i], deviation);
      factors(i, level) = std::isfinite(deviation) ? deviation / shifts(i, level) : kNothing;
      if (!plan->independent[place]) factors(i, level) = 0;
    }
    const auto correlation = [&](int one, int other) {
      const double scale = deviations[one] * deviations[other];
      return scale > 0 ? std::clamp(C(one, other) / scale, -1.0, 1.0) : 0.0;
    };
    correlations.row(i) << correlation(0, 1), correlation(0, 2), correlation(1, 2);
  }
}

// Adds J C J^T of every number.
void Deviations::Workspace::Impl::addMotion() {
  using Columns = Eigen::Map<const Eigen::MatrixXd>;
  const bool all_levels = changes.cols() == kMotionLevels;
  for (std::size_t number = 0; number < numbers.all(); ++number) {
    const double* const values = samples->values(number);
    const Columns shifted(values + 1, changes.rows(), changes.cols());
    changes = (shifted.array() - values[0]) * factors.array();
    double variance = changes.squaredNorm();
    if (all_levels) {
      const auto q = changes.col(0).array(), qd = changes.col(1).array(),
                 qdd = changes.col(2).array();
      const auto r = correlations.array();
      variance += 2 * (r.col(0) * q * qd + (r.col(1) * q + r.col(2) * qd) * qdd).sum();
    }
    variances[number] = variance;
    if (number >= numbers.efforts) continue;
    for (Eigen::Index i = 0; i < changes.rows(); ++i) {
      for (Eigen::Index level = 0; level < changes.cols(); ++level) {
        parts(static_cast<Eigen::Index>(number), kMotionLevels * i + level) =
            changes(i, level) * changes(i, level);
      }
    }
  }
}

// Writes the roots of the variances; rounding may have made a variance negative.
void Deviations::Workspace::Impl::take(const std::vector<bool>& which,
                                       StandardDeviations& to) const {
  std::size_t number = 0;
  const auto next = [&] {
    const bool exists = which.empty() || which[number];
    const double variance = variances[number++];
    if (!exists || !std::isfinite(variance)) return kNothing;
    return variance > 0 ? std::sqrt(variance) : 0;
  };
  for (Eigen::Index i = 0; i < to.effort.size(); ++i) to.effort[i] = next();
  for (auto* wrenches : {&to.child_axes, &to.root_axes}) {
    for (Wrench& wrench : *wrenches) {
      for (int i = 0; i < 3; ++i) wrench.force[i] = next();
      for (int i = 0; i < 3; ++i) wrench.torque[i] = next();
    }
  }
}

Deviations::Deviations(const Mechanism& mechanism, const Scene& scene, const Request& request)
    : impl_(new Impl(mechanism, scene, request)) {}

Deviations::~Deviations() = default;
Deviations::Deviations(Deviations&&) noexcept = default;
Deviations& Deviations::operator=(Deviations&&) noexcept = default;

Eigen::Index Deviations::coordinates() const {
  return impl_->dynamics.coordinates();
}

const std::vector<std::string>& Deviations::effortNames() const {
  return impl_->dynamics.effortNames();
}

const std::vector<bool>& Deviations::residuals() const {
  return impl_->dynamics.residuals();
}

bool Deviations::hasTolerances() const {
  return impl_->has_tolerances;
}

const std::vector<bool>& Deviations::independent() const {
  return impl_->independent;
}

Deviations::Workspace Deviations::makeWorkspace() const {
  return Workspace(*impl_);
}

void Deviations::computeMotion(const Motion& motion, const MotionCovariance& covariance,
                               Workspace& workspace) const {
  const Load& own = impl_->dynamics.impl_->own_load;
  computeMotion(
      motion, covariance, [&own](const Eigen::VectorXd&, Load& load) { load = own; }, workspace);
}

void Deviations::computeMotion(const Motion& motion, const MotionCovariance& covariance,
                               const LoadLaw& law, Workspace& workspace) const {
  Workspace::Impl& memory = *workspace.impl_;
  if (memory.plan != impl_.get()) {
    throw MotionError("the workspace belongs to another Deviations");
  }
  requireLengths(motion, coordinates());
  if (covariance.coordinates.size() != impl_->independent.size()) {
    throw MotionError("covariance: " + std::to_string(covariance.coordinates.size()) +
                      " matrices are given, the mechanism has " + std::to_string(coordinates()) +
                      " coordinates");
  }
  memory.setShifts(motion, covariance);
  memory.samples->compute(motion, memory.shifts, law);
  memory.addMotion();
  memory.take(memory.samples->known(), memory.motion);
}

void Deviations::computeDescription(const Motion& motion, Workspace& workspace) const {
  Workspace::Impl& memory = *workspace.impl_;
  if (memory.plan != impl_.get()) {
    throw MotionError("the workspace belongs to another Deviations");
  }
  requireLengths(motion, coordinates());
  std::fill(memory.variances.begin(), memory.variances.end(), 0);
  impl_->description.addVariances(motion, memory.workspaces, memory.variances, memory.known);
  memory.take(memory.known, memory.description);
}

Deviations::Workspace::Workspace(const Deviations::Impl& plan) : impl_(new Impl(plan)) {}

Deviations::Workspace::~Workspace() = default;
Deviations::Workspace::Workspace(Workspace&&) noexcept = default;
Deviations::Workspace& Deviations::Workspace::operator=(Workspace&&) noexcept = default;

const StandardDeviations& Deviations::Workspace::motion() const {
  return impl_->motion;
}

const StandardDeviations& Deviations::Workspace::description() const {
  return impl_->description;
}

const Eigen::MatrixXd& Deviations::Workspace::effortParts() const {
  return impl_->parts;
}

}  // namespace virtual_work_dynamics
