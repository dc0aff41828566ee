#include "ros/rviz_for_robot.h"

int main(int argc, char** argv) {
  return virtual_work_dynamics::rvizForRobot(argc, argv);
}
