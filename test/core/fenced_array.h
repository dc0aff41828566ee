#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace virtual_work_dynamics {

/// An array next to a page that must not be touched: a read or write past that edge crashes. The
/// bytes on its other side, up to the page there, are watched. All bytes are the same to begin
/// with.
template <typename Real>
class FencedArray {
 public:
  enum Edge { kFenceBehind, kFenceBefore };

  explicit FencedArray(std::size_t count, Edge edge = kFenceBehind) : size_(count * sizeof(Real)) {
    const std::size_t page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    inside_ = (size_ / page + 1) * page;
    mapped_ = inside_ + 2 * page;
    void* const memory = ::mmap(nullptr, mapped_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no memory for a fenced array");
    all_ = static_cast<unsigned char*>(memory);
    begin_ = all_ + page;
    if (::mprotect(begin_, inside_, PROT_READ | PROT_WRITE) != 0) {
      throw std::runtime_error("no fence round an array");
    }
    std::memset(begin_, kUntouched, inside_);
    data_ = edge == kFenceBehind ? begin_ + inside_ - size_ : begin_;
  }
  ~FencedArray() { ::munmap(all_, mapped_); }
  FencedArray(const FencedArray&) = delete;
  FencedArray& operator=(const FencedArray&) = delete;

  Real* data() { return reinterpret_cast<Real*>(data_); }

  /// Whether nothing was written on the side that does not crash.
  bool surroundingsUntouched() const {
    for (const unsigned char* byte = begin_; byte != begin_ + inside_; ++byte) {
      if ((byte < data_ || byte >= data_ + size_) && *byte != kUntouched) return false;
    }
    return true;
  }

 private:
  static constexpr unsigned char kUntouched = 0xa5;

  std::size_t size_, inside_, mapped_;
  unsigned char* all_;
  unsigned char* begin_;  // of the bytes that may be touched
  unsigned char* data_;
};

}  // namespace virtual_work_dynamics
