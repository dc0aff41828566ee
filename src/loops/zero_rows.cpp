#include "loops/zero_rows.h"

#include <algorithm>
#include <limits>
#include <random>

namespace virtual_work_dynamics {

namespace {

// A row is an analytic function of the position: when it is zero in a few that have nothing in
// common with each other, it is zero in all.
constexpr int kPositions = 6;
constexpr double kLargestTurn = 3;  // rad; slides go as far, in lengths of the mechanism
// Roundings of the products that a row is made of, in units of the numbers that cancel.
constexpr double kRowRounding = 256 * std::numeric_limits<double>::epsilon();

// The largest distance of a frame on the paths of closures from the root.
double reachOf(const LoopKinematics& kinematics) {
  double reach = 0;
  for (std::size_t c = 0; c < kinematics.closures(); ++c) {
    reach = std::max({reach, kinematics.parentOrigin(c).norm(), kinematics.childOrigin(c).norm()});
    for (const PathStep& step : kinematics.path(c)) {
      reach = std::max(reach, kinematics.originOf(step.joint + 1).norm());
    }
  }
  return reach;
}

}  // namespace

std::vector<bool> zeroRows(const Mechanism& mechanism, const LoopKinematics& given) {
  std::vector<bool> zero(static_cast<std::size_t>(given.conditions()), false);
  if (given.drives()) return zero;
  LoopKinematics kinematics = given;
  // Only closures' rows depend on nothing but the position.
  for (Eigen::Index i = 0; i < kinematics.firstOf(kinematics.closures()); ++i) {
    zero[static_cast<std::size_t>(i)] = !kinematics.condition(i).adopts_constant;
  }
  const double length = std::max(reachOf(kinematics), std::numeric_limits<double>::min());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> turn(-kLargestTurn, kLargestTurn);
  Eigen::VectorXd q(kinematics.jacobian().cols());
  for (int n = 0; n < kPositions; ++n) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = turn(random) * scaleOf(mechanism.unitOf(static_cast<int>(i)), length);
    }
    kinematics.setPosition(q);
    const double reach = std::max(reachOf(kinematics), length);
    for (Eigen::Index i = 0; i < kinematics.conditions(); ++i) {
      if (!zero[static_cast<std::size_t>(i)]) continue;
      const double size = scaleOf(kinematics.condition(i).unit, reach);
      const double largest = kinematics.jacobian().row(i).cwiseAbs().maxCoeff();
      zero[static_cast<std::size_t>(i)] = largest <= kRowRounding * size;
    }
  }
  return zero;
}

std::vector<int> zeroRowsOf(const LoopKinematics& kinematics, std::size_t set,
                            const std::vector<bool>& zero) {
  std::vector<int> rows;
  const Eigen::Index first = kinematics.firstOf(set);
  for (Eigen::Index i = first; i < kinematics.firstOf(set + 1); ++i) {
    if (zero[static_cast<std::size_t>(i)]) rows.push_back(static_cast<int>(i - first));
  }
  return rows;
}

}  // namespace virtual_work_dynamics
