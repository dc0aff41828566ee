#!/usr/bin/python3
"""A robot on two feet whose wrenches are measured: what is left for the root, and a foot that falls
silent. Everything has noise and stamps that jitter, and rates of its own."""
import time

from geometry_msgs.msg import Vector3, WrenchStamped
from nav_msgs.msg import Odometry
import numpy as np
from sensor_msgs.msg import JointState, MultiDOFJointState

from carried_arm import quaternion, twist
from node_under_test import EPOCH, Node, NodeTest, joint_state, ros_time, run, vector
from standing_biped import BIPED, FEET, JOINTS, ROOT, StandingBiped

MS = 1000000
SECONDS = 4
LAG = 50 * MS
# Standard deviations: joints, rad (18 bits in a turn) and rad/s; root, m and rad, m/s and rad/s;
# feet, N and N m; stamps, ns.
ENCODER, SPEED, POSE, TWIST = 1.2e-5, 2e-3, 1e-4, 1e-3
FORCE, MOMENT, JITTER = 1.0, 0.05, 1e5


class TwoFeet(NodeTest):
    def start(self, feet=True, parameters=None):
        self.biped = StandingBiped()
        self.noise = np.random.default_rng(11)
        scene = {'root': 'moving', 'reactions': ['ground']}
        if feet:
            scene['applied_wrenches'] = [
                {'name': side, 'link': side + '_foot', 'live': True,
                 'deviation': {'force': FORCE, 'torque': MOMENT}} for side in FEET]
        self.node = Node(self, BIPED, dict({'scene': scene, 'root': {'source': 'odometry'}},
                                           **(parameters or {})))
        self.roots = self.node.feed('odom', Odometry)
        self.states = self.node.feed('joint_states', JointState)
        self.feet = {side: self.node.feed('inverse_dynamics/wrench/' + side, WrenchStamped)
                     for side in (FEET if feet else [])}
        self.efforts = self.node.record('effort', JointState)
        self.reactions = self.node.record('reactions', MultiDOFJointState)
        self.wrenches = 0

    def normal(self, deviation, count=3):
        return deviation * self.noise.normal(size=count)

    def jittered(self, ns):
        return ns + int(self.noise.normal() * JITTER)

    def stamps(self, rate, first=0.0, last=SECONDS):
        return [EPOCH + int(i * 1e9 / rate) for i in range(int(first * rate), int(last * rate) + 1)]

    def send_root(self):
        stamps = self.stamps(200, -0.05)
        for ns in stamps:
            root = self.biped.root(ns)
            message = Odometry(child_frame_id=ROOT)
            message.header.frame_id = 'odom'
            message.header.stamp = ros_time(self.jittered(ns))
            message.pose.pose.position = Vector3(*(root.position + self.normal(POSE)))
            message.pose.pose.orientation = quaternion(root.rotation, self.normal(POSE))
            message.twist.twist = twist(root.rotation.T @ root.velocity + self.normal(TWIST),
                                        root.rotation.T @ root.angular + self.normal(TWIST))
            self.roots.publish(message)
        self.node.wait_for_count('root messages received', len(stamps))

    def send_foot(self, side, stamps):
        for ns in stamps:
            force, moment = self.biped.soles(ns)[side]
            message = WrenchStamped()
            message.header.stamp = ros_time(self.jittered(ns))
            message.header.frame_id = side + '_sole'
            message.wrench.force = Vector3(*(force + self.normal(FORCE)))
            message.wrench.torque = Vector3(*(moment + self.normal(MOMENT)))
            self.feet[side].publish(message)
        self.wrenches += len(stamps)
        self.node.wait_for_count('wrenches received', self.wrenches)

    def send_joints(self):
        """Returns the stamps."""
        sent = []
        for ns in self.stamps(500):
            q, qd, _ = self.biped.joints(ns)
            sent.append(self.jittered(ns))
            self.states.publish(joint_state(
                sent[-1], {name: q[name] + self.normal(ENCODER, 1)[0] for name in JOINTS},
                {name: qd[name] + self.normal(SPEED, 1)[0] for name in JOINTS}))
        self.node.wait_for_count('joint states received', len(sent))
        return sent

    def residuals(self, messages, after=1.5):
        """rms of force and moment of ground's wrench, once the noises are learnt."""
        chosen = [m for m in messages if m.header.stamp.to_nsec() > EPOCH + after * 1e9]
        self.assertGreater(len(chosen), 400)
        values = np.array([vector(m.wrench[0].force) + vector(m.wrench[0].torque) for m in chosen])
        self.assertTrue(np.isfinite(values).all())
        return (np.sqrt(np.mean(values[:, :3] ** 2, axis=0)),
                np.sqrt(np.mean(values[:, 3:] ** 2, axis=0)))

    def test_feet_bear_the_robot_and_nothing_is_left_for_the_root(self):
        self.start(parameters={'certificates': True, 'cross_check_rate': 100})
        deviations = self.node.record('effort_deviation', JointState)
        self.node.wait_for_plan('effort', 'reactions', 'effort_deviation')
        self.send_root()
        for side in FEET:
            self.send_foot(side, self.stamps(333, -0.05))
        sent = self.send_joints()
        results = self.efforts.wait(len(sent) - 27)
        force, moment = self.residuals(self.reactions.wait(len(results)))
        # Within 2 % of 499 N: the noise of the feet, and that of the accelerations of 51 kg. What rests,
        # here the way aside, may set off at any moment and so is smoothed least.
        print('residual: force %s N, moment %s N m' % (force, moment))
        self.assertLess(max(force), 10)
        self.assertLess(max(moment), 2.0)
        self.check_efforts(results, deviations.wait(len(results)))
        values = self.node.wait_for_count('cross-checks done', 1)
        self.assertEqual(values['dropped'], '0')
        self.assertLess(float(values['cross-check, largest difference (relative)']), 1e-12)
        for law in ('power', 'ground force', 'ground moment'):
            self.assertLess(float(values['certificate: %s (largest, relative)' % law]), 1e-12)

    def check_efforts(self, results, deviations):
        """Of the joints: near the truth, and by what is said of them."""
        said = {m.header.stamp.to_nsec(): m for m in deviations}
        ratios, errors, sizes = [], [], []
        for message in [m for m in results
                        if m.header.stamp.to_nsec() > EPOCH + 1500 * MS][::12]:
            ns = message.header.stamp.to_nsec()
            self.assertEqual(message.name, JOINTS)
            right = np.array(self.biped.efforts(ns))
            errors.append(np.array(message.effort) - right)
            sizes.append(right)
            ratios.append(errors[-1] / np.array(said[ns].effort))
        ratios = np.array(ratios)
        self.assertGreater(len(ratios), 60)
        rms = np.sqrt(np.mean(np.square(errors), axis=0))
        size = np.sqrt(np.mean(np.square(sizes), axis=0))
        print('efforts: rms %s of %s, %.3f within two deviations' % (
            rms, size, np.mean(np.abs(ratios) <= 2)))
        # The last one of an ankle is the noise of its foot.
        self.assertLess(max(rms), 1.5)
        self.assertGreater(np.mean(np.abs(ratios) <= 2), 0.85)

    def test_without_feet_the_root_bears_all(self):
        self.start(feet=False)
        self.node.wait_for_plan('effort', 'reactions')
        self.send_root()
        sent = self.send_joints()
        force, _ = self.residuals(self.reactions.wait(len(sent) - 27))
        self.assertGreater(force[2], 400)

    def test_a_foot_that_falls_silent_withholds_results(self):
        self.start()
        self.node.wait_for_plan('effort', 'reactions')
        self.send_root()
        self.send_foot('left', self.stamps(333, -0.05))
        silent, again = 2.0, 3.0
        self.send_foot('right', self.stamps(333, -0.05, silent))
        self.send_foot('right', self.stamps(333, again))
        start = time.monotonic()
        sent = self.send_joints()
        # A wrench stands for 0.1 s: no result from then until the foot comes back.
        last = max(ns for ns in self.stamps(333, 0, silent))
        first = min(ns for ns in self.stamps(333, again))
        dropped = int(self.node.wait_for_count('dropped: no wrench', 440)['dropped: no wrench'])
        count = len(sent) - 27 - dropped
        stamps = [m.header.stamp.to_nsec() for m in self.efforts.wait(count)]
        withheld = [ns for ns in sent[:-27] if ns not in set(stamps)]
        for ns in withheld:
            self.assertGreater(ns, last + 99 * MS)
            self.assertLess(ns, first + MS)
        held = [ns for ns in stamps if last + MS < ns < first - MS]
        self.assertLess(max(held), last + 101 * MS)
        values = self.node.diagnostics()
        self.assertGreater(int(values['samples with a wrench held']), 45)
        self.assertIn(self.node.name + '/wrench/right is known from stamp', values['last drop'])
        self.assertIn('wrench_timeout is 0.1 s', values['last drop'])
        said = [line for line in self.node.lines('WARN') if 'no wrench' in line]
        self.assertThrottled(said, start)
        # What comes after is as good as what came before.
        force, _ = self.residuals(
            [m for m in self.reactions.wait(count) if m.header.stamp.to_nsec() > first], 3.05 - 1.5)


if __name__ == '__main__':
    run(TwoFeet)
