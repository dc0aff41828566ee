#include "offline/watched_file.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>

namespace virtual_work_dynamics {
namespace {

std::size_t sizeOf(const std::string& path) {
  std::error_code pipe;
  const std::uintmax_t size = std::filesystem::file_size(path, pipe);
  return pipe ? 0 : static_cast<std::size_t>(size);
}

}  // namespace

WatchedFile::WatchedFile(const std::string& path)
    : file_(path),
      size_(sizeOf(path)),
      progress_(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "reading " + path) {}

std::size_t WatchedFile::read(char* to, std::size_t most) {
  const std::size_t count = file_.read(to, most);
  read_ += count;
  rows_ += static_cast<std::size_t>(std::count(to, to + count, '\n'));
  if (size_ > 0) {
    progress_.update(std::min(read_, size_), size_);
  } else {
    progress_.updateCount(rows_, "rows");
  }
  return count;
}

}  // namespace virtual_work_dynamics
