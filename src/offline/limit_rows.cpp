#include "offline/limit_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"

namespace virtual_work_dynamics {

LimitRows::LimitRows(std::vector<std::string> names, std::vector<double> limits)
    : names_(std::move(names)), limits_(std::move(limits)), found_(limits_.size()) {}

void LimitRows::add(double time, const Results& results) {
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const double effort = results.effort[static_cast<Eigen::Index>(i)];
    if (!results.effortExists(i) || !(std::abs(effort) > limits_[i])) continue;
    Excess& excess = found_[i];
    if (excess.rows++ == 0) excess.first = excess.last = time;
    excess.first = std::min(excess.first, time);
    excess.last = std::max(excess.last, time);
    if (std::abs(effort) <= std::abs(excess.peak)) continue;
    excess.peak = effort;
    excess.at = time;
  }
}

std::string LimitRows::text(const std::string& where) const {
  std::string text;
  std::size_t limited = 0;
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    limited += std::isfinite(limits_[i]) ? 1 : 0;
    const Excess& excess = found_[i];
    if (excess.rows == 0) continue;
    text += "warning: " + where + ": effort of " + inQuotes(names_[i]) + " is beyond its limit " +
            numberText(limits_[i]) + " in " + std::to_string(excess.rows) +
            (excess.rows == 1 ? " row" : " rows") + " from " + numberText(excess.first) + " s to " +
            numberText(excess.last) + " s, at most " + numberText(excess.peak) + " at " +
            numberText(excess.at) + " s\n";
  }
  if (!text.empty()) return text;
  return "note: " + where + ": no effort is beyond its limit; " + std::to_string(limited) + " of " +
         std::to_string(limits_.size()) + " joints have one\n";
}

}  // namespace virtual_work_dynamics
