#include <gtest/gtest.h>

#include <string>

#include "allocation_guard.h"
#include "dynamics/contact_gaps.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

// A table on four feet that is pushed more and more, until it cannot hold.
TEST(ContactsAllocation, IntervalsAndGapsDoNotAllocate) {
  BodiesOnAxes bodies;
  bodies.add(JointType::kFixed, 0, bodies.x());
  bodies.load(1, 10, {1, 1, 1}, {0.1, 0.05, 0});
  std::string text =
      "joint_types: [{name: joint_1, type: floating}]\nactuated: []\ncontact_intervals: true\n"
      "assembly: [{name: joint_1.z, position: 0.7}]\ncontacts:\n";
  for (const char* at : {"0.3, 0.2", "0.3, -0.2", "-0.3, 0.2", "-0.3, -0.2"}) {
    text += std::string("  - {name: \"foot ") + at + "\", link: link_1, at: [" + at +
            ", -0.7], plane: {link: link_0}, friction: 0.4, gap: {close: 0, open: 0.001}}\n";
  }
  const Scene scene = sceneOf(text);
  const Mechanism mechanism = withJointTypes(bodies.build(), scene);
  const Dynamics dynamics(mechanism, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  ContactGaps gaps(mechanism, scene);
  Motion motion(6, 1);
  motion.q[2] = 0.7;
  std::size_t can = 0, allocations = 0;
  for (int i = 0; i < 20; ++i) {
    motion.qdd[0] = 0.3 * i;
    const AllocationGuard guard;
    dynamics.compute(motion, workspace);
    gaps.take(motion);
    allocations += guard.allocations();
    if (workspace.results().loops.holds[0] == Hold::kCanHold) ++can;
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(can > 5 && can < 15) << can;
}

}  // namespace
}  // namespace virtual_work_dynamics
