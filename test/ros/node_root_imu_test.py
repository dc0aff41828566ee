#!/usr/bin/python3
"""A root that moves as an inertial measurement unit says, which is on any link; what is bad."""
import math

from geometry_msgs.msg import Vector3
import numpy as np

from carried_arm import ROOT
from node_under_test import EPOCH, ros_time, run
from root_messages import WITH_UNIT, imu, with_unit
from root_node import MS, RootTest


class RootByImu(RootTest):
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


if __name__ == '__main__':
    run(RootByImu)
