// One joint that turns on and on: whether the estimator drifts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "estimator/report_parts.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kWheel[] = R"(<robot name="wheel">
  <link name="base"/>
  <link name="wheel"><inertial><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/>
    <axis xyz="0 0 1"/></joint>
</robot>)";
constexpr int kRate = 1000;        // Hz
constexpr double kSpeed = 1;       // rad/s
constexpr double kSwing = 0.5;     // rad
constexpr double kSwingSpeed = 3;  // rad/s
constexpr double kQuantum = 1e-4;  // rad
constexpr double kTwoPi = 6.283185307179586;
constexpr long kEvery = 97;  // samples from one that is evaluated to the next
constexpr int kParts = 24;   // hours of a day

double angle(double t) {
  return kSpeed * t + kSwing * std::sin(kSwingSpeed * t);
}

}  // namespace

void measureLongRun(long samples, const ReportRows& rows) {
  const Mechanism mechanism = readUrdf(kWheel);
  EstimatorSettings settings;
  MotionEstimator estimator(mechanism, settings);
  StreamSpec spec;
  spec.group = "long_run";
  spec.rate = kRate;
  spec.quantum = kQuantum;
  Motion motion(1);
  const int coordinate = 0;
  const long part = std::max<long>(1, samples / kParts);
  std::array<double, 3> squares{};
  long count = 0;
  for (long k = 0; k < samples; ++k) {
    const double t = static_cast<double>(k) / kRate;
    // The driver wraps to half a turn on either side.
    const double q = kQuantum * std::round(std::remainder(angle(t), kTwoPi) / kQuantum);
    estimator.push(static_cast<std::int64_t>(k) * (1000000000 / kRate), &coordinate, &q, nullptr,
                   1);
    if (k % kEvery != 0 || k < kRate) {
      estimator.skip();
    } else if (estimator.ready()) {
      const double then = 1e-9 * static_cast<double>(estimator.evaluate(motion));
      const double w = kSwingSpeed;
      const std::array<double, 3> errors{motion.q[0] - angle(then),
                                         motion.qd[0] - kSpeed - kSwing * w * std::cos(w * then),
                                         motion.qdd[0] + kSwing * w * w * std::sin(w * then)};
      for (std::size_t i = 0; i < 3; ++i) squares[i] += errors[i] * errors[i];
      ++count;
    }
    if ((k + 1) % part != 0 || count == 0) continue;
    const char* const names[] = {"q_rms_rad", "qd_rms_rad_s", "qdd_rms_rad_s2"};
    for (std::size_t i = 0; i < 3; ++i)
      rows.add("long_run", spec, "part_" + std::to_string((k + 1) / part), 1e3 * settings.lag,
               names[i], std::sqrt(squares[i] / static_cast<double>(count)));
    squares.fill(0);
    count = 0;
  }
}

}  // namespace virtual_work_dynamics
