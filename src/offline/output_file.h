#pragma once

#include <cstdio>
#include <string>

namespace virtual_work_dynamics {

/// A file that is complete or not there: written to `<path>.part` beside it and renamed by
/// commit(). Without commit(), and when SIGINT, SIGTERM or SIGHUP ends the process, the partial
/// file is removed. Standard output, devices and pipes are written directly. One at a time.
class OutputFile {
 public:
  /// @param path empty: standard output.   @throws FileError naming path and reason.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// @throws FileError as soon as a failure shows, at the latest in commit().
  void write(const std::string& text);
  /// Once, at the end.
  void commit();

 private:
  [[noreturn]] void throwCannotWrite(int error) const;

  std::string path_;  ///< where the content ends up; for messages too
  std::string part_;  ///< where it is written meanwhile; empty: nothing to rename or remove
  std::FILE* stream_ = nullptr;
};

/// The path at which a file is written until it is complete.
std::string partPath(const std::string& path);

}  // namespace virtual_work_dynamics
