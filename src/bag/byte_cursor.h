#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace virtual_work_dynamics {

/// Takes little-endian values off the front of bytes. Once they run out, ok() is false and every
/// value is zero or empty.
class ByteCursor {
 public:
  ByteCursor(const char* data, std::size_t size) : at_(data), left_(size) {}
  explicit ByteCursor(std::string_view bytes) : ByteCursor(bytes.data(), bytes.size()) {}

  bool ok() const { return ok_; }
  bool empty() const { return left_ == 0; }
  std::size_t left() const { return left_; }

  std::uint8_t byte() { return static_cast<std::uint8_t>(whole(1)); }
  std::uint32_t word() { return static_cast<std::uint32_t>(whole(4)); }
  std::uint64_t longWord() { return whole(8); }
  double real() {
    const std::uint64_t bits = longWord();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  /// A time of ROS: seconds, then nanoseconds; ns.
  std::int64_t time() {
    const std::uint32_t seconds = word();
    return std::int64_t{seconds} * 1000000000 + word();
  }
  std::string_view bytes(std::size_t count) {
    if (count > left_) {
      ok_ = false;
      left_ = 0;
      return {};
    }
    const std::string_view taken(at_, count);
    at_ += count;
    left_ -= count;
    return taken;
  }
  /// Bytes that follow their number, a word.
  std::string_view sized() { return bytes(word()); }

 private:
  std::uint64_t whole(int size) {
    const std::string_view taken = bytes(static_cast<std::size_t>(size));
    std::uint64_t value = 0;
    for (std::size_t i = taken.size(); i > 0; --i) {
      value = value << 8 | static_cast<unsigned char>(taken[i - 1]);
    }
    return value;
  }

  const char* at_;
  std::size_t left_;
  bool ok_ = true;
};

}  // namespace virtual_work_dynamics
