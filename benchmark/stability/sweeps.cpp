#include "stability/sweeps.h"

#include <cstdlib>
#include <utility>

namespace virtual_work_dynamics {
namespace {

double drawn(RandomNumbers& random, double range, double zeros) {
  const double value = random.uniform(-range, range);
  if (zeros > 0 && random.chance(zeros)) return random.chance(0.5) ? 0.0 : -0.0;
  return value;
}

std::vector<Sweep> joined(const std::vector<std::vector<Sweep>>& families) {
  std::vector<Sweep> all;
  for (const std::vector<Sweep>& family : families) {
    all.insert(all.end(), family.begin(), family.end());
  }
  return all;
}

}  // namespace

StabilityCase caseOf(Mechanism mechanism, const MotionRange& range, Scene scene) {
  std::vector<double> sizes;  // of the coordinates; 0: turns
  for (const int k : mechanism.coordinates()) {
    const Joint& joint = mechanism.joints()[k];
    const bool slides = joint.type == JointType::kPrismatic;
    sizes.push_back(slides ? static_cast<double>(joint.p_PoKo_P.norm()) : 0);
  }
  const auto motion = [sizes, range](RandomNumbers& random) {
    Motion state(static_cast<Eigen::Index>(sizes.size()));
    for (Eigen::Index i = 0; i < state.q.size(); ++i) {
      const double size = sizes[static_cast<std::size_t>(i)];
      const double unit = size > 0 ? size : 1;
      state.q[i] = drawn(random, size > 0 ? size * range.slide : range.angle, range.zeros);
      state.qd[i] = drawn(random, unit * range.rate, range.zeros);
      state.qdd[i] = drawn(random, unit * range.acceleration, range.zeros);
    }
    return state;
  };
  return {std::move(mechanism), std::move(scene), motion};
}

std::vector<double> powersOfTen(int from, int to, int step) {
  std::vector<double> values;
  for (int exponent = from; exponent <= to; exponent += step) {
    values.push_back(std::strtod(("1e" + std::to_string(exponent)).c_str(), nullptr));
  }
  return values;
}

std::vector<Sweep> treeSweeps() {
  return joined({bodySweeps(), motionSweeps(), structureSweeps(), balanceSweeps()});
}

std::vector<Sweep> loopSweeps() {
  return joined({fourBarSweeps(), heldSweeps(), linkageSweeps(), touchSweeps()});
}

}  // namespace virtual_work_dynamics
