#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/counters.h"
#include "ros/loop_samples.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// Computes samples and trajectory points by the plan in use, writes its messages, and has results
/// checked as the plan says. One thread. Does not allocate after construction.
class SampleComputation {
 public:
  /// @param coordinates of the mechanism.
  /// @param static_motion the scene takes velocities and accelerations as zero.
  /// @param counters of samples, points and run times; outlives this.
  /// @param certificates of all samples of plans that certify; outlives this.
  /// @param loops completes motions of joint states, and records samples; null: an open chain.
  SampleComputation(Eigen::Index coordinates, bool static_motion, Counters& counters,
                    CertificateRecord& certificates, LoopSamples* loops = nullptr);

  /// Where the motion of the sample to compute next is to be put.
  Motion& motion() { return motion_; }

  /// What became of a sample; messages stay as they were unless it is done.
  enum class Outcome { kDone, kNotFinite, kOpenLoop };

  /// The sample whose motion is motion().
  Outcome compute(ActivePlan& plan, std::int64_t stamp_ns);
  /// One point of a trajectory, by itself.
  Outcome compute(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point);
  /// The next point of a trajectory from the first on, as many at once as the plan takes.
  Outcome computeNext(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point);

 private:
  using Clock = std::chrono::steady_clock;

  void takePoint(const TrajectoryMotion& trajectory, std::size_t point);
  void computeBlock(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t first);
  Outcome computeOne(ActivePlan& plan, std::int64_t stamp_ns);
  Outcome computeLoops(ActivePlan& plan, std::int64_t stamp_ns, Clock::time_point start);
  Outcome fillMessages(ActivePlan& plan, std::int64_t stamp_ns);
  void check(ActivePlan& plan);
  void checkLoops(ActivePlan& plan);

  const bool static_motion_;
  Counters& counters_;
  CertificateRecord& certificates_;
  LoopSamples* const loops_;
  Motion motion_;
  Eigen::VectorXd tree_effort_;  // without actuated closures
};

}  // namespace virtual_work_dynamics
