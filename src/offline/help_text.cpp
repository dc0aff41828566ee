#include "offline/arguments.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kHelp[] =
    R"(inverse_dynamics_offline: active efforts and joint reactions of a recorded motion

  inverse_dynamics_offline --urdf ROBOT.urdf --motion MOTION.csv|BAG... [options]
  inverse_dynamics_offline --urdf ROBOT.urdf --check [options]
  inverse_dynamics_offline --urdf ROBOT.urdf --explain [options]
  inverse_dynamics_offline --urdf ROBOT.urdf --generate FILE.c [options]

Input
  --urdf FILE           robot description. Without it: that of --rosparam, or that which the bag of the
                        motion has as a std_msgs/String on /robot_description (with the scene, as YAML
                        text on /inverse_dynamics/scene, if there is one)
  --rosparam FILE       what 'rosparam dump FILE' wrote: the description from robot_description, the scene
                        from ~scene of the node of --node, as the node finds them; --urdf and --scene
                        replace them. For an --output BAG, all parameters of the node count
  --motion FILE         motion as CSV: a header with the columns time, position.<joint>,
                        velocity.<joint>, acceleration.<joint> in any order (s, rad or m); lines
                        that start with # are comments. The CSV of 'rostopic echo -p' of joint
                        states and of PlotJuggler is read, too. Missing accelerations, or velocities, are
                        estimated by a smoother that finds the noise of the recording. Where the
                        scene closes loops, the columns are of all joints, or of as many as move the
                        others: the actuated ones, or any other choice, free axes of closures
                        (position.<closure>) and poses of links (position.pose.<link>.x, y, z, qx,
                        qy, qz, qw, in axes of the root link) included. - reads standard input.
                        An .npz of numpy.savez has the same columns as arrays.
  --motion BAG...       motion as a bag of ROS 1, or the parts that rosbag split it into: a row for
                        each sensor_msgs/JointState that has all joints. The result has their stamps
                        in a column stamp (s, all nanoseconds), and times from the first one on. A bag
                        that is damaged or was not closed gives what can be read of it.
  --rename RULE         PATTERN=NAME: joints of the motion whose names the regular expression matches as a
                        whole are called NAME, in which \1 is what its first group matches; several
                        times for several rules, of which the first that matches counts
  --degrees             angles of the motion, and their derivatives, are in degrees
  --topic NAME          topic of the joint states in the bag (default: the only one, or joint_states in
                        the namespace of --node, or /joint_states)
  --residuals           the motion also has efforts that were measured (columns effort.<joint>, or the
                        efforts of joint states): adds the columns measured_effort.<joint> and
                        measured_residual.<joint>, computed less measured, which is the external effort
                        where all else is known; and, with --deviations, deviation.measured_residual.<joint>.
                        A table of each joint's VAF, rms, bias and lag goes to standard error
  --measured FILE|BAG   as --residuals, with the efforts from another CSV (columns time and effort.<joint>,
                        or <joint>, or a range of names like tau1..7 that --rename turns into joints) or
                        bag, of the same clock; between two measurements on a straight line
  --observer-gain K     as --residuals, and adds the columns external_effort.<joint>: the external effort
                        by a momentum observer, which needs no accelerations and follows with the time
                        constant 1 / K, K in 1/s
  --measured-topic NAME topic of the joint states with the efforts, where it is not that of the motion
  --scene FILE          scene file (YAML); the options below override it

How missing derivatives are estimated
  --position-noise X    standard deviation of the positions, rad or m (default: found)
  --velocity-noise X    standard deviation of the velocities, rad/s or m/s (default: found)
  --stamp-noise X       standard deviation of the times, s (default: found)
  --bandwidth HZ        what swings so fast keeps half of its amplitude (default: found)
  --lag S               estimates each row from the rows up to S seconds after it, as
                        inverse_dynamics_node does (default: from all rows)
  --max-gap S           nothing is assumed of the motion across longer gaps (default: 0.25)
  --rest JOINT=X        position, rad or m, of a joint that the motion does not have, or that a bag
                        has in messages of its own; several separated by commas

What is computed
  --gravity "X Y Z"     gravity in axes of a root link that rests, m/s^2 (default: 0 0 -9.81)
  --axes root|child|inertial
                        axes of the reactions: of the root link (default), of the child link, or of the
                        inertial frame that a root link moves against
  --reactions LIST      all (every movable joint; the default), none, or joints separated by
                        commas; fixed joints and "ground" by name only
  --no-efforts          reactions only
  --method NAME         virtual_work (the default), or lagrange: Lagrange's equations with a
                        fictitious mobility at each joint, in long double; it is slow, shares no
                        formula with virtual_work and serves to check it
  --certificates        adds the columns certificate.{power,ground_force,ground_moment}: how far
                        each row violates the balance of power, and the wrench of ground the rates
                        of change of momentum, relative to the sum of all terms' magnitudes; they
                        judge the arithmetic, not the motion or the description that it starts from
  --deviations          adds the columns deviation.effort.<joint>, deviation.<name>.{fx,...,tz}:
                        standard deviations of the results by the error of the estimated motion; and,
                        where the scene has tolerances, tolerance.effort.<joint>,
                        tolerance.<name>.{fx,...,tz}: by the errors of masses and inertias
  --effort-limits       lists efforts beyond the limits of the description (<limit effort="...">): joint, times,
                        peak and limit
  --positions           adds the columns position.<joint>, velocity.<joint> and acceleration.<joint>
                        of all joints: the motion that the results belong to, which can be read as a
                        motion again
  --deviation-warn X    notes efforts whose deviation is more than X times the effort, both as rms of
                        all rows, and the cause (default: 0.1)
  --loop-tolerance X    how far the motion may violate closed loops, relative to the loops' size
                        and to the largest rate and acceleration (default: 1e-6)
  --threads N           divides the rows among N threads (default: 1)

Output
  --output FILE         result as CSV (default: standard output); FILE is written as a whole or not
                        at all
                        A name that ends in .npz: as arrays for numpy.load, NaN for empty cells
  --report DIR          makes a load report of the results for the design of bearings, flanges and motors:
                        DIR/report.html, report.md, loads.csv; with --axes child and --positions.
                        Without --output, the results are DIR/results.npz
  --output BAG          a name that ends in .bag: of a motion from a bag, the topics that
                        inverse_dynamics_node would publish, with its results: estimated as it does
                        it, --lag S (default: 0.05) behind; those of deviations with --deviations.
                        Memory does not grow with the bag. Trajectories, live wrenches, payloads,
                        gravity and the motion of the root are read from the topics that the node
                        subscribes to.
  --copy-input          all messages of the bag that is read go to the one that is written, too
  --node NAME           node whose topics are written, and whose topics and parameters are read (default:
                        /inverse_dynamics)
  --remap NAME:=TOPIC   reads a topic of the bag in place of one of the node's, like odom:=/robot/odom or
                        wrench/hand:=/sensor; without TOPIC none is read; several times for several
  --root-source WORD    as the parameter ~root/source: odometry, trajectory, states, tf or imu
  --regressor DIR       instead of a result, a folder of NumPy arrays for identification: effort.npy as
                        described (rows x efforts), regressor.npy, what efforts are per unit of each
                        parameter (parameters x rows x efforts), time.npy, position.npy, velocity.npy,
                        acceleration.npy, and names.json with the parameters and their described values
  --parameters LIST     parameters of the regressor, separated by commas: joints (damping, coulomb,
                        rotor inertia and offset of every joint), links (mass, first moments and moments
                        of inertia about its origin of every link that a joint moves), or links by
                        name (default: joints,links)
  --check               only describes the robot and says what is doubtful about it; for closed
                        loops with --motion, also how close it comes to singular positions
  --explain             only says what a sample costs and what its computation leaves out because
                        no result that is asked for needs it
  --generate FILE       only writes FILE, which ends in .c, .cc, .cpp or .cxx, and a header beside it:
                        C99 and C++ that computes this robot in this scene and needs no library; its
                        functions are named after FILE. In scenes with loops it takes motions of all
                        joints, and returns whether the position is regular (doc/generated_code.md).
  --help                this text
  --version             the version of the package

The result has the columns time, effort.<joint> (N m or N) and, for each reaction,
reaction.<name>.{fx,fy,fz,tx,ty,tz}: force (N) and moment about the joint's origin (N m) that the
parent link exerts on the child link. An empty cell is a value that overflowed or
does not exist.

Where the scene closes loops, closures have effort and reaction columns like joints. Further columns
are determined.effort.<joint>, determined.<name>.{fx,fy,fz,tx,ty,tz}: 1 where rigid-body mechanics
determines the value, 0 where the scene's policy does. In singular positions cells of results without
a value are empty. The columns residual.{position,velocity,acceleration}.<closure> say by how much the motion
violates the closure, in m or rad, m/s or rad/s, m/s^2 or rad/s^2.

Exit status: 0 done, 1 something is wrong with the input or output, 2 wrong usage.

Example
  inverse_dynamics_offline --urdf arm.urdf --motion swing.csv --gravity "0 0 -9.81" \
    --reactions shoulder,ground --axes child --output swing_loads.csv
)";

}  // namespace

std::string helpText() {
  return kHelp;
}

}  // namespace virtual_work_dynamics
