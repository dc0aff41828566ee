#include "offline/rows.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/inertial_axes.h"
#include "motion/free_columns.h"
#include "offline/interval_columns.h"

namespace virtual_work_dynamics {

std::vector<std::string> loopColumns(const Columns& results,
                                     const std::vector<std::string>& closures) {
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < results.efforts.size(); ++i) {
    columns.push_back("determined." + results.effortColumn(i));
  }
  for (const std::string& name : results.reactions) {
    for (const char* component : kWrenchComponents) {
      columns.push_back("determined." + name + "." + component);
    }
  }
  for (const char* level : {"position", "velocity", "acceleration"}) {
    for (const std::string& closure : closures) {
      columns.push_back(std::string("residual.") + level + "." + closure);
    }
  }
  return columns;
}

void Conditions::note(std::size_t row, const Results& results) {
  const double condition = results.loops.determinacy.condition;
  if (results.singular()) return;
  if (condition > kCloseToSingular) ++close_;
  if (condition <= largest_) return;
  largest_ = condition;
  row_ = row;
}

std::string Conditions::worst(const MotionFile& file) const {
  if (largest_ == 0) return "singular positions only";
  std::ostringstream text;
  text.precision(3);
  text << "condition " << largest_ << " at worst, " << file.place(row_) << ", at "
       << numberText(file.table.times[row_]) << " s";
  return text.str();
}

Rows::Rows(const MotionFile& file, const Columns& columns, ReactionAxes axes, bool loops,
           ExtraColumns& extra, ResultTable& table)
    : file_(file),
      columns_(columns),
      child_axes_(axes == ReactionAxes::kChild),
      inertial_axes_(axes == ReactionAxes::kInertial),
      loops_(loops),
      extra_(extra),
      table_(table),
      effort_(static_cast<Eigen::Index>(columns.efforts.size())),
      reactions_(columns.reactions.size()) {}

void Rows::write(std::size_t row, const Motion& motion, const Load& load, const Results& results) {
  take(row, motion, results);
  more_.clear();
  if (loops_) {
    if (results.singular() && ++singular_ == 1) first_singular_row_ = row;
    if (results.undirected() && ++undirected_ == 1) first_undirected_row_ = row;
    if (results.singular() || results.undirected()) leaveOut(results);
    conditions_.note(row, results);
    addLoopCells(results);
  }
  extra_.add(row, motion, load, results, effort_, more_);
  table_.beginRow(file_.table.times[row]);
  if (columns_.stamps) table_.writeStamp(file_.stamps_ns[row]);
  bounds_.clear();
  if (!columns_.bounds.empty()) addIntervals(results, columns_, child_axes_, bounds_);
  table_.writeResults(effort_, reactions_, more_, bounds_);
  progress_.update(row + 1, file_.table.times.size());
}

void Rows::take(std::size_t row, const Motion& motion, const Results& results) {
  effort_ = results.effort.head(effort_.size());
  const std::vector<Wrench>& reactions = child_axes_ ? results.child_axes : results.root_axes;
  std::copy_n(reactions.begin(), reactions_.size(), reactions_.begin());
  if (inertial_axes_) {
    for (Wrench& wrench : reactions_) wrench = inInertialAxes(motion.root, wrench);
  }
  const bool finite = effort_.allFinite() &&
                      std::all_of(reactions_.begin(), reactions_.end(), [](const Wrench& wrench) {
                        return wrench.force.allFinite() && wrench.torque.allFinite();
                      });
  if (!finite && ++overflowed_ == 1) first_row_ = row;
  // A zero has no sign, whatever products with zeros it comes from.
  effort_.array() += 0.0;
  for (Wrench& wrench : reactions_) {
    wrench.force.array() += 0.0;
    wrench.torque.array() += 0.0;
  }
}

// Of components in root axes: turned into inertial axes, each has a share of all of its vector.
Determined Rows::inAxes(const Determined& components) const {
  if (!inertial_axes_) return components;
  Determined turned = components;
  for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const bool all = components[first] && components[first + 1] && components[first + 2];
    std::fill_n(turned.begin() + static_cast<std::ptrdiff_t>(first), 3, all);
  }
  return turned;
}

// Turns results without a value into NaN, which is written as an empty cell.
void Rows::leaveOut(const Results& results) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index i = 0; i < effort_.size(); ++i) {
    if (!results.effortExists(static_cast<std::size_t>(i))) effort_[i] = kNothing;
  }
  for (std::size_t i = 0; i < reactions_.size(); ++i) {
    const Determined exist =
        inAxes(child_axes_ ? results.childAxesExist(i) : results.rootAxesExist(i));
    for (int axis = 0; axis < 3; ++axis) {
      const auto j = static_cast<std::size_t>(axis);
      if (!exist[j]) reactions_[i].force[axis] = kNothing;
      if (!exist[j + 3]) reactions_[i].torque[axis] = kNothing;
    }
  }
}

void Rows::addLoopCells(const Results& results) {
  const LoopResults& loops = results.loops;
  for (std::size_t i = 0; i < columns_.efforts.size(); ++i) {
    more_.push_back(loops.effort_determined[i] ? 1 : 0);
  }
  const auto& flags = child_axes_ ? loops.child_axes_determined : loops.root_axes_determined;
  for (std::size_t i = 0; i < columns_.reactions.size(); ++i) {
    for (const bool flag : inAxes(flags[i])) more_.push_back(flag ? 1 : 0);
  }
  for (const auto level :
       {&ClosureResidual::position, &ClosureResidual::velocity, &ClosureResidual::acceleration}) {
    for (const ClosureResidual& residual : loops.residuals) more_.push_back(residual.*level);
  }
}

std::string Rows::warning() const {
  const auto rows = [](std::size_t count) {
    return std::to_string(count) + (count == 1 ? " row" : " rows");
  };
  const std::string begin = "warning: " + printable(file_.path) + ": ";
  std::string text;
  if (overflowed_ > 0) {
    text = begin + "results of " + rows(overflowed_) + " overflow, first in " +
           file_.place(first_row_) + "; their cells are empty\n";
  }
  if (singular_ > 0) {
    text += begin + rows(singular_) + " in singular positions, first in " +
            file_.place(first_singular_row_) +
            "; cells of results without a value there are empty\n";
  }
  if (undirected_ > 0) {
    text += begin + "the ends of a spring meet in " + rows(undirected_) + ", first in " +
            file_.place(first_undirected_row_) +
            ", so that its force has no direction; cells of results that it reaches are empty\n";
  }
  if (conditions_.close() > 0) {
    text += begin + rows(conditions_.close()) + " close to singular positions, " +
            conditions_.worst(file_) + ": forces may exceed the load by this factor\n";
  }
  return text;
}

}  // namespace virtual_work_dynamics
