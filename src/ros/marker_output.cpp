#include "ros/marker_output.h"

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "base/number_text.h"
#include "dynamics/model_view.h"
#include "ros/message_copies.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

// Of the model's size: diameters of an arrow's shaft and head.
constexpr double kShaft = 0.0045, kHead = 0.009;
// Where the legend begins in the picture, from its centre, of the model's size.
constexpr double kLeft = 0.6, kBelow = 0.38, kStep = 0.06;
// What is smaller than this part of the largest value at the start is shown as 0.
constexpr double kNothing = 1e-4;

std_msgs::ColorRGBA colorOf(double red, double green, double blue) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red / 255);
  color.g = static_cast<float>(green / 255);
  color.b = static_cast<float>(blue / 255);
  color.a = 1;
  return color;
}

// Those of config/inverse_dynamics.rviz; that of text can be read on light and on dark.
const std_msgs::ColorRGBA kForceColor = colorOf(204, 41, 41);
const std_msgs::ColorRGBA kTorqueColor = colorOf(230, 170, 20);
const std_msgs::ColorRGBA kTextColor = colorOf(40, 100, 190);

// Three digits of a number, and what is next to nothing as 0.
void appendRounded(std::string& text, double value, double nothing) {
  char digits[32];
  std::snprintf(digits, sizeof(digits), "%.2e", value < nothing ? 0.0 : value);
  appendNumber(text, std::strtod(digits, nullptr));
}

Marker textMarker(const std::string& kind, const std::string& frame, double height) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.ns = kind;
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.pose.orientation.w = 1;
  marker.scale.z = height;
  marker.color = kTextColor;
  return marker;
}

class MarkerMessage : public MessageOf<visualization_msgs::MarkerArray> {
 public:
  MarkerMessage(const Dynamics& plan, ModelView view, const OutputSettings& settings,
                const std::vector<std::string>& frames, const std::string& root_frame)
      : view_(std::move(view)),
        names_(settings.reactions),
        period_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1 / settings.marker_rate))) {
    const std::vector<std::string>& all = plan.request().child_axes;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto found = std::find(all.begin(), all.end(), names_[i]);
      places_.push_back(static_cast<std::size_t>(found - all.begin()));
      message_.markers.push_back(textMarker(names_[i], frames[i], view_.text_height));
    }
    addLegend(kBelow, view_.legend_force, view_.force_scale, " N", kForceColor, root_frame);
    addLegend(kBelow + kStep, view_.legend_torque, view_.torque_scale, " N m", kTorqueColor,
              root_frame);
  }

  void fill(const OutputSample& sample) override {
    const Clock::time_point now = Clock::now();
    exists_ = now >= due_;
    if (!exists_) return;
    due_ = now + period_;
    for (Marker& marker : message_.markers) marker.header.stamp = timeOf(sample.stamp_ns);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      write(sample.results, i, message_.markers[i].text);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  // RViz centres a text about its point: two empty lines on one side move it by one to the other.
  // The text begins one line above the point.
  void write(const Results& results, std::size_t i, std::string& text) const {
    const int lines = 1 + view_.text_lines[i];
    text.assign(static_cast<std::size_t>(std::max(0, -2 * lines)), '\n');
    text += names_[i];
    if (results.childAxesExist(places_[i]) == kAllComponents) {
      const Wrench& wrench = results.child_axes[places_[i]];
      text += ": ";
      appendRounded(text, wrench.force.norm(), kNothing * view_.legend_force);
      text += " N, ";
      appendRounded(text, wrench.torque.norm(), kNothing * view_.legend_torque);
      text += " N m";
    } else {
      text += ": not determined";
    }
    text.append(static_cast<std::size_t>(std::max(0, 2 * lines)), '\n');
  }

  void addLegend(double below, double value, double scale, const char* unit,
                 const std_msgs::ColorRGBA& color, const std::string& frame) {
    const Vector3d start =
        view_.box.center() - view_.size * (kLeft * view_.right + below * view_.up);
    const Vector3d end = start + value * scale * view_.right;
    Marker arrow;
    arrow.header.frame_id = frame;
    arrow.ns = "legend";
    arrow.id = legend_++;
    arrow.type = Marker::ARROW;
    arrow.pose.orientation.w = 1;
    arrow.points.resize(2);
    copyVector(start, arrow.points[0]);
    copyVector(end, arrow.points[1]);
    arrow.scale.x = kShaft * view_.size;
    arrow.scale.y = kHead * view_.size;
    arrow.color = color;
    message_.markers.push_back(arrow);

    Marker text = textMarker("legend", frame, view_.text_height);
    text.id = legend_++;
    copyVector(end + 3 * view_.text_height * view_.right, text.pose.position);
    text.text = numberText(value) + unit;
    message_.markers.push_back(text);
  }

  const ModelView view_;
  const std::vector<std::string> names_;
  const Clock::duration period_;
  std::vector<std::size_t> places_;
  int legend_ = 0;
  Clock::time_point due_;
};

class MarkerOutput : public Output {
 public:
  MarkerOutput(const Mechanism& mechanism, OutputSettings settings, std::vector<std::string> frames,
               std::string root_frame)
      : mechanism_(mechanism),
        settings_(std::move(settings)),
        frames_(std::move(frames)),
        root_frame_(std::move(root_frame)) {}

  std::string topic() const override { return "markers"; }
  ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const override {
    return ros::AdvertiseOptions::create<visualization_msgs::MarkerArray>(
        topic, queue, {}, {}, ros::VoidConstPtr(), nullptr);
  }
  void addTo(Request& request) const override {
    for (const std::string& name : settings_.reactions) {
      std::vector<std::string>& names = request.child_axes;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan) const override {
    return std::make_unique<MarkerMessage>(
        plan, modelView(mechanism_, settings_.scene, settings_.reactions), settings_, frames_,
        root_frame_);
  }

 private:
  const Mechanism& mechanism_;
  const OutputSettings settings_;
  const std::vector<std::string> frames_;
  const std::string root_frame_;
};

}  // namespace

std::unique_ptr<Output> makeMarkerOutput(const Mechanism& mechanism, const OutputSettings& settings,
                                         const std::vector<std::string>& frames,
                                         const std::string& root_frame) {
  return std::make_unique<MarkerOutput>(mechanism, settings, frames, root_frame);
}

}  // namespace virtual_work_dynamics
