#include "core/loop_completion.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

namespace {

constexpr int kMostSteps = 200;
constexpr int kMostHalvings = 30;
// Misfits over the length below which a loop counts as closed, as it does below the tolerance of
// the rank; Newton's method goes on until rounding stops it, usually at 1e-16.
constexpr double kClosed = 1e-12;
// A step turns nothing further than this, so that an almost singular position throws nothing away.
constexpr double kLongestStep = 0.5;
// What of velocities and accelerations may contradict the conditions, of the largest term.
constexpr double kConsistent = 1e-8;

// A position found by Newton's method is good to the square root of rounding where the conditions
// are singular, so that their Jacobian, singular in truth, shows a condition number of some 1e8
// there.
constexpr double kSharpest = 1e7;

Eigen::Index conditionsOf(const LoopKinematics& kinematics, std::size_t closure) {
  return kinematics.firstOf(closure + 1) - kinematics.firstOf(closure);
}

Eigen::Index mostCoordinates(const std::vector<LoopGroup>& groups) {
  std::size_t most = 0;
  for (const LoopGroup& group : groups) most = std::max(most, group.coordinates.size());
  return static_cast<Eigen::Index>(most);
}

// No closure has more than six conditions.
Eigen::Index mostConditions(const std::vector<LoopGroup>& groups) {
  std::size_t most = 0;
  for (const LoopGroup& group : groups) most = std::max(most, group.closures.size());
  return static_cast<Eigen::Index>(6 * most);
}

}  // namespace

LoopCompletion::LoopCompletion(const Mechanism& mechanism, const std::vector<LoopGroup>& groups,
                               double rank_tolerance, double length)
    : groups_(groups),
      rank_tolerance_(rank_tolerance),
      length_(length),
      factorization_(mostConditions(groups), mostCoordinates(groups)),
      A_(mostConditions(groups), mostCoordinates(groups)),
      right_(mostConditions(groups)),
      found_(mostCoordinates(groups)),
      columns_(static_cast<std::size_t>(mostCoordinates(groups))) {
  for (const int k : mechanism.coordinates()) {
    slides_.push_back(mechanism.joints()[static_cast<std::size_t>(k)].type ==
                      JointType::kPrismatic);
  }
  in_loop_.resize(slides_.size());
  for (const LoopGroup& group : groups) {
    for (const int i : group.coordinates) in_loop_[static_cast<std::size_t>(i)] = true;
  }
  step_.setZero(static_cast<Eigen::Index>(slides_.size()));
  tried_ = step_;
}

double LoopCompletion::rowScale(const LoopKinematics& kinematics, Eigen::Index condition) const {
  return kinematics.turns(condition) ? 1 : 1 / length_;
}

double LoopCompletion::columnScale(int coordinate) const {
  return slides_[static_cast<std::size_t>(coordinate)] ? length_ : 1;
}

void LoopCompletion::factorize(const LoopKinematics& kinematics, const LoopGroup& group,
                               const std::vector<bool>& given) {
  column_count_ = 0;
  for (const int coordinate : group.coordinates) {
    if (!given[static_cast<std::size_t>(coordinate)]) columns_[column_count_++] = coordinate;
  }
  row_count_ = 0;
  for (const std::size_t c : group.closures) {
    for (Eigen::Index i = 0; i < conditionsOf(kinematics, c); ++i, ++row_count_) {
      const Eigen::Index condition = kinematics.firstOf(c) + i;
      for (std::size_t j = 0; j < column_count_; ++j) {
        A_(row_count_, static_cast<Eigen::Index>(j)) =
            rowScale(kinematics, condition) * kinematics.jacobian()(condition, columns_[j]) *
            columnScale(columns_[j]);
      }
    }
  }
  factorization_.factorize(A_.topLeftCorner(row_count_, static_cast<Eigen::Index>(column_count_)),
                           rank_tolerance_);
}

Eigen::Index LoopCompletion::rank(const LoopKinematics& kinematics,
                                  const std::vector<bool>& given) {
  Eigen::Index sum = 0;
  for (const LoopGroup& group : groups_) {
    factorize(kinematics, group, given);
    sum += factorization_.rank();
  }
  return sum;
}

double LoopCompletion::misfit(const LoopKinematics& kinematics) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < kinematics.conditions(); ++i) {
    const double scaled = rowScale(kinematics, i) * kinematics.phi()[i];
    sum += scaled * scaled;
  }
  return std::sqrt(sum);
}

double LoopCompletion::largest(const Eigen::VectorXd& rates) const {
  double most = 0;
  for (std::size_t i = 0; i < slides_.size(); ++i) {
    const double rate = rates[static_cast<Eigen::Index>(i)];
    most = std::max(most, std::abs(rate) / columnScale(static_cast<int>(i)));
  }
  return most;
}

void LoopCompletion::newtonStep(const LoopKinematics& kinematics, const std::vector<bool>& given) {
  step_.setZero();
  for (const LoopGroup& group : groups_) {
    factorize(kinematics, group, given);
    Eigen::Index row = 0;
    for (const std::size_t c : group.closures) {
      for (Eigen::Index i = 0; i < conditionsOf(kinematics, c); ++i) {
        const Eigen::Index condition = kinematics.firstOf(c) + i;
        right_[row++] = -rowScale(kinematics, condition) * kinematics.phi()[condition];
      }
    }
    auto found = found_.head(static_cast<Eigen::Index>(column_count_));
    factorization_.solve(right_.head(row_count_), found);
    const double longest = column_count_ > 0 ? found.cwiseAbs().maxCoeff() : 0;
    const double damping = longest > kLongestStep ? kLongestStep / longest : 1;
    for (std::size_t j = 0; j < column_count_; ++j) {
      step_[columns_[j]] = damping * columnScale(columns_[j]) * found[static_cast<Eigen::Index>(j)];
    }
  }
}

bool LoopCompletion::close(LoopKinematics& kinematics, Eigen::VectorXd& q,
                           const std::vector<bool>& given) {
  kinematics.setPosition(q);
  double now = misfit(kinematics);
  const double closed = std::max(kClosed, rank_tolerance_);
  for (steps_ = 0; steps_ < kMostSteps && now > 0 && std::isfinite(now); ++steps_) {
    newtonStep(kinematics, given);
    double factor = 1, then = now;
    for (int halving = 0; halving < kMostHalvings; ++halving, factor /= 2) {
      tried_ = q + factor * step_;
      kinematics.setPosition(tried_);
      then = misfit(kinematics);
      if (then < now || now <= closed) break;
    }
    if (!(then < now)) break;
    q = tried_;
    now = then;
  }
  kinematics.setPosition(q);
  return now <= closed;
}

// Solves A_p u = -rates for the entries of `unknown` that are not given.
bool LoopCompletion::solveRates(const LoopKinematics& kinematics, const std::vector<bool>& given,
                                const Eigen::VectorXd& rates, double size,
                                Eigen::VectorXd& unknown) {
  for (const LoopGroup& group : groups_) {
    factorize(kinematics, group, given);
    if (factorization_.redundancy() > 0 || factorization_.condition() > kSharpest) return false;
    Eigen::Index row = 0;
    for (const std::size_t c : group.closures) {
      for (Eigen::Index i = 0; i < conditionsOf(kinematics, c); ++i) {
        const Eigen::Index condition = kinematics.firstOf(c) + i;
        right_[row++] = -rowScale(kinematics, condition) * rates[condition];
      }
    }
    const Eigen::Index columns = static_cast<Eigen::Index>(column_count_);
    auto found = found_.head(columns);
    const auto right = right_.head(row_count_);
    factorization_.solve(right, found);
    for (Eigen::Index i = 0; i < row_count_; ++i) {
      const double misses = A_.row(i).head(columns).dot(found.transpose()) - right[i];
      if (!(std::abs(misses) <= kConsistent * size)) return false;
    }
    for (std::size_t j = 0; j < column_count_; ++j) {
      unknown[columns_[j]] = columnScale(columns_[j]) * found[static_cast<Eigen::Index>(j)];
    }
  }
  return true;
}

bool LoopCompletion::complete(LoopKinematics& kinematics, Motion& motion,
                              const std::vector<bool>& given) {
  if (!close(kinematics, motion.q, given)) return false;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i]) continue;
    if (!in_loop_[i]) return false;
    motion.qd[static_cast<Eigen::Index>(i)] = 0;
    motion.qdd[static_cast<Eigen::Index>(i)] = 0;
  }
  kinematics.setMotion(motion);
  const double given_rate = largest(motion.qd);
  if (!solveRates(kinematics, given, kinematics.rates(), given_rate, motion.qd)) return false;
  kinematics.setMotion(motion);
  const double rate = largest(motion.qd);
  const double size = std::max(largest(motion.qdd), rate * rate);
  return solveRates(kinematics, given, kinematics.accelerations(), size, motion.qdd);
}

}  // namespace virtual_work_dynamics
