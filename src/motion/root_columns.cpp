#include "motion/root_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "motion/orientation_length.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kPrefix[] = "root.";

struct Quantity {
  const char* name;
  const char* components;  // a letter each
  double* (*of)(RootMotion& root);
};

constexpr std::array<Quantity, 6> kQuantities{
    {{"position", "xyz", [](RootMotion& root) { return root.position.data(); }},
     {"orientation", "xyzw", [](RootMotion& root) { return root.orientation.coeffs().data(); }},
     {"velocity", "xyz", [](RootMotion& root) { return root.velocity.data(); }},
     {"angular_velocity", "xyz", [](RootMotion& root) { return root.angular_velocity.data(); }},
     {"acceleration", "xyz", [](RootMotion& root) { return root.acceleration.data(); }},
     {"angular_acceleration", "xyz",
      [](RootMotion& root) { return root.angular_acceleration.data(); }}}};

std::vector<std::string> columnsOf(const Quantity& quantity) {
  std::vector<std::string> columns;
  for (const char* component = quantity.components; *component; ++component) {
    columns.push_back(std::string(kPrefix) + quantity.name + "." + *component);
  }
  return columns;
}

const std::set<std::string, std::less<>>& allColumns() {
  static const std::set<std::string, std::less<>> columns = [] {
    std::set<std::string, std::less<>> all;
    for (const Quantity& quantity : kQuantities) {
      for (const std::string& column : columnsOf(quantity)) all.insert(column);
    }
    return all;
  }();
  return columns;
}

}  // namespace

bool isRootColumn(std::string_view column) {
  return allColumns().count(column) > 0;
}

std::vector<std::string> rootColumnsOf(const std::vector<std::string>& header) {
  const std::set<std::string_view> given(header.begin(), header.end());
  std::vector<std::string> wanted;
  for (const Quantity& quantity : kQuantities) {
    const std::vector<std::string> columns = columnsOf(quantity);
    const bool any = std::any_of(columns.begin(), columns.end(), [&](const std::string& column) {
      return given.count(column) > 0;
    });
    if (any) wanted.insert(wanted.end(), columns.begin(), columns.end());
  }
  return wanted;
}

std::string rootColumnsText(const std::string& quantity) {
  return kPrefix + quantity + (quantity == "orientation" ? ".{x,y,z,w}" : ".{x,y,z}");
}

bool givesRoot(const MotionTable& table, const std::string& quantity) {
  const std::vector<std::string>& lack = table.roots_lack;
  return !table.roots.empty() && std::find(lack.begin(), lack.end(), quantity) == lack.end();
}

std::size_t takeRoots(const std::vector<std::string>& columns, const Eigen::MatrixXd& values,
                      MotionTable& table) {
  if (columns.empty()) return static_cast<std::size_t>(values.rows());
  table.roots.assign(static_cast<std::size_t>(values.rows()), RootMotion());
  Eigen::Index column = 0;
  for (const Quantity& quantity : kQuantities) {
    const std::vector<std::string> own = columnsOf(quantity);
    if (std::find(columns.begin(), columns.end(), own.front()) == columns.end()) {
      table.roots_lack.emplace_back(quantity.name);
      continue;
    }
    for (std::size_t component = 0; component < own.size(); ++component, ++column) {
      for (std::size_t row = 0; row < table.roots.size(); ++row) {
        quantity.of(table.roots[row])[component] = values(static_cast<Eigen::Index>(row), column);
      }
    }
  }
  for (std::size_t row = 0; row < table.roots.size(); ++row) {
    Eigen::Quaterniond& orientation = table.roots[row].orientation;
    const double off = std::abs(orientation.norm() - 1);
    if (!(off <= kOrientationOff)) return row;
    table.orientation_error = std::max(table.orientation_error, off);
    orientation.normalize();
  }
  return table.roots.size();
}

}  // namespace virtual_work_dynamics
