#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace virtual_work_dynamics {

/// A file that is written as a whole or not at all: its text goes to a file of a name of its own
/// beside it, `<path>.XXXXXX.part`, which commit() renames. The mode of a file that is replaced is
/// kept, and a file that may not be written stays. Without commit(), and when a signal that can be
/// caught ends the process, the partial file is removed. Of several processes that write one path
/// at once each writes its own file, and the last to commit() is what stays. Standard output,
/// devices and pipes are written directly. A process may have one such object at a time.
class OutputFile {
 public:
  /// Opens the file. @param path where it is to be; empty: standard output.
  /// @throws FileError naming path and reason.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes a text. @throws FileError as soon as a failure shows, at the latest in commit().
  void write(const std::string& text);
  /// Writes bytes in place of those at a position, and goes back to the end. Only where the file is
  /// one that commit() renames. @throws FileError as write().
  void rewrite(std::size_t position, const std::string& bytes);
  /// Whether rewrite() is possible: not of standard output, devices and pipes.
  bool canRewrite() const { return !part_.empty(); }
  /// Completes the file; to be called once, at the end. @throws FileError naming path and reason.
  void commit();

 private:
  [[noreturn]] void throwCannotWrite(int error) const;

  std::string path_;  ///< final path, also for messages
  std::string part_;  ///< path until commit(); empty: nothing to rename or remove
  std::FILE* stream_ = nullptr;
};

}  // namespace virtual_work_dynamics
