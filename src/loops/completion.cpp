#include "loops/completion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/condition_sizes.h"
#include "loops/zero_rows.h"

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

std::vector<RowBlock> conditionBlocks(const Mechanism& mechanism, const LoopGroup& group,
                                      const LoopKinematics& kinematics) {
  const std::vector<bool> zero = zeroRows(mechanism, kinematics);
  std::vector<RowBlock> blocks;
  for (std::size_t local = 0; local < group.sets.size(); ++local) {
    const std::size_t set = group.sets[local];
    blocks.push_back(
        {conditionsOf(kinematics, set), group.moved[local], zeroRowsOf(kinematics, set, zero)});
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
      qr(conditionBlocks(mechanism, own, kinematics), static_cast<int>(own.coordinates.size())),
      rank(sizesOf(mechanism, kinematics, own, length, rank_tolerance), qr.columns(),
           rank_tolerance),
      wanted(own.coordinates.size()) {}

LoopCompletion::LoopCompletion(const Mechanism& mechanism, const LoopKinematics& kinematics,
                               const std::vector<LoopGroup>& groups, double rank_tolerance,
                               double length)
    : kernel_(&loopKernelFor(chosenInstructionSet()).one),
      rank_tolerance_(rank_tolerance),
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
    system.found.reserve(system.group.coordinates.size());
    for (const std::vector<int>& moved : system.group.moved) {
      system.entries.emplace_back();
      system.entries.back().columns.reserve(moved.size());
      system.entries.back().places.reserve(moved.size());
    }
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
    system.found.clear();
    for (std::size_t i = 0; i < group.coordinates.size(); ++i) {
      if (system.wanted[i]) system.found.push_back(static_cast<int>(i));
    }
    for (std::size_t local = 0; local < group.sets.size(); ++local) {
      System::Entries& entries = system.entries[local];
      entries.columns.clear();
      entries.places.clear();
      for (std::size_t k = 0; k < group.moved[local].size(); ++k) {
        const int place = group.moved[local][k];
        if (!system.wanted[static_cast<std::size_t>(place)]) continue;
        const int coordinate = group.coordinates[static_cast<std::size_t>(place)];
        entries.columns.push_back({coordinate, static_cast<int>(k), columnScale(coordinate)});
        entries.places.push_back(place);
      }
    }
  }
}

void LoopCompletion::setEntries(const LoopKinematics& kinematics,
                                const Eigen::VectorXd& row_scales) {
  for (System& system : systems_) {
    for (std::size_t local = 0; local < system.entries.size(); ++local) {
      const std::size_t set = system.group.sets[local];
      const std::vector<ScaledColumn>& columns = system.entries[local].columns;
      Eigen::MatrixXd& entries = system.qr.entriesOf(local);
      kernel_->scaleColumns(
          kinematics.rowsOf(set),
          {columns.data(), static_cast<int>(columns.size()), static_cast<int>(entries.rows())},
          row_scales.data() + kinematics.firstOf(set), kinematics.entriesOf(set), entries.data());
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

// Sets found_, by the group's coordinates, for those that are not given. Returns false when the
// conditions do not determine them well.
bool LoopCompletion::solve(System& system) {
  auto found = found_.head(system.qr.columns());
  if (system.sound) {
    system.qr.leastSquares(right_.data(), found_.data());
    return true;
  }
  system.rank.decide(system.qr, system.wanted);
  system.rank.solve(right_.head(system.qr.rows()), found);
  return system.rank.rank() == system.rank.columns() && system.rank.condition() <= kSharpest;
}

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
  for (const int place : system.found) found_[place] -= refined_[place];
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
    double longest = 0;
    for (const int place : system.found) longest = std::max(longest, std::abs(found_[place]));
    const double damping = longest > kLongestStep ? kLongestStep / longest : 1;
    for (const int place : system.found) {
      const int coordinate = system.group.coordinates[static_cast<std::size_t>(place)];
      step_[coordinate] = damping * columnScale(coordinate) * found_[place];
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
    for (const int place : system.found) {
      const int coordinate = system.group.coordinates[static_cast<std::size_t>(place)];
      unknown[coordinate] = columnScale(coordinate) * found_[place];
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
