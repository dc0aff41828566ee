#include "ros/trajectory_output.h"

#include <limits>
#include <string>
#include <vector>

namespace virtual_work_dynamics {
namespace {

class TrajectoryMessage : public MessageOf<trajectory_msgs::JointTrajectory> {
 public:
  explicit TrajectoryMessage(const Dynamics& plan) : coordinates_(plan.coordinates()) {
    for (Eigen::Index i = 0; i < coordinates_; ++i) {
      is_residual_.push_back(plan.residuals()[static_cast<std::size_t>(i)]);
    }
  }

  void begin(const trajectory_msgs::JointTrajectory& message,
             const TrajectoryMotion& motion) override {
    input_ = &message;
    motion_ = &motion;
    efforts_.resize(static_cast<Eigen::Index>(message.points.size()), coordinates_);
    filled_ = 0;
    exists_ = false;
  }

  void fill(const OutputSample& sample) override {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index i = 0; i < coordinates_; ++i) {
      const auto place = static_cast<std::size_t>(i);
      const bool exists = sample.results.effortExists(place);
      efforts_(filled_, i) = is_residual_[place] ? 0 : exists ? sample.results.effort[i] : kNothing;
    }
    // The message is published complete or not at all.
    exists_ = ++filled_ == efforts_.rows();
    if (exists_) message_ = withEfforts(*input_, *motion_, efforts_);
  }

 private:
  const Eigen::Index coordinates_;
  std::vector<bool> is_residual_;  // by coordinate
  const trajectory_msgs::JointTrajectory* input_ = nullptr;
  const TrajectoryMotion* motion_ = nullptr;
  Eigen::MatrixXd efforts_;  // by point
  Eigen::Index filled_ = 0;
};

class TrajectoryOutput : public Output {
 public:
  std::string topic() const override { return "joint_trajectory"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<trajectory_msgs::JointTrajectory>(
        topic, queue, {}, {}, ros::VoidConstPtr(), nullptr);
  }
  bool ofTrajectories() const override { return true; }
  void addTo(Request& request) const override { request.efforts = true; }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<TrajectoryMessage>(plan);
  }
};

}  // namespace

std::unique_ptr<Output> makeTrajectoryOutput() {
  return std::make_unique<TrajectoryOutput>();
}

}  // namespace virtual_work_dynamics
