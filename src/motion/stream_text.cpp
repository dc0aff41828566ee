#include "motion/stream_text.h"

#include <cmath>
#include <cstdio>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::string frequency(double hertz) {
  char text[32];
  std::snprintf(text, sizeof text, hertz < 1000 ? "%.3g Hz" : "%.3g kHz",
                hertz < 1000 ? hertz : hertz / 1000);
  return text;
}

}  // namespace

std::string streamText(const StreamQuality& quality, const std::string& unit,
                       const std::string& noise) {
  std::string text = frequency(std::round(1e3 / quality.interval) / 1e3) + ", " + noise + " " +
                     brief(quality.position_noise) + " " + unit;
  if (quality.velocity_noise >= 0)
    text += ", velocity noise " + brief(quality.velocity_noise) + " " + unit + "/s";
  if (quality.stamp_noise > 0.01 * quality.interval)
    text += ", stamp noise " + brief(quality.stamp_noise) + " s";
  text += ", bandwidth " + frequency(quality.bandwidth);
  if (quality.jumps > 0) text += ", jumps " + std::to_string(quality.jumps);
  if (quality.left_out > 0) text += ", left out " + std::to_string(quality.left_out);
  return text;
}

std::string velocityProblem(const std::string& joint, double ratio) {
  const std::string begin = "velocities of " + inQuotes(joint) + " are not used: they ";
  const std::string positions = " of the slope of its positions: are these in ";
  if (std::abs(57.29578 * ratio - 1) < 0.05) return begin + "are 1/57" + positions + "degrees?";
  if (std::abs(1000 * ratio - 1) < 0.05) return begin + "are 1/1000" + positions + "millimetres?";
  if (std::abs(ratio) < 0.02) return begin + "stay at zero while its position moves";
  if (std::abs(ratio - 57.29578) < 3)
    return begin + "are 57 times the slope of its positions: degrees per second?";
  return begin + "are " + brief(ratio) + " times the slope of its positions";
}

}  // namespace virtual_work_dynamics
