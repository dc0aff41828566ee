#!/usr/bin/python3
"""Reactions in the axes of the inertial frame that a root moves against, beside those in root axes."""
from sensor_msgs.msg import MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory

from carried_arm import ARM, JOINTS, CarriedArm
from node_under_test import EPOCH, Node, NodeTest, ros_time, rotated, run, trajectory_point, vector
from root_messages import root_trajectory

MS = 1000000
STAMPS = [EPOCH + ns for ns in (0, 130 * MS + 1, 250 * MS + 77, 300 * MS)]
# Rounding of the oracle and of quaternions, with forces of some hundred N.
EXACT = 1e-11


class InertialAxes(NodeTest):
    def start(self, axes, source='trajectory', wait=True):
        self.arm = CarriedArm()
        self.node = Node(self, ARM, {
            'scene': {'root': 'moving', 'reactions': ['ground', 'joint_4']}, 'twist': True,
            'root': {'source': source, 'axes': axes, 'inertial_frame': 'map'}})
        if not wait:
            return
        self.roots = self.node.feed('multi_dof_joint_trajectory', MultiDOFJointTrajectory)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)

    def play(self):
        self.roots.publish(root_trajectory(self.arm, STAMPS, frame='map'))
        self.node.wait_for_count('root messages received', 1)
        message = JointTrajectory(joint_names=JOINTS)
        message.header.stamp = ros_time(STAMPS[0])
        message.points = [trajectory_point(ns - STAMPS[0], JOINTS, self.arm.joints(ns))
                          for ns in STAMPS]
        self.trajectories.publish(message)

    def test_both(self):
        self.start('both')
        in_root = self.node.record('reactions', MultiDOFJointState)
        inertial = self.node.record('reactions_inertial', MultiDOFJointState)
        self.node.wait_for_plan('reactions', 'reactions_inertial')
        self.play()
        messages = inertial.wait(len(STAMPS))
        self.assertStamps(messages, STAMPS)
        for message, other in zip(messages, in_root.wait(len(STAMPS))):
            self.assertEqual((message.header.frame_id, other.header.frame_id), ('map', 'base'))
            self.assertEqual(message.joint_names, other.joint_names)
            ns = message.header.stamp.to_nsec()
            # The oracle's root of its tree is the inertial frame.
            for name, place in (('roll', 'ground'), ('joint_4', 'joint_4')):
                right = self.arm.whole_reaction(name, ns)
                i = message.joint_names.index(place)
                what = '%s at %d' % (name, ns)
                self.assertClose(vector(message.wrench[i].force), right.force, EXACT, what)
                self.assertClose(vector(message.wrench[i].torque), right.torque, EXACT, what)
                self.assertClose(vector(message.transforms[i].translation), right.pose[:3, 3],
                                 EXACT, what)
                for axis in range(3):
                    self.assertClose(rotated(message.transforms[i].rotation, axis),
                                     right.pose[:3, axis], EXACT, what)
                self.assertClose(vector(message.twist[i].linear), right.linear, EXACT, what)
                self.assertClose(vector(message.twist[i].angular), right.angular, EXACT, what)
                turn = self.arm.root(ns).rotation
                self.assertClose(vector(other.wrench[i].force), turn.T @ right.force, EXACT, what)

    def test_inertial_alone(self):
        self.start('inertial')
        recorder = self.node.record('reactions_inertial', MultiDOFJointState)
        self.node.wait_for_plan('reactions_inertial')
        self.play()
        for message in recorder.wait(len(STAMPS)):
            right = self.arm.whole_reaction('roll', message.header.stamp.to_nsec())
            i = message.joint_names.index('ground')
            self.assertClose(vector(message.wrench[i].force), right.force, EXACT, 'force')

    def test_what_is_refused(self):
        for axes, source, text in (
                ('inertial', 'imu', "root/axes: 'inertial': an IMU does not tell the orientation"),
                ('both', 'imu', "root/axes: 'both': an IMU does not tell the orientation"),
                ('world', 'odometry', "root/axes: 'world' is none of root, inertial and both"),
                ('both', '', "root/axes: 'both': the root link rests")):
            self.start(axes, source, wait=False)
            self.assertEqual(self.node.wait(), 1)
            line, = self.node.lines('FATAL')
            self.assertIn(text, line)


if __name__ == '__main__':
    run(InertialAxes)
