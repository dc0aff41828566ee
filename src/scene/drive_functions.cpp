#include "scene/drive_functions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "motion/end_slopes.h"
#include "scene/drive_jumps.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/motion_law.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace {

using Numbers = std::vector<double>;

constexpr double kTwoPi = 6.283185307179586476925286766559;
// Parts of the largest velocity and acceleration of a table below which it rests: a spline finds
// accelerations at the ends of a motion from rest to rest to such a part.
constexpr double kStill = 1e-6;
constexpr double kUnforced = 1e-2;
constexpr double kForever = std::numeric_limits<double>::max();

void set(double q, double qd, double qdd, Motion& motion) {
  motion.q[0] = q;
  motion.qd[0] = qd;
  motion.qdd[0] = qdd;
}

// In pieces from their starts on; the first one also before.
class Polynomial : public TimeFunction {
 public:
  explicit Polynomial(const DriveLaw& law)
      : starts_(law.times.empty() ? Numbers{0} : law.times), coefficients_(law.coefficients) {}

  void evaluate(double t, Motion& motion) const override {
    const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), t);
    const auto piece = static_cast<std::size_t>(after - starts_.begin()) - 1;
    const PolynomialInstant at = polynomialAt(coefficients_[piece], t - starts_[piece]);
    set(at.values[0], at.values[1], at.values[2], motion);
  }

 private:
  const Numbers starts_;
  const std::vector<Numbers> coefficients_;
};

class Sine : public TimeFunction {
 public:
  explicit Sine(const DriveLaw& law)
      : amplitude_(law.amplitude), rate_(kTwoPi / law.period), phase_(law.phase) {}

  void evaluate(double t, Motion& motion) const override {
    const double angle = rate_ * t + phase_;
    set(amplitude_ * std::sin(angle), amplitude_ * rate_ * std::cos(angle),
        -amplitude_ * rate_ * rate_ * std::sin(angle), motion);
  }

 private:
  const double amplitude_, rate_, phase_;
};

// A law whose zero of time is at `start`.
class OfLaw : public TimeFunction {
 public:
  explicit OfLaw(std::unique_ptr<const MotionLaw> law, double start = 0)
      : law_(std::move(law)), start_(start) {}
  void evaluate(double t, Motion& motion) const override { law_->evaluate(t - start_, motion); }

 protected:
  const std::unique_ptr<const MotionLaw> law_;

 private:
  const double start_;
};

class Sweep : public OfLaw {
 public:
  using OfLaw::OfLaw;
  double begin() const override { return 0; }
  double end() const override { return law_->duration(); }
};

// It goes on beyond an end only where it rests there.
class Table : public TimeFunction {
 public:
  explicit Table(Spline spline) : spline_(std::move(spline)) {}
  void evaluate(double t, Motion& motion) const override { spline_.evaluate(t, motion); }
  double begin() const override { return restsAt(0) ? TimeFunction::begin() : spline_.startTime(); }
  double end() const override {
    return restsAt(spline_.knots().positions.rows() - 1) ? TimeFunction::end() : spline_.endTime();
  }

 private:
  bool restsAt(Eigen::Index row) const {
    const auto isSmall = [&](const Eigen::MatrixXd& rates, double part) {
      return std::abs(rates(row, 0)) <= part * rates.cwiseAbs().maxCoeff();
    };
    return isSmall(spline_.knots().velocities, kStill) &&
           isSmall(spline_.knots().accelerations, kUnforced);
  }

  const Spline spline_;
};

void requireFinite(const Numbers& numbers, const char* key, const std::string& place) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isfinite(numbers[i])) continue;
    throw SceneError(place + ": " + key + "[" + std::to_string(i) + "] is not finite");
  }
}

void requireTimes(const Numbers& times, const std::string& place) {
  requireFinite(times, "times", place);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    const std::string where = place + ": times[" + std::to_string(i) + "]: ";
    if (times[i] == times[i - 1]) {
      throw SceneError(where + numberText(times[i]) +
                       " s stands there twice, as where a function jumps");
    }
    throw SceneError(where + numberText(times[i]) + " s is not later than " +
                     numberText(times[i - 1]) + " s before it");
  }
}

void requireRows(const DriveLaw& law, const Numbers& numbers, const char* key,
                 const std::string& place) {
  if (numbers.size() != law.times.size()) {
    throw SceneError(place + ": " + std::to_string(law.times.size()) + " times but " +
                     std::to_string(numbers.size()) + " " + key);
  }
  requireFinite(numbers, key, place);
}

MotionTable tableOf(const DriveLaw& law) {
  MotionTable table;
  table.joints = {law.name};
  table.times = law.times;
  const auto column = [](const Numbers& numbers) {
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                             static_cast<Eigen::Index>(numbers.size()));
  };
  table.positions = column(law.positions);
  if (!law.velocities.empty()) table.velocities = column(law.velocities);
  if (!law.accelerations.empty()) table.accelerations = column(law.accelerations);
  return table;
}

std::unique_ptr<const TimeFunction> polynomial(const DriveLaw& law, const std::string& place) {
  const std::size_t pieces = law.times.empty() ? 1 : law.times.size();
  if (law.coefficients.size() != pieces) {
    throw SceneError(place + ": " + std::to_string(law.times.size()) +
                     " times where pieces start, but coefficients of " +
                     std::to_string(law.coefficients.size()) + " pieces");
  }
  requireTimes(law.times, place);
  for (const Numbers& coefficients : law.coefficients) {
    if (coefficients.empty()) throw SceneError(place + ": coefficients of a piece are missing");
    requireFinite(coefficients, "coefficients", place);
  }
  requireFittingPieces(law, place);
  return std::make_unique<Polynomial>(law);
}

std::unique_ptr<const TimeFunction> table(const DriveLaw& law, const std::string& place) {
  if (law.times.empty()) throw SceneError(place + ": the table has no rows");
  requireTimes(law.times, place);
  requireRows(law, law.positions, "positions", place);
  if (!law.velocities.empty()) requireRows(law, law.velocities, "velocities", place);
  if (!law.accelerations.empty()) requireRows(law, law.accelerations, "accelerations", place);
  if (law.velocities.empty() && !law.accelerations.empty()) {
    throw SceneError(place + ": a table with accelerations needs velocities, too");
  }
  requireSteadyRows(law, place);
  const MotionTable rows = tableOf(law);
  if (rows.hasVelocities()) return std::make_unique<Table>(Spline(rows));
  const EndSlopes slopes = endSlopes(rows);
  return std::make_unique<Table>(Spline(rows, slopes.start, slopes.end));
}

std::unique_ptr<const TimeFunction> minimumJerk(const DriveLaw& law, const std::string& place) {
  requireTimes(law.times, place);
  requireRows(law, law.positions, "positions", place);
  auto points = minimumJerkLaw(tableOf(law));
  return std::make_unique<OfLaw>(std::move(points), law.times.front());
}

void requirePeriod(const DriveLaw& law, const std::string& place) {
  if (!(law.period > 0 && std::isfinite(law.period))) {
    throw SceneError(place + ": period = " + numberText(law.period) + " is not positive");
  }
  const double rate = kTwoPi / law.period;
  if (std::isfinite(rate * rate * law.amplitude) && std::isfinite(rate * rate)) return;
  throw SceneError(place + ": period = " + numberText(law.period) +
                   " s is too short: accelerations are not finite");
}

std::unique_ptr<const TimeFunction> functionOf(const DriveLaw& law, const std::string& place) {
  const Eigen::VectorXd amplitude = Eigen::VectorXd::Constant(1, law.amplitude);
  switch (law.function) {
    case DriveFunction::kCosine:
      requirePeriod(law, place);
      return std::make_unique<OfLaw>(cosineLaw(amplitude, law.period, kForever));
    case DriveFunction::kSine:
      requirePeriod(law, place);
      requireFinite({law.phase}, "phase", place);
      return std::make_unique<Sine>(law);
    case DriveFunction::kSineSweep:
      return std::make_unique<Sweep>(
          sineSweepLaw(amplitude, law.start_frequency, law.end_frequency, law.duration));
    case DriveFunction::kMinimumJerk:
      return minimumJerk(law, place);
    case DriveFunction::kTable:
      return table(law, place);
    case DriveFunction::kPolynomial:
      break;
  }
  return polynomial(law, place);
}

}  // namespace

std::unique_ptr<const TimeFunction> timeFunction(const DriveLaw& law, const std::string& place) {
  for (const double number : {law.offset, law.amplitude}) {
    if (!std::isfinite(number)) throw SceneError(place + ": offset or amplitude is not finite");
  }
  try {
    return functionOf(law, place);
  } catch (const MotionError& error) {
    throw SceneError(place + ": " + error.what());
  }
}

}  // namespace virtual_work_dynamics
