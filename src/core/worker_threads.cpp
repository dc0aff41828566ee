#include "core/worker_threads.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace virtual_work_dynamics {

struct WorkerThreads::Shared {
  std::mutex mutex;
  std::condition_variable start;
  std::condition_variable done;
  Work work = nullptr;
  void* context = nullptr;
  unsigned round = 0;  // grows by one with each run()
  int working = 0;
  bool stop = false;
  std::vector<std::thread> threads;

  void serve(int index) {
    unsigned seen = 0;
    std::unique_lock<std::mutex> lock(mutex);
    while (true) {
      start.wait(lock, [&] { return stop || round != seen; });
      if (stop) return;
      seen = round;
      lock.unlock();
      work(context, index);
      lock.lock();
      if (--working == 0) done.notify_one();
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
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->done.wait(lock, [&] { return shared_->working == 0; });
}

}  // namespace virtual_work_dynamics
