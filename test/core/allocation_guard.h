#pragma once

#include <cstddef>

namespace virtual_work_dynamics {

/// Counts heap allocations of the process while the object lives, whichever library makes them:
/// malloc and its relatives are replaced in this executable and so for every shared library that it
/// loads.
class AllocationGuard {
 public:
  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  std::size_t allocations() const;
};

}  // namespace virtual_work_dynamics
