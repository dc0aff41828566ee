#pragma once

#include <cstdio>
#include <string>

namespace virtual_work_dynamics {

/// A file that is written as a whole or not at all: its text goes to `<path>.part` beside it, which
/// commit() renames. Without commit(), and when SIGINT, SIGTERM or SIGHUP ends the process, the
/// partial file is removed. Standard output, devices and pipes are written directly. A process may
/// have one such object at a time.
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
  /// Completes the file; to be called once, at the end. @throws FileError naming path and reason.
  void commit();

 private:
  [[noreturn]] void throwCannotWrite(int error) const;

  std::string path_;  ///< final path, also for messages
  std::string part_;  ///< path until commit(); empty: nothing to rename or remove
  std::FILE* stream_ = nullptr;
};

/// The path at which a file is written until it is complete.
std::string partPath(const std::string& path);

}  // namespace virtual_work_dynamics
