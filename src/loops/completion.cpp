#include "loops/completion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loops/condition_sizes.h"
#include "loops/zero_rows.h"

namespace virtual_work_dynamics {

namespace {

// Condition number above which conditions count as singular: Newton's method finds a singular
// position only to the square root of rounding, and the Jacobian there, truly singular, shows a
// condition number of about 1e8.
constexpr double kSharpest = 1e7;
// Misfit of a condition that is all that rounding leaves, and below which a step that does not
// lessen it was stopped by rounding.
constexpr double kExact = std::numeric_limits<double>::epsilon();
constexpr double kRounding = 20 * kExact;
// Number of coordinates to be found from which refining rates costs less than factorizing.
constexpr std::size_t kLeastRefined = 10;

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
      wanted(own.coordinates.size()) {
  for (const int i : own.coordinates) bends.push_back(kinematics.bends(i));
  for (const std::size_t s : own.sets) {
    const Eigen::Index first = kinematics.firstOf(s), count = conditionsOf(kinematics, s);
    if (!conditions.empty() && conditions.back().first + conditions.back().count == first) {
      conditions.back().count += count;
    } else {
      conditions.push_back({first, count});
    }
  }
}

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
  step_.setZero(static_cast<Eigen::Index>(in_loop_.size()));
  bend_ = tried_ = step_;
  given_.assign(in_loop_.size(), true);
  want(std::vector<bool>(in_loop_.size(), false));
  const auto places = (position_scales_.array() > 0).count();
  all_places_ = places == position_scales_.size();
  const double root = std::sqrt(static_cast<double>(places));
  exact_ = kExact * root;
  rounding_ = kRounding * root;
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
  determinable_ = refines_ = true;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i] && !in_loop_[i]) determinable_ = false;
  }
  step_.setZero();  // of other coordinates nothing is set
  bend_.setZero();
  for (System& system : systems_) {
    const LoopGroup& group = system.group;
    for (std::size_t i = 0; i < group.coordinates.size(); ++i) {
      system.wanted[i] = !given[static_cast<std::size_t>(group.coordinates[i])];
    }
    system.qr.setPresent(system.wanted);
    system.found.clear();
    for (std::size_t i = 0; i < group.coordinates.size(); ++i) {
      if (!system.wanted[i]) continue;
      const int coordinate = group.coordinates[i];
      system.found.push_back(
          {static_cast<int>(i), coordinate, columnScale(coordinate), system.bends[i]});
    }
    system.square = system.qr.layout().filledRows() == system.found.size();
    refines_ = refines_ && system.found.size() >= kLeastRefined;
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
  return rankBy(position_scales_, kinematics, given);
}

Eigen::Index LoopCompletion::rankOfRates(const LoopKinematics& kinematics,
                                         const std::vector<bool>& given) {
  return rankBy(row_scales_, kinematics, given);
}

Eigen::Index LoopCompletion::rankBy(const Eigen::VectorXd& row_scales,
                                    const LoopKinematics& kinematics,
                                    const std::vector<bool>& given) {
  Eigen::Index sum = 0;
  want(given);
  factorize(kinematics, row_scales);
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
  want(given);
  if (!determinable_) return false;
  factorize(kinematics, row_scales_);
  right_.setZero();
  return std::all_of(systems_.begin(), systems_.end(),
                     [this](System& system) { return solve(system); });
}

void LoopCompletion::setRight(const System& system, const Eigen::VectorXd& conditions) {
  double* right = right_.data();
  for (const System::Conditions& own : system.conditions) {
    const double* const scales = row_scales_.data() + own.first;
    const double* const values = conditions.data() + own.first;
    for (Eigen::Index i = 0; i < own.count; ++i) right[i] = -scales[i] * values[i];
    right += own.count;
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

}  // namespace virtual_work_dynamics
