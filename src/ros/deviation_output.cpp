#include "ros/deviation_output.h"

#include <sensor_msgs/JointState.h>

#include <cmath>
#include <utility>
#include <vector>

#include "ros/message_copies.h"
#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {
namespace {

// Writes names and efforts; those without a deviation are left out.
class JointDeviations : public MessageOf<sensor_msgs::JointState> {
 public:
  JointDeviations(const Mechanism& mechanism, const Scene& scene, const std::string& frame)
      : deviations_(mechanism, scene, Request()), workspace_(deviations_.makeWorkspace()) {
    message_.header.frame_id = frame;
    message_.name.reserve(deviations_.effortNames().size());
    message_.effort.reserve(deviations_.effortNames().size());
  }

 protected:
  void write(std::int64_t stamp_ns, const Eigen::VectorXd& deviations) {
    message_.header.stamp = timeOf(stamp_ns);
    const std::vector<std::string>& names = deviations_.effortNames();
    const bool as_before = deviations.allFinite() && message_.name.size() == names.size();
    if (!as_before) message_.name.clear();
    message_.effort.clear();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double deviation = deviations[static_cast<Eigen::Index>(i)];
      if (!std::isfinite(deviation)) continue;
      if (!as_before) message_.name.push_back(names[i]);
      message_.effort.push_back(deviation);
    }
  }

  const Deviations deviations_;
  Deviations::Workspace workspace_;
};

class MotionDeviations : public JointDeviations {
 public:
  MotionDeviations(const Mechanism& mechanism, const Scene& scene, const std::string& frame,
                   std::shared_ptr<DeviationRecord> record)
      : JointDeviations(mechanism, scene, frame), record_(std::move(record)) {}

  void fill(const OutputSample& sample) override {
    exists_ = sample.covariance != nullptr;
    if (!exists_) return;
    if (sample.law) {
      deviations_.computeMotion(sample.motion, *sample.covariance, *sample.law, workspace_);
    } else {
      deviations_.computeMotion(sample.motion, *sample.covariance, workspace_);
    }
    if (deviations_.hasTolerances()) deviations_.computeDescription(sample.motion, workspace_);
    record_->record(sample.results.effort, workspace_, deviations_.hasTolerances());
    write(sample.stamp_ns, workspace_.motion().effort);
  }

 private:
  std::shared_ptr<DeviationRecord> record_;
};

class DescriptionDeviations : public JointDeviations {
 public:
  using JointDeviations::JointDeviations;

  void fill(const OutputSample& sample) override {
    deviations_.computeDescription(sample.motion, workspace_);
    write(sample.stamp_ns, workspace_.description().effort);
  }
};

class JointDeviationOutput : public Output {
 public:
  JointDeviationOutput(const Mechanism& mechanism, std::string frame,
                       std::shared_ptr<DeviationRecord> record)
      : mechanism_(mechanism), frame_(std::move(frame)), record_(std::move(record)) {}

  std::string topic() const override { return record_ ? "effort_deviation" : "effort_tolerance"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<sensor_msgs::JointState>(topic, queue, {}, {},
                                                                  ros::VoidConstPtr(), nullptr);
  }
  bool ofDeviations() const override { return true; }
  bool usesCovariance() const override { return record_ != nullptr; }
  void addTo(Request& request) const override { request.efforts = true; }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics&, const Scene& scene) const override {
    if (!record_) return std::make_unique<DescriptionDeviations>(mechanism_, scene, frame_);
    return std::make_unique<MotionDeviations>(mechanism_, scene, frame_, record_);
  }

 private:
  const Mechanism mechanism_;
  const std::string frame_;
  const std::shared_ptr<DeviationRecord> record_;  // none: of tolerances
};

}  // namespace

std::unique_ptr<Output> makeDeviationOutput(const Mechanism& mechanism, const std::string& frame,
                                            std::shared_ptr<DeviationRecord> record) {
  return std::make_unique<JointDeviationOutput>(mechanism, frame, std::move(record));
}

std::unique_ptr<Output> makeToleranceOutput(const Mechanism& mechanism, const std::string& frame) {
  return std::make_unique<JointDeviationOutput>(mechanism, frame, nullptr);
}

}  // namespace virtual_work_dynamics
