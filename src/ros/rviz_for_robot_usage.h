#pragma once

namespace virtual_work_dynamics {

/// What rviz_for_robot prints for --help.
constexpr char kRvizForRobotUsage[] =
    R"(usage: rviz_for_robot [options] [ROBOT.urdf] [RVIZ_ARGUMENT ...] [name:=value ...]

Shows a robot and its reactions, as inverse_dynamics_node publishes them, in RViz: arrows and numbers at
the joints, and a display of WrenchStamped, to be switched on, for each reaction that the scene asks for,
closures included. Arrows are scaled by the largest reaction at rest at the start, and the camera shows
the whole robot.

  ROBOT.urdf             robot description; without it, robot, scene and frame prefix are those of the
                         node's parameters
  --scene FILE           scene file (YAML) of a robot that is given; none: a scene without any keys
  --frame FRAME          fixed frame; auto, the default: the root link's
  --frame-prefix PREFIX  ~frame_prefix of the node and of the robot in tf, such as left/
  --node NAME            the node whose topics are shown (default: inverse_dynamics)
  --template FILE        RViz configuration to fill (default: the package's config/inverse_dynamics.rviz)
  --print                print the configuration instead, as a start for one of your own
  --                     what follows is for RViz, as is everything that follows ROBOT and options
  --help                 this text

Names are resolved in the namespace of this program (ROS_NAMESPACE or __ns:=). The configuration is
handed to RViz in memory: no file is left behind. Save it under a name of your own to keep changes.
)";

}  // namespace virtual_work_dynamics
