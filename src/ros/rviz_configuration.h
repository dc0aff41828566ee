#pragma once

#include <string>
#include <vector>

#include "dynamics/model_view.h"

namespace virtual_work_dynamics {

/// What an RViz configuration of a robot with its reactions depends on.
struct RvizScene {
  ModelView view;
  std::vector<std::string> reactions;
  std::vector<std::string> reaction_topics;  ///< of geometry_msgs/WrenchStamped, by reaction
  std::string marker_topic;                  ///< of visualization_msgs/MarkerArray
  std::string robot_description;             ///< name of the parameter
  std::string frame_prefix;                  ///< of the robot's frames in tf
  std::string root_frame;
  std::string fixed_frame;
};

/// The package's config/inverse_dynamics.rviz, as it was when the program was built.
const char* rvizTemplate();

/// Fills a template: every rviz/RobotModel and rviz/Grid, the camera, and for each reaction a copy
/// of the template's first rviz/WrenchStamped. Takes time linear in the number of reactions.
/// @param source names the template in messages.
/// @throws FileError naming what is wrong with the template.
std::string rvizConfiguration(const std::string& rviz_template, const std::string& source,
                              const RvizScene& scene);

}  // namespace virtual_work_dynamics
