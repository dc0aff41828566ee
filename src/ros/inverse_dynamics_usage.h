#pragma once

namespace virtual_work_dynamics {

/// What inverse_dynamics_node prints for --help.
constexpr char kInverseDynamicsUsage[] =
    R"(usage: inverse_dynamics_node [--help] [name:=value ...]

Efforts and joint reactions of a robot, live, from its joint states or trajectories.

subscribes
  joint_states       sensor_msgs/JointState           joints by name, any order, all or some
  joint_trajectory   trajectory_msgs/JointTrajectory  one result for every point
  odom, multi_dof_joint_trajectory, multi_dof_joint_states, /tf, imu
                     by ~root/source                  how the root link moves, where the scene says so
  multi_dof_joint_states                              joints that turn freely, by name
  ~wrench/<name>     geometry_msgs/WrenchStamped      each live applied wrench of the scene
  ~payload/<link>    geometry_msgs/InertiaStamped     what a link carries from now on; mass 0: nothing
  ~gravity           geometry_msgs/Vector3Stamped     gravity from now on
  ~contact/<name>    std_msgs/Bool                    whether a wheel, blade or contact touches from now on

publishes (each only while somebody subscribes)
  ~effort            sensor_msgs/JointState           positions and velocities used, efforts
  ~effort_deviation  sensor_msgs/JointState           standard deviations of efforts by the motion's error
  ~effort_tolerance  sensor_msgs/JointState           the same by the scene's tolerances, where it has any
  ~residual          sensor_msgs/JointState           external efforts: computed less measured ones
  ~external_effort   sensor_msgs/JointState           the same by a momentum observer, without the lag
  ~reactions         sensor_msgs/MultiDOFJointState   joint poses and wrenches, axes of the root link
  ~reactions_inertial                                 the same in inertial axes, by ~root/axes
  ~reaction/<joint>  geometry_msgs/WrenchStamped      the same wrench, frame of the child link
  ~markers           visualization_msgs/MarkerArray   RViz: arrows and numbers at the joints, a legend
  ~joint_trajectory  trajectory_msgs/JointTrajectory  the input trajectory with efforts
  ~determinacy       diagnostic_msgs/DiagnosticArray  closed loops: what mechanics determines; latched
  /diagnostics       diagnostic_msgs/DiagnosticArray  rates, run times, drops, checks
A wrench is what the parent link exerts on the child link, moment about the joint's origin. With closed
loops /tf_static has a frame for each closure, that of ~reaction/<closure>, and /tf one for each contact.

parameters
  robot_description          URDF text; searched from the private namespace upwards
  ~scene                     gravity, reactions, applied wrenches...; see doc/scene_file.md; a map, or
                             its text: _scene/gravity:="[0, 0, -1.62]"
  ~estimator/lag             s the outputs are behind the newest joint state, 0 to 1 (0.05)
  ~estimator/use_velocity    use the velocities of joint states, too (true)
  ~estimator/max_gap         longest gap of a joint that is estimated across, s (0.25)
  ~estimator/position_noise  standard deviation of positions, rad or m (auto: found)
  ~estimator/velocity_noise  standard deviation of velocities, rad/s or m/s (auto)
  ~estimator/stamp_noise     standard deviation of stamps, s (auto)
  ~estimator/bandwidth       Hz that keep half of their amplitude (auto)
  ~estimator/acceleration    estimate | zero (estimate)
  ~hold_after                s without a sample after which a joint is held (0.25)
  ~rest                      [{name, position}] of joints that may never come ([])
  ~wrench_timeout            longest time that a message of a live wrench stands for, s; results that need
                             an older one are dropped (0.1)
  ~root/source               odometry | trajectory | states | tf | imu: who tells how a root link moves ("")
  ~root/inertial_frame       frame that it moves against, with the axes of gravity (odom)
  ~root/axes                 root | inertial | both: axes of reactions (root)
  ~root/link                 what messages call the root link; "": as frame_ids do ("")
  ~root/timeout              longest time that its motion is foreseen, s; results that need more are
                             dropped (0.1)
  ~frame_prefix              put before every frame_id, such as left/ ("")
  ~twist                     fill in the twists of ~reactions (false)
  ~marker_rate               largest rate of ~markers, and of contacts on /tf, Hz, 0.001 to
                             1000 (20)
  ~queue_size/input          messages (1000)
  ~queue_size/output         messages (20000)
  ~trajectory_rate           points a second of a trajectory's results; 0: all at once (0)
  ~trajectory_sampling       samples a second of the motion between points, Hz; 0: at the points (0)
  ~diagnostic_period         s (1.0)
  ~late_threshold            an output this long after its joint state's receipt is late, s (0.001)
  ~cross_check_rate          samples a second that Lagrange's equations check; 0: none (0)
  ~certificates              check power balance and ground's wrench of every sample (false)
  ~residual_warn             WARN from this residual of a check on, relative to sums of magnitudes (1e-10)
  ~residual_error            ERROR from this residual of a check on (1e-7)
  ~deviation_warn            WARN where an effort's deviation exceeds this times the effort, both rms,
                             while ~effort_deviation has subscribers (0.1)
  ~external_effort/thresholds  [{name, effort}]: WARN where an external effort is larger ([])
  ~external_effort/hold      s for which it must be (0.02)
  ~external_effort/by        residual | observer: whose external efforts these are (residual)
  ~external_effort/gain      of the momentum observer, 1/s (25)
  ~effort_limit_warn         WARN where an effort is beyond the description's limit (false)
  ~loop_tolerance            closed loops: WARN where a motion violates one by more, relative (1e-6)
  ~start_patience            closed loops that cannot be assembled from the scene: s to wait at the start for
                             joint states that say where they are (0)
  ~drive_start               stamp at which the time of the scene's drives is zero, s; 0: that of the first result
                             of joint states, or of a trajectory that comes before them (0)
  ~condition_warn            closed loops: WARN close to a singular position, from this condition on (1e4)
)";

}  // namespace virtual_work_dynamics
