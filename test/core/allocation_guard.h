#pragma once

#include <cstddef>

namespace virtual_work_dynamics {

/// Counts heap allocations of the calling process, whichever library makes them, while it lives:
/// malloc and its kin are replaced in this executable and so for every shared library it loads.
class AllocationGuard {
 public:
  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  std::size_t allocations() const;
};

}  // namespace virtual_work_dynamics
