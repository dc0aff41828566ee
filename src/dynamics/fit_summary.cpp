#include "dynamics/fit_summary.h"

#include <cmath>
#include <cstdio>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

// Moves, in deviations, rms of all conditions, beyond which something else than noise is at work.
// Smoothed positions move by less than 1, and what an encoder at rest rounds away makes it 1.
// Velocities move by 1, and by more where deviations are too small.
constexpr double kSystematicPosition = 1.5, kSystematicVelocity = 4;

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

void FitSummary::add(const MotionFit::Outcome& outcome) {
  ++fitted;
  if (!outcome.closed) ++open;
  if (!outcome.explained) ++unexplained;
  position_squares += outcome.position_rms * outcome.position_rms;
  velocity_squares += outcome.velocity_rms * outcome.velocity_rms;
  wheels = outcome.wheels;
  if (outcome.farthest.deviations > farthest.deviations) farthest = outcome.farthest;
}

bool FitSummary::systematic() const {
  const auto count = static_cast<double>(fitted);
  return position_squares > kSystematicPosition * kSystematicPosition * count ||
         velocity_squares > kSystematicVelocity * kSystematicVelocity * count;
}

std::string FitSummary::text(const Mechanism& mechanism, const char* one, const char* many) const {
  const auto count = [&](std::uint64_t number) {
    return std::to_string(number) + " " + (number == 1 ? one : many);
  };
  std::string text;
  if (unexplained > 0) {
    text = count(unexplained) + (unexplained == 1 ? " violates" : " violate") +
           " closures or couplings by more than noise explains";
  } else {
    text = count(fitted) + " fitted to closures and couplings";
    if (systematic()) {
      const auto rms = [&](double squares) {
        return digits(std::sqrt(squares / static_cast<double>(fitted)));
      };
      text += " by more than their noise (" + rms(position_squares) +
              " standard deviations of positions and " + rms(velocity_squares) +
              " of velocities rms), which deviations of results know nothing of";
    }
  }
  if (farthest.coordinate >= 0) {
    const auto place = static_cast<std::size_t>(farthest.coordinate);
    const std::string unit = mechanism.unitOf(farthest.coordinate) == Unit::kMetre ? "m" : "rad";
    text += std::string(": the ") + (farthest.level == 0 ? "position" : "velocity") + " of " +
            inQuotes(mechanism.coordinateNames()[place]) + " the most, by " +
            digits(farthest.amount) + " " + unit + (farthest.level == 0 ? "" : "/s") + ", " +
            digits(farthest.deviations) + " of its standard deviations";
  }
  if (open > 0) {
    text += "; " + count(open) + (open == 1 ? " leaves" : " leave") +
            " closures open by more than a fit closes, and " + (open == 1 ? "its" : "their") +
            " positions stay as measured";
  }
  if (doubtful()) {
    text += wheels ? "; wheels slip, or zeros of encoders, dimensions or delays are wrong"
                   : "; zeros of encoders, dimensions or delays are wrong";
  }
  return text;
}

}  // namespace virtual_work_dynamics
