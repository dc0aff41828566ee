#include "ros/effort_output.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "ros/delivered_efforts.h"
#include "ros/message_copies.h"

namespace virtual_work_dynamics {
namespace {

class EffortMessage : public MessageOf<sensor_msgs::JointState> {
 public:
  EffortMessage(const Dynamics& plan, const std::string& frame,
                std::shared_ptr<ThresholdRecord> limits)
      : names_(namesOf(plan)),
        limits_(std::move(limits)),
        values_(static_cast<std::size_t>(plan.coordinates())),
        delivered_(deliveredEfforts(plan)) {
    for (std::size_t i = 0; i < delivered_.size(); ++i) {
      if (plan.residuals()[i]) undelivered_.push_back(static_cast<Eigen::Index>(i));
    }
    message_.header.frame_id = frame;
    message_.name = names_;
    for (auto* values : {&message_.position, &message_.velocity, &message_.effort}) {
      values->resize(names_.size());
    }
  }

  void fill(const OutputSample& sample) override {
    message_.header.stamp = timeOf(sample.stamp_ns);
    const bool as_before = allExist(sample.results) && message_.name.size() == names_.size();
    if (!as_before) message_.name.clear();
    message_.position.clear();
    message_.velocity.clear();
    message_.effort.clear();
    const std::size_t efforts = names_.size() - undelivered_.size();
    for (std::size_t i = 0; i < efforts; ++i) {
      if (!sample.results.effortExists(i)) continue;
      if (!as_before) message_.name.push_back(names_[i]);
      const auto index = static_cast<Eigen::Index>(i);
      const Eigen::Index closure = index - sample.motion.q.size();
      const LoopResults& loops = sample.results.loops;
      message_.position.push_back(closure < 0 ? sample.motion.q[index]
                                              : loops.actuated_positions[closure]);
      message_.velocity.push_back(closure < 0 ? sample.motion.qd[index]
                                              : loops.actuated_velocities[closure]);
      message_.effort.push_back(sample.results.effort[index]);
    }
    for (std::size_t i = 0; i < undelivered_.size(); ++i) {
      if (!as_before) message_.name.push_back(names_[efforts + i]);
      message_.position.push_back(sample.motion.q[undelivered_[i]]);
      message_.velocity.push_back(sample.motion.qd[undelivered_[i]]);
      message_.effort.push_back(0);
    }
    if (limits_) recordLimits(sample);
  }

 private:
  // Joints of which nothing delivers the effort come again under their own names, without one: tf
  // follows these.
  static std::vector<std::string> namesOf(const Dynamics& plan) {
    std::vector<std::string> names = plan.effortNames();
    for (std::size_t i = 0; i < plan.residuals().size(); ++i) {
      if (plan.residuals()[i]) names.push_back(names[i].substr(std::strlen(kMotionResidual)));
    }
    return names;
  }

  bool allExist(const Results& results) const {
    const std::vector<bool>& exists = results.loops.effort_exists;
    return std::find(exists.begin(), exists.end(), false) == exists.end();
  }

  void recordLimits(const OutputSample& sample) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = delivered_[i] && sample.results.effortExists(i)
                       ? sample.results.effort[static_cast<Eigen::Index>(i)]
                       : std::numeric_limits<double>::quiet_NaN();
    }
    limits_->record(sample.stamp_ns, values_);
  }

  const std::vector<std::string> names_;  // all names; the message has those of existing results
  const std::shared_ptr<ThresholdRecord> limits_;
  std::vector<double> values_;  // of the coordinates
  const std::vector<bool> delivered_;
  std::vector<Eigen::Index> undelivered_;  // coordinates whose efforts are residuals
};

class EffortOutput : public Output {
 public:
  EffortOutput(std::string frame, std::shared_ptr<ThresholdRecord> limits)
      : frame_(std::move(frame)), limits_(std::move(limits)) {}

  std::string topic() const override { return "effort"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<sensor_msgs::JointState>(topic, queue, {}, {},
                                                                  ros::VoidConstPtr(), nullptr);
  }
  void addTo(Request& request) const override { request.efforts = true; }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<EffortMessage>(plan, frame_, limits_);
  }
  bool isAlwaysComputed() const override { return limits_ != nullptr; }

 private:
  std::string frame_;
  std::shared_ptr<ThresholdRecord> limits_;
};

}  // namespace

std::unique_ptr<Output> makeEffortOutput(const std::string& frame,
                                         std::shared_ptr<ThresholdRecord> limits) {
  return std::make_unique<EffortOutput>(frame, std::move(limits));
}

}  // namespace virtual_work_dynamics
