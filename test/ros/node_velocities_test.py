#!/usr/bin/python3
"""Velocities that contradict the positions, or are not there, cost nothing and are named."""
import math

from diagnostic_msgs.msg import DiagnosticStatus
import numpy as np

from encoder_streams import LATEST, MOTION, STEP, Encoders, StreamTest
from node_under_test import EPOCH, run

COUNT = 2000
STAMPS = [EPOCH + STEP * i for i in range(COUNT)]
# Errors over those of the same positions without velocities.
AS_POSITIONS_ALONE = 1.2
# Velocities in the wrong: of the shoulder, the elbow and the slide, from the right ones.
WRONG = {
    'zero, deg/s, 20 % too large': {
        'shoulder': (lambda v: 0.0, 'stay at zero while its position moves'),
        'elbow': (math.degrees, 'are 57 times the slope of its positions: degrees per second?'),
        'slide': (lambda v: 1.2 * v, 'are 1.2 times the slope of its positions')},
    'another sign, and right ones': {
        'shoulder': (lambda v: -v, 'are -1 times the slope of its positions'),
        'elbow': (lambda v: v, None), 'slide': (lambda v: v, None)},
}


class Velocities(StreamTest):
    def send(self, velocity, parameters=None):
        """Sends velocities made by velocity(name, right one), or none; relative errors of results."""
        self.start(parameters)
        encoders = Encoders()
        for ns in STAMPS:
            q, qd = encoders(ns)
            made = velocity and {name: velocity(name, value) for name, value in qd.items()}
            self.publish(ns, q, made)
        return self.effort_errors(self.expect_stamps(STAMPS[:-LATEST]))

    def test_wrong_ones_are_not_used_and_named(self):
        alone = self.send(None)
        self.assertEqual(self.node.lines('WARN'), [])
        for kind, wrong in WRONG.items():
            errors = self.send(lambda name, value, wrong=wrong: wrong[name][0](value))
            self.assertLess(max(errors / alone), AS_POSITIONS_ALONE, kind)
            expected = ["velocities of '%s' are not used: they %s" % (name, text)
                        for name, (_, text) in wrong.items() if text]
            self.assertEqual(self.node.wait_for_status(*expected).level, DiagnosticStatus.WARN)
            for text in expected:
                self.node.wait_for_line('WARN', text)
            # Once each, not once a second.
            self.assertEqual(sorted(self.node.lines('WARN')), sorted(expected))
            values = self.values_after(COUNT)
            for name, (_, text) in wrong.items():
                used = 'velocity noise' in values['samples of ' + name]
                self.assertEqual(used, text is None, values['samples of ' + name])
            self.assertEqual(values['joint states with velocities that are not finite'], '0')

    def test_that_are_not_finite(self):
        alone = self.send(None)
        errors = self.send(lambda name, value: {'shoulder': math.nan, 'elbow': math.inf}.get(
            name, value))
        self.assertLess(max(errors / alone), AS_POSITIONS_ALONE)
        values = self.values_after(COUNT)
        self.assertEqual(values['joint states with velocities that are not finite'], str(COUNT))
        self.assertEqual(values['dropped'], '0')
        # Once, not once a second.
        self.assertEqual(self.node.lines('WARN'), [
            self.node.namespace + "/joint_states: the velocity of 'shoulder' is nan, that of "
            "'elbow' is inf; velocities that are not finite are not used"])
        self.assertNotIn('velocity noise', values['samples of shoulder'])
        self.assertIn('velocity noise', values['samples of slide'])

    def test_that_nobody_wants(self):
        alone = self.send(None)
        errors = self.send(lambda name, value: math.nan, {'estimator': {'use_velocity': False}})
        np.testing.assert_array_equal(errors, alone)

    def test_right_ones_help(self):
        alone = self.send(None)
        errors = self.send(lambda name, value: value)
        self.assertLess(max(errors / alone), 1)
        self.assertEqual(self.node.lines('WARN'), [])
        values = self.values_after(COUNT)
        for name in MOTION(EPOCH)[0]:
            self.assertRegex(values['samples of ' + name],
                             r'^500 Hz, position noise \S+ (rad|m), velocity noise \S+ (rad|m)/s, '
                             r'.*bandwidth \S+ Hz$')


if __name__ == '__main__':
    run(Velocities)
