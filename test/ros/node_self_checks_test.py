#!/usr/bin/python3
"""The node's checks of its own results: off, quiet, and loud on /diagnostics."""
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory

from node_under_test import (EPOCH, Node, NodeTest, Polynomials, joint_state, read, ros_time, run,
                             trajectory_point)

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
# A few roundings to a link, relative to the sums of magnitudes.
SOUND = 1e-13
MS = 1000000
LAG = 5  # samples: ~estimator/lag of 0.05 s
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1, 0.7), elbow=(1.0, 0.9, -0.6, 0.3),
                     slide=(0.05, 0.2, -0.4, -0.5))
DIFFERENCE = 'cross-check, largest difference (relative)'
CERTIFICATES = ['certificate: %s (largest, relative)' % kind
                for kind in ('power', 'ground force', 'ground moment')]
CHECKS = {'cross_check_rate': 1000, 'certificates': True}
# Below any rounding error that there is.
ABSURD = {'residual_warn': 1e-30, 'residual_error': 1e-30}


class SelfChecks(NodeTest):
    def start(self, parameters, *topics):
        kinds = {'effort': JointState, 'reactions': MultiDOFJointState,
                 'reaction/elbow': WrenchStamped, 'joint_trajectory': JointTrajectory}
        self.node = Node(self, ARM, parameters)
        self.states = self.node.feed('joint_states', JointState)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.recorders = {topic: self.node.record(topic, kinds[topic]) for topic in topics}
        self.plan = self.node.wait_for_plan(*topics)

    def move(self, count=40, start=0):
        """Joint states; returns the stamps of the results if these are all there are."""
        stamps = [EPOCH + 10 * MS * (start + i) for i in range(count)]
        for ns in stamps:
            q, qd, _ = MOTION(ns)
            self.states.publish(joint_state(ns, q, qd))
        return stamps[:-LAG]

    def play(self, count=150):
        trajectory = JointTrajectory(joint_names=COORDINATES)
        trajectory.header.stamp = ros_time(EPOCH)
        trajectory.points = [trajectory_point(MS * i, COORDINATES, MOTION(EPOCH + MS * i))
                             for i in range(count)]
        self.trajectories.publish(trajectory)

    def wait_for_status(self, condition, what):
        """The next report that meets the condition on its status and values."""
        found = []

        def meets(values):
            status = self.node.statuses()[-1]
            # Another report may have come meanwhile.
            if {entry.key: entry.value for entry in status.values} == values and \
                    condition(status, values):
                found.append(status)
            return found
        return self.node.diagnostics(meets, what), found[0]

    def expect_sound(self, *keys):
        """Reports have these values, small and none of them alarming."""
        values = self.node.diagnostics(lambda values: all(key in values for key in keys),
                                       str(keys))
        for key in keys:
            self.assertLessEqual(float(values[key]), SOUND, key)
        for status in self.node.statuses():
            self.assertEqual(status.level, DiagnosticStatus.OK, status)
        return values

    def test_off_by_default(self):
        self.start({}, 'effort')
        stamps = self.move()
        self.assertStamps(self.recorders['effort'].wait(len(stamps)), stamps)
        values = self.node.wait_for_count('samples computed', len(stamps))
        self.assertEqual((values['cross-check'], values['certificates']), ('off', 'off'))
        self.assertEqual([key for key in values if key.startswith(('cross-check', 'certificate'))],
                         ['cross-check', 'certificates'])
        self.assertEqual(values['computed'], 'efforts')

    def test_joint_states_that_are_sound(self):
        self.start(CHECKS, 'effort', 'reactions', 'reaction/elbow')
        self.assertEqual(self.plan['cross-check'], 'up to 1000 a second')
        self.assertEqual(self.plan['certificates'], 'on')
        # Nothing has been checked, so there is nothing to show.
        self.assertEqual(self.plan['cross-checks done'], '0')
        self.assertNotIn(DIFFERENCE, self.plan)
        stamps = self.move()
        values = self.expect_sound(DIFFERENCE, *CERTIFICATES)
        self.assertGreater(float(values[DIFFERENCE]), 0)
        self.assertRegex(values['cross-check, where'], '^(effort of|force at|moment at) ')
        self.assertGreaterEqual(int(values['cross-checks done']), 1)
        self.assertStamps(self.recorders['effort'].wait(len(stamps)), stamps)

    def test_trajectories_that_are_sound(self):
        for parameters in ({}, {'trajectory_rate': 1000}):
            self.start({**CHECKS, **parameters}, 'effort', 'reactions')
            self.play()
            self.expect_sound(DIFFERENCE, *CERTIFICATES)
            self.assertEqual(len(self.recorders['effort'].wait(150)), 150)

    def test_checks_follow_the_subscribers(self):
        self.start(CHECKS, 'reaction/elbow')
        # Certificates need the efforts and ground's reaction; nothing of these is published.
        self.assertIn('efforts', self.plan['computed'])
        self.assertIn('2 reactions in child axes', self.plan['computed'])
        stamps = self.move(20)
        self.assertStamps(self.recorders['reaction/elbow'].wait(len(stamps)), stamps)
        before = self.node.wait_for_count('cross-checks done', 1)
        self.recorders['effort'] = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort', 'reaction/elbow')
        self.move(20, start=20)
        self.node.wait_for_count('cross-checks done', int(before['cross-checks done']) + 1)
        self.expect_sound(DIFFERENCE, *CERTIFICATES)
        for recorder in self.recorders.values():
            recorder.stop()
        plan = self.node.wait_for_plan()
        self.assertEqual(plan['computed'], 'nothing')
        self.assertIn(DIFFERENCE, plan)

    def test_errors_name_the_culprit_and_stop_nothing(self):
        self.start({**CHECKS, **ABSURD}, 'effort', 'reactions')
        stamps = self.move(30)
        values, status = self.wait_for_status(
            lambda status, _: 'cross-check: ' in status.message and
            'certificate: ' in status.message, 'both checks')
        self.assertEqual(status.level, DiagnosticStatus.ERROR)
        self.assertIn("%s differs by " % values['cross-check, where'], status.message)
        self.assertIn("of its magnitude from Lagrange's equations", status.message)
        self.assertRegex(status.message, 'certificate: (power|ground)')
        self.assertStamps(self.recorders['effort'].wait(len(stamps)), stamps)
        # Goes on; findings hold while there are no others.
        self.move(30, start=30)
        stamps = [EPOCH + 10 * MS * i for i in range(60)][:-LAG]
        for topic in ('effort', 'reactions'):
            self.assertStamps(self.recorders[topic].wait(len(stamps)), stamps)
        self.node.diagnostics()
        self.node.diagnostics()
        self.assertEqual(self.node.statuses()[-1].level, DiagnosticStatus.ERROR)
        self.assertFalse(self.node.ended())

    def test_warnings_before_errors(self):
        self.start({**CHECKS, 'residual_warn': 1e-30, 'residual_error': 1e-7}, 'effort')
        self.move()
        _, status = self.wait_for_status(
            lambda status, _: 'cross-check: ' in status.message, 'the cross-check')
        self.assertEqual(status.level, DiagnosticStatus.WARN)


if __name__ == '__main__':
    run(SelfChecks)
