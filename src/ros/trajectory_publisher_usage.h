#pragma once

namespace virtual_work_dynamics {

/// What trajectory_publisher_node prints for --help.
constexpr char kTrajectoryPublisherUsage[] =
    R"(usage: trajectory_publisher_node [--help] [name:=value ...]

Plays a motion of joints at a set rate, as a stream of joint states or as one trajectory.

publishes one of
  joint_states      sensor_msgs/JointState           positions, velocities
  joint_trajectory  trajectory_msgs/JointTrajectory  exact positions, velocities, accelerations
and, of a table that has the motion of a root link, on /tf and one of
  odom                        nav_msgs/Odometry
  multi_dof_joint_states      sensor_msgs/MultiDOFJointState
  multi_dof_joint_trajectory  trajectory_msgs/MultiDOFJointTrajectory
  imu                         sensor_msgs/Imu

parameters (in brackets: the defaults, which play the paper's pendulum)
  ~joints                names ([joint_1, joint_2]); with the law table, [] means all of the file
  ~law                   cosine | sine_sweep | minimum_jerk | table (cosine)
  ~amplitudes            rad or m, one for each joint ([pi/12, pi/6])
  ~period                of the cosine, s (12)
  ~start_frequency       of the sweep, Hz (0.1)
  ~end_frequency         of the sweep, Hz (1)
  ~duration              of cosine and sweep, s (6)
  ~via_points            of minimum_jerk, list of {time: s, positions: [rad or m]} ([])
  ~file                  of the table: CSV, columns time, position.<joint>, velocity.<joint>,
                         acceleration.<joint> (""); robot_description, if there is one, says which
                         joints are continuous: whole turns that their driver left out are added. A
                         path is relative to where the node, or with the launch files roslaunch, is
                         started
  ~root/source           odometry | states | trajectory | imu | tf: how columns root.… of the table
                         are published ("": not at all)
  ~root/inertial_frame   frame_id that they are against (odom)
  ~root/link             frame_id of the root link ("": ~frame_prefix and its name in
                         robot_description)
  ~frame_prefix          such as left/ ("")
  ~root/gravity          that an inertial measurement unit feels, m/s^2 ([0, 0, -9.81])
  ~message               joint_state | joint_trajectory (joint_state)
  ~rate                  samples per second, Hz (1000)
  ~velocities            whether joint states carry velocities (true)
  ~stamp                 of a trajectory: now | zero (now)
  ~loop                  repeat the motion, with stamps that go on (false)
  ~loop_pause            time between two rounds of a trajectory, s (0)
  ~wait_for_subscribers  number of subscribers to wait for before the start (1)
  ~start_delay           time from their arrival to the first message, s (0.5)
  ~linger                time to stay alive after the last message, s (1)
)";

}  // namespace virtual_work_dynamics
