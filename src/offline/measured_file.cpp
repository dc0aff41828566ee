#include "offline/measured_file.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "bag/bag_reader.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "motion/csv_lines.h"
#include "offline/bag_topic.h"
#include "offline/npz_motion.h"
#include "offline/progress.h"
#include "offline/state_csv.h"
#include "offline/state_motion.h"
#include "offline/watched_file.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Names = std::vector<std::string>;

constexpr std::string_view kEffort = "effort.";

// Collects efforts by the names of their joints.
class Collector {
 public:
  explicit Collector(const MotionSource& source) : source_(source) {}

  std::size_t seriesOf(const std::string& given) {
    const std::string name = source_.rename(given);
    const auto found = place_of_.emplace(name, efforts_.size());
    if (found.second) efforts_.emplace_back(name);
    return found.first->second;
  }

  void add(std::size_t series, std::int64_t stamp_ns, double value) {
    if (std::isfinite(value)) efforts_[series].add(stamp_ns, value);
  }

  void add(const JointStateContent& content) {
    if (content.efforts.size() != content.names.size() || content.stamp_ns == 0) return;
    for (std::size_t i = 0; i < content.names.size(); ++i) {
      add(seriesOf(content.names[i]), content.stamp_ns, content.efforts[i]);
    }
  }

  MeasuredEfforts take(const std::string& where) {
    MeasuredEfforts measured;
    for (MeasuredEffort& effort : efforts_) {
      if (effort.size() == 0) continue;
      effort.sort();
      measured.push_back(std::move(effort));
    }
    if (measured.empty()) throw FileError(where + ": has no efforts that were measured");
    return measured;
  }

 private:
  const MotionSource& source_;
  MeasuredEfforts efforts_;
  std::unordered_map<std::string, std::size_t> place_of_;
};

void readBag(const MotionSource& source, const std::string& topic, Collector& efforts) {
  JointStateContent content;
  for (const std::string& path : bagParts(source)) {
    Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "reading efforts " + path);
    BagReader reader(path);
    BagMessage message;
    while (reader.next(message)) {
      progress.update(reader.position(), reader.size());
      if (message.connection->topic != topic) continue;
      if (readJointState(message.bytes, content)) efforts.add(content);
    }
    warnOfDamage(reader);
  }
}

// The names that a range such as "tau1..7" stands for; the name itself where it is none.
Names spelledOut(const std::string& name) {
  constexpr std::size_t kLongestNumber = 4;
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  const std::size_t dots = name.find("..");
  if (dots == std::string::npos) return {name};
  std::size_t first = dots;
  while (first > 0 && isDigit(name[first - 1])) --first;
  const std::string from = name.substr(first, dots - first), to = name.substr(dots + 2);
  if (from.empty() || to.empty() || from.size() > kLongestNumber || to.size() > kLongestNumber ||
      !std::all_of(to.begin(), to.end(), isDigit)) {
    return {name};
  }
  Names names;
  for (int i = std::stoi(from); i <= std::stoi(to); ++i) {
    names.push_back(name.substr(0, first) + std::to_string(i));
  }
  return names;
}

// The columns time and effort.<joint> of a CSV.
class EffortCsv {
 public:
  EffortCsv(TextSource& text, const std::string& name, bool bare)
      : lines_(text, name), name_(name), bare_(bare) {}

  void read(Collector& efforts) {
    readHeader(efforts);
    while (lines_.next(false)) readRow(efforts);
  }

 private:
  static constexpr int kNothing = -1, kTime = -2;

  std::string at() const { return name_ + ": line " + std::to_string(lines_.number()); }

  void split(std::string_view line) {
    cells_.clear();
    if (line.find('"') == std::string_view::npos) {
      forEachPlainCell(line, [this](std::size_t, std::string_view c) { cells_.emplace_back(c); });
    } else if (!splitQuoted(line, cells_)) {
      throw FileError(at() + ": its quotes do not match");
    }
  }

  // Whether a column without a kind of its own may be named after a joint.
  bool isBare(const std::string& column) const {
    return bare_ && !column.empty() && column != "stamp" && column.find('.') == std::string::npos;
  }

  void readHeader(Collector& efforts) {
    if (!lines_.next(true)) throw FileError(name_ + ": the file is empty");
    split(lines_.text());
    bool has_time = false;
    for (const std::string& cell : cells_) {
      for (const std::string& column : spelledOut(cell)) {
        int target = kNothing;
        bool bare = false;
        if (column == "time") {
          target = kTime;
          has_time = true;
        } else if (column.rfind(kEffort, 0) == 0) {
          target = seriesOf(column.substr(kEffort.size()), efforts);
        } else if (isBare(column)) {
          target = seriesOf(column, efforts);
          bare = true;
        }
        targets_.push_back(target);
        may_be_text_.push_back(bare);
        names_.push_back(column);
      }
    }
    if (!has_time) throw FileError(at() + ": column 'time' is missing");
    const auto isEffort = [](int target) { return target >= 0; };
    if (std::none_of(targets_.begin(), targets_.end(), isEffort)) {
      throw FileError(at() + ": no column effort.<joint>");
    }
  }

  int seriesOf(const std::string& joint, Collector& efforts) const {
    const auto series = static_cast<int>(efforts.seriesOf(joint));
    if (std::count(targets_.begin(), targets_.end(), series) > 0) {
      throw FileError(at() + ": two columns are efforts of " + inQuotes(joint));
    }
    return series;
  }

  void readRow(Collector& efforts) {
    std::string_view line = lines_.text();
    split(line);
    if (cells_.size() == targets_.size() + 1 && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() != targets_.size()) {
      throw FileError(at() + ": " + std::to_string(targets_.size()) +
                      " cells expected as in the header, " + std::to_string(cells_.size()) +
                      " found");
    }
    std::int64_t stamp_ns = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (targets_[i] == kTime) stamp_ns = nanosecondsOf(number(i), at());
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (targets_[i] < 0 || cells_[i].empty() || isNotANumber(cells_[i])) continue;
      if (leaveText(i)) continue;
      efforts.add(static_cast<std::size_t>(targets_[i]), stamp_ns, number(i));
    }
  }

  // A column without a kind that begins with a text is no joint, such as the mode of a controller.
  bool leaveText(std::size_t column) {
    if (!may_be_text_[column]) return false;
    may_be_text_[column] = false;
    double value = 0;
    if (parseNumber(cells_[column], value)) return false;
    targets_[column] = kNothing;
    std::cerr << "note: " << printable(at()) << ": column " << inQuotes(names_[column])
              << " is not taken for efforts, as it begins with " << inQuotes(cells_[column])
              << "\n";
    return true;
  }

  double number(std::size_t column) const {
    double value = 0;
    if (parseNumber(cells_[column], value)) return value;
    throw FileError(at() + ", column " + std::to_string(column + 1) + ": " +
                    inQuotes(cells_[column]) + " is not a finite number");
  }

  CsvLines lines_;
  const std::string& name_;
  const bool bare_;
  Names cells_;
  std::vector<int> targets_;       // by column
  std::vector<bool> may_be_text_;  // by column, until its first value has come
  Names names_;                    // by column
};

void readText(const MotionSource& source, bool bare, Collector& efforts) {
  const std::string& path = source.files.front();
  if (isNpz(path)) {
    NpzMotion arrays(path);
    return EffortCsv(arrays, path, bare).read(efforts);
  }
  WatchedFile file(path);
  BegunText text(file);
  if (!StateCsv::isBegunBy(text.begin())) {
    EffortCsv(text, path, bare).read(efforts);
    return;
  }
  StateCsv csv(text, path);
  JointStateContent content;
  while (csv.next(content)) efforts.add(content);
}

}  // namespace

MeasuredEfforts readMeasuredEfforts(const MotionSource& source, bool bare) {
  Collector efforts(source);
  std::string where = source.name();
  if (source.files.size() > 1 || looksLikeBag(source.files.front())) {
    const std::string topic = jointStateTopic(source);
    where += ": " + topic;
    readBag(source, topic, efforts);
  } else {
    readText(source, bare, efforts);
  }
  return efforts.take(where);
}

}  // namespace virtual_work_dynamics
