#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>

#include "base/alignment.h"

namespace virtual_work_dynamics {

/// Zeroed bytes aligned for vector instructions.
class AlignedMemory {
 public:
  explicit AlignedMemory(std::size_t size)
      : bytes_(::operator new(size, std::align_val_t(kVectorAlignment))) {
    std::memset(bytes_.get(), 0, size);
  }

  void* get() const { return bytes_.get(); }

 private:
  struct Deleter {
    void operator()(void* bytes) const {
      ::operator delete(bytes, std::align_val_t(kVectorAlignment));
    }
  };
  std::unique_ptr<void, Deleter> bytes_;
};

}  // namespace virtual_work_dynamics
