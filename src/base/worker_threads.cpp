#include "base/worker_threads.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace virtual_work_dynamics {

namespace {

// Number of times that a waiting thread looks before it sleeps: some tens of microseconds, in which
// the next of a series of blocks arrives.
constexpr int kLooks = 2000;

template <typename Condition>
bool happensSoon(Condition condition) {
  for (int i = 0; i < kLooks; ++i) {
    if (condition()) return true;
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }
  return false;
}

}  // namespace

struct WorkerThreads::Shared {
  std::mutex mutex;
  std::condition_variable start;
  std::condition_variable done;
  Work work = nullptr;
  void* context = nullptr;
  std::atomic<unsigned> round{0};  // grows by one with each run()
  std::atomic<int> working{0};
  std::atomic<bool> stop{false};
  std::vector<std::thread> threads;

  void serve(int index) {
    for (unsigned seen = 0;; ++seen) {
      const auto called = [&] { return stop || round != seen; };
      if (!happensSoon(called)) {
        std::unique_lock<std::mutex> lock(mutex);
        start.wait(lock, called);
      }
      if (stop) return;
      work(context, index);
      if (--working > 0) continue;
      const std::lock_guard<std::mutex> lock(mutex);  // between run()'s look and its sleep
      done.notify_one();
    }
  }

  ~Shared() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      stop = true;
    }
    start.notify_all();
    for (std::thread& thread : threads) thread.join();
  }
};

WorkerThreads::WorkerThreads(int count) : shared_(new Shared) {
  Shared* const shared = shared_.get();
  for (int index = 1; index < count; ++index) {
    shared->threads.emplace_back([shared, index] { shared->serve(index); });
  }
}

WorkerThreads::~WorkerThreads() = default;
WorkerThreads::WorkerThreads(WorkerThreads&&) noexcept = default;
WorkerThreads& WorkerThreads::operator=(WorkerThreads&&) noexcept = default;

int WorkerThreads::count() const {
  return static_cast<int>(shared_->threads.size()) + 1;
}

void WorkerThreads::run(Work work, void* context) {
  if (shared_->threads.empty()) return work(context, 0);
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->work = work;
    shared_->context = context;
    shared_->working = static_cast<int>(shared_->threads.size());
    ++shared_->round;
  }
  shared_->start.notify_all();
  work(context, 0);
  const auto finished = [&] { return shared_->working == 0; };
  if (happensSoon(finished)) return;
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->done.wait(lock, finished);
}

}  // namespace virtual_work_dynamics
