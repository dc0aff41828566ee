#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

namespace virtual_work_dynamics {

/// A text that is read a piece at a time, so that it may be longer than memory allows.
class TextSource {
 public:
  virtual ~TextSource() = default;
  /// Reads the next bytes of the text, `most` of them or fewer. @returns their number, 0 at the
  /// end.
  virtual std::size_t read(char* to, std::size_t most) = 0;
};

/// A file, device or pipe with text. Zero bytes, which no text has and of which /dev/zero has no
/// end, are refused.
class TextFile : public TextSource {
 public:
  /// @throws FileError naming path and reason when it cannot be opened.
  explicit TextFile(const std::string& path);
  /// @throws FileError naming path and reason.
  std::size_t read(char* to, std::size_t most) override;

 private:
  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::size_t offset_ = 0;
};

/// A text whose first bytes can be looked at before it is read.
class BegunText : public TextSource {
 public:
  /// @param text must outlive it. @throws whatever reading it throws
  explicit BegunText(TextSource& text);
  /// Its first bytes; fewer where the text is short or comes slowly.
  const std::string& begin() const { return begin_; }
  std::size_t read(char* to, std::size_t most) override;

 private:
  TextSource& text_;
  std::string begin_;
  std::size_t taken_ = 0;  // of begin_
};

/// The whole content of a file, pipe or device. @param longest bytes, beyond any sensible content.
/// @throws FileError naming path and reason when it cannot be read, or never seems to end.
std::string readTextFile(const std::string& path, std::size_t longest);

}  // namespace virtual_work_dynamics
