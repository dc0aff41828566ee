// What is not set of conditions that are decided is not read, whatever memory has been there.
#include <gtest/gtest.h>
#include <malloc.h>

#include <string>
#include <vector>

#include "transmitting_robot.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// While it lives, every byte of memory that is handed out is 0x7e: as doubles, 1e301.
class FilledMemory {
 public:
  FilledMemory() { mallopt(M_PERTURB, 0x81); }
  ~FilledMemory() { mallopt(M_PERTURB, 0); }
  FilledMemory(const FilledMemory&) = delete;
  FilledMemory& operator=(const FilledMemory&) = delete;
};

// The rows of couplings count by the size of what is not given of them.
TEST(RankMemory, WhatFollowsIsDecidedByWhatIsNotGiven) {
  const Mechanism robot = readUrdf(transmittingRobot(""));
  Scene scene;
  scene.couplings.push_back({"belt", {{"elbow", 1}, {"shoulder", -2}}, 0, false});
  scene.couplings.push_back({"shaft", {{"roll", 1}, {"pitch", 3}, {"shoulder", 1}}, 0, false});
  scene.actuated = std::vector<std::string>{"slide", "elbow", "roll"};
  const Dynamics dynamics(robot, scene, Request());
  Given given = dynamics.given();
  for (std::size_t i = 0; i < given.coordinates.size(); ++i) {
    const std::string& name = robot.coordinateNames()[i];
    given.coordinates[i] = name == "slide" || name == "elbow";
  }
  // The shoulder follows from the elbow, and the pitch and the roll are free by one.
  const FilledMemory filled;
  const ClosedLoopDynamics::GivenFinding found = dynamics.judge(given);
  EXPECT_EQ(found.freedom, 1);
  EXPECT_EQ(found.undetermined.size(), 2u);
}

}  // namespace
}  // namespace virtual_work_dynamics
