#include "loops/holds.h"

#include <cmath>

#include "scene/touch_rows.h"

namespace virtual_work_dynamics {

namespace {

// Forces below this fraction of the largest of the loops are rounding errors of a position that is
// not close to singular.
constexpr double kNoForce = 1e-10;

// @param force(i) of the item's unknown i   @param determined(i) whether it is
// @param rounding of forces
template <typename Force, typename Determined>
Hold judged(const LoopHolds::Item& item, double rounding, const Force& force,
            const Determined& determined) {
  if (!determined(item.acting)) return Hold::kNotDecidable;
  const double acting = item.sign * force(item.acting);
  if (acting < -rounding) return Hold::kWrongWay;
  if (!item.friction) return Hold::kHolds;
  double square = 0;
  for (int i = item.along_begin; i < item.along_end; ++i) {
    if (!determined(i)) return Hold::kNotDecidable;
    const double along = force(i);
    square += along * along;
  }
  const double most = *item.friction * acting;
  return std::sqrt(square) <= most + rounding ? Hold::kHolds : Hold::kOutsideCone;
}

}  // namespace

LoopHolds::LoopHolds(const Scene& scene, const LoopKinematics& kinematics,
                     const std::vector<LoopGroup>& groups) {
  for (std::size_t c = 0; c < scene.closures.size(); ++c) {
    const Closure& closure = scene.closures[c];
    const bool touches = kinematics.closure(c).traits().touches();
    if (!(touches && closure.touch.normal) && !closure.pulls_only) continue;
    Item item{0, 0, 0, -1, 0, 0, {}};  // a cable's one unknown is an effort that pushes
    if (touches) {
      item.acting = conditionCount(closure) - 1;
      item.sign = 1;
      item.along_end = item.acting;
      item.friction = closure.touch.friction;
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (std::size_t local = 0; local < groups[g].closures.size(); ++local) {
        if (groups[g].closures[local] != c) continue;
        item.group = g;
        item.local = local;
      }
    }
    names_.push_back(closure.name);
    items_.push_back(item);
  }
}

Hold LoopHolds::judge(LoopForces& forces, const Item& item) {
  if (item.acting < 0) return Hold::kHolds;  // it is lifted
  const Eigen::Index first = forces.firstUnknownOf(item.local);
  const double* const units = forces.unitsOf(item.local);
  const Eigen::VectorXd& x = forces.solution().x;
  return judged(
      item, kNoForce * x.cwiseAbs().maxCoeff(), [&](int i) { return units[i] * x[first + i]; },
      [&](int i) { return forces.isDetermined(first + i); });
}

Hold LoopHolds::judge(const LoopForces& forces, const Item& item, const Packed& packed) {
  if (item.acting < 0) return Hold::kHolds;  // it is lifted
  const double* const units = forces.unitsOf(item.local);
  const auto first = static_cast<std::size_t>(forces.firstUnknownOf(item.local));
  const auto at = [&](const double* numbers, std::size_t i) {
    return numbers[i * packed.width + packed.sample];
  };
  return judged(
      item, kNoForce * packed.largest,
      [&](int i) { return units[i] * at(packed.x, first + static_cast<std::size_t>(i)); },
      [&](int i) {
        const auto place = static_cast<std::size_t>(i - item.along_begin);
        return !packed.null_squares || LoopForces::isUnique(at(packed.null_squares, place));
      });
}

void LoopHolds::judge(std::vector<LoopForces>& forces, std::vector<Hold>& holds) const {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    holds[i] = judge(forces[items_[i].group], items_[i]);
  }
}

}  // namespace virtual_work_dynamics
