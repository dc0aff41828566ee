#!/usr/bin/python3
"""A root that moves, told by poses whose accelerations are estimated: axes, rates, noise, what is bad."""
import math
import random

import numpy as np
from tf2_msgs.msg import TFMessage

from carried_arm import ROOT, CarriedArm, twist
from node_under_test import EPOCH, run
from root_messages import HANGS_AT, HANGS_BY, frame, frames, odometry, state
from root_node import MS, RootTest


class RootPoses(RootTest):
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
        self.node.wait_for_status('velocities of ', 'root.')

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
    run(RootPoses)
