#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Deviation of an effort over the effort itself, each an rms, above which it is in doubt, unless
/// the user says it.
constexpr double kDeviationWarn = 0.1;

/// An effort whose deviation is large beside the effort itself.
struct EffortDoubt {
  std::string name;
  double deviation = 0;  ///< rms of the deviations, N m or N
  double relative = 0;   ///< over the rms of the effort
  std::string cause;     ///< what makes the largest part, such as "the noise of its own velocity"
};

/// Says of a doubt, for example, "effort of 'elbow': deviation 0.8, 23 % of its rms, mostly from
/// the noise of its own acceleration".
std::string toString(const EffortDoubt& doubt);

/// What makes those of Deviations::Workspace::effortParts() that are not of coordinates, such as
/// "the noise of the root's angular acceleration".
std::vector<std::string> otherCauses(const Scene& scene);
/// Names of the live wrenches of a scene whose deviations are not known, and so count as exact.
std::vector<std::string> exactWrenches(const Scene& scene);

/// Sums of squares of efforts and their deviations over samples, of which it tells the doubts.
class EffortDoubts {
 public:
  /// @param efforts names of efforts
  /// @param residuals whether each is a residual, of which none is in doubt: it is to vanish
  /// @param coordinates names of the coordinates, the first of the efforts
  /// @param others further causes, see otherCauses()
  EffortDoubts(std::vector<std::string> efforts, std::vector<bool> residuals,
               std::vector<std::string> coordinates, std::vector<std::string> others = {});

  /// Adds a sample. Efforts without a value or deviation do not count. Does not allocate.
  /// @param computed deviations of the sample
  /// @param of_motion whether their share of the motion was computed
  /// @param of_description whether their share of the description was computed
  void add(const Eigen::VectorXd& effort, const Deviations::Workspace& computed, bool of_motion,
           bool of_description);
  /// Forgets deviations and keeps efforts, with whose rms later deviations are compared, too.
  void forgetDeviations();

  /// Number of samples since the start, or since forgetDeviations().
  std::size_t samples() const { return samples_; }
  /// The efforts whose deviation is more than `threshold` times the effort, each an rms, in their
  /// order. Allocates.
  std::vector<EffortDoubt> above(double threshold) const;

 private:
  std::string causeOf(Eigen::Index effort) const;

  std::vector<std::string> efforts_, coordinates_, others_;
  std::vector<bool> residuals_;
  std::size_t samples_ = 0;
  Eigen::VectorXd effort_counts_, effort_squares_;                 // by effort
  Eigen::VectorXd counts_, motion_squares_, description_squares_;  // by effort
  Eigen::MatrixXd parts_;  // as Deviations::Workspace::effortParts()
};

}  // namespace virtual_work_dynamics
