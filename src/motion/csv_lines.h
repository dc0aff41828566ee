#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/text_file.h"

namespace virtual_work_dynamics {

/// A text without the blanks, tabs and carriage returns around it.
std::string_view trimmed(std::string_view text);

/// Calls `use(column index, cell)` for every cell of a line without quotes.
template <typename Use>
void forEachPlainCell(std::string_view line, Use use) {
  std::size_t count = 0;
  while (true) {
    const std::size_t comma = line.find(',');
    use(count++, trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

/// Splits a line in which some cells stand in quotes (RFC 4180): a comma inside them is part of the
/// cell, and two quotes are one. Returns false when the quotes do not match.
bool splitQuoted(std::string_view line, std::vector<std::string>& cells);

/// The lines of a text that are neither blank nor comments.
class CsvLines {
 public:
  /// @param name of the text, for messages; it must outlive this.
  CsvLines(TextSource& text, const std::string& name) : source_(text), name_(name) {}

  /// Goes to the next line and returns false at the end.
  /// @throws FileError for rows after a blank line, as two files written into one have them, and
  /// for a line that is too long.
  bool next(bool blanks_may_stand_before);

  /// The line, trimmed; valid until the next one.
  std::string_view text() const { return line_; }
  /// Its number in the text, from 1; before the first one 0.
  std::size_t number() const { return number_; }

 private:
  bool readLine();
  void skipByteOrderMark();

  TextSource& source_;
  const std::string& name_;
  std::string buffer_;
  std::size_t start_ = 0;  // of what has not been taken, in the buffer
  bool at_end_ = false;
  std::string_view line_;
  std::size_t number_ = 0;
};

}  // namespace virtual_work_dynamics
