#!/usr/bin/python3
"""Tables with the motion of a root link, as trajectory_publisher_node plays them."""
import itertools
import tempfile
import xmlrpc.client

from nav_msgs.msg import Odometry
import numpy as np
import rosgraph
import rospy
from sensor_msgs.msg import Imu, JointState, MultiDOFJointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import MultiDOFJointTrajectory

from carried_arm import ARM, JOINTS, ROOT, CarriedArm, quaternion
from node_under_test import (Node, NodeTest, Process, Recorder, executable, rotated, run, vector,
                             wait_until)

STEP = 5000000  # ns, from row to row and from message to message
ROWS = 101
# Positions of up to 3 m and rates of some tens per s^2, by way of a quaternion.
ROUNDING = 1e-12
QUANTITIES = ('position', 'velocity', 'acceleration', 'angular_velocity', 'angular_acceleration')
_numbers = itertools.count(1)


class PlayedRoots(NodeTest):
    def setUp(self):
        self.arm = CarriedArm(start_ns=0)
        self.namespace = '/played_%d' % next(_numbers)

    def table(self, quantities):
        """Rows in closed form; the sign of quaternions changes from row to row."""
        file = tempfile.NamedTemporaryFile('w', suffix='.csv')
        self.addCleanup(file.close)
        header = ['time'] + [level + '.' + joint for level in ('position', 'velocity', 'acceleration')
                             for joint in JOINTS]
        header += ['root.%s.%s' % (quantity, axis) for quantity in quantities for axis in 'xyz']
        header += ['root.orientation.' + axis for axis in 'xyzw']
        file.write(','.join(header) + '\n')
        for i in range(ROWS):
            root = self.arm.root(i * STEP)
            values = dict(zip(QUANTITIES, (root.position, root.velocity, root.acceleration,
                                           root.angular, root.angular_acceleration)))
            turn = quaternion(root.rotation)
            cells = [i * STEP / 1e9]
            for level in self.arm.joints(i * STEP):
                cells += [level[name] for name in JOINTS]
            for quantity in quantities:
                cells += list(values[quantity])
            cells += [(-1) ** i * value for value in (turn.x, turn.y, turn.z, turn.w)]
            file.write(','.join('%r' % float(cell) for cell in cells) + '\n')
        file.flush()
        return file.name

    def record(self, topic, kind):
        recorder = Recorder(topic if topic[0] == '/' else self.namespace + '/' + topic, kind)
        self.addCleanup(recorder.stop)
        return recorder

    def play(self, source, parameters=None, quantities=QUANTITIES):
        name = self.namespace + '/trajectory_publisher'
        rospy.set_param(self.namespace + '/robot_description', ARM)
        rospy.set_param(name, dict({'law': 'table', 'joints': [], 'file': self.table(quantities),
                                    'rate': 200, 'root': {'source': source}}, **(parameters or {})))
        return Process(self, [executable('trajectory_publisher_node'), '__ns:=' + self.namespace,
                              '__name:=trajectory_publisher'])

    def begin(self, *topics):
        """Lets the player begin, which waits for joint states to be listened to: once these topics are."""
        name, master = self.namespace + '/trajectory_publisher', rosgraph.Master('/test')

        def listened():
            publishers = dict(master.getSystemState()[0])
            names = [topic if topic[0] == '/' else self.namespace + '/' + topic for topic in topics]
            if not all(name in publishers.get(topic, []) for topic in names):
                return False
            _, _, bus = xmlrpc.client.ServerProxy(master.lookupNode(name)).getBusInfo('/test')
            return set(names) <= {entry[4] for entry in bus if entry[2] == 'o'}
        wait_until(listened, 'subscribers of %s' % (topics,))
        return self.record('joint_states', JointState)

    def played(self, source, topic, kind, beside=(), **others):
        """Messages of the root with the time of each since the start, ns."""
        roots = self.record(topic, kind)
        player = self.play(source, **others)
        states = self.begin(topic, *beside)
        messages = roots.wait(ROWS)
        self.assertEqual(player.wait(), 0, player.output())
        start = states.wait(ROWS)[0].header.stamp.to_nsec()
        self.assertStamps(messages, [start + i * STEP for i in range(ROWS)])
        return [(i * STEP, message) for i, message in enumerate(messages)]

    def assertTurn(self, found, rotation):
        for axis in range(3):
            self.assertClose(rotated(found, axis), rotation[:, axis], ROUNDING, 'axis')

    def assertTwist(self, found, linear, angular, tolerance=ROUNDING):
        self.assertClose(vector(found.linear), linear, tolerance, 'linear')
        self.assertClose(vector(found.angular), angular, tolerance, 'angular')

    def test_odometry(self):
        for ns, message in self.played('odometry', 'odom', Odometry):
            root = self.arm.root(ns)
            self.assertEqual((message.header.frame_id, message.child_frame_id), ('odom', ROOT))
            self.assertClose(vector(message.pose.pose.position), root.position, ROUNDING, 'position')
            self.assertTurn(message.pose.pose.orientation, root.rotation)
            self.assertTwist(message.twist.twist, root.rotation.T @ root.velocity,
                             root.rotation.T @ root.angular)

    def test_states(self):
        parameters = {'root': {'source': 'states', 'inertial_frame': 'world', 'link': 'left/base'}}
        for ns, message in self.played('states', 'multi_dof_joint_states', MultiDOFJointState,
                                       parameters=parameters):
            root = self.arm.root(ns)
            self.assertEqual((message.header.frame_id, message.joint_names),
                             ('world', ['left/base']))
            self.assertClose(vector(message.transforms[0].translation), root.position, ROUNDING,
                             'position')
            self.assertTurn(message.transforms[0].rotation, root.rotation)
            self.assertTwist(message.twist[0], root.velocity, root.angular)

    def test_trajectory_of_one_point_each(self):
        for ns, message in self.played('trajectory', 'multi_dof_joint_trajectory',
                                       MultiDOFJointTrajectory):
            self.assertPoint(message.points[0], self.arm.root(ns))

    def assertPoint(self, point, root):
        self.assertClose(vector(point.transforms[0].translation), root.position, ROUNDING, 'position')
        self.assertTurn(point.transforms[0].rotation, root.rotation)
        self.assertTwist(point.velocities[0], root.velocity, root.angular)
        self.assertTwist(point.accelerations[0], root.acceleration, root.angular_acceleration)

    def test_imu(self):
        gravity = np.array([0.5, 0, -3.7])
        parameters = {'root': {'source': 'imu', 'gravity': gravity.tolist()}}
        for ns, message in self.played('imu', 'imu', Imu, parameters=parameters):
            root = self.arm.root(ns)
            self.assertEqual(message.header.frame_id, ROOT)
            self.assertEqual(message.orientation_covariance[0], -1)
            self.assertClose(vector(message.angular_velocity), root.rotation.T @ root.angular,
                             ROUNDING, 'rate')
            self.assertClose(vector(message.linear_acceleration),
                             root.rotation.T @ (root.acceleration - gravity), ROUNDING, 'force')

    def test_tf_beside_and_alone(self):
        frames = self.record('/tf', TFMessage)
        self.played('odometry', 'odom', Odometry, beside=['/tf'])
        count = 26  # 0.5 s at 50 Hz
        self.assertEqual(len(frames.wait(count)), count)
        player = self.play('tf')
        self.begin('/tf')
        messages = frames.wait(count + ROWS)[count:]
        self.assertEqual(player.wait(), 0, player.output())
        start = messages[0].transforms[0].header.stamp.to_nsec()
        for message in messages:
            found = message.transforms[0]
            root = self.arm.root(found.header.stamp.to_nsec() - start)
            self.assertEqual((found.header.frame_id, found.child_frame_id), ('odom', ROOT))
            self.assertClose(vector(found.transform.translation), root.position, ROUNDING, 'position')
            self.assertTurn(found.transform.rotation, root.rotation)

    def test_poses_alone(self):
        """Rates are those of a spline: its error falls as the third power of 5 ms times the speed."""
        for ns, message in self.played('odometry', 'odom', Odometry,
                                       quantities=('position',)):
            root = self.arm.root(ns)
            self.assertTurn(message.pose.pose.orientation, root.rotation)
            self.assertTwist(message.twist.twist, root.rotation.T @ root.velocity,
                             root.rotation.T @ root.angular, 1e-5)

    def test_trajectory_through_the_node_is_exact(self):
        node = Node(self, ARM, {'scene': {'root': 'moving'}, 'root': {'source': 'trajectory'}})
        self.namespace = node.namespace
        efforts = node.record('effort', JointState)
        node.wait_for_plan('effort')
        # Messages of two topics have no order: what comes before the root's has no result.
        player = self.play('trajectory', {'message': 'joint_trajectory', 'loop': True,
                                          'loop_pause': 1})
        messages = efforts.wait(ROWS)[:ROWS]
        player.interrupt()
        self.assertEqual(player.wait(), 0, player.output())
        start = messages[0].header.stamp.to_nsec()
        self.assertStamps(messages, [start + i * STEP for i in range(ROWS)])
        for i, message in enumerate(messages):
            self.assertClose(message.effort, self.arm.efforts(i * STEP), 1e-11, 'efforts')

    def test_what_is_wrong_is_said(self):
        for parameters, quantities, text in (
                ({'root': {'source': 'gps'}}, QUANTITIES,
                 "~root/source: 'gps' is none of odometry, trajectory, states, tf and imu"),
                ({'root': {'source': 'imu', 'gravity': [1]}}, QUANTITIES,
                 '~root/gravity: expected three numbers, m/s^2, got 1'),
                ({'law': 'cosine', 'joints': JOINTS, 'amplitudes': [1] * 6}, QUANTITIES,
                 '~root/source: only the law `table` knows how a root moves'),
                ({'message': 'joint_trajectory'}, QUANTITIES,
                 '~root/source: with message: joint_trajectory, expected trajectory: other messages '
                 'would tell of the root when the trajectory is over'),
                ({}, ('velocity',), '~file: columns are missing: root.position.{x,y,z}')):
            player = self.play('odometry', parameters, quantities)
            self.assertEqual(player.wait(), 1)
            self.assertEqual([line.replace(self.namespace + '/trajectory_publisher/', '~')
                              for line in player.lines('FATAL')], ['parameter ' + text])


if __name__ == '__main__':
    run(PlayedRoots)
