"""Messages that tell how the root of an arm on a carrier moves, for ROS tests."""
import math

from geometry_msgs.msg import Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
import numpy as np
from sensor_msgs.msg import Imu, MultiDOFJointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import MultiDOFJointTrajectory, MultiDOFJointTrajectoryPoint

from carried_arm import ARM, ROOT, quaternion, transform, twist
from node_under_test import ros_time


def root_trajectory(arm, stamps, start=None, link=ROOT, frame='odom'):
    """Points at these stamps, the header at the first one."""
    start = stamps[0] if start is None else start
    message = MultiDOFJointTrajectory(joint_names=['wheel', link])
    message.header.stamp = ros_time(start)
    message.header.frame_id = frame
    for ns in stamps:
        root = arm.root(ns)
        point = MultiDOFJointTrajectoryPoint()
        point.transforms = [transform(arm.root(0)), transform(root)]
        point.velocities = [twist([9] * 3, [9] * 3), twist(root.velocity, root.angular)]
        point.accelerations = [twist([9] * 3, [9] * 3),
                               twist(root.acceleration, root.angular_acceleration)]
        point.time_from_start.secs, point.time_from_start.nsecs = divmod(ns - start, 1000000000)
        message.points.append(point)
    return message


def odometry(arm, ns, stamp=None, noise=None, size=0.0):
    """Pose in the inertial frame, twist in the axes of the root; deviations m, rad, and per s."""
    root = arm.root(ns)
    turn = root.rotation
    message = Odometry(child_frame_id=ROOT)
    message.header.frame_id = 'odom'
    message.header.stamp = ros_time(ns if stamp is None else stamp)
    errors = np.zeros((4, 3)) if noise is None else size * noise.normal(size=(4, 3))
    message.pose.pose.position = Vector3(*(root.position + errors[0]))
    message.pose.pose.orientation = quaternion(turn, errors[1])
    message.twist.twist = twist(turn.T @ root.velocity + 10 * errors[2],
                                turn.T @ root.angular + 10 * errors[3])
    return message


def state(arm, ns):
    """Without twists."""
    message = MultiDOFJointState(joint_names=['wheel', ROOT])
    message.header.frame_id = 'odom'
    message.header.stamp = ros_time(ns)
    message.transforms = [transform(arm.root(0)), transform(arm.root(ns))]
    return message


def frame(parent, child, ns, position, turn):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp = ros_time(ns)
    message.transform = Transform(translation=Vector3(*position), rotation=quaternion(turn))
    return message


# The root hangs on a frame beside it: its origin and axes in that frame.
HANGS_AT = np.array([0.3, -0.2, 0.5])
HANGS_BY = np.array([[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]])


def frames(arm, ns):
    """The frame that the root hangs on, against the inertial frame."""
    root = arm.root(ns)
    turn = root.rotation @ HANGS_BY.T
    return TFMessage([frame('left/mount', 'left/finger', ns, [0, 0, 1], np.eye(3)),
                      frame('odom', 'left/mount', ns, root.position - turn @ HANGS_AT, turn)])


# A unit on a mount that is fixed to the root: its origin and axes in the root link.
UNIT_AT = np.array([0.2, -0.1, 0.3])
UNIT_TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def with_unit(link):
    """The arm with such a mount on one of its links."""
    return ARM.replace('</robot>', """<link name="unit"/><joint name="mount" type="fixed">
        <parent link="%s"/><child link="unit"/><origin xyz="0.2 -0.1 0.3" rpy="0 0 %r"/></joint>
        </robot>""" % (link, math.pi / 2))


WITH_UNIT = with_unit(ROOT)


def imu(arm, ns, noise=None, sizes=(0.0, 0.0), link=ROOT, oriented=False):
    """What the unit measures; deviations in rad/s and m/s^2."""
    rate, force, axes = arm.unit(ns, UNIT_AT, UNIT_TURN, link)
    message = Imu()
    message.header.frame_id = 'unit'
    message.header.stamp = ros_time(ns)
    if oriented:
        message.orientation = quaternion(axes)
    else:
        message.orientation_covariance[0] = -1
    if noise is not None:
        rate = rate + sizes[0] * noise.normal(size=3)
        force = force + sizes[1] * noise.normal(size=3)
    message.angular_velocity = Vector3(*rate)
    message.linear_acceleration = Vector3(*force)
    return message
