#include "ros/joint_watch.h"

#include <utility>

namespace virtual_work_dynamics {

constexpr std::chrono::seconds JointWatch::kPatience;

JointWatch::JointWatch(std::vector<std::string> joints, std::vector<bool> needed)
    : joints_(std::move(joints)),
      needed_(std::move(needed)),
      start_(Clock::now()),
      seen_(joints_.size()) {
  for (auto& seen : seen_) seen.store(kNever, std::memory_order_relaxed);
}

void JointWatch::saw(const int* coordinates, int count) {
  const std::int64_t now = now_.load(std::memory_order_relaxed);
  for (int i = 0; i < count; ++i) {
    seen_[static_cast<std::size_t>(coordinates[i])].store(now, std::memory_order_relaxed);
  }
}

void JointWatch::setTime(Clock::time_point now) {
  now_.store(std::chrono::duration_cast<std::chrono::seconds>(now - start_).count(),
             std::memory_order_relaxed);
}

std::vector<std::string> JointWatch::neverSeen() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (isNeeded(i) && seen_[i].load(std::memory_order_relaxed) == kNever)
      names.push_back(joints_[i]);
  }
  return names;
}

std::vector<std::string> JointWatch::missing() const {
  const std::int64_t now = now_.load(std::memory_order_relaxed);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const std::int64_t seen = seen_[i].load(std::memory_order_relaxed);
    if (!isNeeded(i)) continue;
    if (seen == kNever || now - seen > kPatience.count()) names.push_back(joints_[i]);
  }
  return names;
}

std::vector<std::string> JointWatch::notNeeded(bool seen) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const bool was_seen = seen_[i].load(std::memory_order_relaxed) != kNever;
    if (!isNeeded(i) && was_seen == seen) names.push_back(joints_[i]);
  }
  return names;
}

}  // namespace virtual_work_dynamics
