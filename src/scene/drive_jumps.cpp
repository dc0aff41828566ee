#include "scene/drive_jumps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/number_text.h"
#include "motion/far_positions.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr const char* kLevels[] = {"position", "velocity", "acceleration"};
constexpr const char* kUnits[] = {"rad or m", "rad/s or m/s", "rad/s^2 or m/s^2"};

// Jumps below this part of what the terms of a piece add up to are rounding of its coefficients.
constexpr double kFits = 1e-6;

[[noreturn]] void failAtJump(const std::string& place, int level, double time) {
  throw SceneError(place + ": " + kLevels[level] + " jumps at " + numberText(time) + " s");
}

// A function of time by samples.
struct Samples {
  std::vector<double> times, values;
  double resolution = 0;  // of the values
};

// The step from which the numbers of a table are made up, as far as it is decimal.
double resolutionOf(const std::vector<double>& values) {
  constexpr int kMostDigits = 12;
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  double step = 1;
  for (int digits = 0; digits <= kMostDigits; ++digits, step /= 10) {
    const double slack = largest / step * 4 * std::numeric_limits<double>::epsilon();
    const auto fits = [&](double value) {
      return std::abs(value / step - std::round(value / step)) <= slack;
    };
    if (std::all_of(values.begin(), values.end(), fits)) return step;
  }
  return largest * std::numeric_limits<double>::epsilon();
}

// Slopes between samples, at the instants in the middle of them.
Samples differencesOf(const Samples& of) {
  Samples differences;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < of.times.size(); ++i) {
    const double step = of.times[i] - of.times[i - 1];
    differences.times.push_back(of.times[i - 1] + step / 2);
    differences.values.push_back((of.values[i] - of.values[i - 1]) / step);
    shortest = std::min(shortest, step);
  }
  differences.resolution = 2 * of.resolution / shortest;
  return differences;
}

double usualStep(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

// As recordings are judged: see judgeFar().
void requireSteady(const Samples& samples, int level, const std::string& place) {
  const std::size_t count = samples.times.size();
  if (count < 3) return;
  const double interval = usualStep(samples.times);
  for (std::size_t i = 1; i < count; ++i) {
    const double step = samples.values[i] - samples.values[i - 1];
    const double time = samples.times[i] - samples.times[i - 1];
    if (!isFar(step, time, interval, samples.resolution, 0)) continue;
    const std::size_t first = i < kBeforeFar ? 0 : i - kBeforeFar;
    const std::size_t shown = std::min(count - first, i - first + kMostFar);
    const FarFinding found =
        judgeFar(&samples.times[first], &samples.values[first], static_cast<int>(i - first),
                 static_cast<int>(shown), interval);
    if (found.verdict == FarVerdict::kJump || found.verdict == FarVerdict::kAlone) {
      failAtJump(place, level, samples.times[i]);
    }
  }
}

}  // namespace

PolynomialInstant polynomialAt(const std::vector<double>& coefficients, double t) {
  PolynomialInstant at{};
  for (std::size_t power = coefficients.size(); power-- > 0;) {
    // Horner's rule for the value and, by the product rule, for its derivatives.
    at.values[2] = at.values[2] * t + 2 * at.values[1];
    at.values[1] = at.values[1] * t + at.values[0];
    at.values[0] = at.values[0] * t + coefficients[power];
    at.sizes[2] = at.sizes[2] * std::abs(t) + 2 * at.sizes[1];
    at.sizes[1] = at.sizes[1] * std::abs(t) + at.sizes[0];
    at.sizes[0] = at.sizes[0] * std::abs(t) + std::abs(coefficients[power]);
  }
  return at;
}

void requireFittingPieces(const DriveLaw& law, const std::string& place) {
  for (std::size_t i = 1; i < law.times.size(); ++i) {
    const PolynomialInstant before =
        polynomialAt(law.coefficients[i - 1], law.times[i] - law.times[i - 1]);
    const PolynomialInstant after = polynomialAt(law.coefficients[i], 0);
    for (int level = 0; level < 3; ++level) {
      const double jump = after.values[level] - before.values[level];
      if (std::abs(jump) <= kFits * (before.sizes[level] + after.sizes[level])) continue;
      throw SceneError(place + ": " + kLevels[level] + " jumps by " + numberText(jump) + " " +
                       kUnits[level] + " at " + numberText(law.times[i]) + " s");
    }
  }
}

void requireSteadyRows(const DriveLaw& law, const std::string& place) {
  const Samples positions{law.times, law.positions, resolutionOf(law.positions)};
  requireSteady(positions, 0, place);
  const Samples velocities = law.velocities.empty()
                                 ? differencesOf(positions)
                                 : Samples{law.times, law.velocities, resolutionOf(law.velocities)};
  requireSteady(velocities, 1, place);
  const Samples accelerations =
      law.accelerations.empty()
          ? differencesOf(velocities)
          : Samples{law.times, law.accelerations, resolutionOf(law.accelerations)};
  requireSteady(accelerations, 2, place);
}

}  // namespace virtual_work_dynamics
