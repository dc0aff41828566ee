#include "motion/simplex_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace virtual_work_dynamics {

void SimplexSearch::start(const Point& first, const Point& steps, int dimensions, double tolerance,
                          int most) {
  dimensions_ = dimensions;
  tolerance_ = tolerance;
  left_ = most;
  corners_.fill(first);
  for (int i = 0; i < dimensions; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    corners_[axis + 1][axis] += steps[axis];
  }
  askCorner(0, Stage::kCorners);
}

void SimplexSearch::askCorner(int corner, Stage stage) {
  corner_ = corner;
  stage_ = stage;
  asked_ = corners_[static_cast<std::size_t>(corner)];
}

/// Asks for the point on the line from the worst corner through the centre, at `factor` times the
/// distance beyond the centre.
void SimplexSearch::ask(double factor, Stage stage) {
  const Point& worst = corners_[static_cast<std::size_t>(dimensions_)];
  stage_ = stage;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions_); ++i)
    asked_[i] = centre_[i] + factor * (centre_[i] - worst[i]);
}

void SimplexSearch::replaceWorst(const Point& point, double value) {
  const auto worst = static_cast<std::size_t>(dimensions_);
  corners_[worst] = point;
  values_[worst] = value;
  beginRound();
}

double SimplexSearch::size() const {
  double size = 0;
  for (std::size_t corner = 1; corner <= static_cast<std::size_t>(dimensions_); ++corner)
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions_); ++i)
      size = std::max(size, std::abs(corners_[corner][i] - corners_[0][i]));
  return size;
}

void SimplexSearch::beginRound() {
  const auto corners = static_cast<std::size_t>(dimensions_) + 1;
  for (std::size_t i = 1; i < corners; ++i)
    for (std::size_t k = i; k > 0 && values_[k] < values_[k - 1]; --k) {
      std::swap(values_[k], values_[k - 1]);
      std::swap(corners_[k], corners_[k - 1]);
    }
  if (left_ <= 0 || size() <= tolerance_) {
    stage_ = Stage::kFinished;
    return;
  }
  centre_.fill(0);
  for (std::size_t corner = 0; corner + 1 < corners; ++corner)
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions_); ++i)
      centre_[i] += corners_[corner][i] / dimensions_;
  asked_ = corners_[0];  // for entries beyond the dimensions
  ask(1, Stage::kReflect);
}

void SimplexSearch::tell(double value) {
  --left_;
  const auto worst = static_cast<std::size_t>(dimensions_);
  switch (stage_) {
    case Stage::kCorners:
    case Stage::kShrink:
      values_[static_cast<std::size_t>(corner_)] = value;
      if (corner_ < dimensions_) {
        askCorner(corner_ + 1, stage_);
      } else {
        beginRound();
      }
      return;
    case Stage::kReflect:
      reflected_ = asked_;
      reflected_value_ = value;
      if (value < values_[0]) {
        ask(2, Stage::kExpand);
      } else if (value < values_[worst - 1]) {
        replaceWorst(asked_, value);
      } else {
        ask(value < values_[worst] ? 0.5 : -0.5, Stage::kContract);
      }
      return;
    case Stage::kExpand:
      if (value < reflected_value_) {
        replaceWorst(asked_, value);
      } else {
        replaceWorst(reflected_, reflected_value_);
      }
      return;
    case Stage::kContract:
      if (value < std::min(reflected_value_, values_[worst])) {
        replaceWorst(asked_, value);
        return;
      }
      for (std::size_t corner = 1; corner <= worst; ++corner)
        for (std::size_t i = 0; i < worst; ++i)
          corners_[corner][i] = 0.5 * (corners_[corner][i] + corners_[0][i]);
      askCorner(1, Stage::kShrink);
      return;
    case Stage::kFinished:
      return;
  }
}

}  // namespace virtual_work_dynamics
