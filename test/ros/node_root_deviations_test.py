#!/usr/bin/python3
"""Efforts of an arm on a shaken base, known by an IMU alone or by noisy poses, and how far off they may
be: ~effort_deviation covers joints and root. Noise, jitter and rates of their own everywhere."""
from nav_msgs.msg import Odometry
import numpy as np
from sensor_msgs.msg import Imu, JointState

from carried_arm import JOINTS, CarriedArm
from node_under_test import EPOCH, Node, NodeTest, joint_state, ros_time, run
from root_messages import WITH_UNIT, imu, odometry, with_unit

MS = 1000000
SECONDS = 5  # as many messages as are kept
LEARNT = EPOCH + 2000 * MS
JITTER = 1e5  # ns
# Encoders of 18 bits in a turn, and velocities by drivers.
ENCODER, SPEED = 1.2e-5, 2e-3
# Of a unit at 200 Hz as data sheets have it, rad/s and m/s^2.
RATE_NOISE, FORCE_NOISE = 2e-3, 0.02


class RootDeviations(NodeTest):
    def start(self, source, topic, kind, robot=WITH_UNIT):
        self.arm = CarriedArm()
        self.noise = np.random.default_rng(21)
        self.node = Node(self, robot, {
            'scene': {'root': 'moving', 'reactions': 'none'}, 'root': {'source': source},
            'deviation_warn': 1e-9})
        self.roots = self.node.feed(topic, kind)
        self.states = self.node.feed('joint_states', JointState)
        self.efforts = self.node.record('effort', JointState)
        self.deviations = self.node.record('effort_deviation', JointState)
        self.node.wait_for_plan('effort', 'effort_deviation')

    def jittered(self, ns):
        return ns + int(self.noise.normal() * JITTER)

    def send(self, root_message, rate):
        stamps = [EPOCH + int(i * 1e9 / rate) for i in range(SECONDS * rate + 1)]
        for ns in stamps:
            message = root_message(ns)
            message.header.stamp = ros_time(self.jittered(ns))
            self.roots.publish(message)
        self.node.wait_for_count('root messages received', len(stamps))
        count = SECONDS * 500
        for i in range(count):
            ns = EPOCH + i * 2 * MS
            q, qd, _ = self.arm.joints(ns)
            self.states.publish(joint_state(
                self.jittered(ns), {name: q[name] + ENCODER * self.noise.normal() for name in JOINTS},
                {name: qd[name] + SPEED * self.noise.normal() for name in JOINTS}))
        self.node.wait_for_count('joint states received', count)
        return self.efforts.wait(count - 40)

    def check(self, results, largest):
        """Errors against the exact motion of the base: rms, and how they compare with what is said."""
        said = {m.header.stamp.to_nsec(): m for m in self.deviations.wait(len(results))}
        errors, deviations, efforts = [], [], []
        for message in [m for m in results if m.header.stamp.to_nsec() > LEARNT][::12]:
            ns = message.header.stamp.to_nsec()
            self.assertEqual(said[ns].name, JOINTS)
            right = np.array(self.arm.efforts(ns))
            errors.append(np.array(message.effort) - right)
            deviations.append(said[ns].effort)
            efforts.append(right)
        errors, deviations = np.array(errors), np.array(deviations)
        self.assertGreater(len(errors), 100)
        rms = np.sqrt(np.mean(errors ** 2, axis=0))
        inside = np.mean(np.abs(errors) <= 2 * deviations, axis=0)
        ratio = rms / np.sqrt(np.mean(deviations ** 2, axis=0))
        print('efforts %s, errors %s N m, over deviations %s, within two %s' % (
            np.sqrt(np.mean(np.array(efforts) ** 2, axis=0)), rms, ratio, inside))
        self.assertLess(max(rms), largest)
        self.assertGreater(np.mean(inside), 0.9)
        for joint, name in enumerate(JOINTS):
            self.assertTrue(0.5 < ratio[joint] < 1.5, '%s: %g' % (name, ratio[joint]))
            self.assertGreater(inside[joint], 0.82, name)

    def test_imu_alone(self):
        self.start('imu', 'imu', Imu)
        results = self.send(lambda ns: imu(self.arm, ns, self.noise, (RATE_NOISE, FORCE_NOISE)), 200)
        # Of up to some hundred N m.
        self.check(results, 2)
        values = self.node.diagnostics()
        for axis in 'xyz':
            self.assertIn('rad/s', values['samples of root.angular_velocity.' + axis])
            self.assertIn('m/s^2', values['samples of root.specific_force.' + axis])
        # What makes the most of the doubts is said: the unit's noise, beside that of the encoders.
        causes = {entry.value for status in self.node.statuses() for entry in status.values
                  if entry.key == 'efforts in doubt'}
        self.assertTrue(any("mostly from the noise of the root's" in text for text in causes),
                        causes)

    def test_imu_on_a_link_that_joints_move(self):
        self.start('imu', 'imu', Imu, with_unit('upper_arm'))
        results = self.send(lambda ns: imu(self.arm, ns, self.noise, (RATE_NOISE, FORCE_NOISE),
                                           link='upper_arm'), 200)
        self.check(results, 2)

    def test_poses(self):
        self.start('odometry', 'odom', Odometry)
        results = self.send(lambda ns: odometry(self.arm, ns, noise=self.noise, size=1e-4), 100)
        self.check(results, 2)
        values = self.node.diagnostics()
        for name in ('position.x', 'position.y', 'position.z', 'orientation'):
            self.assertIn('noise', values['samples of root.' + name])


if __name__ == '__main__':
    run(RootDeviations)
