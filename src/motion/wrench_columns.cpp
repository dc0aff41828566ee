#include "motion/wrench_columns.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "base/wrench_components.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::string_view kWrenchPrefix = "wrench.";

}  // namespace

std::string wrenchColumn(const std::string& wrench, const char* component) {
  return std::string(kWrenchPrefix) + wrench + "." + component;
}

std::string_view wrenchOf(std::string_view column) {
  const std::size_t point = column.rfind('.');
  if (column.substr(0, kWrenchPrefix.size()) != kWrenchPrefix || point <= kWrenchPrefix.size())
    return {};
  const std::string_view component = column.substr(point + 1);
  const bool known = std::find(std::begin(kWrenchComponents), std::end(kWrenchComponents),
                               component) != std::end(kWrenchComponents);
  if (!known) return {};
  return column.substr(kWrenchPrefix.size(), point - kWrenchPrefix.size());
}

std::vector<std::string> wrenchesOf(const std::vector<std::string>& columns) {
  std::vector<std::string> wrenches;
  std::set<std::string_view> seen;
  for (const std::string& column : columns) {
    const std::string_view wrench = wrenchOf(column);
    if (!wrench.empty() && seen.insert(wrench).second) wrenches.emplace_back(wrench);
  }
  return wrenches;
}

}  // namespace virtual_work_dynamics
