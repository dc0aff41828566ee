#!/usr/bin/python3
"""Measured efforts beside computed ones, live: ~residual, ~external_effort, thresholds and limits."""
import random

from diagnostic_msgs.msg import DiagnosticStatus
import numpy as np
from sensor_msgs.msg import JointState

from encoder_streams import ARM, COORDINATES, LATEST, MOTION, MS, STEP, Encoders, StreamTest
from node_under_test import EPOCH, Node, joint_state, run, wait_until
from rigid_bodies import RigidBodies

COUNT = 1500
STAMPS = [EPOCH + STEP * i for i in range(COUNT)]
# A push on the elbow, N m, between these messages.
PUSH = 6.0
PUSHED = range(900, 1300)
EFFORT_NOISE = 0.02  # N m, N


class ExternalEfforts(StreamTest):
    def message(self, i, measured=tuple(COORDINATES)):
        """What drivers send at a step, with efforts of some joints."""
        ns = STAMPS[i]
        message = joint_state(ns, *self.encoders(ns))
        for name in message.name:
            effort = self.bodies.effort(name, *MOTION(ns)) + self.random.gauss(0, EFFORT_NOISE)
            if name == 'elbow' and i in PUSHED:
                effort -= PUSH  # what the push does, the motor need not
            message.effort.append(effort if name in measured else float('nan'))
        return message

    def send(self, steps, **options):
        self.encoders, self.random = Encoders(), random.Random(2)
        for i in steps:
            self.states.publish(self.message(i, **options))

    def warnings(self):
        return [status.message for status in self.node.statuses()
                if status.level == DiagnosticStatus.WARN]

    def expect_warning(self, *parts):
        self.assertEqual(self.node.wait_for_status(*parts).level, DiagnosticStatus.WARN)

    def test_residual_is_computed_less_measured_at_the_instants_of_results(self):
        self.start()
        residuals = self.node.record('residual', JointState)
        self.node.wait_for_plan('effort', 'residual')
        self.send(range(COUNT))
        efforts = self.expect_stamps(STAMPS[:-LATEST])
        messages = residuals.wait(len(efforts))
        self.assertStamps(messages, STAMPS[:-LATEST])
        measured = self.measured()
        for i, (message, effort) in enumerate(zip(messages, efforts)):
            self.assertEqual(message.name, effort.name)
            self.assertEqual(message.header.frame_id, effort.header.frame_id)
            self.assertClose(message.effort, np.array(effort.effort) - measured[i], 1e-9, 'residual')
        elbow = COORDINATES.index('elbow')
        pushed = [m.effort[elbow] for m in messages[PUSHED[50]:PUSHED[-50]]]
        quiet = [m.effort[elbow] for m in messages[500:PUSHED[0] - 50]]
        self.assertLess(abs(np.mean(pushed) - PUSH), 0.1)
        self.assertLess(abs(np.mean(quiet)), 0.1)

    def measured(self):
        self.encoders, self.random = Encoders(), random.Random(2)
        return [self.message(i).effort for i in range(COUNT)]

    def test_observer_follows_joint_states_without_the_lag(self):
        self.start({'external_effort': {'gain': 40}})
        observed = self.node.record('external_effort', JointState)
        self.node.wait_for_plan('effort', 'external_effort')
        self.send(range(COUNT))
        self.expect_stamps(STAMPS[:-LATEST])
        messages = observed.wait(COUNT - LATEST)
        stamps = [m.header.stamp.to_nsec() for m in messages]
        self.assertEqual(stamps, STAMPS[LATEST:])
        elbow = COORDINATES.index('elbow')
        values = {ns: m.effort[elbow] for ns, m in zip(stamps, messages)}
        for step, expected in ((PUSHED[0] - 1, 0), (PUSHED[0] + 25, PUSH * (1 - np.exp(-40 * 0.05))),
                               (PUSHED[0] + 150, PUSH), (PUSHED[-1] + 150, 0)):
            around = [values[STAMPS[i]] for i in range(step - 3, step + 4)]
            self.assertLess(abs(np.mean(around) - expected), 0.5, step)

    def test_thresholds_name_the_joint_without_subscribers(self):
        self.start({'external_effort': {'thresholds': [{'name': 'elbow', 'effort': 3.0},
                                                       {'name': 'slide', 'effort': 30.0}],
                                        'hold': 0.1}})
        self.efforts.stop()
        self.node.wait_for_plan()
        self.send(range(PUSHED[0]))
        self.values_after(PUSHED[0])
        self.node.diagnostics(lambda values: values.get('external efforts') == 'none', 'no effort')
        self.send(range(PUSHED[0], PUSHED[0] + 300))
        self.expect_warning("external effort of 'elbow'", 'more than 3')
        self.assertFalse([text for text in self.warnings() if 'slide' in text])

    def test_thresholds_may_be_of_the_observer(self):
        self.start({'external_effort': {'thresholds': [{'name': 'elbow', 'effort': 3.0}],
                                        'by': 'observer'}})
        self.send(range(PUSHED[0] + 200))
        self.expect_warning("external effort of 'elbow'", 'more than 3')

    def test_joints_without_efforts_are_named_once_and_others_work(self):
        self.start()
        residuals = self.node.record('residual', JointState)
        observed = self.node.record('external_effort', JointState)
        self.node.wait_for_plan('effort', 'residual', 'external_effort')
        self.send(range(400), measured=('elbow', 'slide'))
        messages = residuals.wait(400 - LATEST)
        for message in messages + observed.wait(400 - LATEST):
            self.assertEqual(message.name, ['elbow', 'slide'])
            self.assertTrue(np.isfinite(message.effort).all())
        self.node.wait_for_line('WARN', 'measured efforts')
        told = [line for line in self.node.lines('WARN') if 'measured efforts' in line]
        self.assertEqual(len(told), 1, self.node.lines('WARN'))
        self.assertIn("there are no measured efforts of 'shoulder', which", told[0])

    def test_two_drivers_with_equal_stamps_both_have_external_efforts(self):
        self.start()
        residuals = self.node.record('residual', JointState)
        observed = self.node.record('external_effort', JointState)
        self.node.wait_for_plan('effort', 'residual', 'external_effort')
        self.encoders, self.random = Encoders(), random.Random(2)
        for i in range(300):
            whole = self.message(i)
            for places in ((0, 1), (2,)):
                part = JointState(header=whole.header)
                for field in ('name', 'position', 'velocity', 'effort'):
                    setattr(part, field, [getattr(whole, field)[place] for place in places])
                self.states.publish(part)
        for recorder in (residuals, observed):
            for message in recorder.wait(150):
                self.assertEqual(message.name, COORDINATES)

    def test_diagnostics_name_subscribers_of_what_is_always_computed(self):
        self.start({'external_effort': {'thresholds': [{'name': 'elbow', 'effort': 3.0}]}})
        residuals = self.node.record('residual', JointState)
        self.node.wait_for_plan('effort', 'residual')
        residuals.stop()
        self.node.wait_for_plan('effort')

    def test_observer_takes_a_joint_of_rest_that_never_comes(self):
        self.start({'rest': [{'name': 'slide', 'position': 0.05}]})
        observed = self.node.record('external_effort', JointState)
        self.node.wait_for_plan('effort', 'external_effort')
        self.encoders, self.random = Encoders(), random.Random(2)
        for i in range(200):
            message = self.message(i)
            for values in (message.name, message.position, message.velocity, message.effort):
                del values[COORDINATES.index('slide')]
            self.states.publish(message)
        for message in observed.wait(100):
            self.assertEqual(message.name, ['shoulder', 'elbow'])
            self.assertTrue(np.isfinite(message.effort).all())

    def test_a_driver_that_stops_has_no_external_effort_and_others_work(self):
        self.start({'estimator': {'max_gap': 0.1}})
        observed = self.node.record('external_effort', JointState)
        self.node.wait_for_plan('effort', 'external_effort')
        self.encoders, self.random = Encoders(), random.Random(2)
        stop, end = 200, 500
        for i in range(end):
            message = self.message(i)
            if i >= stop:
                for values in (message.name, message.position, message.velocity, message.effort):
                    del values[COORDINATES.index('slide')]
            self.states.publish(message)
        at_end = STAMPS[end - 1]
        wait_until(lambda: any(m.header.stamp.to_nsec() == at_end for m in observed.messages()),
                   'the last message')
        for message in observed.messages():
            ns = message.header.stamp.to_nsec()
            if ns < STAMPS[stop]:
                self.assertEqual(message.name, COORDINATES)
            elif ns > STAMPS[stop] + 100 * MS:
                self.assertEqual(message.name, ['shoulder', 'elbow'])

    def test_observer_names_the_joints_without_velocities(self):
        self.start()
        self.node.record('external_effort', JointState)
        self.node.wait_for_plan('effort', 'external_effort')
        self.encoders, self.random = Encoders(), random.Random(2)
        for i in range(300):
            message = self.message(i)
            message.velocity[COORDINATES.index('elbow')] = float('nan')
            self.states.publish(message)
        self.node.wait_for_line('WARN', "no position or no velocity of 'elbow',")

    def test_efforts_beyond_the_limits_of_the_description(self):
        weak = ARM.replace('effort="100" velocity="5"', 'effort="1.5" velocity="5"')
        self.assertNotEqual(weak, ARM)
        self.bodies = RigidBodies(ARM)
        self.assertGreater(max(abs(self.bodies.effort('shoulder', *MOTION(ns))) for ns in STAMPS), 2)
        self.node = Node(self, weak, {'effort_limit_warn': True})
        self.states = self.node.feed('joint_states', JointState)
        # Without a subscriber.
        self.node.diagnostics(lambda values: values['computed'] == 'efforts', 'the plan')
        self.send(range(COUNT))
        self.expect_warning("effort beyond its limit of 'shoulder'", 'more than 1.5')
        self.assertFalse([text for text in self.warnings() if "'slide'" in text])


if __name__ == '__main__':
    run(ExternalEfforts)
