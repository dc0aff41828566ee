#!/usr/bin/python3
"""Live wrenches in frames that are no links of the robot: of tf, and the frame that a root moves against."""
import math
import time

from geometry_msgs.msg import TransformStamped, Vector3, WrenchStamped
import numpy as np
import rospy
from sensor_msgs.msg import Imu, JointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory

from carried_arm import ARM, JOINTS, CarriedArm, quaternion
from node_live_wrenches_test import (AXES, COORDINATES, MOTION, MS, UNEVEN, live, ramp, trajectory,
                                     wrench)
from node_live_wrenches_test import ARM as SMALL_ARM
from node_under_test import EPOCH, Node, NodeTest, ros_time, run, trajectory_point, wait_until
from rigid_bodies import RigidBodies
from root_messages import root_trajectory

# Rounding of the oracle and of quaternions in tf.
EXACT = 1e-11
# A sensor beside a link, or a plate beside the root.
AT = np.array([0.2, -0.3, 0.1])
TURN = np.array([[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]])


def pose_of(turn, at):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, at
    return pose


def frame(parent, child, ns, pose):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp = ros_time(ns)
    message.transform.translation = Vector3(*pose[:3, 3])
    message.transform.rotation = quaternion(pose[:3, :3])
    return message


def efforts(bodies, motion, names, axes, slides, pose, force, torque):
    """By the oracle without the wrench, less the wrench's work on each joint's unit motion."""
    force, torque = pose[:3, :3] @ force, pose[:3, :3] @ torque
    result = []
    for name in names:
        joint = bodies.reaction(name, *motion).pose
        axis = joint[:3, :3] @ np.array(axes[name])
        moment = torque + np.cross(pose[:3, 3] - joint[:3, 3], force)
        work = axis @ (force if name in slides else moment)
        result.append(bodies.effort(name, *motion) - work)
    return result


class Frames(NodeTest):
    def start(self, robot, scene, parameters=None):
        self.node = Node(self, robot, dict({'scene': scene}, **(parameters or {})))
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.efforts = self.node.record('effort', JointState)
        self.wrenches = self.node.feed('inverse_dynamics/wrench/push', WrenchStamped)
        self.node.wait_for_plan('effort')
        # The node listens to tf from the first such frame on.
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=1000)
        self.addCleanup(self.tf.unregister)

    def place(self, *frames):
        """Frames that stand still, as parent, child, pose; they are there before the node listens."""
        latched = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        self.addCleanup(latched.unregister)
        latched.publish(TFMessage([frame(parent, child, 0, pose) for parent, child, pose in frames]))

    def send(self, *messages):
        for message in messages:
            self.wrenches.publish(message)
        self.node.wait_for_count('wrenches received', len(messages))

    def check_small(self, count, pose_at):
        bodies = RigidBodies(SMALL_ARM)
        for message in self.efforts.wait(count):
            ns = message.header.stamp.to_nsec()
            motion = MOTION(ns)
            self.assertClose(message.effort, efforts(
                bodies, motion, COORDINATES, AXES, ['slide'], pose_at(bodies, motion, ns),
                *ramp(ns)), EXACT, 'at %d' % ns)

    def wait_until_taken(self, stamp):
        """Until a wrench of this instant has found its frame: a result there is no longer dropped."""
        def computed():
            before = len(self.efforts.messages())
            self.trajectories.publish(trajectory([0], stamp))
            rospy.sleep(0.1)
            return len(self.efforts.messages()) > before
        wait_until(computed, self.node.output)

    def test_a_sensor_that_hangs_on_a_link(self):
        # tf has nothing of how the links move; the robot's kinematics does.
        self.place(('forearm', 'bracket_of_test', pose_of(np.eye(3), [0, 0, 0.05])),
                   ('bracket_of_test', 'sensor_of_test', pose_of(TURN, AT)))
        self.start(SMALL_ARM, live())
        stamps = [EPOCH + i * 70 * MS for i in range(-1, 6)]
        self.send(*[wrench(ns, *ramp(ns), frame='sensor_of_test') for ns in stamps])
        self.wait_until_taken(stamps[-1])
        before = len(self.efforts.messages())
        self.trajectories.publish(trajectory(UNEVEN))
        self.efforts.wait(before + len(UNEVEN))
        self.check_small(before + len(UNEVEN), lambda bodies, motion, ns: (
            bodies.reaction('elbow', *motion).pose @ pose_of(np.eye(3), [0, 0, 0.05]) @
            pose_of(TURN, AT)))
        self.assertEqual(self.node.diagnostics()['dropped: unknown frame'], '0')

    def test_a_plate_that_tf_moves(self):
        # tf comes later than the wrenches, which wait for it.
        self.start(SMALL_ARM, live(), {'wrench_timeout': 10})

        def plate(ns):
            t = (ns - EPOCH) / 1e9
            return pose_of(TURN, AT + np.array([t, -2 * t, 0.5 * t]))
        stamps = [EPOCH + i * 70 * MS for i in range(-1, 6)]
        self.send(*[wrench(ns, *ramp(ns), frame='plate_of_test') for ns in stamps])
        wait_until(lambda: self.tf.get_num_connections() > 0, self.node.output)
        self.tf.publish(TFMessage([frame('world_of_test', 'stand', EPOCH - 200 * MS, np.eye(4)),
                                   frame('world_of_test', 'stand', EPOCH + 900 * MS, np.eye(4))]))
        for i in range(-30, 60):
            ns = EPOCH + i * 10 * MS
            self.tf.publish(TFMessage([frame('world_of_test', 'plate_of_test', ns, plate(ns))]))
        self.wait_until_taken(stamps[-1])
        before = len(self.efforts.messages())
        # At the stamps of the wrenches, as in between both they and the plate have moved.
        times = [ns - EPOCH for ns in stamps[1:]]
        self.trajectories.publish(trajectory(times))
        messages = self.efforts.wait(before + len(times))
        self.assertStamps(messages[before:], stamps[1:])
        self.check_small(before + len(times), lambda bodies, motion, ns: plate(ns))

    def test_frames_that_nobody_knows(self):
        self.place(('tower_of_test', 'island_of_test', np.eye(4)))
        self.start(SMALL_ARM, live())
        start = time.monotonic()
        for i, name in enumerate(('nowhere_of_test', 'island_of_test')):
            self.wrenches.publish(wrench(EPOCH + i * MS, frame=name))
            values = self.node.wait_for_count('dropped: unknown frame', i + 1)
            self.assertIn("/wrench/push: its frame '%s' is not a link of robot 'test_arm'" % name,
                          values['last drop'])
            self.assertIn(', and tf tells of no way from it to one at stamp ', values['last drop'])
        self.assertThrottled([line for line in self.node.lines('WARN') if 'unknown frame' in line],
                             start)
        # Neither of them holds up those that are known.
        self.wrenches.publish(wrench(EPOCH + 10 * MS))
        self.trajectories.publish(trajectory([0], EPOCH + 10 * MS))
        self.efforts.wait(1)

    def standing(self, **parameters):
        """The arm on a frame of tf, beside which there is a plate; tf is heard from now on."""
        self.start(SMALL_ARM, live(), parameters)
        self.wrenches.publish(wrench(EPOCH - 1000 * MS, frame='nowhere_of_test'))
        wait_until(lambda: self.tf.get_num_connections() > 0, self.node.output)

    def send_plate(self, first, last):
        for i in range(first, last, 10):
            ns = EPOCH + i * MS
            self.tf.publish(TFMessage([
                frame('world_of_test', 'stand', ns, np.eye(4)),
                frame('world_of_test', 'plate_of_test', ns, pose_of(TURN, AT))]))

    def test_stamps_of_all_sizes(self):
        # Differences of such stamps do not fit into ros::Duration.
        self.standing()
        for stamp in (3000000000, 10, 4294967295, 0, 2147483648):
            self.tf.publish(TFMessage([frame('world_of_test', 'ball', stamp * 1000 * MS, np.eye(4))]))
        self.send_plate(0, 110)
        self.wrenches.publish(wrench(EPOCH + 50 * MS, frame='plate_of_test'))
        self.wait_until_taken(EPOCH + 50 * MS)
        self.assertEqual(self.node.diagnostics()['dropped: internal'], '0')

    def test_what_lies_before_all_of_tf_is_dropped_at_once(self):
        self.standing(wrench_timeout=600)
        self.send_plate(0, 110)
        self.wrenches.publish(wrench(EPOCH - 20 * MS, frame='plate_of_test'))
        # By patience it would wait for 30 s.
        values = self.node.wait_for_count('dropped: unknown frame', 1)
        self.assertIn("its frame 'plate_of_test' is not a link", values['last drop'])
        self.wrenches.publish(wrench(EPOCH + 50 * MS, frame='plate_of_test'))
        self.wait_until_taken(EPOCH + 50 * MS)

    def test_what_is_known_passes_what_is_not(self):
        self.standing(wrench_timeout=600)
        self.send_plate(0, 110)
        self.wrenches.publish(wrench(EPOCH + 10 * MS, frame='nowhere_of_test'))
        # A stamp of the future does not hold up what comes behind it, either.
        self.wrenches.publish(wrench(EPOCH + 5000 * MS, frame='plate_of_test'))
        self.wrenches.publish(wrench(EPOCH + 50 * MS, frame='plate_of_test'))
        self.wait_until_taken(EPOCH + 50 * MS)
        self.wrenches.publish(wrench(EPOCH + 60 * MS))
        self.wait_until_taken(EPOCH + 60 * MS)
        self.assertEqual(self.node.diagnostics()['dropped: unknown frame'], '0')

    def carried(self, parameters=None):
        self.arm = CarriedArm()
        self.start(ARM, {'root': 'moving', 'reactions': 'none', 'applied_wrenches': [
            {'name': 'push', 'link': 'wrist_3', 'live': True}]}, parameters)

    def check_carried(self, name, pose):
        roots = self.node.feed('multi_dof_joint_trajectory', MultiDOFJointTrajectory)
        stamps = [EPOCH + i * 70 * MS for i in range(6)]
        roots.publish(root_trajectory(self.arm, stamps))
        self.node.wait_for_count('root messages received', 1)
        self.send(*[wrench(ns, *ramp(ns), frame=name) for ns in stamps])
        message = JointTrajectory(joint_names=JOINTS)
        message.header.stamp = ros_time(stamps[0])
        message.points = [trajectory_point(ns - stamps[0], JOINTS, self.arm.joints(ns))
                          for ns in stamps]

        def computed():
            before = len(self.efforts.messages())
            self.trajectories.publish(message)
            rospy.sleep(0.2)
            return len(self.efforts.messages()) == before + len(stamps)
        wait_until(computed, self.node.output)
        bodies = RigidBodies(ARM)
        axes = {joint: bodies.axis(joint) for joint in JOINTS}
        for found in self.efforts.messages()[-len(stamps):]:
            ns = found.header.stamp.to_nsec()
            self.assertClose(found.effort, efforts(
                self.arm.bodies, self.arm.whole(ns), JOINTS, axes, [], pose, *ramp(ns)), EXACT,
                'at %d' % ns)
        self.assertEqual(self.node.diagnostics()['dropped: unknown frame'], '0')

    def test_the_frame_that_the_root_moves_against(self):
        self.carried({'root': {'source': 'trajectory'}})
        self.check_carried('odom', np.eye(4))

    def test_a_plate_beside_which_the_root_moves(self):
        # tf has nothing of the robot.
        self.place(('odom', 'floor_of_test', pose_of(TURN, AT)))
        self.carried({'root': {'source': 'trajectory'}})
        self.check_carried('floor_of_test', pose_of(TURN, AT))

    def test_an_imu_does_not_tell_where_the_root_is(self):
        self.carried({'root': {'source': 'imu'}})
        self.node.feed('imu', Imu)
        self.wrenches.publish(wrench(EPOCH, frame='odom'))
        values = self.node.wait_for_count('dropped: unknown frame', 1)
        self.assertIn("its frame 'odom' is the inertial one, and an IMU does not tell where the root "
                      'link is in it', values['last drop'])


if __name__ == '__main__':
    assert math.isclose(np.linalg.det(TURN), 1)
    run(Frames)
