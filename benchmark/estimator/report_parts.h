#pragma once

#include <string>

#include "estimator/report_rows.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The arm that all simulated streams are of.
struct Arm {
  Mechanism mechanism;
  InverseDynamics dynamics;
  Deviations deviations;

  static Arm read();
};

/// completeMotion() and its alternatives on a stream, beside Savitzky and Golay's filter.
void measureOffline(const Arm& arm, const StreamSpec& spec, const ReportRows& rows);
/// MotionEstimator on a stream, beside the best Kalman smoother of the same lag.
void measureNode(const Arm& arm, const StreamSpec& spec, const ReportRows& rows);
/// A stream with wrong velocities, with and without using them.
void measureWrongVelocities(const Arm& arm, const StreamSpec& spec, const ReportRows& rows);
/// Time per sample.
void measureTime(const Arm& arm, bool quick, const ReportRows& rows);
/// Thread time of the deviations of a sample of the arm, with and without reactions, beside that of
/// a block of 3 n + 1 samples, taken in turn: medians.
void measureDeviationCost(const Arm& arm, const ReportRows& rows);
/// One joint that turns on for as many samples at 1 kHz.
void measureLongRun(long samples, const ReportRows& rows);
/// A real recording, as in `folder`/README.md: explained variance of the measured torques.
void measureRecorded(const std::string& folder, const ReportRows& rows);

}  // namespace virtual_work_dynamics
