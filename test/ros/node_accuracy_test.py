#!/usr/bin/python3
"""The paper's composed pendulum through ROS: published numbers against its closed forms."""
import csv
import math
import os
import unittest

import rospy
from sensor_msgs.msg import JointState, MultiDOFJointState

from node_under_test import Node, NodeTest, Process, Recorder, executable, read, run

L1, L2, M1, M2, G = 0.50, 0.75, 0.25, 1.0, 9.81
COLUMNS = ['m10_z', 'm21_z', 'f10_x', 'f10_y', 'f21_x', 'f21_y']
JOINTS = ['joint_1', 'joint_2']
# N m and N: closed forms of order 20 in another order of operations.
EXACT = 1e-12
# Of a column's range, for accelerations estimated from joint states at 1 kHz.
ESTIMATED = 1e-4
MS = 1000000
# Of the estimator, samples: 0.05 s at 1 kHz.
LAG = 50
RATE = math.pi / 6


def motion(t):
    """(5.11) with its derivatives: for each order the two angles."""
    amplitudes = (math.pi / 12, math.pi / 6)
    return [[a * (1 - math.cos(RATE * t)) for a in amplitudes],
            [a * RATE * math.sin(RATE * t) for a in amplitudes],
            [a * RATE ** 2 * math.cos(RATE * t) for a in amplitudes]]


def rod_end(angle, rate, acceleration, length):
    """Acceleration of the end of a rod that hangs from a point at rest: second derivative of
    length (cos, sin), x0 down."""
    c, s = math.cos(angle), math.sin(angle)
    return (length * (-s * acceleration - c * rate ** 2),
            length * (c * acceleration - s * rate ** 2))


def closed_form(t):
    """The six columns: torques (5.7), and the forces of Newton's law for the centres of mass, of
    which f10_x is (5.8)."""
    (p1, p2), (v1, v2), (a1, a2) = motion(t)
    torque_1 = ((M1 / 3 + M2) * L1 ** 2 * a1 + M2 * L2 ** 2 / 3 * (a1 + a2)
                + M2 * L1 * L2 / 2 * (2 * a1 + a2) * math.cos(p2)
                - M2 * L1 * L2 / 2 * v2 * (2 * v1 + v2) * math.sin(p2)
                + (M1 + 2 * M2) / 2 * G * L1 * math.sin(p1) + M2 * G * L2 / 2 * math.sin(p1 + p2))
    torque_2 = (M2 * L2 ** 2 / 3 * (a1 + a2)
                + M2 * L1 * L2 / 2 * (a1 * math.cos(p2) + v1 ** 2 * math.sin(p2))
                + M2 * G * L2 / 2 * math.sin(p1 + p2))
    centre_1 = rod_end(p1, v1, a1, L1 / 2)
    hinge = rod_end(p1, v1, a1, L1)
    centre_2 = rod_end(p1 + p2, v1 + v2, a1 + a2, L2 / 2)
    force_2 = (M2 * (hinge[0] + centre_2[0] - G), M2 * (hinge[1] + centre_2[1]))
    force_1 = (force_2[0] + M1 * (centre_1[0] - G), force_2[1] + M1 * centre_1[1])
    return [torque_1, torque_2, *force_1, *force_2]


def equation_5_8(t):
    """f10_x as printed, by Lagrange."""
    (p1, p2), (v1, v2), (a1, a2) = motion(t)
    return (-(M1 + M2) * G
            - (M1 + 2 * M2) / 2 * L1 * (a1 * math.sin(p1) + v1 ** 2 * math.cos(p1))
            - M2 * L2 / 2 * ((a1 + a2) * math.sin(p1 + p2) + (v1 + v2) ** 2 * math.cos(p1 + p2)))


def reference():
    """Rows of the reference file by their instants in ms; None when it is not there."""
    folder = os.environ.get('VWD_SHARED_DATA') or rospy.get_param('~shared', '')
    path = os.path.join(folder, 'reference', 'composed_pendulum.csv')
    if not os.path.isfile(path):
        return None
    with open(path, encoding='utf-8', newline='') as file:
        rows = csv.DictReader(line for line in file if not line.startswith('#'))
        return {round(float(row['t']) * 1000): [float(row[name]) for name in COLUMNS]
                for row in rows}


class Accuracy(NodeTest):
    """Each motion is played once, and its results are compared with both oracles."""

    @classmethod
    def setUpClass(cls):
        cls.played = {}

    def play(self, message, rate):
        """Results by their ns from the start of the motion, and those ns of the input."""
        if message not in self.played:
            self.played[message] = self.run_nodes(message, rate)
        return self.played[message]

    def run_nodes(self, message, rate):
        node = Node(self, read('..', '..', 'urdf', 'composed_pendulum.urdf'),
                    {'scene': {'gravity': [G, 0, 0]}})
        recorders = [node.record('effort', JointState),
                     node.record('reactions', MultiDOFJointState)]
        inputs = Recorder(node.namespace + '/joint_states', JointState)
        self.addCleanup(inputs.stop)
        node.wait_for_plan('effort', 'reactions')
        states = message == 'joint_state'
        publisher = node.namespace + '/trajectory_publisher'
        rospy.set_param(publisher, {'message': message, 'rate': rate, 'start_delay': 0,
                                    'wait_for_subscribers': 2 if states else 1})
        player = Process(self, [executable('trajectory_publisher_node'),
                                '__ns:=' + node.namespace, '__name:=trajectory_publisher'])
        count = 6 * rate + 1 - (LAG if states else 0)
        efforts, reactions = (recorder.wait(count) for recorder in recorders)
        self.assertEqual(player.wait(), 0, player.output())
        self.assertEqual((len(efforts), len(reactions)), (count, count))
        stamps = [m.header.stamp.to_nsec() for m in (inputs.wait(6 * rate + 1) if states
                                                     else efforts)]
        values = {}
        for effort, reaction in zip(efforts, reactions):
            self.assertEqual(effort.header.stamp, reaction.header.stamp)
            self.assertEqual((effort.name, reaction.joint_names), (JOINTS, JOINTS))
            first, second = (wrench.force for wrench in reaction.wrench)
            for wrench, torque in zip(reaction.wrench, effort.effort):
                # The plane's moment is the active torque; nothing sticks out of the plane.
                self.assertEqual(wrench.torque.z, torque)
                self.assertEqual([wrench.force.z, wrench.torque.x, wrench.torque.y], [0, 0, 0])
            values[effort.header.stamp.to_nsec() - stamps[0]] = [
                *effort.effort, first.x, first.y, second.x, second.y]
        self.assertNoGaps(efforts)
        self.assertNoGaps(reactions)
        return values, [stamp - stamps[0] for stamp in stamps]

    def largest_errors(self, results, expected):
        """Of each column, for maps of rows by the same key."""
        # Not assertEqual: it takes minutes over what differs in lists of thousands.
        self.assertTrue(list(results) == list(expected), 'results at other instants')
        errors = [0.0] * len(COLUMNS)
        for key, row in results.items():
            for i, value in enumerate(row):
                self.assertTrue(math.isfinite(value))
                errors[i] = max(errors[i], abs(value - expected[key][i]))
        return errors

    def check(self, title, errors, limits, unit=''):
        print('%s:\n  largest errors%s %s' % (title, unit, ', '.join(
            '%s %.2g' % column for column in zip(COLUMNS, errors))))
        for name, error, limit in zip(COLUMNS, errors, limits):
            self.assertLessEqual(error, limit, '%s: %s' % (title, name))

    def ranges(self):
        rows = [closed_form(ms / 1000) for ms in range(0, 6001)]
        return [max(column) - min(column) for column in zip(*rows)]

    def test_closed_form_has_5_8(self):
        for ms in range(0, 6001, 50):
            self.assertClose([closed_form(ms / 1000)[2]], [equation_5_8(ms / 1000)], EXACT, '(5.8)')

    def test_trajectory_against_closed_form(self):
        values, stamps = self.play('joint_trajectory', 20)
        self.assertTrue(stamps == [50 * MS * i for i in range(121)], 'other points')
        errors = self.largest_errors(values, {ns: closed_form(ns / 1e9) for ns in stamps})
        self.check('JointTrajectory, 121 points, against the closed forms', errors, [EXACT] * 6)

    def test_trajectory_against_reference(self):
        rows = self.reference()
        values, _ = self.play('joint_trajectory', 20)
        errors = self.largest_errors({round(ns / MS): row for ns, row in values.items()}, rows)
        self.check('JointTrajectory, 121 points, against the reference', errors, [EXACT] * 6)

    def estimated(self):
        values, stamps = self.play('joint_state', 1000)
        self.assertTrue(stamps == [MS * i for i in range(6001)], 'other joint states')
        # Instants of the input from the first one on, the newest ones not yet: the lag.
        self.assertTrue(list(values) == stamps[:-LAG], 'results at other instants')
        print('lag: %g ms' % ((stamps[-1] - max(values)) / MS))
        return values

    def test_joint_states_against_closed_form(self):
        values = self.estimated()
        errors = self.largest_errors(values, {ns: closed_form(ns / 1e9) for ns in values})
        shares = [error / extent for error, extent in zip(errors, self.ranges())]
        self.check('JointState at 1 kHz, %d results, against the closed forms' % len(values),
                   shares, [ESTIMATED] * 6, ', shares of the range:')

    def test_joint_states_against_reference(self):
        rows = self.reference()
        values = {round(ns / MS): row for ns, row in self.estimated().items()}
        # The lag ends at the last instant.
        inner = {ms: row for ms, row in rows.items() if ms in values}
        self.assertEqual(len(inner), 120)
        errors = self.largest_errors({ms: values[ms] for ms in inner}, inner)
        shares = [error / (max(column) - min(column))
                  for error, column in zip(errors, zip(*rows.values()))]
        self.check('JointState at 1 kHz, 120 instants, against the reference', shares,
                   [ESTIMATED] * 6, ', shares of the range:')

    def reference(self):
        rows = reference()
        if rows is None:
            raise unittest.SkipTest('the reference results are not there (VWD_SHARED_DATA '
                                    'or ~shared names their folder)')
        self.assertEqual(list(rows), list(range(0, 6001, 50)))
        return rows


if __name__ == '__main__':
    run(Accuracy)
