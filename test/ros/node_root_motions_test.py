#!/usr/bin/python3
"""A root that moves, told by messages: axes and instants, attitudes, rates, what is bad or stale."""
import math
import random

from geometry_msgs.msg import Vector3
from nav_msgs.msg import Odometry
import numpy as np
from sensor_msgs.msg import Imu, JointState, MultiDOFJointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory

from carried_arm import ARM, JOINTS, ROOT, CarriedArm, twist
from node_under_test import (EPOCH, Node, NodeTest, joint_state, ros_time, run, trajectory_point,
                             vector, wait_until)
from root_messages import (HANGS_AT, HANGS_BY, WITH_UNIT, frame, frames, imu, odometry,
                           root_trajectory, state, with_unit)

MS = 1000000
# Times that are no multiples of each other, ns.
UNEVEN = [0, 130 * MS + 1, 250 * MS + 77, 300 * MS, 710 * MS + 13]
# Rounding of the oracle and of quaternions, with efforts of some hundred N m.
EXACT = 1e-11


class RootTest(NodeTest):
    """The node with an arm whose root moves, and the oracle."""

    def start(self, source, arm=None, parameters=None, robot=ARM):
        self.arm = arm or CarriedArm()
        self.node = Node(self, robot, dict({
            'scene': {'root': 'moving', 'reactions': ['ground']},
            'root': {'source': source}}, **(parameters or {})))
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.states = self.node.feed('joint_states', JointState)
        self.efforts = self.node.record('effort', JointState)
        self.reactions = self.node.record('reactions', MultiDOFJointState)
        self.node.wait_for_plan('effort', 'reactions')
        self.sent = 0
        topic, kind = {'odometry': ('odom', Odometry),
                       'trajectory': ('multi_dof_joint_trajectory', MultiDOFJointTrajectory),
                       'states': ('multi_dof_joint_states', MultiDOFJointState),
                       'tf': ('/tf', TFMessage),
                       'imu': ('imu', Imu)}[source]
        self.topic = topic if topic[0] == '/' else self.node.namespace + '/' + topic
        self.roots = self.node.feed(topic, kind)

    def send(self, *messages):
        """Sends messages of the root and waits until the node has them."""
        for message in messages:
            self.roots.publish(message)
        self.sent += len(messages)
        return self.node.wait_for_count('root messages received', self.sent)

    def joint_trajectory(self, stamps):
        message = JointTrajectory(joint_names=JOINTS)
        message.header.stamp = ros_time(stamps[0])
        message.points = [trajectory_point(ns - stamps[0], JOINTS, self.arm.joints(ns))
                          for ns in stamps]
        return message

    def play(self, stamps):
        self.trajectories.publish(self.joint_trajectory(stamps))

    def worst(self, count):
        """Largest errors of efforts, N m, and of ground's wrench, over some tens of messages."""
        worst = [0, 0]
        every = max(1, count // 50)  # the oracle takes its time
        for message in self.efforts.wait(count)[::every]:
            wanted = self.arm.efforts(message.header.stamp.to_nsec())
            self.assertEqual(message.name, JOINTS)
            worst[0] = max(worst[0], max(np.abs(np.array(message.effort) - wanted)))
        for message in self.reactions.wait(count)[::every]:
            self.assertEqual(message.joint_names, ['ground'])
            wanted = np.concatenate(self.arm.ground(message.header.stamp.to_nsec()))
            found = vector(message.wrench[0].force) + vector(message.wrench[0].torque)
            worst[1] = max(worst[1], max(np.abs(found - wanted)))
        self.assertTrue(all(math.isfinite(value) for value in worst))
        return worst


class RootTrajectories(RootTest):
    def test_trajectory_is_exact_at_its_points(self):
        self.start('trajectory', parameters={'certificates': True, 'cross_check_rate': 100})
        stamps = [EPOCH + ns for ns in UNEVEN]
        self.send(root_trajectory(self.arm, stamps, EPOCH - 5))
        self.play(stamps)
        messages = self.efforts.wait(len(stamps))
        self.assertStamps(messages, stamps)
        for message in messages:
            self.assertClose(message.effort, self.arm.efforts(message.header.stamp.to_nsec()),
                             EXACT, 'efforts')
        self.assertLess(self.worst(len(stamps))[1], 1e-9)
        values = self.node.diagnostics()
        self.assertEqual(values['samples with the root foreseen'], '0')
        self.assertEqual(values['dropped'], '0')

    def test_trajectory_at_another_rate_than_joint_states(self):
        """The joints at 500 Hz, the root's messages of one point at 50 Hz."""
        self.start('trajectory', CarriedArm(1.5), {'root': {
            'source': 'trajectory', 'inertial_frame': 'world', 'link': 'virtual_joint'}})
        for i in range(100):
            ns = EPOCH + i * 20 * MS
            self.roots.publish(root_trajectory(self.arm, [ns], frame='world',
                                               link='virtual_joint'))
        self.node.wait_for_count('root messages received', 100)
        for i in range(500, 900):
            ns = EPOCH + i * 2 * MS + 333
            self.states.publish(joint_state(ns, *self.arm.joints(ns)[:2]))
        # The lag of 0.05 s is 25 samples.
        self.assertLess(max(self.worst(370)), 0.02)

    def test_trajectory_between_the_points_of_joints(self):
        self.start('trajectory', parameters={'trajectory_sampling': 200})
        self.send(root_trajectory(self.arm, [EPOCH + i * 10 * MS for i in range(101)]))
        self.play([EPOCH + i * 50 * MS for i in range(21)])
        self.assertLess(max(self.worst(201)), 0.02)

    def test_what_is_stale_is_not_computed_with_and_said(self):
        self.start('trajectory')
        stamps = [EPOCH + i * 50 * MS for i in range(20)]
        self.play(stamps[:1])
        values = self.node.wait_for_count('dropped: no root motion', 1)
        self.assertIn(self.topic + ' has not told how the root link moves, at point 1',
                      values['last drop'])
        self.send(root_trajectory(self.arm, stamps[:7]))  # up to 0.3 s
        self.play(stamps)
        # Foreseen for ~root/timeout, 0.1 s: results up to 0.4 s.
        values = self.node.wait_for_count('dropped: no root motion', 12)
        self.assertStamps(self.efforts.wait(9), stamps[:9])
        self.assertEqual(values['dropped: no root motion'], '12')
        self.assertEqual(values['samples with the root foreseen'], '2')
        self.assertIn('tells how the root link moves from stamp', values['last drop'])
        self.assertIn('root/timeout is 0.1 s, at point 20', values['last drop'])
        said = [line for line in self.node.lines('WARN') if 'no root motion' in line]
        self.assertTrue(any('result dropped (no root motion)' in line for line in said), said)
        self.assertLessEqual(len(said), 2)
        later = [ns + 2000 * MS for ns in stamps]
        self.send(root_trajectory(self.arm, later))
        self.play(later)
        self.assertStamps(self.efforts.wait(29)[9:], later)

    def test_bad_trajectories(self):
        self.start('trajectory', parameters={'frame_prefix': 'left/'})
        stamps = [EPOCH, EPOCH + 50 * MS]

        def changed(change, link='left/' + ROOT):
            message = root_trajectory(self.arm, stamps, link=link)
            change(message)
            return message

        def rotation(message):
            return message.points[1].transforms[1].rotation

        cases = [
            (lambda m: setattr(m.header, 'frame_id', 'map'), 'unknown frame',
             "its frame 'map' is not the inertial frame 'odom'"),
            (lambda m: setattr(m, 'joint_names', ['a', ROOT]), 'unknown frame',
             "it does not name the root link 'left/base', but a, base"),
            (lambda m: setattr(m, 'joint_names', ['left/base'] * 2), 'joint twice',
             "it names 'left/base' twice"),
            (lambda m: setattr(m, 'points', []), 'no points', 'it has no points'),
            (lambda m: setattr(m.points[1], 'accelerations', []), 'array length',
             'point 2 has 0 accelerations for 2 names'),
            (lambda m: m.points[1].velocities.pop(), 'array length',
             'point 2 has 1 velocities for 2 names'),
            (lambda m: m.points[0].transforms.pop(), 'array length',
             'point 1 has 1 transforms for 2 names'),
            (lambda m: setattr(m.points[1].time_from_start, 'nsecs', 0), 'times',
             'time_from_start of point 2 is 0 s, not later than the point before'),
            (lambda m: setattr(rotation(m), 'y', math.nan), 'not finite',
             'its point 2 rotation.y is nan'),
            (lambda m: setattr(m.points[1].accelerations[1].angular, 'z', math.inf), 'not finite',
             'its point 2 acceleration.angular.z is inf'),
            (lambda m: setattr(rotation(m), 'w', rotation(m).w + 0.5), 'orientation',
             'its point 2 rotation has the length 1.'),
        ]
        for change, reason, text in cases:
            count = int(self.node.diagnostics()['dropped: ' + reason])
            self.send(changed(change))
            values = self.node.wait_for_count('dropped: ' + reason, count + 1)
            self.assertIn(self.topic + ': ', values['last drop'])
            self.assertIn(text, values['last drop'])
        self.assertEqual(int(self.node.diagnostics()['dropped']), len(cases))

        def stretch(message):
            for name in 'xyzw':
                setattr(rotation(message), name, getattr(rotation(message), name) * 1.0005)
        self.send(changed(stretch), changed(stretch))
        wait_until(lambda: self.node.lines('WARN'), self.node.output)
        self.play(stamps)
        self.worst(2)
        said = [line for line in self.node.lines('WARN') if 'scaled to 1' in line]
        self.assertEqual(len(said), 1, said)
        self.assertIn('the quaternion point 2 rotation has the length 1.0005', said[0])


class RootPoses(RootTest):
    """Sources whose accelerations are estimated; the joints at 500 Hz and exact."""

    SECONDS = 4

    def follow(self, roots, rate):
        """Sends what roots(ns) makes at a rate, Hz, and joint states up to the end."""
        stamps = [EPOCH + int(i * 1e9 / rate) for i in range(int(self.SECONDS * rate) + 1)]
        for ns in stamps:
            self.roots.publish(roots(ns))
        self.node.wait_for_count('root messages received', len(stamps))
        # Until the noises are found from some tenths of a second, accelerations are less exact.
        first, last = EPOCH + 2000 * MS, EPOCH + self.SECONDS * 1000 * MS
        for ns in range(first, last + 1, 2 * MS):
            self.states.publish(joint_state(ns, *self.arm.joints(ns)[:2]))
        # The lag of 0.05 s is 25 samples, and the first four are waited for.
        return self.worst((last - first) // (2 * MS) - 27)

    def test_odometry(self):
        self.start('odometry', parameters={'certificates': True, 'cross_check_rate': 100})
        worst = self.follow(lambda ns: odometry(self.arm, ns), 50)
        # Of some hundred N m: what 20 ms leave of a motion that turns by some rad/s.
        self.assertLess(worst[0], 0.05)
        self.assertLess(worst[1], 0.1)
        values = self.node.wait_for_count('cross-checks done', 1)
        self.assertLess(float(values['cross-check, largest difference (relative)']), 1e-12)
        for law in ('power', 'ground force', 'ground moment'):
            self.assertLess(float(values['certificate: %s (largest, relative)' % law]), 1e-12)
        for count in ('dropped', 'samples with the root foreseen', 'restarts of the root'):
            self.assertEqual(values[count], '0', count)

    def test_odometry_from_another_attitude(self):
        self.start('odometry', CarriedArm(start=(2.0, 1.5, -0.4)))
        worst = self.follow(lambda ns: odometry(self.arm, ns), 50)
        self.assertLess(worst[0], 0.05)
        self.assertLess(worst[1], 0.1)

    def test_odometry_of_noise(self):
        self.start('odometry')
        noise = np.random.default_rng(5)
        # 0.1 mm and 1e-4 rad, and ten times that per second.
        worst = self.follow(lambda ns: odometry(self.arm, ns, noise=noise, size=1e-4), 100)
        self.assertLess(max(worst), 3)

    def test_odometry_with_stamps_that_jitter(self):
        self.start('odometry')
        noise = random.Random(3)
        worst = self.follow(lambda ns: odometry(self.arm, ns, ns + int(noise.gauss(0, 2e5))), 50)
        self.assertLess(max(worst), 4)

    def test_states(self):
        self.start('states')
        worst = self.follow(lambda ns: state(self.arm, ns), 100)
        self.assertLess(max(worst), 0.02)

    def test_tf(self):
        self.start('tf', parameters={'frame_prefix': 'left/'})
        fixed = self.node.feed('/tf_static', TFMessage)
        self.play([EPOCH])
        values = self.node.wait_for_count('dropped: no root motion', 1)
        self.assertIn("/tf has no transform from 'odom' to 'left/base', at point 1",
                      values['last drop'])
        fixed.publish(TFMessage([frame('left/mount', 'left/base', EPOCH, HANGS_AT, HANGS_BY)]))
        worst = self.follow(lambda ns: frames(self.arm, ns), 100)
        self.assertLess(max(worst), 0.02)

    def test_tf_of_bad_numbers(self):
        self.start('tf')
        bad = [frame('odom', ROOT, EPOCH, [0, math.nan, 0], np.eye(3)),
               frame('odom', ROOT, EPOCH, [0, 0, 0], np.eye(3))]
        bad[1].transform.rotation.x = 0.5
        for message, reason, text in zip(bad, ('not finite', 'orientation'), (
                "of frame 'base', its translation.y is nan",
                "of frame 'base', its rotation has the length 1.118")):
            self.roots.publish(TFMessage([message]))
            values = self.node.wait_for_count('dropped: ' + reason, 1)
            self.assertIn('/tf: ' + text, values['last drop'])

    def test_imu(self):
        self.start('imu', robot=WITH_UNIT,
                   parameters={'certificates': True, 'cross_check_rate': 100})
        worst = self.follow(lambda ns: imu(self.arm, ns), 200)
        self.assertLess(max(worst), 0.005)
        values = self.node.wait_for_count('cross-checks done', 1)
        self.assertLess(float(values['cross-check, largest difference (relative)']), 1e-12)
        for law in ('power', 'ground force', 'ground moment'):
            self.assertLess(float(values['certificate: %s (largest, relative)' % law]), 1e-12)

    def test_imu_on_a_link_that_joints_move(self):
        self.start('imu', robot=with_unit('wrist_1'),
                   parameters={'certificates': True, 'cross_check_rate': 100})
        worst = self.follow(lambda ns: imu(self.arm, ns, link='wrist_1'), 200)
        self.assertLess(max(worst), 0.05)
        # Of points of a trajectory, by the joints' motion at each of them.
        stamps = [EPOCH + 400 * MS, EPOCH + 433 * MS, EPOCH + 500 * MS]
        before = len(self.efforts.messages())
        self.play(stamps)
        for message in self.efforts.wait(before + len(stamps))[before:]:
            wanted = self.arm.efforts(message.header.stamp.to_nsec())
            self.assertLess(max(np.abs(np.array(message.effort) - wanted)), 0.05)
        values = self.node.wait_for_count('cross-checks done', 1)
        self.assertLess(float(values['cross-check, largest difference (relative)']), 1e-12)

    def test_imu_that_moves_to_another_link(self):
        # What the unit measured there says nothing of here.
        self.start('imu', robot=with_unit('wrist_1'))
        self.send(*[imu(self.arm, EPOCH + i * 5 * MS, link='wrist_1') for i in range(100)])
        # After a pause of 0.3 s, of more than ~estimator/max_gap.
        self.send(*[self.unit_on_root(EPOCH + i * 5 * MS) for i in range(160, 260)])
        self.assertEqual(self.node.diagnostics()['dropped'], '0')
        stamps = [EPOCH + 1000 * MS, EPOCH + 1100 * MS]
        self.play(stamps)
        for message in self.efforts.wait(len(stamps)):
            wanted = self.arm.efforts(message.header.stamp.to_nsec())
            self.assertLess(max(np.abs(np.array(message.effort) - wanted)), 0.02)
        self.play([EPOCH + 300 * MS])
        values = self.node.wait_for_count('dropped: no root motion', 1)
        self.assertIn('tells how the root link moves from stamp', values['last drop'])

    def unit_on_root(self, ns):
        message = imu(self.arm, ns)
        message.header.frame_id = ROOT
        rate, force, _ = self.arm.unit(ns, np.zeros(3), np.eye(3))
        message.angular_velocity = Vector3(*rate)
        message.linear_acceleration = Vector3(*force)
        return message

    def test_imus_by_turns(self):
        self.start('imu', robot=with_unit('wrist_1'))
        for i in range(100):
            self.roots.publish(self.unit_on_root(EPOCH + i * 5 * MS))
            self.roots.publish(imu(self.arm, EPOCH + i * 5 * MS + 2 * MS, link='wrist_1'))
        self.sent = 200
        values = self.node.wait_for_count('dropped: unknown frame', 100)
        self.assertIn("imu: its frame 'unit' is another one than '%s' of the unit that is listened to"
                      % ROOT, values['last drop'])
        stamps = [EPOCH + 300 * MS, EPOCH + 400 * MS]
        self.play(stamps)
        for message in self.efforts.wait(len(stamps)):
            wanted = self.arm.efforts(message.header.stamp.to_nsec())
            self.assertLess(max(np.abs(np.array(message.effort) - wanted)), 0.02)

    def test_imu_of_noise(self):
        self.start('imu', robot=WITH_UNIT)
        noise = np.random.default_rng(7)
        worst = self.follow(lambda ns: imu(self.arm, ns, noise, (2e-3, 0.02)), 200)
        self.assertLess(max(worst), 5)

    def test_bad_imu(self):
        self.start('imu', robot=WITH_UNIT)
        bad = [imu(self.arm, EPOCH) for _ in range(4)]
        bad[0].header.frame_id = 'unti'
        bad[1].angular_velocity.x = math.nan
        bad[2].linear_acceleration_covariance[0] = -1
        bad[3].header.stamp = ros_time(0)
        for message, text in zip(bad, (
                "its frame 'unti' is not a link of robot 'six_axis_arm'",
                'its angular_velocity.x is nan',
                'by its covariance it does not have linear_acceleration',
                'its stamp is zero')):
            self.send(message)
            values = self.node.wait_for_count('dropped', self.sent)
            self.assertIn(self.topic + ': ' + text, values['last drop'])

    def test_poses_too_far_apart(self):
        self.start('odometry')
        self.send(*[odometry(self.arm, EPOCH + i * 300 * MS) for i in range(10)])
        self.play([EPOCH + 1500 * MS])
        values = self.node.wait_for_count('dropped: no root motion', 1)
        self.assertIn('has messages 0.3 s apart, and across more than', values['last drop'])
        self.assertIn('estimator/max_gap = 0.25 s no acceleration is estimated, at point 1',
                      values['last drop'])
        self.assertEqual(values['gaps of the root'], '9')

    def test_poses_count_without_rates_that_are_not_finite(self):
        self.start('odometry')

        def unmeasured(ns):
            message = odometry(self.arm, ns)
            message.twist.twist.angular.y = math.nan
            message.twist.twist.linear.z = math.inf
            return message
        worst = self.follow(unmeasured, 50)
        self.assertLess(worst[0], 0.05)
        self.assertLess(worst[1], 0.1)
        values = self.node.diagnostics()
        self.assertEqual(values['dropped'], '0')
        self.assertEqual(int(values['root messages with rates that are not finite']), self.SECONDS * 50 + 1)
        # Nor do they count as velocities of zero, which would contradict the poses.
        self.assertEqual([line for line in self.node.lines('WARN') if 'velocities of' in line], [])
        said = [line for line in self.node.lines('WARN') if 'not finite' in line]
        self.assertEqual(len(said), 1, said)
        self.assertIn(self.topic + ': its twist.linear.z is inf: poses count without rates', said[0])

    def test_twists_in_other_axes_are_named(self):
        self.start('odometry')

        def other(ns):
            message = odometry(self.arm, ns)
            root = self.arm.root(ns)
            message.twist.twist = twist(root.velocity, root.angular)  # of the inertial frame
            return message
        self.follow(other, 50)
        self.node.diagnostics(lambda values: [
            status for status in self.node.statuses()
            if 'velocities of ' in status.message and 'root.' in status.message], 'the WARN')

    def test_bad_odometry(self):
        self.start('odometry')
        stamps = [EPOCH + i * 2 * MS for i in range(100)]
        self.send(*[odometry(self.arm, ns) for ns in stamps if ns != stamps[90]])
        late = odometry(self.arm, EPOCH - MS)
        child = odometry(self.arm, stamps[-1] + MS)
        child.child_frame_id = 'base_footprint'
        broken = odometry(self.arm, stamps[-1] + MS)
        broken.pose.pose.position.y = math.nan
        for message, reason, text in (
                (child, 'unknown frame',
                 "its child_frame_id 'base_footprint' is not the root link 'base'"),
                (broken, 'not finite', 'its position.y is nan'),
                (odometry(self.arm, stamps[80]), 'equal stamp', 'was received before'),
                (late, 'too late', 'is too far behind those received before')):
            self.send(message)
            values = self.node.wait_for_count('dropped: ' + reason, 1)
            self.assertIn(self.topic + ': ', values['last drop'])
            self.assertIn(text, values['last drop'])
        self.send(odometry(self.arm, stamps[90]))
        self.assertEqual(self.node.wait_for_count('root messages put in order', 1)['dropped'], '4')
        self.play([stamps[95]])
        self.assertLess(max(self.worst(1)), 1)
        # As a looped bag does it.
        self.send(*[odometry(self.arm, ns - 1000 * MS) for ns in stamps])
        self.node.wait_for_count('restarts of the root', 1)
        self.play([stamps[95]])
        self.node.wait_for_count('dropped: no root motion', 1)
        self.play([stamps[95] - 1000 * MS])
        self.efforts.wait(2)


if __name__ == '__main__':
    run(RootTrajectories, RootPoses)
