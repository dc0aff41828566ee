#include "loops/completion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/condition_sizes.h"

namespace virtual_work_dynamics {

namespace {

// How often a step is halved when the loops are closed to the rank's tolerance: near singular
// positions half a step often helps, and where frames fit no better none does.
constexpr int kHalvingsWhenClosed = 4;
// Misfit over the length below which a loop counts as closed, as it also does below the rank's
// tolerance. Newton's method goes on until rounding stops it or is all that is left of each
// condition.
constexpr double kClosed = 1e-12;
constexpr double kExact = std::numeric_limits<double>::epsilon();
// Misfit of a condition below which a step that does not lessen it was stopped by rounding.
constexpr double kRounding = 20 * kExact;
// Longest step, rad or of the length, so that an almost singular position does not cause a jump.
constexpr double kLongestStep = 0.5;
// Longest step, rad or of the length, after which rates are refined from the factorization before
// it: once, to the square of the step.
constexpr double kCloseBy = 1e-7;
// How much of the right side refined rates may miss.
constexpr double kRefined = 16 * kExact;
// How far velocities and accelerations may contradict the conditions, relative to the largest term.
constexpr double kConsistent = 1e-8;

// Condition number above which conditions count as singular: Newton's method finds a singular
// position only to the square root of rounding, and the Jacobian there, truly singular, shows a
// condition number of about 1e8.
constexpr double kSharpest = 1e7;

Eigen::Index conditionsOf(const LoopKinematics& kinematics, std::size_t set) {
  return kinematics.firstOf(set + 1) - kinematics.firstOf(set);
}

Eigen::Index ownConditions(const LoopGroup& group, const LoopKinematics& kinematics) {
  Eigen::Index own = 0;
  for (const std::size_t s : group.sets) own += conditionsOf(kinematics, s);
  return own;
}

Eigen::Index mostCoordinates(const std::vector<LoopGroup>& groups) {
  std::size_t most = 0;
  for (const LoopGroup& group : groups) most = std::max(most, group.coordinates.size());
  return static_cast<Eigen::Index>(most);
}

Eigen::Index mostConditions(const std::vector<LoopGroup>& groups,
                            const LoopKinematics& kinematics) {
  Eigen::Index most = 0;
  for (const LoopGroup& group : groups) most = std::max(most, ownConditions(group, kinematics));
  return most;
}

std::vector<RowBlock> conditionBlocks(const LoopGroup& group, const LoopKinematics& kinematics) {
  std::vector<RowBlock> blocks;
  for (std::size_t local = 0; local < group.sets.size(); ++local) {
    blocks.push_back({conditionsOf(kinematics, group.sets[local]), group.moved[local]});
  }
  return blocks;
}

Eigen::VectorXd sizesOf(const Mechanism& mechanism, const LoopKinematics& kinematics,
                        const LoopGroup& group, double length, double rank_tolerance) {
  const ConditionSizes sizes(mechanism, kinematics, group, length, rank_tolerance);
  Eigen::VectorXd by_row(ownConditions(group, kinematics));
  Eigen::Index row = 0;
  for (std::size_t local = 0; local < group.sets.size(); ++local) {
    const std::size_t s = group.sets[local];
    for (Eigen::Index i = kinematics.firstOf(s); i < kinematics.firstOf(s + 1); ++i) {
      by_row[row++] = sizes.ofRow(local, kinematics.condition(i).unit);
    }
  }
  return by_row;
}

}  // namespace

constexpr LoopCompletion::Search LoopCompletion::kFromAnywhere;
constexpr LoopCompletion::Search LoopCompletion::kFromCloseBy;

LoopCompletion::System::System(const Mechanism& mechanism, const LoopKinematics& kinematics,
                               const LoopGroup& own, double rank_tolerance, double length)
    : group(own),
      qr(conditionBlocks(own, kinematics), static_cast<int>(own.coordinates.size())),
      rank(sizesOf(mechanism, kinematics, own, length, rank_tolerance), qr.columns(),
           rank_tolerance),
      wanted(own.coordinates.size()) {}

LoopCompletion::LoopCompletion(const Mechanism& mechanism, const LoopKinematics& kinematics,
                               const std::vector<LoopGroup>& groups, double rank_tolerance,
                               double length)
    : rank_tolerance_(rank_tolerance),
      length_(length),
      row_scales_(kinematics.conditions()),
      in_loop_(mechanism.coordinates().size()),
      right_(mostConditions(groups, kinematics)),
      found_(mostCoordinates(groups)),
      misses_(right_.size()),
      refined_(found_.size()) {
  for (Eigen::Index i = 0; i < row_scales_.size(); ++i) {
    row_scales_[i] = 1 / scaleOf(kinematics.condition(i).unit, length);
  }
  position_scales_ = row_scales_;
  for (Eigen::Index i = 0; i < row_scales_.size(); ++i) {
    if (!kinematics.condition(i).has_position) position_scales_[i] = 0;
  }
  for (int i = 0; i < static_cast<int>(in_loop_.size()); ++i) {
    column_scales_.push_back(scaleOf(mechanism.unitOf(i), length));
  }
  for (const LoopGroup& group : groups) {
    systems_.emplace_back(mechanism, kinematics, group, rank_tolerance, length);
    for (const int i : group.coordinates) in_loop_[static_cast<std::size_t>(i)] = true;
  }
  for (System& system : systems_) {
    std::size_t most = 0;
    for (const std::vector<int>& moved : system.group.moved) most += moved.size();
    system.entries.reserve(most);
  }
  given_.assign(in_loop_.size(), true);
  want(std::vector<bool>(in_loop_.size(), false));
  step_.setZero(static_cast<Eigen::Index>(in_loop_.size()));
  tried_ = step_;
}

std::vector<LoopGroup> LoopCompletion::groups() const {
  std::vector<LoopGroup> groups;
  for (const System& system : systems_) groups.push_back(system.group);
  return groups;
}

double LoopCompletion::columnScale(int coordinate) const {
  return column_scales_[static_cast<std::size_t>(coordinate)];
}

// Makes the coordinates that are not given those to be found.
void LoopCompletion::want(const std::vector<bool>& given) {
  if (given_ == given) return;
  given_ = given;
  for (System& system : systems_) {
    const LoopGroup& group = system.group;
    for (std::size_t i = 0; i < group.coordinates.size(); ++i) {
      system.wanted[i] = !given[static_cast<std::size_t>(group.coordinates[i])];
    }
    system.qr.setPresent(system.wanted);
    system.entries.clear();
    for (std::size_t local = 0; local < group.sets.size(); ++local) {
      for (std::size_t k = 0; k < group.moved[local].size(); ++k) {
        const int place = group.moved[local][k];
        if (!system.wanted[static_cast<std::size_t>(place)]) continue;
        system.entries.push_back({local, static_cast<Eigen::Index>(k), place,
                                  group.coordinates[static_cast<std::size_t>(place)]});
      }
    }
  }
}

void LoopCompletion::setEntries(const LoopKinematics& kinematics,
                                const Eigen::VectorXd& row_scales) {
  for (System& system : systems_) {
    for (const System::Entry& entry : system.entries) {
      const Eigen::Index first = kinematics.firstOf(system.group.sets[entry.local]);
      Eigen::MatrixXd& entries = system.qr.entriesOf(entry.local);
      const double* from = kinematics.jacobian().col(entry.coordinate).data() + first;
      const double* row_scale = row_scales.data() + first;
      double* to = entries.col(entry.column).data();
      const double scale = columnScale(entry.coordinate);
      for (Eigen::Index i = 0; i < entries.rows(); ++i) to[i] = row_scale[i] * from[i] * scale;
    }
  }
}

void LoopCompletion::factorize(const LoopKinematics& kinematics,
                               const Eigen::VectorXd& row_scales) {
  setEntries(kinematics, row_scales);
  close_by_ = false;
  for (System& system : systems_) {
    system.sound = system.qr.factorize(MultifrontalQr::sureCondition(rank_tolerance_),
                                       system.rank.largestSize());
  }
}

// Whether all factorizations are well-conditioned.
bool LoopCompletion::sound() const {
  return std::all_of(systems_.begin(), systems_.end(),
                     [](const System& system) { return system.sound; });
}

Eigen::Index LoopCompletion::rank(const LoopKinematics& kinematics,
                                  const std::vector<bool>& given) {
  Eigen::Index sum = 0;
  want(given);
  factorize(kinematics, position_scales_);
  for (System& system : systems_) {
    if (system.sound) {
      sum += std::count(system.wanted.begin(), system.wanted.end(), true);
    } else {
      system.rank.decide(system.qr, system.wanted);
      sum += system.rank.rank();
    }
  }
  return sum;
}

bool LoopCompletion::determine(const LoopKinematics& kinematics, const std::vector<bool>& given) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i] && !in_loop_[i]) return false;
  }
  want(given);
  factorize(kinematics, row_scales_);
  right_.setZero();
  return std::all_of(systems_.begin(), systems_.end(),
                     [this](System& system) { return solve(system); });
}

void LoopCompletion::setRight(const LoopKinematics& kinematics, const System& system,
                              const Eigen::VectorXd& conditions) {
  double* right = right_.data();
  for (const std::size_t s : system.group.sets) {
    for (Eigen::Index i = kinematics.firstOf(s); i < kinematics.firstOf(s + 1); ++i) {
      *right++ = -row_scales_[i] * conditions[i];
    }
  }
}

// Sets found_, by the group's coordinates, with zero for given ones. Returns false when the
// conditions do not determine them well.
bool LoopCompletion::solve(System& system) {
  auto found = found_.head(system.qr.columns());
  const auto right = right_.head(system.qr.rows());
  if (system.sound) {
    system.qr.leastSquares(right, found);
    return true;
  }
  system.rank.decide(system.qr, system.wanted);
  system.rank.solve(right, found);
  return system.rank.rank() == system.rank.columns() && system.rank.condition() <= kSharpest;
}

// Finds the largest violation of a condition by what solve() found.
double LoopCompletion::misses(const System& system) {
  const MultifrontalQr& qr = system.qr;
  auto misses = misses_.head(qr.rows());
  misses = -right_.head(qr.rows());
  for (const System::Entry& entry : system.entries) {
    const Eigen::MatrixXd& entries = qr.entriesOf(entry.local);
    const double* column = entries.col(entry.column).data();
    double* sum = misses_.data() + qr.firstOf(entry.local);
    const double factor = found_[entry.place];
    for (Eigen::Index i = 0; i < entries.rows(); ++i) sum[i] += factor * column[i];
  }
  return misses.cwiseAbs().maxCoeff();
}

// Corrects what solve() found by the factorization of a position close by. Returns false when that
// does not suffice.
bool LoopCompletion::refine(System& system) {
  const Eigen::Index columns = system.qr.columns();
  const double enough = kRefined * right_.head(system.qr.rows()).cwiseAbs().maxCoeff();
  if (misses(system) <= enough) return true;
  system.qr.leastSquares(misses_.head(system.qr.rows()), refined_.head(columns));
  found_.head(columns) -= refined_.head(columns);
  return misses(system) <= enough;
}

double LoopCompletion::misfit(const LoopKinematics& kinematics) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < kinematics.conditions(); ++i) {
    const double scaled = position_scales_[i] * kinematics.phi()[i];
    sum += scaled * scaled;
  }
  return std::sqrt(sum);
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

// Sets the step that the latest factorization leads to.
void LoopCompletion::setStep(const LoopKinematics& kinematics) {
  step_.setZero();
  step_length_ = 0;
  for (System& system : systems_) {
    setRight(kinematics, system, kinematics.phi());
    solve(system);
    const double longest = found_.head(system.qr.columns()).cwiseAbs().maxCoeff();
    const double damping = longest > kLongestStep ? kLongestStep / longest : 1;
    for (std::size_t i = 0; i < system.group.coordinates.size(); ++i) {
      const int coordinate = system.group.coordinates[i];
      step_[coordinate] = damping * columnScale(coordinate) * found_[static_cast<Eigen::Index>(i)];
    }
    step_length_ = std::max(step_length_, damping * longest);
  }
}

// A step s leaves a misfit of about |H| s^2 / 2, where H holds the second derivatives of the
// conditions; a step s' that the same factorization leads to from there, one of about |H| s s'. So
// the misfit before s' and both steps tell the misfit after it, and whether another factorization
// can be spared.
bool LoopCompletion::close(LoopKinematics& kinematics, Eigen::VectorXd& q,
                           const std::vector<bool>& given, const Search& search) {
  want(given);
  close_by_ = false;
  kinematics.setPosition(q);
  double now = misfit(kinematics);
  const double closed = std::max(kClosed, rank_tolerance_);
  const double root = std::sqrt(static_cast<double>((position_scales_.array() > 0).count()));
  const double exact = kExact * root, rounding = kRounding * root;
  double before = 0;  // length of the step before, when its factorization may serve again
  for (steps_ = 0; steps_ < search.most_steps && now > exact && std::isfinite(now); ++steps_) {
    bool last = false;
    if (before > 0) {
      setStep(kinematics);
      last = 2 * now * step_length_ <= exact * before;
    }
    if (!last) {
      factorize(kinematics, position_scales_);
      setStep(kinematics);
    }
    double factor = 1, then = now;
    const int halvings = now <= closed ? kHalvingsWhenClosed : search.most_halvings;
    for (int halving = 0; halving < halvings; ++halving, factor /= 2) {
      tried_ = q + factor * step_;
      kinematics.setPosition(tried_);
      then = misfit(kinematics);
      if (then < now || now <= rounding) break;
    }
    if (!(then < now)) {
      kinematics.setPosition(q);
      close_by_ = close_by_ || (!last && sound());
      break;
    }
    q = tried_;
    const bool stalled = then > search.stalled * now && then > closed;
    now = then;
    if (stalled || (last && now <= rounding)) break;
    before = !last && factor == 1 && sound() ? step_length_ : 0;
    close_by_ = before > 0 && before <= kCloseBy;
  }
  return now <= closed;
}

// Solves (3.2), A_p u = -rates, for the entries of `unknown` that are not given.
bool LoopCompletion::solveRates(const LoopKinematics& kinematics, const Eigen::VectorXd& rates,
                                double size, Eigen::VectorXd& unknown) {
  for (System& system : systems_) {
    setRight(kinematics, system, rates);
    if (!solve(system)) return false;
    if (close_by_ ? !refine(system) : !(misses(system) <= kConsistent * size)) return false;
    for (std::size_t i = 0; i < system.group.coordinates.size(); ++i) {
      if (!system.wanted[i]) continue;
      const int coordinate = system.group.coordinates[i];
      unknown[coordinate] = columnScale(coordinate) * found_[static_cast<Eigen::Index>(i)];
    }
  }
  return true;
}

bool LoopCompletion::complete(LoopKinematics& kinematics, Motion& motion,
                              const std::vector<bool>& given, const Search& search) {
  if (!close(kinematics, motion.q, given, search)) return false;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i] && !in_loop_[i]) return false;
  }
  if (close_by_ && row_scales_ == position_scales_) {
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
  kinematics.setRates(motion.qd);
  double rate = largest(motion.qd);
  if (kinematics.drives()) rate = std::max(rate, largestCondition(kinematics.b()));
  if (!solveRates(kinematics, kinematics.rates(), rate, motion.qd)) return false;
  kinematics.setMotion(motion);
  rate = std::max(rate, largest(motion.qd));
  double size = std::max(largest(motion.qdd), rate * rate);
  if (kinematics.drives()) size = std::max(size, largestCondition(kinematics.bd()));
  return solveRates(kinematics, kinematics.accelerations(), size, motion.qdd);
}

}  // namespace virtual_work_dynamics
