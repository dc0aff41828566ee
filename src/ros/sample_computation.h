#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamics/live_wrenches.h"
#include "dynamics/root_by_link.h"
#include "motion/root_course.h"
#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/counters.h"
#include "ros/loop_record.h"
#include "ros/motion_completer.h"
#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"

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
  /// @param dynamics of the scene, with any request.
  /// @param completer of motions of joint states; must outlive this.
  /// @param wrenches the live ones of `scene`; must outlive this.
  /// @param root how the root moves, where it moves; must outlive this. Null: it rests.
  SampleComputation(const Dynamics& dynamics, const Scene& scene, MotionCompleter& completer,
                    LiveWrenches& wrenches, const SampleRecords& records,
                    RootCourse* root = nullptr);
  SampleComputation(const SampleComputation&) = delete;
  SampleComputation& operator=(const SampleComputation&) = delete;

  /// The motion of the sample to compute next, to be set by the caller except for the root's.
  Motion& motion() { return motion_; }

  /// What became of a sample. Messages change only when it is kDone. kNoTurn is for who sets the
  /// motion: how a joint that turns freely does so is not known.
  enum class Outcome { kDone, kNotFinite, kOpenLoop, kNoDrive, kNoWrench, kNoRoot, kNoTurn };

  /// Computes the sample of joint states whose motion is motion() and writes messages of samples.
  /// @param covariance of all coordinates of motion(); it gets those of the root and of live
  ///   wrenches, and must have come from makeCovariance(). Null: not known
  /// @param noise of single positions, where the motion is to be fitted to the closures; null: it
  /// is
  ///   not
  Outcome compute(ActivePlan& plan, std::int64_t stamp_ns, MotionCovariance* covariance = nullptr,
                  const Eigen::VectorXd* noise = nullptr);
  /// A covariance with all entries that samples need.
  MotionCovariance makeCovariance() const;
  /// Gives the points of a trajectory, which are complete, the motion of the root, as it is known
  /// now. Allocates where the root moves.
  void setRoots(TrajectoryMotion& trajectory);
  /// Computes one point of a trajectory by itself.
  Outcome compute(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point);
  /// Computes one of TrajectoryMotion::samples, which there must be.
  Outcome computeSample(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t sample);
  /// Computes the next point of a trajectory, beginning with the first, as many at once as the plan
  /// takes. Writes messages of trajectories, and also those of samples if `as_sample`.
  Outcome computeNext(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t point,
                      bool as_sample);

  /// Which live wrench was not known when the outcome was kNoWrench.
  std::size_t unknownWrench() const { return unknown_wrench_; }

 private:
  using Clock = std::chrono::steady_clock;

  Outcome whyIncomplete() const;
  void takePoint(const TrajectoryMotion& trajectory, std::size_t point);
  bool setRoot(std::int64_t stamp_ns, RootMotion& motion, MotionCovariance* covariance = nullptr);
  void placeRoot(Motion& motion);
  bool setLoad(std::int64_t stamp_ns, MotionCovariance* covariance = nullptr);
  void computeBlock(ActivePlan& plan, const TrajectoryMotion& trajectory, std::size_t first);
  Outcome computeOne(ActivePlan& plan, std::int64_t stamp_ns, Clock::time_point start,
                     MotionCovariance* covariance, bool measured = false);
  enum class Of { kSample, kTrajectory, kBoth };  // messages
  Outcome finish(ActivePlan& plan, std::int64_t stamp_ns, const Results& results, Of messages,
                 const MotionCovariance* covariance = nullptr, bool measured = false);
  void check(ActivePlan& plan, const Results& results);

  const bool static_motion_;
  MotionCompleter& completer_;
  LiveWrenches& wrenches_;
  RootCourse* const root_;  // null: it rests
  RootByLink root_by_link_;
  SampleRecords records_;
  Motion motion_;
  std::vector<WrenchCovariance> wrench_covariances_;  // of applied wrenches, as the scene says
  Load load_;                                         // of motion_
  const LoadLaw law_;                                 // that load_ is of, as the position changes
  std::vector<Load> point_loads_;  // of the points of a block; none without live wrenches
  std::size_t unknown_wrench_ = 0;
  Eigen::VectorXd tree_effort_;  // without efforts of actuated closures
};

}  // namespace virtual_work_dynamics
