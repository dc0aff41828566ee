#include <gtest/gtest.h>

#include <string>

#include "allocation_guard.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/drives.h"

namespace virtual_work_dynamics {
namespace {

TEST(DrivesAllocation, MotionsOfAllLawsDoNotAllocate) {
  BodiesOnAxes bodies;
  bodies.load(bodies.slide(0, bodies.x()), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  Given given;
  given.coordinates = {true};
  for (const std::string law :
       {"polynomial, times: [0, 1], coefficients: [[0, 1], [1, 1]]",
        "cosine, amplitude: 1, period: 2", "sine, amplitude: 1, period: 2, phase: 1",
        "sine_sweep, amplitude: 1, start_frequency: 1, end_frequency: 2, duration: 5",
        "minimum_jerk, times: [0, 1, 2], positions: [0, 1, 0]",
        "table, times: [0, 1, 2], positions: [0, 1, 2]"}) {
    Drives drives(mechanism, sceneOf("drives: [{name: joint_1, law: " + law + "}]"));
    Motion motion(1), driven(0);
    const AllocationGuard guard;
    for (const double t : {0.2, 1.0, 1.7}) {
      EXPECT_FALSE(drives.evaluate(t, given, motion, driven).has_value());
    }
    EXPECT_EQ(guard.allocations(), 0U) << law;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
