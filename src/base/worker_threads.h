#pragma once

#include <memory>

namespace virtual_work_dynamics {

/// Threads that sleep until there is work for all of them.
class WorkerThreads {
 public:
  /// Does the work of one thread, whose index counts from 0. Must not throw.
  using Work = void (*)(void* context, int index);

  /// Starts count - 1 threads; the calling thread is the one with index 0.
  explicit WorkerThreads(int count);
  ~WorkerThreads();
  WorkerThreads(WorkerThreads&&) noexcept;
  WorkerThreads& operator=(WorkerThreads&&) noexcept;

  int count() const;

  /// Calls `work` once for each index and returns when all calls are done. Does not allocate.
  void run(Work work, void* context);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace virtual_work_dynamics
