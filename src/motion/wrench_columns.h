#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// How columns of wrenches are named, as messages say it.
constexpr char kWrenchColumns[] = "wrench.<name>.{fx,fy,fz,tx,ty,tz}";

/// Name of the column of a wrench's component.
std::string wrenchColumn(const std::string& wrench, const char* component);

/// The wrench whose component a column is; empty when it is none.
std::string_view wrenchOf(std::string_view column);

/// The wrenches that columns belong to, each once, in the order of their first columns.
std::vector<std::string> wrenchesOf(const std::vector<std::string>& columns);

}  // namespace virtual_work_dynamics
