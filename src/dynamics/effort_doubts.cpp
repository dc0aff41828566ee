#include "dynamics/effort_doubts.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {

std::string toString(const EffortDoubt& doubt) {
  std::ostringstream text;
  text.precision(2);
  text << "effort of " << inQuotes(doubt.name) << ": deviation " << doubt.deviation << ", ";
  if (std::isfinite(doubt.relative)) {
    text << 100 * doubt.relative << " % of its rms";
  } else {
    text << "while the effort is zero";
  }
  text << ", mostly from " << doubt.cause;
  return text.str();
}

std::vector<std::string> otherCauses(const Scene& scene) {
  std::vector<std::string> causes;
  if (scene.root_moves) {
    for (const char* quantity :
         {"orientation", "angular velocity", "angular acceleration", "acceleration"}) {
      causes.push_back(std::string("the noise of the root's ") + quantity);
    }
  }
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    if (!wrench.deviation) continue;
    causes.push_back("the noise of " + (wrench.name.empty()
                                            ? "the applied wrench on " + inQuotes(wrench.link)
                                            : "the wrench " + inQuotes(wrench.name)));
  }
  return causes;
}

std::vector<std::string> exactWrenches(const Scene& scene) {
  std::vector<std::string> names;
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    if (wrench.live && !wrench.deviation) names.push_back(wrench.name);
  }
  return names;
}

EffortDoubts::EffortDoubts(std::vector<std::string> efforts, std::vector<bool> residuals,
                           std::vector<std::string> coordinates, std::vector<std::string> others)
    : efforts_(std::move(efforts)),
      coordinates_(std::move(coordinates)),
      others_(std::move(others)),
      residuals_(std::move(residuals)) {
  const auto count = static_cast<Eigen::Index>(efforts_.size());
  effort_counts_.setZero(count);
  effort_squares_.setZero(count);
  counts_.setZero(count);
  motion_squares_.setZero(count);
  description_squares_.setZero(count);
  parts_.setZero(count, kMotionLevels * static_cast<Eigen::Index>(coordinates_.size()) +
                            static_cast<Eigen::Index>(others_.size()));
}

void EffortDoubts::add(const Eigen::VectorXd& effort, const Deviations::Workspace& computed,
                       bool of_motion, bool of_description) {
  ++samples_;
  for (Eigen::Index i = 0; i < counts_.size(); ++i) {
    const double motion = of_motion ? computed.motion().effort[i] : 0;
    const double description = of_description ? computed.description().effort[i] : 0;
    if (!std::isfinite(effort[i]) || !std::isfinite(motion) || !std::isfinite(description)) {
      continue;
    }
    effort_counts_[i] += 1;
    effort_squares_[i] += effort[i] * effort[i];
    counts_[i] += 1;
    motion_squares_[i] += motion * motion;
    description_squares_[i] += description * description;
    if (of_motion) parts_.row(i) += computed.effortParts().row(i);
  }
}

void EffortDoubts::forgetDeviations() {
  samples_ = 0;
  counts_.setZero();
  motion_squares_.setZero();
  description_squares_.setZero();
  parts_.setZero();
}

std::vector<EffortDoubt> EffortDoubts::above(double threshold) const {
  std::vector<EffortDoubt> doubts;
  for (Eigen::Index i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0 || residuals_[static_cast<std::size_t>(i)]) continue;
    const double deviation = std::sqrt((motion_squares_[i] + description_squares_[i]) / counts_[i]);
    const double effort = std::sqrt(effort_squares_[i] / effort_counts_[i]);
    if (!(deviation > threshold * effort)) continue;
    doubts.push_back(
        {efforts_[static_cast<std::size_t>(i)], deviation, deviation / effort, causeOf(i)});
  }
  return doubts;
}

std::string EffortDoubts::causeOf(Eigen::Index effort) const {
  static const char* const kLevels[] = {"position", "velocity", "acceleration"};
  Eigen::Index largest = 0;
  const double part = parts_.size() > 0 ? parts_.row(effort).maxCoeff(&largest) : 0;
  if (description_squares_[effort] >= part) return "the tolerances of masses and inertias";
  const auto other = largest - kMotionLevels * static_cast<Eigen::Index>(coordinates_.size());
  if (other >= 0) return others_[static_cast<std::size_t>(other)];
  const Eigen::Index coordinate = largest / kMotionLevels;
  const std::string level = kLevels[largest % kMotionLevels];
  // An actuated closure's effort stands after those of the coordinates.
  if (coordinate == effort) return "the noise of its own " + level;
  return "the noise of the " + level + " of " +
         inQuotes(coordinates_[static_cast<std::size_t>(coordinate)]);
}

}  // namespace virtual_work_dynamics
