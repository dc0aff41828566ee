#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/completion.h"

namespace virtual_work_dynamics {

namespace {

// How much of the right side refined rates may miss.
constexpr double kRefined = 16 * std::numeric_limits<double>::epsilon();
// How far velocities and accelerations may contradict the conditions, relative to the largest term.
constexpr double kConsistent = 1e-8;

}  // namespace

// Finds the largest violation of a condition by what solve() found.
double LoopCompletion::misses(const System& system) {
  const MultifrontalQr& qr = system.qr;
  const Eigen::Index rows = qr.rows();
  double* const misses = misses_.data();
  for (Eigen::Index i = 0; i < rows; ++i) misses[i] = -right_[i];
  for (std::size_t local = 0; local < system.entries.size(); ++local) {
    const System::Entries& own = system.entries[local];
    const Eigen::MatrixXd& entries = qr.entriesOf(local);
    double* const sums = misses + qr.firstOf(local);
    for (std::size_t k = 0; k < own.columns.size(); ++k) {
      const double* const column = entries.data() + own.columns[k].place * entries.rows();
      const double factor = found_[own.places[k]];
      for (Eigen::Index i = 0; i < entries.rows(); ++i) sums[i] += factor * column[i];
    }
  }
  double most = 0, sum = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    most = std::max(most, std::abs(misses[i]));
    sum += std::abs(misses[i]);
  }
  return std::isfinite(sum) ? most : std::numeric_limits<double>::infinity();
}

// Corrects what solve() found by the factorization of a position close by. Returns false when that
// does not suffice.
bool LoopCompletion::refine(System& system) {
  const double enough = kRefined * right_.head(system.qr.rows()).cwiseAbs().maxCoeff();
  if (misses(system) <= enough) return true;
  system.qr.leastSquares(misses_.data(), refined_.data());
  for (const System::Found& of : system.found) found_[of.place] -= refined_[of.place];
  return misses(system) <= enough;
}

// A square system that is well-conditioned contradicts nothing.
bool LoopCompletion::isMet(const System& system, double size) {
  if (!(system.square && system.sound)) return misses(system) <= kConsistent * size;
  double sum = 0;
  for (const System::Found& of : system.found) sum += std::abs(found_[of.place]);
  return std::isfinite(sum);
}

double LoopCompletion::largest(const Eigen::VectorXd& rates) const {
  double most = 0;
  for (std::size_t i = 0; i < in_loop_.size(); ++i) {
    const double rate = rates[static_cast<Eigen::Index>(i)];
    most = std::max(most, std::abs(rate) / columnScale(static_cast<int>(i)));
  }
  return most;
}

double LoopCompletion::largestCondition(const Eigen::VectorXd& conditions) const {
  double most = 0;
  for (Eigen::Index i = 0; i < conditions.size(); ++i) {
    most = std::max(most, std::abs(row_scales_[i] * conditions[i]));
  }
  return most;
}

// Solves (3.2), A_p u = -rates, for the entries of `unknown` that are not given.
bool LoopCompletion::solveRates(const Eigen::VectorXd& rates, double size,
                                Eigen::VectorXd& unknown) {
  for (System& system : systems_) {
    setRight(system, rates);
    if (!solve(system)) return false;
    if (close_by_ ? !refine(system) : !isMet(system, size)) return false;
    for (const System::Found& of : system.found) {
      unknown[of.coordinate] = of.scale * found_[of.place];
    }
  }
  return true;
}

bool LoopCompletion::complete(LoopKinematics& kinematics, Motion& motion,
                              const std::vector<bool>& given, const Search& search) {
  if (!close(kinematics, motion.q, given, search) || !determinable_) return false;
  if (close_by_ && refines_ && all_places_) {
    setEntries(kinematics, row_scales_);
    if (findRates(kinematics, motion)) return true;
  }
  factorize(kinematics, row_scales_);
  return findRates(kinematics, motion);
}

// Finds velocities and accelerations by the factorizations of this position, or one close by.
bool LoopCompletion::findRates(LoopKinematics& kinematics, Motion& motion) {
  for (std::size_t i = 0; i < given_.size(); ++i) {
    if (given_[i]) continue;
    motion.qd[static_cast<Eigen::Index>(i)] = 0;
    motion.qdd[static_cast<Eigen::Index>(i)] = 0;
  }
  // Sizes are for what may contradict itself.
  const bool sized =
      !close_by_ && !std::all_of(systems_.begin(), systems_.end(),
                                 [](const auto& of) { return of.square && of.sound; });
  kinematics.setRates(motion.qd);
  double rate = sized ? largest(motion.qd) : 0;
  if (sized && kinematics.drives()) rate = std::max(rate, largestCondition(kinematics.b()));
  if (!solveRates(kinematics.rates(), rate, motion.qd)) return false;
  kinematics.setMotion(motion);
  double size = 0;
  if (sized) {
    rate = std::max(rate, largest(motion.qd));
    size = std::max(largest(motion.qdd), rate * rate);
    if (kinematics.drives()) size = std::max(size, largestCondition(kinematics.bd()));
  }
  return solveRates(kinematics.accelerations(), size, motion.qdd);
}

}  // namespace virtual_work_dynamics
