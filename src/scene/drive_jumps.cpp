#include "scene/drive_jumps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/number_text.h"
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
  double rounding = 0;     // of the values, at most
  std::size_t widest = 1;  // steps that a jump of it shows in, at most
};

// Steps beside a jump that tell what is usual, and those that are needed.
constexpr std::size_t kBeside = 3;
constexpr std::size_t kFewestBeside = 2;
// By how much a jump exceeds what slopes beside it differ by.
constexpr double kUnlike = 4;
constexpr double kUnlikeAtEnds = 8;
// Part of the range of a table that its decimals may leave out at most.
constexpr double kCoarsest = 2e-3;
// Fourth differences of white noise, in its standard deviations.
constexpr double kOfNoise = 8;
// Part of a velocity below which the way does not go along with it.
constexpr double kAlong = 0.1;

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

// What fourth differences of most rows that move stay below: round numbers need not be rounded
// ones.
double unevennessOf(const std::vector<double>& y) {
  std::vector<double> uneven;
  for (std::size_t i = 4; i < y.size(); ++i) {
    if (std::all_of(&y[i - 4], &y[i], [&](double value) { return value == y[i]; })) continue;
    uneven.push_back(std::abs(y[i] - 4 * y[i - 1] + 6 * y[i - 2] - 4 * y[i - 3] + y[i - 4]));
  }
  if (uneven.empty()) return std::numeric_limits<double>::infinity();
  const auto most = uneven.begin() + static_cast<std::ptrdiff_t>(uneven.size() * 3 / 4);
  std::nth_element(uneven.begin(), most, uneven.end());
  return *most;
}

double roundingOf(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double exact =
      std::max(std::abs(*least), std::abs(*most)) * std::numeric_limits<double>::epsilon();
  const double uneven = unevennessOf(values);
  const double step = std::min(
      {std::max(resolutionOf(values), uneven / kOfNoise), uneven, kCoarsest * (*most - *least)});
  return std::max(step / 2, exact);
}

Samples samplesOf(const std::vector<double>& times, const std::vector<double>& values) {
  return {times, values, roundingOf(values), 1};
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
  differences.rounding = 2 * of.rounding / shortest;
  differences.widest = of.widest + 1;
  return differences;
}

// The largest difference between slopes one after the other.
double roughness(const std::vector<double>& slopes, std::size_t first, std::size_t last) {
  double rough = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    rough = std::max(rough, std::abs(slopes[i] - slopes[i - 1]));
  }
  return rough;
}

// Whether the samples jump within `width` steps from `first` on: they come elsewhere than by the
// slopes beside, by more than these differ from each other.
bool jumpsAt(const Samples& samples, const std::vector<double>& slopes, std::size_t first,
             std::size_t width) {
  const std::size_t after = first + width, count = slopes.size();
  const bool has_left = first >= kFewestBeside, has_right = count - after >= kFewestBeside;
  const bool at_end = width == 1 && samples.widest == 1 && (first == 0 || after == count);
  if (!(has_left && has_right) && !(at_end && (has_left || has_right))) return false;
  double rough = 0, slope = 0;
  if (has_left) {
    rough = roughness(slopes, first - std::min(first, kBeside), first);
    slope += slopes[first - 1];
  }
  if (has_right) {
    rough = std::max(rough, roughness(slopes, after, std::min(count, after + kBeside)));
    slope += slopes[after];
  }
  if (has_left && has_right) {
    rough = std::max(rough, std::abs(slopes[after] - slopes[first - 1]));
    slope /= 2;
  }
  const double time = samples.times[after] - samples.times[first];
  const double jump = samples.values[after] - samples.values[first] - slope * time;
  double shortest = time;
  for (std::size_t i = first - std::min(first, kBeside); i < std::min(count, after + kBeside);
       ++i) {
    shortest = std::min(shortest, samples.times[i + 1] - samples.times[i]);
  }
  const double unlike = at_end ? kUnlikeAtEnds : kUnlike;
  return std::abs(jump) > unlike * rough * time + (2 + 2 * time / shortest) * samples.rounding;
}

void requireSteady(const Samples& samples, int level, const std::string& place) {
  std::vector<double> slopes;
  for (std::size_t i = 1; i < samples.times.size(); ++i) {
    slopes.push_back((samples.values[i] - samples.values[i - 1]) /
                     (samples.times[i] - samples.times[i - 1]));
  }
  for (std::size_t first = 0; first < slopes.size(); ++first) {
    for (std::size_t width = 1; width <= samples.widest && first + width <= slopes.size();
         ++width) {
      if (jumpsAt(samples, slopes, first, width)) {
        failAtJump(place, level, samples.times[first + width]);
      }
    }
  }
}

// Positions go along where velocities at both ends of a step do.
void requireAlong(const Samples& positions, const Samples& velocities, const std::string& place) {
  for (std::size_t i = 1; i < positions.times.size(); ++i) {
    const double before = velocities.values[i - 1], after = velocities.values[i];
    if (!(before * after > 0)) continue;
    const double time = positions.times[i] - positions.times[i - 1];
    const double way = (positions.values[i] - positions.values[i - 1]) * (after > 0 ? 1 : -1);
    const double least = std::min(std::abs(before), std::abs(after)) * time;
    if (way + 2 * positions.rounding >= kAlong * (least - velocities.rounding * time)) continue;
    throw SceneError(place + ": velocities are not those of the positions, which do not go along " +
                     "with them from " + numberText(positions.times[i - 1]) + " s to " +
                     numberText(positions.times[i]) + " s");
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
  const Samples positions = samplesOf(law.times, law.positions);
  requireSteady(positions, 0, place);
  const Samples velocities =
      law.velocities.empty() ? differencesOf(positions) : samplesOf(law.times, law.velocities);
  requireSteady(velocities, 1, place);
  const Samples accelerations = law.accelerations.empty() ? differencesOf(velocities)
                                                          : samplesOf(law.times, law.accelerations);
  requireSteady(accelerations, 2, place);
  if (!law.velocities.empty()) requireAlong(positions, velocities, place);
}

}  // namespace virtual_work_dynamics
