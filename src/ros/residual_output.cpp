#include "ros/residual_output.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ros/delivered_efforts.h"
#include "ros/message_copies.h"
#include "virtual_work_dynamics/momentum_observer.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

// Names and external efforts; those that are not known are left out.
class ExternalEfforts : public MessageOf<sensor_msgs::JointState> {
 public:
  ExternalEfforts(Names names, const std::string& frame,
                  std::shared_ptr<EffortMeasurements> efforts,
                  std::shared_ptr<ThresholdRecord> record, bool observes)
      : names_(std::move(names)),
        efforts_(std::move(efforts), observes),
        record_(std::move(record)),
        values_(names_.size(), std::numeric_limits<double>::quiet_NaN()) {
    message_.header.frame_id = frame;
    message_.name.reserve(names_.size());
    message_.effort.reserve(names_.size());
    exists_ = false;
  }

 protected:
  // Writes values_.
  void write(std::int64_t stamp_ns) {
    message_.header.stamp = timeOf(stamp_ns);
    std::size_t known = 0;
    for (const double value : values_) known += std::isfinite(value) ? 1 : 0;
    const bool as_before = known == names_.size() && message_.name.size() == known;
    if (!as_before) message_.name.clear();
    message_.effort.clear();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (!std::isfinite(values_[i])) continue;
      if (!as_before) message_.name.push_back(names_[i]);
      message_.effort.push_back(values_[i]);
    }
    exists_ = known > 0;
    if (record_) record_->record(stamp_ns, values_);
  }

  const Names names_;
  const EffortMeasurements::User efforts_;
  const std::shared_ptr<ThresholdRecord> record_;
  std::vector<double> values_;  // by coordinate; NaN: not known
};

class ResidualMessage : public ExternalEfforts {
 public:
  ResidualMessage(const Dynamics& plan, const std::string& frame,
                  std::shared_ptr<EffortMeasurements> efforts,
                  std::shared_ptr<ThresholdRecord> record)
      : ExternalEfforts(
            {plan.effortNames().begin(), plan.effortNames().begin() + plan.coordinates()}, frame,
            std::move(efforts), std::move(record), false),
        delivered_(deliveredEfforts(plan)) {}

  void fill(const OutputSample& sample) override {
    exists_ = false;
    if (!sample.measured) return;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = std::numeric_limits<double>::quiet_NaN();
      if (!delivered_[i] || !sample.results.effortExists(i)) continue;
      values_[i] =
          sample.results.effort[static_cast<Eigen::Index>(i)] - efforts_->at(i, sample.stamp_ns);
    }
    write(sample.stamp_ns);
  }

 private:
  const std::vector<bool> delivered_;
};

class ResidualOutput : public Output {
 public:
  ResidualOutput(std::string frame, std::shared_ptr<EffortMeasurements> efforts,
                 std::shared_ptr<ThresholdRecord> record)
      : frame_(std::move(frame)), efforts_(std::move(efforts)), record_(std::move(record)) {}

  std::string topic() const override { return "residual"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<sensor_msgs::JointState>(topic, queue, {}, {},
                                                                  ros::VoidConstPtr(), nullptr);
  }
  bool ofMeasuredEfforts() const override { return true; }
  bool isAlwaysComputed() const override { return record_ != nullptr; }
  void addTo(Request& request) const override { request.efforts = true; }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<ResidualMessage>(plan, frame_, efforts_, record_);
  }

 private:
  const std::string frame_;
  const std::shared_ptr<EffortMeasurements> efforts_;
  const std::shared_ptr<ThresholdRecord> record_;
};

// The momentum observer and what it has seen. The computing thread alone uses it; the plans that it
// goes through have it one after the other.
class Observation {
 public:
  Observation(const Mechanism& mechanism, const Scene& scene, double gain, double max_gap)
      : max_gap_ns_(std::llround(std::min(max_gap, 1e9) * 1e9)),
        observer_(mechanism, scene, gain),
        load_(scene),
        motion_(static_cast<Eigen::Index>(mechanism.coordinates().size())),
        measured_(motion_.q) {}

  // Takes the newest joint state, unless it has been taken.
  bool take(const EffortMeasurements::Latest& latest) {
    if (latest.stamp_ns == EffortMeasurements::kNever) return false;
    if (started_ && latest.stamp_ns == latest_ns_) return false;
    known_ = read(latest);
    if (known_) step(latest.stamp_ns);
    return true;
  }

  // The external effort after what was taken last; NaN: not known.
  double external(std::size_t coordinate) const {
    return known_ ? observer_.external()[static_cast<Eigen::Index>(coordinate)]
                  : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  // Returns whether the position and the velocity of every joint are known.
  bool read(const EffortMeasurements::Latest& latest) {
    for (std::size_t i = 0; i < latest.q.size(); ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      motion_.q[index] = latest.q[i];
      // A joint whose driver has stopped is held where it was, and its effort is no longer known.
      const bool held = latest.stamps_ns[i] < latest.stamp_ns - max_gap_ns_;
      motion_.qd[index] = held ? 0 : latest.qd[i];
      measured_[index] = held ? std::numeric_limits<double>::quiet_NaN() : latest.effort[i];
    }
    return motion_.q.allFinite() && motion_.qd.allFinite();
  }

  void step(std::int64_t stamp_ns) {
    const std::int64_t length = started_ ? stamp_ns - latest_ns_ : 0;
    if (!started_ || length < 0 || length > max_gap_ns_) {
      observer_.restart();
      begin_ns_ = stamp_ns;
    }
    started_ = true;
    latest_ns_ = stamp_ns;
    // From the beginning, as a double has no room for today's nanoseconds.
    observer_.step(static_cast<double>(stamp_ns - begin_ns_) / 1e9, motion_, load_, measured_);
  }

  const std::int64_t max_gap_ns_;
  MomentumObserver observer_;
  const Load load_;
  Motion motion_;
  Eigen::VectorXd measured_;
  std::int64_t begin_ns_ = 0, latest_ns_ = 0;
  bool started_ = false, known_ = false;
};

class ObservedMessage : public ExternalEfforts {
 public:
  ObservedMessage(Names names, const std::string& frame,
                  std::shared_ptr<EffortMeasurements> efforts,
                  std::shared_ptr<ThresholdRecord> record, std::shared_ptr<Observation> observation)
      : ExternalEfforts(std::move(names), frame, std::move(efforts), std::move(record), true),
        observation_(std::move(observation)) {}

  // Takes the newest joint state, which is ahead of the sample.
  void fill(const OutputSample& sample) override {
    const EffortMeasurements::Latest& latest = efforts_->latest();
    exists_ = false;
    if (!sample.measured || !observation_->take(latest)) return;
    for (std::size_t i = 0; i < names_.size(); ++i) values_[i] = observation_->external(i);
    write(latest.stamp_ns);
  }

 private:
  const std::shared_ptr<Observation> observation_;
};

// Whether an observer may go on in another scene: what changes while the node runs is as before.
bool haveEqualLoads(const Scene& a, const Scene& b) {
  return a.gravity == b.gravity &&
         std::equal(a.payloads.begin(), a.payloads.end(), b.payloads.begin(), b.payloads.end(),
                    [](const Payload& one, const Payload& other) {
                      return one.link == other.link && one.mass == other.mass &&
                             one.at == other.at && one.inertia == other.inertia;
                    });
}

class ExternalEffortOutput : public Output {
 public:
  ExternalEffortOutput(const Mechanism& mechanism, std::string frame, double gain, double max_gap,
                       std::shared_ptr<EffortMeasurements> efforts,
                       std::shared_ptr<ThresholdRecord> record)
      : mechanism_(mechanism),
        frame_(std::move(frame)),
        gain_(gain),
        max_gap_(max_gap),
        efforts_(std::move(efforts)),
        record_(std::move(record)) {}

  std::string topic() const override { return "external_effort"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<sensor_msgs::JointState>(topic, queue, {}, {},
                                                                  ros::VoidConstPtr(), nullptr);
  }
  bool ofMeasuredEfforts() const override { return true; }
  bool isAlwaysComputed() const override { return record_ != nullptr; }
  void addTo(Request&) const override {}
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics&, const Scene& scene) const override {
    if (!observation_ || !haveEqualLoads(scene, observed_scene_)) {
      observation_ = std::make_shared<Observation>(mechanism_, scene, gain_, max_gap_);
      observed_scene_ = scene;
    }
    return std::make_unique<ObservedMessage>(mechanism_.coordinateNames(), frame_, efforts_,
                                             record_, observation_);
  }

 private:
  const Mechanism mechanism_;
  const std::string frame_;
  const double gain_, max_gap_;
  const std::shared_ptr<EffortMeasurements> efforts_;
  const std::shared_ptr<ThresholdRecord> record_;
  // One for all plans of equal loads, so that a new plan does not begin anew. Only the compiling
  // thread uses these two.
  mutable std::shared_ptr<Observation> observation_;
  mutable Scene observed_scene_;
};

}  // namespace

std::unique_ptr<Output> makeResidualOutput(const std::string& frame,
                                           std::shared_ptr<EffortMeasurements> efforts,
                                           std::shared_ptr<ThresholdRecord> record) {
  return std::make_unique<ResidualOutput>(frame, std::move(efforts), std::move(record));
}

std::unique_ptr<Output> makeExternalEffortOutput(const Mechanism& mechanism,
                                                 const std::string& frame, double gain,
                                                 double max_gap,
                                                 std::shared_ptr<EffortMeasurements> efforts,
                                                 std::shared_ptr<ThresholdRecord> record) {
  return std::make_unique<ExternalEffortOutput>(mechanism, frame, gain, max_gap, std::move(efforts),
                                                std::move(record));
}

}  // namespace virtual_work_dynamics
