#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/output_file.h"

namespace virtual_work_dynamics {

/// An array of an .npz, with one value in each row.
struct NpzColumn {
  std::string name;
  bool times =
      false;  ///< its values are nanoseconds since 1970 (datetime64[ns]) instead of numbers
};

/// A file of an .npz that is no array.
struct NpzText {
  std::string name;
  std::string text;
};

/// Writes a table as .npz, which numpy.load() reads: an array for each column, not compressed. As
/// the number of rows is known, each column has its place in the file from the start, and a part of
/// the rows is in memory.
class NpzWriter {
 public:
  /// Begins the file. @param file an OutputFile that can be rewritten; must outlive it
  /// @param rows number of rows that will be written
  /// @param most32 places and lengths beyond it are written in 64 bits; less in tests only
  NpzWriter(OutputFile& file, const std::vector<NpzColumn>& columns, std::size_t rows,
            const std::vector<NpzText>& texts = {}, std::uint64_t most32 = 0xfffffffe);

  /// Adds the next value, row by row.
  void add(double value);
  /// Adds the next value of a column of times.
  void addTime(std::int64_t ns);
  /// Writes the directory and commits the file. All rows must have been written.
  void finish();

 private:
  struct Entry {
    std::string name;
    std::uint64_t place = 0;  // of its header in the file
    std::uint64_t length = 0;
    std::uint32_t crc = 0;
  };

  void begin(Entry entry, const std::string& begin);
  void addBits(std::uint64_t bits);
  void writeRows();
  bool isLong(std::uint64_t number) const { return number > most32_; }
  std::string localHeader(const Entry& entry) const;
  std::string centralHeader(const Entry& entry) const;
  std::string end(std::uint64_t directory, std::uint64_t length) const;

  OutputFile& file_;
  const std::uint64_t most32_;
  const std::size_t rows_;           // in all
  std::vector<Entry> entries_;       // columns first
  std::vector<std::uint64_t> next_;  // by column: place of its next value
  std::uint64_t place_ = 0;          // where the next entry begins
  std::size_t written_ = 0;          // rows
  std::size_t column_ = 0;           // of the next value
  std::size_t held_most_ = 0;
  std::vector<std::string> held_;  // by column: values in memory
};

}  // namespace virtual_work_dynamics
