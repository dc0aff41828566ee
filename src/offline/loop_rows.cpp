#include "offline/loop_rows.h"

#include <limits>
#include <sstream>

#include "base/number_text.h"

namespace virtual_work_dynamics {
namespace {

const std::vector<Determined>& flagsOf(const LoopSample& sample, bool child_axes) {
  return child_axes ? sample.childAxesDetermined() : sample.rootAxesDetermined();
}

}  // namespace

std::vector<std::string> namesOfEfforts(const Mechanism& mechanism,
                                        const ClosedLoopDynamics& dynamics) {
  std::vector<std::string> names = mechanism.coordinateNames();
  const std::vector<std::string>& closures = dynamics.actuatedClosures();
  names.insert(names.end(), closures.begin(), closures.end());
  return names;
}

std::vector<std::string> loopColumns(const Columns& results, const std::vector<Closure>& closures) {
  std::vector<std::string> columns;
  for (const std::string& name : results.efforts) columns.push_back("determined.effort." + name);
  for (const std::string& name : results.reactions) {
    for (const char* component : kWrenchComponents) {
      columns.push_back("determined." + name + "." + component);
    }
  }
  for (const char* level : {"position", "velocity", "acceleration"}) {
    for (const Closure& closure : closures) {
      columns.push_back(std::string("residual.") + level + "." + closure.name);
    }
  }
  return columns;
}

void appendLoopCells(const LoopSample& sample, const Columns& results, bool child_axes,
                     std::vector<double>& cells) {
  for (std::size_t i = 0; i < results.efforts.size(); ++i) {
    cells.push_back(sample.effortDetermined()[i] ? 1 : 0);
  }
  for (std::size_t i = 0; i < results.reactions.size(); ++i) {
    for (const bool flag : flagsOf(sample, child_axes)[i]) cells.push_back(flag ? 1 : 0);
  }
  const std::vector<ClosureResidual>& residuals = sample.residuals();
  for (const ClosureResidual& residual : residuals) cells.push_back(residual.position);
  for (const ClosureResidual& residual : residuals) cells.push_back(residual.velocity);
  for (const ClosureResidual& residual : residuals) cells.push_back(residual.acceleration);
}

void Conditions::note(std::size_t row, const LoopSample& sample) {
  const double condition = sample.determinacy().condition;
  if (sample.singular()) return;
  if (condition > kCloseToSingular) ++close_;
  if (condition <= largest_) return;
  largest_ = condition;
  row_ = row;
}

std::string Conditions::worst(const MotionFile& file) const {
  if (largest_ == 0) return "singular positions only";
  std::ostringstream text;
  text.precision(3);
  text << "condition " << largest_ << " at worst, line " << file.lines[row_] << ", at "
       << numberText(file.table.times[row_]) << " s";
  return text.str();
}

void leaveOutUndetermined(const LoopSample& sample, bool child_axes, Eigen::VectorXd& effort,
                          std::vector<Wrench>& reactions) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index i = 0; i < effort.size(); ++i) {
    if (!sample.effortDetermined()[static_cast<std::size_t>(i)]) effort[i] = kNothing;
  }
  const std::vector<Determined>& flags = flagsOf(sample, child_axes);
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto j = static_cast<std::size_t>(axis);
      if (!flags[i][j]) reactions[i].force[axis] = kNothing;
      if (!flags[i][j + 3]) reactions[i].torque[axis] = kNothing;
    }
  }
}

}  // namespace virtual_work_dynamics
