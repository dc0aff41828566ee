#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Expects two lists of wrenches to be the same to a part of the sums of norms of an ErrorBound.
/// @param bound of the sample; the wrenches are those of ground and of all joints, in its order
inline void expectTheSame(const std::vector<Wrench>& found, const std::vector<Wrench>& expected,
                          double tolerance, const ErrorBound& bound) {
  ASSERT_EQ(found.size(), bound.wrenches().size());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const WrenchMagnitude& unit = bound.wrenches()[i];
    EXPECT_LE((found[i].force - expected[i].force).norm(), tolerance * unit.force) << i;
    EXPECT_LE((found[i].torque - expected[i].torque).norm(), tolerance * unit.moment) << i;
  }
}

}  // namespace virtual_work_dynamics
