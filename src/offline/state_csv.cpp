#include "offline/state_csv.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::string_view kEchoed = "%time";
constexpr std::string_view kSeries = "__time";
// Columns before those of the arrays: %time, seq, stamp, frame_id.
constexpr std::size_t kStamp = 2, kArrays = 4;
constexpr double kUnknownColumn = std::numeric_limits<double>::quiet_NaN();

bool startsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool isDigits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Seconds with a decimal fraction, whose nanoseconds a double would not hold; ns. False when the
// text is not such a time, before 1970 or beyond the stamps of ROS.
bool parseSeconds(std::string_view text, std::int64_t& ns) {
  constexpr std::size_t kMostSeconds = 10, kNanoseconds = 9;
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string fraction(text.substr(std::min(point + 1, text.size())));
  const std::string_view seconds = text.substr(0, point);
  if (!isDigits(seconds) || seconds.size() > kMostSeconds) return false;
  if (point < text.size() && !isDigits(fraction)) return false;
  fraction.resize(kNanoseconds, '0');
  ns = std::stoll(std::string(seconds)) * 1000000000 + std::stoll(fraction);
  return true;
}

bool parseNanoseconds(const std::string& text, std::int64_t& ns) {
  constexpr std::size_t kMost = 18;
  if (!isDigits(text) || text.size() > kMost + 1) return false;
  if (text.size() == kMost + 1 && text > "4294967295999999999") return false;
  ns = std::stoll(text);
  return true;
}

}  // namespace

bool StateCsv::isBegunBy(std::string_view text) {
  if (startsWith(text, "\"")) text.remove_prefix(1);
  return startsWith(text, kEchoed) || startsWith(text, kSeries);
}

StateCsv::StateCsv(TextSource& text, const std::string& name) : lines_(text, name), name_(name) {
  if (!lines_.next(true)) throw FileError(name_ + ": the file is empty");
  split(lines_.text());
  echoed_ = cells_[0] == kEchoed;
  if (!echoed_) {
    readSeries();
  } else if (cells_.size() <= kArrays || cells_[kStamp] != "field.header.stamp" ||
             cells_[kArrays] != "field.name0") {
    refuse("is not what 'rostopic echo -p' writes of sensor_msgs/JointState");
  }
  has_velocities_ = std::find(cells_.begin(), cells_.end(), "field.velocity0") != cells_.end();
  has_efforts_ = std::find(cells_.begin(), cells_.end(), "field.effort0") != cells_.end();
}

void StateCsv::refuse(const std::string& problem) const {
  throw FileError(name_ + ": line " + std::to_string(line()) + ": " + problem);
}

void StateCsv::split(std::string_view line) {
  cells_.clear();
  if (line.find('"') != std::string_view::npos) {
    if (!splitQuoted(line, cells_)) refuse("its quotes do not match");
    return;
  }
  forEachPlainCell(line, [this](std::size_t, std::string_view cell) { cells_.emplace_back(cell); });
}

// The columns <topic>/<joint>/position, velocity and effort.
void StateCsv::readSeries() {
  std::unordered_map<std::string, int> joint_of;
  for (std::size_t column = 0; column < cells_.size(); ++column) {
    const std::string& cell = cells_[column];
    series_.emplace_back();
    const std::size_t end = cell.rfind('/');
    if (end == std::string::npos || end == 0) continue;
    const std::string kind = cell.substr(end + 1);
    if (kind != "position" && kind != "velocity" && kind != "effort") continue;
    const std::string joint =
        cell.substr(cell.rfind('/', end - 1) + 1, end - 1 - cell.rfind('/', end - 1));
    const auto known = joint_of.emplace(joint, static_cast<int>(joints_.size()));
    if (known.second) joints_.push_back(joint);
    series_.back() = {known.first->second, kind == "position" ? 0 : kind == "velocity" ? 1 : 2};
    for (std::size_t other = 0; other < column; ++other) {
      if (series_[other].joint != series_.back().joint ||
          series_[other].kind != series_.back().kind) {
        continue;
      }
      refuse("columns " + std::to_string(other + 1) + " and " + std::to_string(column + 1) +
             " are both the " + kind + " of " + inQuotes(joint));
    }
  }
  if (joints_.empty()) refuse("no column <topic>/<joint>/position");
}

double StateCsv::number(std::size_t column) const {
  double value = 0;
  if (parseNumber(cells_[column], value)) return value;
  if (isNotANumber(cells_[column])) return kUnknownColumn;
  throw FileError(name_ + ": line " + std::to_string(line()) + ", column " +
                  std::to_string(column + 1) + ": " + inQuotes(cells_[column]) +
                  " is not a number");
}

bool StateCsv::next(JointStateContent& content) {
  while (lines_.next(false)) {
    split(lines_.text());
    if (echoed_) {
      takeEchoed(content);
      return true;
    }
    if (takeSeries(content)) return true;
  }
  return false;
}

// A row has the names, then as many positions, and maybe velocities and efforts; another message
// may have more joints or fewer than the one of the header.
void StateCsv::takeEchoed(JointStateContent& content) const {
  double value = 0;
  std::size_t names = 0;
  while (kArrays + names < cells_.size() && !parseNumber(cells_[kArrays + names], value) &&
         !isNotANumber(cells_[kArrays + names])) {
    ++names;
  }
  const std::size_t values = cells_.size() - std::min(cells_.size(), kArrays + names);
  if (names == 0 || values < names || values % names != 0) {
    refuse(std::to_string(names) + " names, but " + std::to_string(values) + " values");
  }
  if (!parseNanoseconds(cells_[kStamp], content.stamp_ns)) {
    refuse(inQuotes(cells_[kStamp]) + " is not a stamp in nanoseconds");
  }
  const auto first = cells_.begin() + kArrays;
  content.names.assign(first, first + static_cast<std::ptrdiff_t>(names));
  content.positions.clear();
  content.velocities.clear();
  content.efforts.clear();
  const std::size_t efforts = has_velocities_ ? 2 : 1;  // lists before them
  for (std::size_t i = 0; i < names; ++i) {
    content.positions.push_back(number(kArrays + names + i));
    if (has_velocities_ && values >= 2 * names) {
      content.velocities.push_back(number(kArrays + 2 * names + i));
    }
    if (has_efforts_ && values > efforts * names) {
      content.efforts.push_back(number(kArrays + (efforts + 1) * names + i));
    }
  }
}

bool StateCsv::takeSeries(JointStateContent& content) const {
  if (cells_.size() > series_.size()) {
    refuse(std::to_string(series_.size()) + " cells expected as in the header, " +
           std::to_string(cells_.size()) + " found");
  }
  if (!parseSeconds(cells_[0], content.stamp_ns)) {
    refuse(inQuotes(cells_[0]) + " is not a time in seconds");
  }
  std::vector<double> values[3];
  for (auto& of_kind : values) of_kind.assign(joints_.size(), kUnknownColumn);
  std::vector<bool> has(joints_.size(), false);
  for (std::size_t column = 1; column < cells_.size(); ++column) {
    if (series_[column].joint < 0 || cells_[column].empty()) continue;
    const auto joint = static_cast<std::size_t>(series_[column].joint);
    const int kind = series_[column].kind;
    values[kind][joint] = number(column);
    if (kind == 0) has[joint] = true;
  }
  content.names.clear();
  content.positions.clear();
  content.velocities.clear();
  content.efforts.clear();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!has[i]) continue;
    content.names.push_back(joints_[i]);
    content.positions.push_back(values[0][i]);
    content.velocities.push_back(values[1][i]);
    content.efforts.push_back(values[2][i]);
  }
  return !content.names.empty();
}

}  // namespace virtual_work_dynamics
