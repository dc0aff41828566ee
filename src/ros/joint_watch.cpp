#include "ros/joint_watch.h"

#include <utility>

#include "ros/message_text.h"

namespace virtual_work_dynamics {

constexpr std::chrono::seconds JointWatch::kPatience;

JointWatch::JointWatch(std::vector<std::string> joints, std::vector<bool> needed,
                       std::vector<bool> following)
    : joints_(std::move(joints)),
      needed_(std::move(needed)),
      following_(std::move(following)),
      start_(Clock::now()),
      seen_(joints_.size()) {
  for (auto& seen : seen_) seen.store(kNever, std::memory_order_relaxed);
}

bool JointWatch::isNeeded(std::size_t i) const {
  if (!all_needed_) return needed_[i];
  return !following_[i] || seen_[i].load(std::memory_order_relaxed) != kNever;
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

std::vector<std::string> JointWatch::doubts() const {
  std::vector<std::string> lines;
  const std::vector<std::string> in_vain = notNeeded(true);
  if (!in_vain.empty()) {
    lines.push_back("joints " + shortList(in_vain) + " are given, but not " +
                    shortList(notNeeded(false)) +
                    ": they are ignored, and the motion of both follows from the closures");
  }
  const std::vector<std::string> waited_for = neverSeen();
  if (!waited_for.empty()) {
    lines.push_back("joints " + shortList(waited_for) +
                    " have not been received in 5 s; nothing is published until all have been");
  }
  return lines;
}

// The joints not waited for that were seen before (true) or never (false).
std::vector<std::string> JointWatch::notNeeded(bool seen) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const bool was_seen = seen_[i].load(std::memory_order_relaxed) != kNever;
    if (!isNeeded(i) && was_seen == seen) names.push_back(joints_[i]);
  }
  return names;
}

}  // namespace virtual_work_dynamics
