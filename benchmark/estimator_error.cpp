// Error of the estimated motion, and of the efforts computed from it, for joint states as encoders
// give them: every setting of the estimator on every stream, as rows of a CSV.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "command_line.h"
#include "encoder_stream.h"
#include "offline/output_file.h"
#include "offline/progress.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/urdf_reader.h"

using namespace virtual_work_dynamics;

namespace {

constexpr char kHelp[] =
    R"(estimator_error: error of estimated velocities, accelerations and efforts

  estimator_error [--output FILE] [--quick]

The six-axis arm moves by sums of sines, so that its motion and its efforts are known exactly. Its
joint states are sampled, read by encoders and given to the estimator, for every window, order and
lag; what comes out is compared with the exact values at the same instant.

  --output FILE   result as CSV (default: standard output); FILE is complete or not there
  --quick         fewer streams, settings and instants, for a look in seconds
  --help          this text

Exit status: 0 done, 1 something is wrong with the robot or the output, 2 wrong usage.
)";

constexpr ArmMotion kMotions[] = {{"slow", 0.15, {0.10, 0.23, 0.37}},
                                  {"brisk", 0.5, {0.25, 0.6, 1.1}},
                                  {"sharp", 0.5, {0.5, 1.3, 3.1}}};
const ArmMotion& kBrisk = kMotions[1];

// 4096 counts with 0.06 degrees of noise is what the data sheet of the magnetic encoder AS5045 says
// of its fast mode.
constexpr double kMagneticNoise = 0.06 * 4096 / 360;
constexpr Encoder kEncoders[] = {{"exact", 0, 1, 0},
                                 {"magnetic_12bit_joint", 4096, 1, kMagneticNoise},
                                 {"magnetic_12bit_motor", 4096, 100, kMagneticNoise},
                                 {"optical_20bit_joint", 1048576, 1, 0},
                                 {"servo_17bit_motor", 131072, 100, 0},
                                 {"servo_20bit_motor", 1048576, 100, 0}};
const Encoder& kExactEncoder = kEncoders[0];
const Encoder& kOpticalEncoder = kEncoders[3];

constexpr const char* kVelocityNames[] = {"none", "differences", "exact"};
constexpr const char* kStampingNames[] = {"true", "uneven", "wrong"};

// Every setting is evaluated from the same sample on, when the longest window is full.
constexpr int kLongestWindow = 127;

/// What of all this a run goes through.
struct Extent {
  std::vector<int> rates{125, 250, 500, 1000};  // Hz
  std::vector<int> windows{5, 9, 13, 17, 25, 33, 49, 65, 97, kLongestWindow};
  std::vector<int> orders{2, 3, 4, 5};
  std::vector<int> lags{0, 1, 2, 4, 8, 16, 32};  // up to the middle of the window, which is added
  std::vector<const ArmMotion*> motions{&kMotions[0], &kMotions[1], &kMotions[2]};
  double seconds = 8;  // of motion that is evaluated
  int instants = 400;  // at which it is evaluated
};

Extent quickExtent() {
  Extent extent;
  extent.rates = {250, 1000};
  extent.windows = {5, 9, 17, 33, 65, kLongestWindow};
  extent.orders = {3, 5};
  extent.motions = {&kMotions[1], &kMotions[2]};
  extent.seconds = 4;
  extent.instants = 100;
  return extent;
}

/// Root mean square and largest magnitude.
struct Size {
  double squares = 0;
  double largest = 0;
  int count = 0;

  void add(double value) {
    squares += value * value;
    largest = std::max(largest, std::abs(value));
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

/// Of all joints together.
struct Errors {
  Size qd;         // rad/s
  Size qdd;        // rad/s^2
  Size effort;     // N m
  Size share;      // effort over the range of the joint's effort
  Size share_now;  // the same, against the effort at the newest sample
};

/// A recorded stream, replayed for one setting after the other.
class Trial {
 public:
  Trial(const Mechanism& mechanism, const InverseDynamics& dynamics, const Stream& stream,
        const Extent& extent);

  Errors runEstimator(const EstimatorSettings& settings);
  /// Positions differenced twice, over the real times between them.
  Errors runDifferences();
  /// The motion instead of errors, for scale.
  Errors sizeOfMotion() const;

 private:
  template <typename Estimate>
  Errors replay(std::size_t behind, Estimate&& estimate);

  const Mechanism& mechanism_;
  const InverseDynamics& dynamics_;
  Workspace workspace_;
  Motion motion_{kArmJoints};
  bool with_velocities_;
  std::size_t stride_;  // samples from one evaluation to the next
  Recording recording_;
};

Trial::Trial(const Mechanism& mechanism, const InverseDynamics& dynamics, const Stream& stream,
             const Extent& extent)
    : mechanism_(mechanism),
      dynamics_(dynamics),
      workspace_(dynamics.makeWorkspace()),
      with_velocities_(stream.velocity != VelocitySource::kNone) {
  const int evaluated = static_cast<int>(extent.seconds * stream.rate);
  stride_ = static_cast<std::size_t>(std::max(1, evaluated / extent.instants));
  recording_ = record(stream, dynamics, kLongestWindow + evaluated);
}

/// Calls `estimate(sample, wanted)` for each sample; where wanted, it has to leave in motion_ what
/// it makes of the motion `behind` samples before that one.
template <typename Estimate>
Errors Trial::replay(std::size_t behind, Estimate&& estimate) {
  Errors errors;
  for (std::size_t k = 0; k < recording_.samples.size(); ++k) {
    const bool wanted = k >= kLongestWindow && (k - kLongestWindow) % stride_ == 0;
    estimate(k, wanted);
    if (!wanted) continue;
    dynamics_.compute(motion_, workspace_);
    const Truth& then = recording_.truth[k - behind];
    const Truth& now = recording_.truth[k];
    for (int j = 0; j < kArmJoints; ++j) {
      const double effort = workspace_.effort()[j];
      const double range = recording_.effort_range[j];
      errors.qd.add(motion_.qd[j] - then.motion.qd[j]);
      errors.qdd.add(motion_.qdd[j] - then.motion.qdd[j]);
      errors.effort.add(effort - then.effort[j]);
      errors.share.add((effort - then.effort[j]) / range);
      errors.share_now.add((effort - now.effort[j]) / range);
    }
  }
  return errors;
}

Errors Trial::runEstimator(const EstimatorSettings& settings) {
  constexpr std::array<int, kArmJoints> coordinates{0, 1, 2, 3, 4, 5};
  MotionEstimator estimator(mechanism_, settings);
  const auto behind = static_cast<std::size_t>(settings.estimate ? settings.lag : 0);
  return replay(behind, [&](std::size_t k, bool wanted) {
    const Sample& sample = recording_.samples[k];
    estimator.push(sample.stamp, coordinates.data(), sample.q.data(),
                   with_velocities_ ? sample.qd.data() : nullptr, kArmJoints);
    if (!wanted) {
      estimator.skip();
    } else if (estimator.evaluate(motion_) != recording_.samples[k - behind].stamp) {
      throw MotionError("sample " + std::to_string(k) + " is not evaluated " +
                        std::to_string(behind) + " samples before it");
    }
  });
}

Errors Trial::runDifferences() {
  return replay(1, [&](std::size_t k, bool wanted) {
    if (!wanted) return;
    const Sample& first = recording_.samples[k - 2];
    const Sample& middle = recording_.samples[k - 1];
    const Sample& last = recording_.samples[k];
    const double before = 1e-9 * static_cast<double>(middle.stamp - first.stamp);
    const double after = 1e-9 * static_cast<double>(last.stamp - middle.stamp);
    for (std::size_t j = 0; j < kArmJoints; ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      const double slope_before = (middle.q[j] - first.q[j]) / before;
      const double slope_after = (last.q[j] - middle.q[j]) / after;
      motion_.q[at] = middle.q[j];
      motion_.qd[at] = (slope_before * after + slope_after * before) / (before + after);
      motion_.qdd[at] = 2 * (slope_after - slope_before) / (before + after);
    }
  });
}

Errors Trial::sizeOfMotion() const {
  Errors sizes;
  for (const Truth& truth : recording_.truth) {
    for (int j = 0; j < kArmJoints; ++j) {
      sizes.qd.add(truth.motion.qd[j]);
      sizes.qdd.add(truth.motion.qdd[j]);
      sizes.effort.add(truth.effort[j]);
      sizes.share.add(truth.effort[j] / recording_.effort_range[j]);
    }
  }
  sizes.share_now = sizes.share;
  return sizes;
}

constexpr char kHeader[] =
    "rate_hz,motion,highest_frequency_hz,encoder,counts_per_turn,gear_ratio,noise_rms_counts,"
    "velocity,stamps,method,window,order,lag,delay_ms,"
    "qd_rms_rad_s,qd_max_rad_s,qdd_rms_rad_s2,qdd_max_rad_s2,effort_rms_Nm,effort_max_Nm,"
    "effort_rms_share,effort_max_share,effort_now_rms_share\n";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string join(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : ",") + cell;
  return text;
}

/// The rows of one stream.
class Rows {
 public:
  explicit Rows(const Stream& stream) : rate_(stream.rate) {
    const Encoder& encoder = *stream.encoder;
    stream_ = join({std::to_string(stream.rate), stream.motion->name,
                    number(stream.motion->highestFrequency()), encoder.name,
                    std::to_string(static_cast<int>(encoder.counts)), number(encoder.gear),
                    number(encoder.noise), kVelocityNames[static_cast<int>(stream.velocity)],
                    kStampingNames[static_cast<int>(stream.stamping)]});
  }

  void add(const std::string& method, int window, int order, int lag, const Errors& errors) {
    text_ += join({stream_, method, std::to_string(window), std::to_string(order),
                   std::to_string(lag), number(1000.0 * lag / rate_)});
    for (const Size* size : {&errors.qd, &errors.qdd, &errors.effort, &errors.share})
      text_ += "," + number(size->rms()) + "," + number(size->largest);
    text_ += "," + number(errors.share_now.rms()) + "\n";
  }

  const std::string& text() const { return text_; }

 private:
  int rate_;
  std::string stream_;  // the cells that all rows share
  std::string text_;
};

/// Methods: default (the estimator's own settings), least_squares (all others), differences,
/// zero_acceleration (the estimator switched off) and motion_itself (no errors: the motion).
std::string runStream(const Mechanism& mechanism, const InverseDynamics& dynamics,
                      const Stream& stream, const Extent& extent) {
  Trial trial(mechanism, dynamics, stream, extent);
  Rows rows(stream);
  EstimatorSettings settings;
  rows.add("default", settings.window, settings.order, settings.lag, trial.runEstimator(settings));
  for (const int window : extent.windows) {
    const int middle = (window - 1) / 2;
    std::vector<int> lags;
    for (const int lag : extent.lags)
      if (lag < middle) lags.push_back(lag);
    lags.push_back(middle);
    for (const int order : extent.orders) {
      if (order >= window) continue;
      for (const int lag : lags) {
        settings.window = window;
        settings.order = order;
        settings.lag = lag;
        rows.add("least_squares", window, order, lag, trial.runEstimator(settings));
      }
    }
  }
  if (stream.velocity == VelocitySource::kNone)
    rows.add("differences", 3, 2, 1, trial.runDifferences());
  settings.estimate = false;
  rows.add("zero_acceleration", 1, 0, 0, trial.runEstimator(settings));
  if (stream.encoder == &kExactEncoder && stream.velocity == VelocitySource::kNone &&
      stream.stamping == Stamping::kTrue)
    rows.add("motion_itself", 1, 0, 0, trial.sizeOfMotion());
  return rows.text();
}

/// All combinations, except that exact velocities and stamps other than true come with the brisk
/// motion only, and the latter with two encoders.
std::vector<Stream> allStreams(const Extent& extent) {
  std::vector<Stream> streams;
  for (const int rate : extent.rates) {
    for (const VelocitySource velocity :
         {VelocitySource::kNone, VelocitySource::kDifferences, VelocitySource::kExact}) {
      for (const ArmMotion* motion : extent.motions) {
        if (velocity == VelocitySource::kExact && motion != &kBrisk) continue;
        for (const Encoder& encoder : kEncoders)
          streams.push_back({rate, motion, &encoder, velocity, Stamping::kTrue});
      }
      for (const Encoder* encoder : {&kExactEncoder, &kOpticalEncoder})
        for (const Stamping stamping : {Stamping::kUneven, Stamping::kWrong})
          streams.push_back({rate, &kBrisk, encoder, velocity, stamping});
    }
  }
  return streams;
}

void run(const std::string& path, const Extent& extent) {
  const Mechanism mechanism = readUrdfFile(VWD_SOURCE_DIR "/urdf/six_axis_arm.urdf");
  const InverseDynamics dynamics(mechanism, Scene(), Request());
  const std::vector<Stream> streams = allStreams(extent);
  OutputFile file(path);
  file.write(kHeader);
  {
    Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      progress.update(i, streams.size());
      file.write(runStream(mechanism, dynamics, streams[i], extent));
    }
  }
  file.commit();
}

}  // namespace

int main(int argc, char** argv) {
  std::string output;
  bool quick = false;
  return runProgram("estimator_error", kHelp, argc, argv,
                    {text("--output", output), flag("--quick", quick)}, [&] {
                      run(output, quick ? quickExtent() : Extent());
                      return 0;
                    });
}
