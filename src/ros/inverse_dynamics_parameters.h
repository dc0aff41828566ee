#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamics/effort_doubts.h"
#include "ros/loop_limits.h"
#include "ros/root_settings.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/scene.h"

namespace ros {
class NodeHandle;
}

namespace YAML {
class Node;
}

namespace virtual_work_dynamics {

/// How the node checks what it computes.
struct SelfCheckSettings {
  double cross_check_rate = 0;   ///< samples/s that Lagrange's equations check; 0: none
  bool certificates = false;     ///< whether every sample is certified
  double residual_warn = 1e-10;  ///< WARN from here on, relative to sums of magnitudes
  double residual_error = 1e-7;  ///< ERROR from here on, relative to sums of magnitudes
};

/// What is made of measured efforts, and which efforts are watched.
struct ExternalEffortSettings {
  /// Thresholds of external efforts by joint, N m or N; none: nothing is watched.
  std::vector<std::pair<std::string, double>> thresholds;
  double hold = 0.02;          ///< s that one must be exceeded
  bool observed = false;       ///< whether the thresholds are of ~external_effort, not of ~residual
  double observer_gain = 25;   ///< of ~external_effort, 1/s
  bool effort_limits = false;  ///< whether efforts beyond the description's limits are a WARN
};

/// A joint whose states may never come.
struct RestingJoint {
  std::string name;
  double position = 0;  ///< rad or m
};

/// Everything that inverse_dynamics_node reads from the parameter server.
struct InverseDynamicsParameters {
  std::string robot_description;      ///< URDF text
  std::string robot_description_key;  ///< name of the parameter that holds the URDF text
  Scene scene;
  bool scene_given = false;        ///< false: the scene is the default one
  EstimatorSettings estimator;     ///< settings as given; a static scene does not estimate
  std::vector<RestingJoint> rest;  ///< positions of joints until they come
  std::string frame_prefix;        ///< prefix of every frame_id
  bool twist = false;              ///< whether the twists of ~reactions are filled in
  int input_queue = 1000;          ///< messages
  int output_queue = 20000;        ///< messages
  double trajectory_rate = 0;      ///< points/s; 0: all points of a trajectory at once
  double trajectory_sampling = 0;  ///< Hz, of the motion between points; 0: at the points
  double diagnostic_period = 1.0;  ///< s
  double wrench_timeout = 0.1;     ///< longest time that a live wrench stands for, s
  double drive_start = 0;          ///< stamp of the time zero of drives, s; 0: the first one
  RootSettings root;               ///< how the node learns of the motion of a root that moves
  double late_threshold = 0.001;   ///< s, from receipt of a joint state to its published result
  double start_patience = 0;       ///< s to wait for joint states where loops cannot be assembled
  LoopLimits loop_limits;          ///< samples beyond them are a WARN
  SelfCheckSettings self_check;
  ExternalEffortSettings external;
  double marker_rate = 20;                 ///< largest rate of ~markers, Hz
  double deviation_warn = kDeviationWarn;  ///< deviation of an effort over the effort, both rms
};

/// Reads and checks the private parameters of the node, and robot_description, which is searched
/// upwards from the private namespace.
/// @param private_node the handle NodeHandle("~").
/// @throws ParameterError or SceneError, one line naming the parameter that is missing, unknown, of
///   a wrong type or out of range.
InverseDynamicsParameters readInverseDynamicsParameters(const ros::NodeHandle& private_node);

/// Reads and checks private parameters from wherever they were kept, without the description.
/// @param scene in place of ~scene
/// @throws ParameterError or SceneError, the latter about `scene`.
InverseDynamicsParameters readInverseDynamicsParameters(PrivateParameters parameters,
                                                        const YAML::Node& scene);

}  // namespace virtual_work_dynamics
