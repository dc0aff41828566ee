#!/usr/bin/python3
"""Reactions in the axes of the inertial frame that a root moves against, beside those in root axes."""
from sensor_msgs.msg import Imu, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory

from carried_arm import ARM, JOINTS, CarriedArm
from node_under_test import EPOCH, Node, NodeTest, ros_time, rotated, run, trajectory_point, vector
from root_messages import imu, root_trajectory, with_unit

MS = 1000000
STAMPS = [EPOCH + ns for ns in (0, 130 * MS + 1, 250 * MS + 77, 300 * MS)]
# Rounding of the oracle and of quaternions, with forces of some hundred N.
EXACT = 1e-11


class InertialAxes(NodeTest):
    def start(self, axes, source='trajectory', wait=True, robot=ARM):
        self.arm = CarriedArm()
        self.node = Node(self, robot, {
            'scene': {'root': 'moving', 'reactions': ['ground', 'joint_4']}, 'twist': True,
            'root': {'source': source, 'axes': axes, 'inertial_frame': 'map'}})
        if not wait:
            return
        if source == 'imu':
            self.units = self.node.feed('imu', Imu)
        else:
            self.roots = self.node.feed('multi_dof_joint_trajectory', MultiDOFJointTrajectory)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)

    def play(self, stamps=None):
        if stamps is None:
            stamps = STAMPS
            self.roots.publish(root_trajectory(self.arm, stamps, frame='map'))
            self.node.wait_for_count('root messages received', 1)
        message = JointTrajectory(joint_names=JOINTS)
        message.header.stamp = ros_time(stamps[0])
        message.points = [trajectory_point(ns - stamps[0], JOINTS, self.arm.joints(ns))
                          for ns in stamps]
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

    def test_imu_with_orientation(self):
        for link in ('base', 'forearm'):
            with self.subTest(link):
                self.check_imu(link)

    def check_imu(self, link):
        self.start('both', 'imu', robot=with_unit(link))
        inertial = self.node.record('reactions_inertial', MultiDOFJointState)
        in_root = self.node.record('reactions', MultiDOFJointState)
        self.node.wait_for_plan('reactions', 'reactions_inertial')
        messages = [imu(self.arm, EPOCH + i * 5 * MS, link=link, oriented=True) for i in range(200)]
        for message in messages:
            self.units.publish(message)
        self.node.wait_for_count('root messages received', len(messages))
        stamps = [EPOCH + ns * MS for ns in (400, 611, 930)]
        self.play(stamps)
        for message, other in zip(inertial.wait(len(stamps)), in_root.wait(len(stamps))):
            ns = message.header.stamp.to_nsec()
            self.assertEqual(message.header.frame_id, 'map')
            # Where the root is, and how fast, a unit does not tell.
            self.assertEqual((len(message.transforms), len(message.twist)), (0, 0))
            self.assertEqual((len(other.transforms), len(other.twist)), (2, 2))
            for name, place in (('roll', 'ground'), ('joint_4', 'joint_4')):
                right = self.arm.whole_reaction(name, ns)
                i = message.joint_names.index(place)
                # Of some hundred N and N m, by smoothed measurements.
                self.assertClose(vector(message.wrench[i].force), right.force, 2e-4, name)
                self.assertClose(vector(message.wrench[i].torque), right.torque, 2e-4, name)
                turn = self.arm.root(ns).rotation
                self.assertClose(vector(other.wrench[i].force), turn.T @ right.force, 2e-4, name)
        # Not all units tell it.
        self.units.publish(imu(self.arm, EPOCH + 1005 * MS, link=link))
        values = self.node.wait_for_count('dropped: orientation', 1)
        self.assertIn('/imu: by its covariance it does not have orientation, without which there '
                      'are no results in inertial axes', values['last drop'])
        message = imu(self.arm, EPOCH + 1005 * MS, link=link, oriented=True)
        message.orientation.w += 1
        self.units.publish(message)
        values = self.node.wait_for_count('dropped: orientation', 2)
        self.assertIn('its orientation has the length', values['last drop'])

    def test_what_is_refused(self):
        for axes, source, text in (
                ('world', 'odometry', "root/axes: 'world' is none of root, inertial and both"),
                ('both', '', "root/axes: 'both': the root link rests")):
            self.start(axes, source, wait=False)
            self.assertEqual(self.node.wait(), 1)
            line, = self.node.lines('FATAL')
            self.assertIn(text, line)


if __name__ == '__main__':
    run(InertialAxes)
