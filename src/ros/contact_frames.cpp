#include "ros/contact_frames.h"

#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "ros/message_copies.h"
#include "scene/closure_types.h"

namespace virtual_work_dynamics {
namespace {

class ContactFramesMessage : public MessageOf<tf2_msgs::TFMessage> {
 public:
  ContactFramesMessage(const Dynamics& plan, const std::vector<std::string>& contacts,
                       const std::string& root_frame, const std::string& frame_prefix, double rate)
      : period_ns_(static_cast<std::int64_t>(1e9 / rate)) {
    exists_ = false;
    const std::vector<std::string>& all = plan.request().root_axes;
    for (const std::string& contact : contacts) {
      places_.push_back(
          static_cast<std::size_t>(std::find(all.begin(), all.end(), contact) - all.begin()));
      message_.transforms.emplace_back();
      message_.transforms.back().header.frame_id = root_frame;
      message_.transforms.back().child_frame_id = frame_prefix + contact;
    }
  }

  // What is planned is not where the robot is, and tf would take it for that.
  void fill(const OutputSample& sample) override {
    exists_ = false;
    if (!sample.measured) return;
    const std::int64_t now = sample.stamp_ns;
    if (latest_ns_ && now >= *latest_ns_ && now - *latest_ns_ < period_ns_) return;
    exists_ = true;
    latest_ns_ = now;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      message_.transforms[i].header.stamp = timeOf(sample.stamp_ns);
      copyPose(sample.results.poses[places_[i]], message_.transforms[i].transform);
    }
  }

 private:
  const std::int64_t period_ns_;  // of the samples' stamps
  std::optional<std::int64_t> latest_ns_;
  std::vector<std::size_t> places_;
};

class ContactFramesOutput : public Output {
 public:
  ContactFramesOutput(std::vector<std::string> contacts, std::string root_frame,
                      std::string frame_prefix, double rate)
      : contacts_(std::move(contacts)),
        root_frame_(std::move(root_frame)),
        frame_prefix_(std::move(frame_prefix)),
        rate_(rate) {}

  std::string topic() const override { return "/tf"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<tf2_msgs::TFMessage>(topic, queue, {}, {},
                                                              ros::VoidConstPtr(), nullptr);
  }
  void addTo(Request& request) const override {
    for (const std::string& contact : contacts_) {
      std::vector<std::string>& names = request.root_axes;
      if (std::find(names.begin(), names.end(), contact) == names.end()) names.push_back(contact);
    }
    request.poses = true;
  }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
    return std::make_unique<ContactFramesMessage>(plan, contacts_, root_frame_, frame_prefix_,
                                                  rate_);
  }

 private:
  const std::vector<std::string> contacts_;
  const std::string root_frame_, frame_prefix_;
  const double rate_;
};

}  // namespace

std::vector<std::string> movingContacts(const Scene& scene,
                                        const std::vector<std::string>& reactions) {
  std::vector<std::string> contacts;
  for (const Closure& closure : scene.closures) {
    const bool shown =
        std::find(reactions.begin(), reactions.end(), closure.name) != reactions.end();
    const bool elsewhere =
        std::any_of(scene.moments_about.begin(), scene.moments_about.end(),
                    [&](const MomentPoint& point) { return point.name == closure.name; });
    if (shown && !elsewhere && traitsOf(closure.type).touches()) contacts.push_back(closure.name);
  }
  return contacts;
}

std::unique_ptr<Output> makeContactFrames(std::vector<std::string> contacts,
                                          const std::string& root_frame,
                                          const std::string& frame_prefix, double rate) {
  return std::make_unique<ContactFramesOutput>(std::move(contacts), root_frame, frame_prefix, rate);
}

}  // namespace virtual_work_dynamics
