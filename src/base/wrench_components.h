#pragma once

namespace virtual_work_dynamics {

/// Names of the components of a wrench in columns of files, in their order.
constexpr const char* kWrenchComponents[] = {"fx", "fy", "fz", "tx", "ty", "tz"};

}  // namespace virtual_work_dynamics
