// How soon a push at the tool of a simulated arm is seen in measured efforts, and how often noise
// alone looks like one: by the residual of the estimated motion, and by the momentum observer.
//
// The six-axis arm swings without end. Joint states come at 500 Hz, their stamps jitter by 0.2 ms
// (standard deviation); encoders have 17 bits a revolution, velocities white noise of 0.01 rad/s,
// efforts of 0.2 % of the joint's limit. A threshold is 6 times the rms of a minute without a push,
// and must be exceeded for the hold time. Pushes of 20 N for 0.4 s act on the tool in directions
// and at instants of chance; a push is seen late by the time from its beginning to the joint state
// that shows it.
//
// Usage: collision_detection URDF [MINUTES [PUSHES [GAIN]]]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "robot/effort_limits.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/momentum_observer.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace {

using namespace virtual_work_dynamics;

constexpr double kRate = 500;            // Hz
constexpr double kJitter = 2e-4;         // s
constexpr double kVelocityNoise = 0.01;  // rad/s
constexpr double kEffortNoise = 0.002;   // of the limit
constexpr double kCount = 6.283185307179586 / 131072;
constexpr double kForce = 20, kPushed = 0.4, kEvery = 3;  // N, s, s
constexpr double kThreshold = 6;                          // rms of a minute
constexpr std::array<double, 3> kHolds{0, 0.01, 0.02};    // s

Scene sceneOf(bool pushed) {
  Scene scene;
  scene.reactions = ReactionSelection::kNone;
  if (!pushed) return scene;
  AppliedWrench push;
  push.link = "wrist_3";
  push.axes = Axes::kRoot;
  push.force = {1, 0, 0};
  scene.applied_wrenches = {push};
  return scene;
}

// The arm and what its drivers say of it.
class Arm {
 public:
  Arm(const std::string& urdf, unsigned seed)
      : mechanism(readUrdf(urdf)),
        dynamics_(mechanism, sceneOf(true)),
        workspace_(dynamics_.makeWorkspace()),
        load_(sceneOf(true)),
        limits_(effortLimits(mechanism)),
        random_(seed),
        motion_(dynamics_.coordinates()) {}

  // The state of an instant, with the effort of motors that hold against a force at the tool.
  void sample(double t, const Eigen::Vector3d& force) {
    static const double kSizes[] = {0.9, 0.5, 0.6, 0.7, 0.6, 0.9};
    static const double kMiddles[] = {0, -1.1, 1.2, -0.4, 0.8, 0};
    for (Eigen::Index i = 0; i < motion_.q.size(); ++i) {
      const double w = 0.9 + 0.37 * static_cast<double>(i), a = kSizes[i];
      motion_.q[i] = kMiddles[i] + a * std::sin(w * t) + 0.1 * a * std::sin(3.3 * w * t);
      motion_.qd[i] = a * w * (std::cos(w * t) + 0.33 * std::cos(3.3 * w * t));
      motion_.qdd[i] = -a * w * w * (std::sin(w * t) + 1.089 * std::sin(3.3 * w * t));
    }
    load_.wrenches[0].force = force;
    dynamics_.compute(motion_, load_, workspace_);
    stamp_ns = std::llround((t + kJitter * normal_(random_)) * 1e9) + 1000000000;
    q.resize(6);
    qd.resize(6);
    effort.resize(6);
    for (Eigen::Index i = 0; i < 6; ++i) {
      q[i] = kCount * std::round(motion_.q[i] / kCount);
      qd[i] = motion_.qd[i] + kVelocityNoise * normal_(random_);
      effort[i] = workspace_.results().effort[i] +
                  kEffortNoise * limits_[static_cast<std::size_t>(i)] * normal_(random_);
    }
  }

  Eigen::Vector3d direction() {
    Eigen::Vector3d d(normal_(random_), normal_(random_), normal_(random_));
    return d.normalized();
  }
  double chance() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  const Mechanism mechanism;
  std::int64_t stamp_ns = 0;
  Eigen::VectorXd q, qd, effort;

 private:
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
  Load load_;
  std::vector<double> limits_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Motion motion_;
};

// Watches external efforts: first their rms, then thresholds.
class Alarm {
 public:
  void learn(const Eigen::VectorXd& external) {
    if (squares_.size() == 0) squares_.setZero(external.size());
    squares_ += external.cwiseAbs2();
    ++count_;
  }
  void arm() { thresholds_ = kThreshold * (squares_ / count_).cwiseSqrt(); }
  const Eigen::VectorXd& thresholds() const { return thresholds_; }

  // Whether an alarm begins, for each hold time.
  std::array<bool, kHolds.size()> begins(double t, const Eigen::VectorXd& external) {
    std::array<bool, kHolds.size()> begins{};
    since_.resize(static_cast<std::size_t>(external.size()), -1);
    std::array<bool, kHolds.size()> now{};
    for (Eigen::Index i = 0; i < external.size(); ++i) {
      double& since = since_[static_cast<std::size_t>(i)];
      if (!(std::abs(external[i]) > thresholds_[i]))
        since = -1;
      else if (since < 0)
        since = t;
      for (std::size_t h = 0; h < kHolds.size(); ++h) {
        now[h] = now[h] || (since >= 0 && t - since >= kHolds[h] - 1e-9);
      }
    }
    for (std::size_t h = 0; h < kHolds.size(); ++h) {
      begins[h] = now[h] && !on_[h];
      on_[h] = now[h];
    }
    return begins;
  }

 private:
  Eigen::VectorXd squares_, thresholds_;
  double count_ = 0;
  std::vector<double> since_;
  std::array<bool, kHolds.size()> on_{};
};

// Both estimates, as the node makes them.
class Watch {
 public:
  Watch(Arm& arm, double gain)
      : arm_(arm),
        dynamics_(arm.mechanism, sceneOf(false)),
        workspace_(dynamics_.makeWorkspace()),
        estimator_(arm.mechanism, EstimatorSettings()),
        observer_(arm.mechanism, sceneOf(false), gain),
        motion_(6),
        observed_(6) {}

  // Takes the newest joint state. The residual comes behind it.
  template <typename Residual, typename Observed>
  void take(Residual residual, Observed observed) {
    static const int kAll[] = {0, 1, 2, 3, 4, 5};
    efforts_[arm_.stamp_ns] = arm_.effort;
    if (efforts_.size() > 200) efforts_.erase(efforts_.begin());
    estimator_.push(arm_.stamp_ns, kAll, arm_.q.data(), arm_.qd.data(), 6);
    while (estimator_.ready()) {
      const std::int64_t stamp = estimator_.evaluate(motion_, nullptr);
      const auto later = efforts_.upper_bound(stamp);
      if (later == efforts_.begin() || later == efforts_.end()) continue;
      const auto before = std::prev(later);
      const double share = static_cast<double>(stamp - before->first) /
                           static_cast<double>(later->first - before->first);
      dynamics_.compute(motion_, workspace_);
      residual(Eigen::VectorXd(workspace_.results().effort - before->second -
                               share * (later->second - before->second)));
    }
    if (arm_.stamp_ns <= latest_) return;
    latest_ = arm_.stamp_ns;
    observed_.q = arm_.q;
    observed_.qd = arm_.qd;
    observer_.step(static_cast<double>(arm_.stamp_ns) / 1e9, observed_, Load(), arm_.effort);
    observed(observer_.external());
  }

 private:
  Arm& arm_;
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
  MotionEstimator estimator_;
  MomentumObserver observer_;
  Motion motion_, observed_;
  std::map<std::int64_t, Eigen::VectorXd> efforts_;
  std::int64_t latest_ = 0;
};

struct Seen {
  std::array<int, kHolds.size()> alarms{};
  std::array<std::vector<double>, kHolds.size()> delays;
};

void print(const char* name, const Alarm& alarm, const Seen& seen, double minutes, int pushes) {
  std::printf("%s, thresholds", name);
  for (Eigen::Index i = 0; i < 6; ++i) std::printf(" %.2f", alarm.thresholds()[i]);
  std::printf(" N m\n");
  for (std::size_t h = 0; h < kHolds.size(); ++h) {
    std::vector<double> delays = seen.delays[h];
    std::sort(delays.begin(), delays.end());
    std::printf("  hold %2.0f ms: %d false alarms in %.0f min; %zu of %d pushes seen",
                1e3 * kHolds[h], seen.alarms[h], minutes, delays.size(), pushes);
    if (!delays.empty()) {
      std::printf(", after %.1f ms (median), %.1f ms (90 %%), %.1f ms (worst)",
                  1e3 * delays[delays.size() / 2], 1e3 * delays[delays.size() * 9 / 10],
                  1e3 * delays.back());
    }
    std::printf("\n");
  }
}

void run(const std::string& path, double minutes, int pushes, double gain) {
  constexpr double kStarts = 10, kLearns = 60;  // s
  Arm arm(readTextFile(path, std::size_t{1} << 28), 1);
  Watch watch(arm, gain);
  Alarm alarms[2];
  Seen seen[2];
  const double armed = kStarts + kLearns, pushed = armed + 60 * minutes;
  Eigen::Vector3d force(0, 0, 0);
  double push = pushed + 1;
  std::array<bool, kHolds.size()> found[2] = {};
  int number = 0;
  const auto take = [&](std::size_t which, double t, const Eigen::VectorXd& external) {
    if (t < kStarts) return;
    if (t < armed) return alarms[which].learn(external);
    if (alarms[which].thresholds().size() == 0) alarms[which].arm();
    const auto begins = alarms[which].begins(t, external);
    for (std::size_t h = 0; h < kHolds.size(); ++h) {
      if (!begins[h]) continue;
      if (t < pushed) ++seen[which].alarms[h];
      if (t < push || t > push + kPushed + 0.2 || found[which][h]) continue;
      found[which][h] = true;
      seen[which].delays[h].push_back(t - push);
    }
  };
  for (std::int64_t i = 0; number < pushes || i / kRate < pushed; ++i) {
    const double t = static_cast<double>(i) / kRate;
    const bool now = t >= push && t < push + kPushed;
    if (now && force.isZero()) force = kForce * arm.direction();
    if (!now && !force.isZero()) force.setZero();
    if (t > push + kEvery / 2) {
      push += kEvery * (1 + 0.3 * arm.chance());
      found[0] = found[1] = {};
      ++number;
    }
    arm.sample(t, force);
    watch.take([&](const Eigen::VectorXd& external) { take(0, t, external); },
               [&](const Eigen::VectorXd& external) { take(1, t, external); });
  }
  std::printf("20 N at the tool, %.0f Hz\n", kRate);
  print("residual, 50 ms behind", alarms[0], seen[0], minutes, pushes);
  std::printf("gain %.0f 1/s: ", gain);
  print("observer", alarms[1], seen[1], minutes, pushes);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 5) {
    std::fprintf(stderr, "usage: collision_detection URDF [MINUTES [PUSHES [GAIN]]]\n");
    return 2;
  }
  const auto number = [&](int i, double fallback) {
    return argc > i ? std::atof(argv[i]) : fallback;
  };
  try {
    run(argv[1], number(2, 60), static_cast<int>(number(3, 100)), number(4, 25));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "collision_detection: %s\n", error.what());
    return 1;
  }
  return 0;
}
