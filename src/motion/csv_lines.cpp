#include "motion/csv_lines.h"

#include <algorithm>
#include <utility>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kPiece = 65536;
constexpr std::size_t kMegabyte = std::size_t{1} << 20;
constexpr std::size_t kLongestLine = 64 * kMegabyte;  // of a million columns and more

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

bool splitQuoted(std::string_view line, std::vector<std::string>& cells) {
  cells.clear();
  while (true) {
    line = trimmed(line);
    std::string cell;
    if (line.substr(0, 1) == "\"") {
      std::size_t at = 1;
      for (; at < line.size() && (line[at] != '"' || line.substr(at + 1, 1) == "\""); ++at) {
        if (line[at] == '"') ++at;
        cell += line[at];
      }
      if (at >= line.size()) return false;
      line = trimmed(line.substr(at + 1));
      if (!line.empty() && line.front() != ',') return false;
    } else {
      const std::string_view plain = trimmed(line.substr(0, line.find(',')));
      if (plain.find('"') != std::string_view::npos) return false;
      cell = std::string(plain);
      line.remove_prefix(std::min(line.find(','), line.size()));
    }
    cells.push_back(std::move(cell));
    if (line.empty()) return true;
    line.remove_prefix(1);
  }
}

bool CsvLines::next(bool blanks_may_stand_before) {
  std::size_t blank_line = 0;
  while (readLine()) {
    ++number_;
    if (number_ == 1) skipByteOrderMark();
    line_ = trimmed(line_);
    if (line_.empty()) {
      if (blank_line == 0) blank_line = number_;
    } else if (line_.front() != '#') {
      if (blank_line == 0 || blanks_may_stand_before) return true;
      throw FileError(name_ + ": line " + std::to_string(blank_line) + " is blank, but line " +
                      std::to_string(number_) + " follows");
    }
  }
  return false;
}

/// Takes the next line off the buffer, which is filled as far as needed; false at the end.
bool CsvLines::readLine() {
  std::size_t searched = start_;
  std::size_t end = buffer_.find('\n', searched);
  while (end == std::string::npos && !at_end_) {
    buffer_.erase(0, start_);
    start_ = 0;
    searched = buffer_.size();
    if (searched > kLongestLine) {
      throw FileError(name_ + ": line " + std::to_string(number_ + 1) + " has more than " +
                      std::to_string(kLongestLine / kMegabyte) + " MB, or no end");
    }
    buffer_.resize(searched + kPiece);
    const std::size_t count = source_.read(&buffer_[searched], kPiece);
    buffer_.resize(searched + count);
    at_end_ = count == 0;
    end = buffer_.find('\n', searched);
  }
  if (start_ == buffer_.size()) return false;
  end = std::min(end, buffer_.size());
  line_ = std::string_view(buffer_).substr(start_, end - start_);
  start_ = std::min(end + 1, buffer_.size());
  return true;
}

void CsvLines::skipByteOrderMark() {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    line_.remove_prefix(kByteOrderMark.size());
  }
}

}  // namespace virtual_work_dynamics
