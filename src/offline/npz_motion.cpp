#include "offline/npz_motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kValuesAtOnce = 1 << 16;

// A name as a cell of a header; in quotes where it needs them.
std::string headerCell(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string cell = "\"";
  for (const char letter : name) cell += letter == '"' ? "\"\"" : std::string(1, letter);
  return cell + "\"";
}

bool isOfMotion(const std::string& name) {
  const std::string kind = name.substr(0, name.find('.'));
  return kind == "time" || kind == "position" || kind == "velocity" || kind == "acceleration";
}

constexpr std::int64_t kNotATime = std::numeric_limits<std::int64_t>::min();  // numpy's NaT

}  // namespace

bool isNpz(const std::string& path) {
  if (looksLikeNpz(path)) return true;
  const std::string_view end = ".npz";
  const bool named = path.size() > end.size() && path.substr(path.size() - end.size()) == end;
  std::error_code unknown;  // a file that cannot be opened is told so by its reader
  if (named && std::filesystem::is_regular_file(path, unknown)) {
    throw FileError(path + ": is not an .npz as numpy.savez writes it: it is no zip file");
  }
  return false;
}

NpzMotion::NpzMotion(const std::string& path)
    : path_(path),
      file_(path),
      rows_at_once_(
          std::max<std::size_t>(1, kValuesAtOnce / std::max<std::size_t>(1, file_.names().size()))),
      values_(file_.names().size()),
      times_(file_.names().size()),
      progress_(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "reading " + path) {
  if (file_.names().empty()) throw FileError(path + ": has no one-dimensional arrays of numbers");
  for (std::size_t i = 0; i < file_.names().size(); ++i) {
    const std::string& name = file_.names()[i];
    if (name.find_first_of("\r\n") != std::string::npos) {
      throw FileError(path + ": array " + inQuotes(name) + ": a name has no line end");
    }
    moves_.push_back(isOfMotion(name));
    text_ += (i == 0 ? "" : ",") + headerCell(name);
  }
  text_ += '\n';
}

std::size_t NpzMotion::read(char* to, std::size_t most) {
  if (taken_ == text_.size()) addRows();
  const std::size_t count = std::min(most, text_.size() - taken_);
  std::copy_n(text_.data() + taken_, count, to);
  taken_ += count;
  return count;
}

void NpzMotion::addRows() {
  text_.clear();
  taken_ = 0;
  const std::size_t count = std::min(rows_at_once_, file_.rows() - next_);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (file_.areTimes(i)) {
      file_.readTimes(i, next_, count, times_[i]);
    } else {
      file_.read(i, next_, count, values_[i]);
    }
  }
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (i > 0) text_ += ',';
      addCell(i, row);
    }
    text_ += '\n';
  }
  next_ += count;
  progress_.update(next_, file_.rows());
}

void NpzMotion::addCell(std::size_t array, std::size_t row) {
  const bool is_time = file_.areTimes(array);
  if (is_time && times_[array][row] != kNotATime) return appendSeconds(text_, times_[array][row]);
  const double value = is_time ? std::numeric_limits<double>::quiet_NaN() : values_[array][row];
  if (std::isfinite(value)) return appendNumber(text_, value);
  if (!moves_[array]) return;
  throw FileError(path_ + ": index " + std::to_string(next_ + row) + " of " +
                  inQuotes(file_.names()[array]) + " is " + numberText(value) + ", no number");
}

}  // namespace virtual_work_dynamics
