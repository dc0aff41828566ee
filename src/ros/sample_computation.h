#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/counters.h"
#include "ros/loop_record.h"
#include "ros/motion_completer.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// Records of what is found about samples; they outlive what writes to them.
struct SampleRecords {
  Counters& counters;  ///< of samples, points and run times
  CertificateRecord& certificates;
  LoopRecord& loops;
};

/// Computes samples and trajectory points by the plan in use, writes its messages, and has results
/// checked as the plan says. Serves one thread. Does not allocate after construction.
class SampleComputation {
 public:
  /// @param static_motion whether the scene takes velocities and accelerations as zero.
  /// @param completer of motions of joint states; must outlive this.
  SampleComputation(Eigen::Index coordinates, bool static_motion, MotionCompleter& completer,
                    const SampleRecords& records);

  /// The motion of the sample to compute next, to be set by the caller.
  Motion& motion() { return motion_; }

  /// What became of a sample. Messages change only when it is kDone.
  enum class Outcome { kDone, kNotFinite, kOpenLoop };

  /// Computes the sample whose motion is motion() and writes messages of samples.
  Outcome compute(ActivePlan& plan, std::int64_t stamp_ns);
  /// Computes one point of a trajectory by itself.
  Outcome compute(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point);
  /// Computes one of TrajectoryMotion::samples, which there must be.
  Outcome computeSample(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t sample);
  /// Computes the next point of a trajectory, beginning with the first, as many at once as the plan
  /// takes. Writes messages of trajectories, and also those of samples if `as_sample`.
  Outcome computeNext(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point,
                      bool as_sample);

 private:
  using Clock = std::chrono::steady_clock;

  void takePoint(const TrajectoryMotion& trajectory, std::size_t point);
  void computeBlock(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t first);
  Outcome computeOne(ActivePlan& plan, std::int64_t stamp_ns, Clock::time_point start);
  enum class Of { kSample, kTrajectory, kBoth };  // messages
  Outcome finish(ActivePlan& plan, std::int64_t stamp_ns, const Results& results, Of messages);
  void check(ActivePlan& plan, const Results& results);

  const bool static_motion_;
  MotionCompleter& completer_;
  SampleRecords records_;
  Motion motion_;
  Eigen::VectorXd tree_effort_;  // without efforts of actuated closures
};

}  // namespace virtual_work_dynamics
