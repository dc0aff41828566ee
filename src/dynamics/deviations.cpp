#include "virtual_work_dynamics/deviations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "dynamics/compiled_dynamics.h"
#include "dynamics/covariance_sizes.h"
#include "dynamics/description_shares.h"
#include "dynamics/pressing_teeth.h"
#include "dynamics/scene_doubts.h"
#include "dynamics/shift_sizes.h"
#include "dynamics/shifted_samples.h"
#include "scene/input_checks.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/free_turn.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

Request withoutPoses(Request request) {
  request.poses = request.twists = request.can_hold = request.intervals = request.residuals = false;
  request.determinacy = true;
  return request;
}

// The root's covariance, and the part of it that an effort is doubtful by: turn, angular velocity,
// angular acceleration and acceleration.
constexpr Eigen::Index kRootParts = 4;

}  // namespace

struct Deviations::Impl {
  Impl(const Mechanism& of, const Scene& scene, const Request& request)
      : mechanism(of),
        dynamics(mechanism, scene, withoutPoses(request)),
        shift_plan(mechanism, scene),
        shift_sizes{!teethPress(scene)},
        has_tolerances(scene.tolerances.any()),
        wrenches(wrenchCovariances(scene)),
        independent(independentCoordinates(mechanism, dynamics.impl_->loops,
                                           dynamics.impl_->have_positions)),
        description(mechanism, scene, dynamics.request()) {
    requireSoundDoubts(scene);
  }

  std::unique_ptr<ShiftedSamples> makeSamples() const {
    const Dynamics::Impl& plan = *dynamics.impl_;
    if (plan.chain) {
      return std::make_unique<ShiftedChain>(mechanism, *plan.chain, shift_plan, plan.own_load);
    }
    return std::make_unique<ShiftedLoops>(mechanism, *plan.loops, shift_plan, plan.own_load,
                                          independent);
  }

  Mechanism mechanism;
  Dynamics dynamics;
  ShiftPlan shift_plan;
  ShiftSizes shift_sizes;
  bool has_tolerances;
  std::vector<WrenchCovariance> wrenches;  // as the scene says
  IndependentCoordinates independent;
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
        factors(compiled.dynamics.coordinates(),
                static_cast<Eigen::Index>(compiled.shift_plan.levels)),
        changes(factors),
        correlations(factors.rows(), 3),
        folded(compiled.dynamics.coordinates(), compiled.mechanism.orientations()) {
    shifts.coordinates = factors;
    shifts.wrenches.resize(6 * static_cast<Eigen::Index>(compiled.shift_plan.wrenches.size()));
    motion.effort.setZero(static_cast<Eigen::Index>(numbers.efforts));
    motion.child_axes.resize(numbers.child_axes);
    motion.root_axes.resize(numbers.root_axes);
    description = motion;
    parts.setZero(motion.effort.size(),
                  kMotionLevels * factors.rows() + (compiled.shift_plan.root > 0 ? kRootParts : 0) +
                      static_cast<Eigen::Index>(compiled.shift_plan.wrenches.size()));
  }

  const Motion& sampleOf(const Motion& at, const MotionCovariance& covariance);
  void setShifts(const Motion& at, const MotionCovariance& covariance);
  void setWrenchShifts(const MotionCovariance& covariance);
  void setTurnShifts(const Motion& at, const MotionCovariance& covariance);
  void addMotion(const MotionCovariance& covariance);
  double addCoordinates(std::size_t number);
  double addTurns(std::size_t number, const MotionCovariance& covariance);
  double addRoot(std::size_t number, const MotionCovariance& covariance);
  double addWrenches(std::size_t number, const MotionCovariance& covariance);
  void setPart(std::size_t number, Eigen::Index part, double value) {
    if (number < numbers.efforts) parts(static_cast<Eigen::Index>(number), part) = value;
  }
  void take(const std::vector<bool>& which, StandardDeviations& to) const;

  const Deviations::Impl* plan;
  std::unique_ptr<ShiftedSamples> samples;
  std::vector<Dynamics::Workspace> workspaces;  // of the description's plans
  ResultNumbers numbers;
  std::vector<double> variances;  // by number
  std::vector<bool> known;        // of the description's share, by number
  SampleShifts shifts;
  // Coordinates x levels: deviations over shifts, changes of a result by the deviations.
  Eigen::MatrixXd factors, changes;
  Eigen::MatrixXd correlations;  // of q and qd, q and qdd, qd and qdd; by coordinate
  Motion folded;                 // with angles of zero
  StandardDeviations motion, description;
  Eigen::MatrixXd parts;
};

// The sample with angles of zero where covariances are those of free turns.
const Motion& Deviations::Workspace::Impl::sampleOf(const Motion& at,
                                                    const MotionCovariance& covariance) {
  if (covariance.turns.empty()) return at;
  folded = at;
  if (folded.orientations.empty())
    folded.orientations.resize(plan->mechanism.orientations(), Eigen::Quaterniond::Identity());
  foldFreeTurns(plan->mechanism, folded);
  return folded;
}

void Deviations::Workspace::Impl::setShifts(const Motion& at, const MotionCovariance& covariance) {
  const Eigen::VectorXd* const values[] = {&at.q, &at.qd, &at.qdd};
  for (Eigen::Index i = 0; i < factors.rows(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    const Eigen::Matrix3d& C = covariance.coordinates[place];
    const Eigen::Vector3d deviations = C.diagonal().cwiseSqrt();
    for (Eigen::Index level = 0; level < factors.cols(); ++level) {
      const double deviation = deviations[level];
      const double shift =
          plan->shift_sizes.of(static_cast<MotionLevel>(level), (*values[level])[i], deviation);
      shifts.coordinates(i, level) = shift;
      factors(i, level) = std::isfinite(deviation) ? deviation / shift : kNothing;
      if (!plan->independent.of(static_cast<std::size_t>(level))[place]) factors(i, level) = 0;
    }
    const auto correlation = [&](int one, int other) {
      const double scale = deviations[one] * deviations[other];
      return scale > 0 ? std::clamp(C(one, other) / scale, -1.0, 1.0) : 0.0;
    };
    correlations.row(i) << correlation(0, 1), correlation(0, 2), correlation(1, 2);
  }
  shifts.root_link = covariance.root_link;
  shifts.turns = !covariance.turns.empty();
  if (shifts.turns) setTurnShifts(at, covariance);
  setWrenchShifts(covariance);
  const RootMotion& root = at.root;
  const Eigen::Vector3d* const vectors[] = {&root.angular_velocity, &root.angular_acceleration,
                                            &root.acceleration};
  for (Eigen::Index i = 0; i < shifts.root.size(); ++i) {
    const MotionLevel level = i < 3   ? MotionLevel::kPosition
                              : i < 6 ? MotionLevel::kVelocity
                                      : MotionLevel::kAcceleration;
    const double value = i < 3 ? 0 : (*vectors[i / 3 - 1])[i % 3];
    shifts.root[i] = plan->shift_sizes.of(level, value, std::sqrt(covariance.root(i, i)));
  }
}

void Deviations::Workspace::Impl::setWrenchShifts(const MotionCovariance& covariance) {
  const auto& given = covariance.wrenches.empty() ? plan->wrenches : covariance.wrenches;
  for (Eigen::Index i = 0; i < shifts.wrenches.size(); ++i) {
    const std::size_t wrench = plan->shift_plan.wrenches[static_cast<std::size_t>(i / 6)];
    shifts.wrenches[i] = plan->shift_sizes.ofWrench(std::sqrt(given[wrench](i % 6, i % 6)));
  }
}

// Of joints that turn freely, the numbers of their turns shift; addTurns() weighs them.
void Deviations::Workspace::Impl::setTurnShifts(const Motion& at,
                                                const MotionCovariance& covariance) {
  for (std::size_t turn = 0; turn < covariance.turns.size(); ++turn) {
    const FreeTurn own = freeTurnOf(plan->mechanism, turn, at);
    const Eigen::Index first = plan->mechanism.anglesOf(turn);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (Eigen::Index level = 0; level < factors.cols(); ++level) {
        const double value = level == 1   ? own.angular_velocity[axis]
                             : level == 2 ? own.angular_acceleration[axis]
                                          : 0;
        const Eigen::Index number = 3 * level + axis;
        shifts.coordinates(first + axis, level) =
            plan->shift_sizes.of(static_cast<MotionLevel>(level), value,
                                 std::sqrt(covariance.turns[turn](number, number)));
        factors(first + axis, level) = 0;
      }
    }
  }
}

// Adds J C J^T of every number.
void Deviations::Workspace::Impl::addMotion(const MotionCovariance& covariance) {
  for (std::size_t number = 0; number < numbers.all(); ++number) {
    double variance = addCoordinates(number);
    if (shifts.turns) variance += addTurns(number, covariance);
    if (plan->shift_plan.root > 0) variance += addRoot(number, covariance);
    variances[number] = variance + addWrenches(number, covariance);
  }
}

double Deviations::Workspace::Impl::addCoordinates(std::size_t number) {
  using Columns = Eigen::Map<const Eigen::MatrixXd>;
  const double* const values = samples->values(number);
  const Columns shifted(values + 1, changes.rows(), changes.cols());
  changes = (shifted.array() - values[0]) * factors.array();
  double variance = changes.squaredNorm();
  if (changes.cols() == kMotionLevels) {
    const auto q = changes.col(0).array(), qd = changes.col(1).array(),
               qdd = changes.col(2).array();
    const auto r = correlations.array();
    variance += 2 * (r.col(0) * q * qd + (r.col(1) * q + r.col(2) * qd) * qdd).sum();
  }
  for (Eigen::Index i = 0; i < changes.rows(); ++i) {
    for (Eigen::Index level = 0; level < changes.cols(); ++level)
      setPart(number, kMotionLevels * i + level, changes(i, level) * changes(i, level));
  }
  return variance;
}

double Deviations::Workspace::Impl::addTurns(std::size_t number,
                                             const MotionCovariance& covariance) {
  const double* const values = samples->values(number);
  double variance = 0;
  for (std::size_t turn = 0; turn < covariance.turns.size(); ++turn) {
    const TurnCovariance& C = covariance.turns[turn];
    const Eigen::Index first = plan->mechanism.anglesOf(turn);
    Eigen::Matrix<double, 9, 1> slope = Eigen::Matrix<double, 9, 1>::Zero();
    for (Eigen::Index i = 0; i < 3 * factors.cols(); ++i) {
      const Eigen::Index coordinate = first + i % 3, level = i / 3;
      const auto place = static_cast<std::size_t>(coordinate);
      const auto of = static_cast<std::size_t>(level);
      if (!plan->independent.of(of)[place]) continue;
      const std::size_t column = plan->shift_plan.columnOf(of, place);
      slope[i] = (values[column] - values[0]) / shifts.coordinates(coordinate, level);
      setPart(number, kMotionLevels * coordinate + level, slope[i] * slope[i] * C(i, i));
    }
    variance += slope.dot(C * slope);
  }
  return variance;
}

double Deviations::Workspace::Impl::addRoot(std::size_t number,
                                            const MotionCovariance& covariance) {
  const double* const values = samples->values(number);
  const Eigen::Map<const Eigen::Matrix<double, 12, 1>> shifted(values +
                                                               plan->shift_plan.firstOfRoot());
  const Eigen::Matrix<double, 12, 1> slope = (shifted.array() - values[0]) / shifts.root.array();
  for (Eigen::Index part = 0; part < kRootParts; ++part) {
    const auto own = slope.segment<3>(3 * part);
    setPart(number, kMotionLevels * factors.rows() + part,
            own.dot(covariance.root.block<3, 3>(3 * part, 3 * part) * own));
  }
  return slope.dot(covariance.root * slope);
}

double Deviations::Workspace::Impl::addWrenches(std::size_t number,
                                                const MotionCovariance& covariance) {
  const ShiftPlan& columns = plan->shift_plan;
  const auto& given = covariance.wrenches.empty() ? plan->wrenches : covariance.wrenches;
  const double* const values = samples->values(number);
  const auto first = parts.cols() - static_cast<Eigen::Index>(columns.wrenches.size());
  double variance = 0;
  for (std::size_t i = 0; i < columns.wrenches.size(); ++i) {
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> shifted(values + columns.firstOfWrench(i));
    const Eigen::Matrix<double, 6, 1> slope =
        (shifted.array() - values[0]) /
        shifts.wrenches.segment<6>(6 * static_cast<Eigen::Index>(i)).array();
    const double own = slope.dot(given[columns.wrenches[i]] * slope);
    setPart(number, first + static_cast<Eigen::Index>(i), own);
    variance += own;
  }
  return variance;
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
  return impl_->independent.positions;
}

Deviations::Workspace Deviations::makeWorkspace() const {
  return Workspace(*impl_);
}

void Deviations::computeMotion(const Motion& motion, const MotionCovariance& covariance,
                               Workspace& workspace) const {
  const Load& own = impl_->dynamics.impl_->own_load;
  computeMotion(
      motion, covariance, [&own](const Motion&, Load& load) { load = own; }, workspace);
}

void Deviations::computeMotion(const Motion& motion, const MotionCovariance& covariance,
                               const LoadLaw& law, Workspace& workspace) const {
  Workspace::Impl& memory = *workspace.impl_;
  if (memory.plan != impl_.get()) {
    throw MotionError("the workspace belongs to another Deviations");
  }
  requireLengths(motion, coordinates());
  requireSizes(impl_->mechanism, impl_->wrenches.size(), covariance);
  const Motion& sample = memory.sampleOf(motion, covariance);
  memory.setShifts(sample, covariance);
  memory.samples->compute(sample, memory.shifts, law);
  memory.addMotion(covariance);
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
