#include "loops/zero_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace virtual_work_dynamics {

namespace {

// A row is an analytic function of the position: when it is zero in a few that have nothing in
// common with each other, it is zero in all.
constexpr int kPositions = 6;
constexpr double kLargestTurn = 3;  // rad; slides go as far, in lengths of the loops
// Entries that count as roundings of the products that they are made of, over their size without
// cancellation. To leave out a row changes results by so much, and that must be rounding, too.
constexpr double kRowRounding = 16 * std::numeric_limits<double>::epsilon();
// LoopExtent of a loop, over its distance from the root or the largest extent, below which it is
// rounding itself.
constexpr double kLeastExtent = 1e-4;

/// Distances between origins on the path of a closure, and from the root.
struct LoopExtent {
  double largest = 0, reach = 0;
};

LoopExtent extentOfLoop(const LoopKinematics& kinematics, std::size_t closure) {
  LoopExtent extent;
  std::vector<Eigen::Vector3d> origins{kinematics.parentEnd(closure),
                                       kinematics.childOrigin(closure)};
  for (const PathStep& step : kinematics.path(closure)) {
    const Eigen::Vector3d& origin = kinematics.originOf(step.joint + 1);
    extent.reach = std::max(extent.reach, origin.norm());
    if (kinematics.sizes(closure, step.joint)) origins.push_back(origin);
  }
  for (const Eigen::Vector3d& a : origins) {
    extent.reach = std::max(extent.reach, a.norm());
    for (const Eigen::Vector3d& b : origins) {
      extent.largest = std::max(extent.largest, (a - b).norm());
    }
  }
  return extent;
}

// By closure: the length that levers of its rows are compared with; never zero.
std::vector<double> lengthsOfLoops(const LoopKinematics& kinematics) {
  std::vector<LoopExtent> extents;
  double largest = 0, reach = 0;
  for (std::size_t c = 0; c < kinematics.closures(); ++c) {
    extents.push_back(extentOfLoop(kinematics, c));
    largest = std::max(largest, extents.back().largest);
    reach = std::max(reach, extents.back().reach);
  }
  if (!(largest > kLeastExtent * reach)) largest = reach > 0 ? reach : 1;
  std::vector<double> lengths;
  for (const LoopExtent& extent : extents) {
    const double least = kLeastExtent * std::max(extent.reach, largest);
    lengths.push_back(extent.largest > least ? extent.largest : std::max(extent.reach, largest));
  }
  return lengths;
}

// The largest change of a closure's condition when a coordinate turns by one radian or slides by
// `length`.
double largestEntry(const Mechanism& mechanism, const LoopKinematics& kinematics,
                    std::size_t closure, Eigen::Index condition, double length) {
  double largest = 0;
  for (const int k : kinematics.set(closure).coordinates()) {
    const double scale = scaleOf(mechanism.unitOf(k), length);
    largest = std::max(largest, scale * std::abs(kinematics.jacobian()(condition, k)));
  }
  return largest;
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
  const std::vector<double> lengths = lengthsOfLoops(kinematics);
  const double length = lengths.empty() ? 1 : *std::max_element(lengths.begin(), lengths.end());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> turn(-kLargestTurn, kLargestTurn);
  Eigen::VectorXd q(kinematics.jacobian().cols());
  for (int n = 0; n < kPositions; ++n) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = turn(random) * scaleOf(mechanism.unitOf(static_cast<int>(i)), length);
    }
    kinematics.setPosition(q);
    for (std::size_t c = 0; c < lengths.size(); ++c) {
      for (Eigen::Index i = kinematics.firstOf(c); i < kinematics.firstOf(c + 1); ++i) {
        if (!zero[static_cast<std::size_t>(i)]) continue;
        const double size = scaleOf(kinematics.condition(i).unit, lengths[c]);
        zero[static_cast<std::size_t>(i)] =
            largestEntry(mechanism, kinematics, c, i, lengths[c]) <= kRowRounding * size;
      }
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
