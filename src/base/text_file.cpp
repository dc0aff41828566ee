#include "base/text_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

// Uses C streams because they tell why a read failed (a directory opens like any file).
std::string readTextFile(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  std::string text;
  if (file) {
    std::array<char, 65536> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
      text.append(buffer.data(), count);
    }
  }
  if (!file || std::ferror(file.get())) {
    throw FileError(path + ": cannot be read: " + std::strerror(errno));
  }
  return text;
}

}  // namespace virtual_work_dynamics
