#include "ros/counters.h"

namespace virtual_work_dynamics {

void Counters::drop(DropReason reason, const std::string& text) {
  const std::lock_guard<std::mutex> lock(last_drop_mutex_);  // two threads may drop messages
  dropped[index(reason)].add();
  last_drop_ = text;
}

std::uint64_t Counters::allDropped() const {
  std::uint64_t sum = 0;
  for (const Counter& counter : dropped) sum += counter.value();
  return sum;
}

std::string Counters::lastDrop() const {
  const std::lock_guard<std::mutex> lock(last_drop_mutex_);
  return last_drop_;
}

}  // namespace virtual_work_dynamics
