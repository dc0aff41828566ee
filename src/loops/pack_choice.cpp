#include <algorithm>
#include <cmath>

#include "loops/sample_pack.h"

namespace virtual_work_dynamics {

// Whether one change may be open that efforts are chosen along; see LoopForces.
bool SamplePack::choosesAlong(const LoopForces& forces) {
  return !forces.effortsFollow() && forces.factorization().nullity() == 1;
}

// Whether the null space changes no effort.
bool SamplePack::isUnique(const Group& group, std::size_t sample) const {
  for (std::size_t i = 0; i < group.efforts; ++i) {
    if (!LoopForces::isUnique(group.null_square[i * width_ + sample])) return false;
  }
  return true;
}

// Leaves out samples whose rank is in doubt, or in which a null space of several dimensions changes
// efforts.
void SamplePack::judge(const LoopForces& forces, const Group& group) {
  for (std::size_t j = 0; j < width_; ++j) {
    const bool sure = group.condition[j] <= forces.sureCondition();
    if (!sure || !(group.null_vector || isUnique(group, j))) computed_[j] = false;
  }
}

void SamplePack::judgeHolds(const LoopForces& forces, const Group& group) {
  if (group.items.empty()) return;
  const bool open = group.unknowns.size() > group.efforts;
  const auto unknowns = static_cast<std::size_t>(forces.unknowns());
  for (std::size_t j = 0; j < width_; ++j) {
    LoopHolds::Packed packed{group.x, nullptr, 0, width_, j};
    for (std::size_t i = 0; i < unknowns; ++i) {
      packed.largest = std::max(packed.largest, std::abs(group.x[i * width_ + j]));
    }
    if (open) packed.null_squares = group.null_square + group.efforts * width_;
    for (const std::size_t i : group.items) {
      const LoopHolds::Item& item = plan_.holds.items()[i];
      holds_[i * width_ + j] = static_cast<double>(LoopHolds::judge(forces, item, packed));
      if (open) packed.null_squares += (item.along_end - item.along_begin + 1) * width_;
    }
  }
}

// The one vector of the null space: see MultifrontalQr::nullVector().
void SamplePack::findNullVector(const MultifrontalQr& qr, const FrontsMemory& memory,
                                Group& group) {
  const FrontLayout& layout = qr.layout();
  const FrontsView& view = layout.view();
  std::fill_n(group.null_vector, static_cast<std::size_t>(qr.rows()) * width_, 0.0);
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    if (layout.placeOf(row).front >= 0) continue;
    std::fill_n(group.null_vector + row * width_, width_, 1.0);
    return;
  }
  const auto zOf = [&](std::size_t f) { return group.numbers + view.fronts[f].z * width_; };
  const auto start = [&](std::size_t f) {
    std::fill_n(zOf(f), static_cast<std::size_t>(view.fronts[f].most_rows) * width_, 0.0);
    group.reached[f] = true;
  };
  std::fill(group.reached.begin(), group.reached.end(), false);
  for (std::size_t f = group.reached.size(); f-- > 0;) {
    const FrontState& state = group.states[f];
    if (!group.reached[f] && state.steps < state.rows) {
      start(f);
      std::fill_n(zOf(f) + static_cast<std::size_t>(state.steps) * width_, width_, 1.0);
    }
    if (!group.reached[f]) continue;
    fronts_.reflectBack(view, memory, static_cast<int>(f));
    const double* z = zOf(f);
    for (const std::size_t b : layout.fronts()[f].blocks) {
      for (int row = layout.firstOf(b); row < layout.firstOf(b + 1); ++row, z += width_) {
        std::copy_n(z, width_, group.null_vector + static_cast<std::size_t>(row) * width_);
      }
    }
    for (const std::size_t child : layout.fronts()[f].children) {
      const auto first = static_cast<std::size_t>(view.fronts[child].pivots);
      const std::size_t remaining = static_cast<std::size_t>(group.states[child].steps) - first;
      start(child);
      std::copy_n(z, remaining * width_, zOf(child) + first * width_);
      z += remaining * width_;
    }
  }
}

// See LoopForces::chooseAlong().
void SamplePack::chooseEfforts(const LoopForces& forces, const FrontsMemory& memory, Group& group) {
  bool found = false;
  for (std::size_t j = 0; j < width_; ++j) {
    group.chosen[j] = 0;
    if (isUnique(group, j)) continue;
    if (!found) findNullVector(forces.factorization(), memory, group);
    found = true;
    double along = 0, square = 0;
    for (const LoopUnknowns::Effort& effort : forces.efforts()) {
      const std::size_t at = static_cast<std::size_t>(effort.unknown) * width_ + j;
      along += group.null_vector[at] * group.x[at];
      square += group.null_vector[at] * group.null_vector[at];
    }
    const double way = along / square;
    const std::size_t end = static_cast<std::size_t>(forces.unknowns()) * width_;
    for (std::size_t at = j; at < end; at += width_) {
      if (group.null_vector[at] != 0) group.x[at] -= way * group.null_vector[at];
    }
    group.chosen[j] = 1;
  }
}

}  // namespace virtual_work_dynamics
