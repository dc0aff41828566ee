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

/// Where what is found about samples is kept; all outlive whoever writes to them.
struct SampleRecords {
  Counters& counters;  ///< of samples, points and run times
  CertificateRecord& certificates;
  LoopRecord& loops;
};

/// Computes samples and trajectory points by the plan in use, writes its messages, and has results
/// checked as the plan says. One thread. Does not allocate after construction.
class SampleComputation {
 public:
  /// @param static_motion the scene takes velocities and accelerations as zero.
  /// @param completer of motions of joint states; outlives this.
  SampleComputation(Eigen::Index coordinates, bool static_motion, MotionCompleter& completer,
                    const SampleRecords& records);

  /// Where the motion of the sample to compute next is to be put.
  Motion& motion() { return motion_; }

  /// What became of a sample; messages stay as they were unless it is done.
  enum class Outcome { kDone, kNotFinite, kOpenLoop };

  /// The sample whose motion is motion(); messages of samples are written.
  Outcome compute(ActivePlan& plan, std::int64_t stamp_ns);
  /// One point of a trajectory, by itself.
  Outcome compute(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point);
  /// The next point of a trajectory from the first on, as many at once as the plan takes. Writes
  /// messages of trajectories, and those of samples where `as_sample`.
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
  Eigen::VectorXd tree_effort_;  // without actuated closures
};

}  // namespace virtual_work_dynamics
