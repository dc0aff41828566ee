#include "motion/track_samples.h"

#include <algorithm>

#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {
namespace {

/// Intervals that their mean is taken over.
constexpr int kUsualIntervals = 64;

}  // namespace

void TrackSamples::clear() {
  size_ = 0;
  stretch_ = 0;
}

TrackSample& TrackSamples::add() {
  newest_ = (newest_ + 1) & (capacity() - 1);
  size_ = std::min(size_ + 1, capacity());
  return (*this)[0];
}

TrackSample& TrackSamples::insert(int age) {
  add();
  for (int i = 0; i < age; ++i) (*this)[i] = (*this)[i + 1];
  return (*this)[age];
}

void TrackSamples::lengthenStretch() {
  stretch_ = std::min(stretch_ + 1, capacity());
  // Samples that came late are counted, too.
  const int intervals = std::min(stretch_ - 1, kUsualIntervals);
  interval_ = secondsBetween((*this)[intervals].stamp, (*this)[0].stamp) / intervals;
}

int TrackSamples::ageAt(std::int64_t instant) const {
  int later = -1;
  int age = size_ - 1;
  while (age - later > 1) {
    const int middle = later + (age - later) / 2;
    if ((*this)[middle].stamp > instant) {
      later = middle;
    } else {
      age = middle;
    }
  }
  return age;
}

bool TrackSamples::nextInstant(std::int64_t after, std::int64_t lag, std::int64_t& instant) const {
  bool found = false;
  for (int age = 0; age < size_; ++age) {
    const std::int64_t stamp = (*this)[age].stamp;
    if (stamp <= after) break;
    if ((*this)[0].stamp - stamp < lag && age + 1 < capacity()) continue;
    instant = stamp;
    found = true;
  }
  return found;
}

bool TrackSamples::surround(std::int64_t instant, std::int64_t longest, int fewest) const {
  const int base = ageAt(instant);
  int newest = base;
  while (newest > 0 && !(*this)[newest - 1].first && base - newest < fewest) --newest;
  if (newest == base && instant - (*this)[base].stamp > longest) return false;
  int oldest = base;
  while (oldest + 1 < size_ && !(*this)[oldest].first && oldest - newest < fewest) ++oldest;
  return oldest - newest + 1 >= fewest;
}

}  // namespace virtual_work_dynamics
