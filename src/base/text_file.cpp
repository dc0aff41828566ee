#include "base/text_file.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

}  // namespace

// Uses C streams because they tell why a read failed (a directory opens like any file).
TextFile::TextFile(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  if (!file_) throw FileError(path_ + ": cannot be read: " + std::strerror(errno));
}

std::size_t TextFile::read(char* to, std::size_t most) {
  const std::size_t count = std::fread(to, 1, most, file_.get());
  if (std::ferror(file_.get())) {
    throw FileError(path_ + ": cannot be read: " + std::strerror(errno));
  }
  if (const void* const zero = count == 0 ? nullptr : std::memchr(to, '\0', count)) {
    const auto place = offset_ + static_cast<std::size_t>(static_cast<const char*>(zero) - to);
    throw FileError(path_ + ": is not a text: byte " + std::to_string(place + 1) +
                    " is zero; only UTF-8 is read");
  }
  offset_ += count;
  return count;
}

BegunText::BegunText(TextSource& text) : text_(text), begin_(64, '\0') {
  begin_.resize(text_.read(begin_.data(), begin_.size()));
}

std::size_t BegunText::read(char* to, std::size_t most) {
  if (taken_ == begin_.size()) return text_.read(to, most);
  const std::size_t count = begin_.copy(to, most, taken_);
  taken_ += count;
  return count;
}

std::string readTextFile(const std::string& path, std::size_t longest) {
  TextFile file(path);
  std::string text;
  std::array<char, 65536> buffer;
  while (const std::size_t count = file.read(buffer.data(), buffer.size())) {
    text.append(buffer.data(), count);
    if (text.size() > longest) {
      throw FileError(path + ": has more than " + std::to_string(longest / kMegabyte) +
                      " MB, or no end");
    }
  }
  return text;
}

}  // namespace virtual_work_dynamics
