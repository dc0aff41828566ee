#include "offline/joint_state_rows.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/number_text.h"
#include "base/printable.h"
#include "motion/largest_motion.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Stamps that go back by less come late; by more, another recording begins.
constexpr std::int64_t kLatestBy = 1000000000;  // ns

std::size_t placeOf(const std::string& name, const Names& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool has(const Names& names, const std::string& name) {
  return placeOf(name, names) < names.size();
}

std::string lengths(std::size_t names, std::size_t values, const char* what) {
  return std::to_string(names) + " names but " + std::to_string(values) + " " + what;
}

// Why the values of a message cannot be used; empty: they can.
std::string problemOf(const JointStateContent& message) {
  const std::size_t names = message.names.size();
  if (names == 0) return "it has no joints";
  if (message.positions.size() != names) {
    return lengths(names, message.positions.size(), "positions");
  }
  if (!message.velocities.empty() && message.velocities.size() != names) {
    return lengths(names, message.velocities.size(), "velocities");
  }
  if (message.stamp_ns == 0) return "its stamp is zero";
  for (std::size_t i = 0; i < names; ++i) {
    if (std::abs(message.positions[i]) <= kLargestMotion) continue;
    return "the position of " + inQuotes(message.names[i]) + " is " +
           numberText(message.positions[i]);
  }
  return "";
}

}  // namespace

void JointStateRows::refuse(std::size_t number, const std::string& why) {
  if (++refused_ == 1) refusal_ = row_name_ + (" " + std::to_string(number)) + ": " + why;
}

std::optional<std::size_t> JointStateRows::layoutOf(const Names& given, std::size_t number) {
  if (latest_ < layouts_.size() && layouts_[latest_].given == given) return latest_;
  const auto known = std::find_if(layouts_.begin(), layouts_.end(),
                                  [&](const Layout& layout) { return layout.given == given; });
  if (known != layouts_.end()) return static_cast<std::size_t>(known - layouts_.begin());
  Names names;
  for (const std::string& name : given) {
    names.push_back(rename_(name));
    if (placeOf(names.back(), names) + 1 == names.size()) continue;
    refuse(number, "it names " + inQuotes(names.back()) + " twice");
    return std::nullopt;
  }
  for (const std::string& name : names) {
    if (!has(joints_, name)) joints_.push_back(name);
  }
  layouts_.push_back({given, names, {}, {}, {}});
  return layouts_.size() - 1;
}

void JointStateRows::add(const JointStateContent& message, std::size_t number) {
  const std::string problem = problemOf(message);
  if (!problem.empty()) return refuse(number, problem);
  const auto place = layoutOf(message.names, number);
  if (!place) return;
  latest_ = *place;
  Layout& layout = layouts_[latest_];
  layout.rows.push_back({message.stamp_ns, number});
  layout.positions.insert(layout.positions.end(), message.positions.begin(),
                          message.positions.end());
  if (message.velocities.empty()) {
    layout.velocities.resize(layout.positions.size(), kUnknown);
  } else {
    layout.velocities.insert(layout.velocities.end(), message.velocities.begin(),
                             message.velocities.end());
  }
}

// Which joints keep every message from being whole.
std::string JointStateRows::missing(const Names& joints) const {
  Names nowhere, apart;
  for (const std::string& joint : joints) {
    if (!has(joints_, joint)) nowhere.push_back(joint);
  }
  if (!nowhere.empty()) {
    return "no message has " + namesInQuotes(nowhere) + "; they have " + namesInQuotes(joints_) +
           "; --rest JOINT=X gives a joint that rests its position";
  }
  const auto found = [&](const Layout& layout) {
    return std::count_if(joints.begin(), joints.end(),
                         [&](const std::string& joint) { return has(layout.names, joint); });
  };
  const auto most =
      std::max_element(layouts_.begin(), layouts_.end(),
                       [&](const Layout& a, const Layout& b) { return found(a) < found(b); });
  for (const std::string& joint : joints) {
    if (!has(most->names, joint)) apart.push_back(joint);
  }
  return "no message has all joints: those with the most lack " + namesInQuotes(apart) +
         ", which others have; --rest JOINT=X gives a joint that rests its position, and for an "
         "--output BAG joint states may come in parts";
}

JointStateRows::Table JointStateRows::make(const Names& joints) const {
  Table table;
  table.motion.joints = joints;
  std::vector<std::vector<std::size_t>> columns(layouts_.size());
  std::vector<Place> places;
  for (std::size_t l = 0; l < layouts_.size(); ++l) {
    const Layout& layout = layouts_[l];
    for (const std::string& joint : joints) columns[l].push_back(placeOf(joint, layout.names));
    const auto found = static_cast<std::size_t>(
        std::count_if(columns[l].begin(), columns[l].end(),
                      [&](std::size_t column) { return column < layout.names.size(); }));
    if (found < joints.size()) {
      (found == 0 ? table.without_any : table.without_some) += layout.rows.size();
      continue;
    }
    for (std::size_t i = 0; i < layout.rows.size(); ++i) {
      places.push_back({layout.rows[i], &layout, &columns[l], i});
    }
  }
  if (places.empty()) throw Error(missing(joints));
  const auto earlier = [](const Place& a, const Place& b) { return a.row.message < b.row.message; };
  std::sort(places.begin(), places.end(), earlier);
  std::int64_t newest = places.front().row.stamp_ns;
  for (const Place& place : places) {
    if (place.row.stamp_ns < newest - kLatestBy) {
      throw Error(row_name_ + (" " + std::to_string(place.row.message)) + ": its stamp is " +
                  numberText(static_cast<double>(newest - place.row.stamp_ns) / 1e9) +
                  " s before one that came earlier, as if two recordings were in one");
    }
    newest = std::max(newest, place.row.stamp_ns);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.row.stamp_ns < b.row.stamp_ns; });
  const auto end = std::unique(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.row.stamp_ns == b.row.stamp_ns;
  });
  table.repeated = static_cast<std::size_t>(places.end() - end);
  places.erase(end, places.end());
  fill(places, table);
  return table;
}

void JointStateRows::fill(const std::vector<Place>& places, Table& table) {
  MotionTable& motion = table.motion;
  const auto rows = static_cast<Eigen::Index>(places.size());
  const auto joints = static_cast<Eigen::Index>(motion.joints.size());
  motion.positions.resize(rows, joints);
  motion.velocities.resize(rows, joints);
  bool some = false;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Place& place = places[static_cast<std::size_t>(row)];
    const std::int64_t stamp = place.row.stamp_ns;
    table.stamps_ns.push_back(stamp);
    table.messages.push_back(place.row.message);
    // Of whole nanoseconds, as stamps of today are too long for a double.
    motion.times.push_back(static_cast<double>(stamp - table.stamps_ns.front()) / 1e9);
    const std::size_t first = place.index * place.layout->names.size();
    for (Eigen::Index joint = 0; joint < joints; ++joint) {
      const std::size_t from = first + (*place.columns)[static_cast<std::size_t>(joint)];
      motion.positions(row, joint) = place.layout->positions[from];
      motion.velocities(row, joint) = place.layout->velocities[from];
      some = some || std::isfinite(place.layout->velocities[from]);
    }
  }
  const bool all = (motion.velocities.array().abs() <= kLargestMotion).all();
  table.velocities_left_out = some && !all;
  if (!all) motion.velocities.resize(0, 0);
}

}  // namespace virtual_work_dynamics
