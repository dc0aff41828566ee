#pragma once

#include <cstddef>
#include <string>

#include "base/text_file.h"
#include "offline/progress.h"

namespace virtual_work_dynamics {

/// A file that shows how far it has been read while that takes long: its part where the length is
/// known, the number of rows and their rate where it comes from a pipe.
class WatchedFile : public TextSource {
 public:
  /// @throws FileError as TextFile, and so does read().
  explicit WatchedFile(const std::string& path);
  std::size_t read(char* to, std::size_t most) override;

 private:
  TextFile file_;
  std::size_t size_;  // bytes; 0: unknown
  std::size_t read_ = 0;
  std::size_t rows_ = 0;
  Progress progress_;
};

}  // namespace virtual_work_dynamics
