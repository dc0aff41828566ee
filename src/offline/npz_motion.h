#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/text_file.h"
#include "npz/npz_reader.h"
#include "offline/progress.h"

namespace virtual_work_dynamics {

/// Whether a file is an .npz. @throws FileError when its name says so, but not its content.
bool isNpz(const std::string& path);

/// The arrays of an .npz as the CSV that has them as columns, so that the rules of CSV hold for
/// both: numbers with the digits that read back equal, and empty cells where arrays have no number.
class NpzMotion : public TextSource {
 public:
  /// @throws FileError as NpzReader
  explicit NpzMotion(const std::string& path);
  /// @throws FileError naming a value of a motion that is no number
  std::size_t read(char* to, std::size_t most) override;

  /// What is in the file besides the arrays.
  const std::vector<std::string>& others() const { return file_.others(); }

 private:
  void addRows();
  void addCell(std::size_t array, std::size_t row);

  std::string path_;
  NpzReader file_;
  std::vector<bool> moves_;  // by array: whether it is of a motion
  std::size_t rows_at_once_;
  std::size_t next_ = 0;  // row
  std::vector<std::vector<double>> values_;
  std::vector<std::vector<std::int64_t>> times_;
  std::string text_;  // not yet taken
  std::size_t taken_ = 0;
  Progress progress_;
};

}  // namespace virtual_work_dynamics
