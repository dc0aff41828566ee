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
constexpr double kLeft = 0.58, kBelow = 0.42, kStep = 0.06;
constexpr std::size_t kRoomForNumbers = 80;  // and lines, so that samples do not allocate
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

Marker markerOf(int type, const std::string& kind, int id, const std::string& frame,
                const std_msgs::ColorRGBA& color) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.ns = kind;
  marker.id = id;
  marker.type = type;
  marker.pose.orientation.w = 1;
  marker.color = color;
  return marker;
}

Marker textMarker(const std::string& kind, int id, const std::string& frame, double height) {
  Marker marker = markerOf(Marker::TEXT_VIEW_FACING, kind, id, frame, kTextColor);
  marker.scale.z = height;
  return marker;
}

Marker arrowMarker(const std::string& kind, int id, const std::string& frame,
                   const std_msgs::ColorRGBA& color, double size) {
  Marker marker = markerOf(Marker::ARROW, kind, id, frame, color);
  marker.points.resize(2);
  marker.scale.x = kShaft * size;
  marker.scale.y = kHead * size;
  return marker;
}

// RViz does not show an arrow without length.
void setArrow(const Vector3d& arrow, Marker& marker) {
  const bool shown = arrow.norm() > marker.scale.x;
  marker.action = shown ? Marker::ADD : Marker::DELETE;
  if (shown) copyVector(arrow, marker.points[1]);
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
      message_.markers.push_back(textMarker(names_[i], 0, frames[i], view_.text_height));
      message_.markers.back().text.reserve(names_[i].size() + kRoomForNumbers);
      message_.markers.push_back(arrowMarker(names_[i], 1, frames[i], kForceColor, view_.size));
      message_.markers.push_back(arrowMarker(names_[i], 2, frames[i], kTorqueColor, view_.size));
    }
    // RViz draws them where the link is in each picture, as it draws the link itself.
    for (Marker& marker : message_.markers) marker.frame_locked = true;
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
    for (std::size_t i = 0; i < names_.size(); ++i) write(sample.results, i);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void write(const Results& results, std::size_t i) {
    Marker* const markers = &message_.markers[3 * i];
    const bool exists = results.childAxesExist(places_[i]) == kAllComponents;
    const Wrench wrench = exists ? results.child_axes[places_[i]] : Wrench();
    writeText(exists ? &wrench : nullptr, i, markers[0].text);
    setArrow(view_.force_scale * wrench.force, markers[1]);
    setArrow(view_.torque_scale * wrench.torque, markers[2]);
  }

  // RViz centres a text about its point: two empty lines on one side move it by one to the other.
  // The text begins one line above the point.
  void writeText(const Wrench* wrench, std::size_t i, std::string& text) const {
    const int lines = 1 + view_.text_lines[i];
    text.assign(static_cast<std::size_t>(std::max(0, -2 * lines)), '\n');
    text += names_[i];
    if (wrench) {
      text += ": ";
      appendRounded(text, wrench->force.norm(), kNothing * view_.legend_force);
      text += " N, ";
      appendRounded(text, wrench->torque.norm(), kNothing * view_.legend_torque);
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
    message_.markers.push_back(arrowMarker("legend", legend_++, frame, color, view_.size));
    copyVector(start, message_.markers.back().points[0]);
    copyVector(end, message_.markers.back().points[1]);

    Marker text = textMarker("legend", legend_++, frame, view_.text_height);
    copyVector(end + 3 * view_.text_height * view_.right, text.pose.position);
    text.text = numberText(value) + unit;
    message_.markers.push_back(text);
  }

  const ModelView view_;
  const std::vector<std::string> names_;
  const Clock::duration period_;
  std::vector<std::size_t> places_;
  int legend_ = 3;  // those of a reaction of that name are less
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
  bool isForLooking() const override { return true; }
  void addTo(Request& request) const override {
    for (const std::string& name : settings_.reactions) {
      std::vector<std::string>& names = request.child_axes;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan, const Scene&) const override {
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
