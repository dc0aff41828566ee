#!/usr/bin/python3
"""Joint states in, efforts and reactions out: names, partial messages, restarts."""
import itertools
import math

from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import JointState, MultiDOFJointState

from node_under_test import EPOCH, Node, NodeTest, Polynomials, joint_state, read, run, wait_until
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
REACTIONS = ['shoulder', 'elbow', 'slide', '2nd.finger', 'left-finger']
# The oracle's rounding.
EXACT = 1e-12
# The default estimator's polynomial is of order 3, so cubics have no error but rounding: 1e-16 of a
# position over the squared step, 1e-4 s^2, and a margin of a thousand.
ESTIMATED = 1e-9
MS = 1000000
WINDOW = 9
LAG = 4
# Continuous beyond half a turn, so that nothing may wrap it.
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1, 0.7), elbow=(3.0, 1.9, -0.6, 1.3),
                     slide=(0.05, 0.2, -0.4, -0.5))


class JointStates(NodeTest):
    def start(self, parameters=None):
        self.bodies = RigidBodies(ARM)
        self.node = Node(self, ARM, parameters)
        self.states = self.node.feed('joint_states', JointState)
        self.efforts = self.node.record('effort', JointState)
        self.reactions = self.node.record('reactions', MultiDOFJointState)
        self.node.wait_for_plan('effort', 'reactions')

    def expect_outputs(self, stamps, motion=MOTION, tolerance=ESTIMATED):
        """Exactly these outputs, all of them right."""
        for recorder in (self.efforts, self.reactions):
            messages = recorder.wait(len(stamps))
            self.assertStamps(messages, stamps)
            self.assertNoGaps(messages)
        for message in self.efforts.messages():
            self.assertEqual(message.name, COORDINATES)
            ns = message.header.stamp.to_nsec()
            self.assertEffort(message, self.bodies, motion(ns), tolerance)
        for message in self.reactions.messages():
            self.assertEqual(message.joint_names, REACTIONS)
            self.assertEqual(message.twist, [])
            ns = message.header.stamp.to_nsec()
            self.assertReactions(message, self.bodies, motion(ns), tolerance)

    def publish(self, ns, names=COORDINATES, velocities=True, motion=MOTION):
        q, qd, _ = motion(ns)
        message = joint_state(ns, {name: q[name] for name in names}, qd)
        if not velocities:
            message.velocity = []
        self.states.publish(message)

    def test_names_in_any_order_beside_extra_joints(self):
        self.start()
        stamps = [EPOCH + 10 * MS * i for i in range(40)]
        orders = itertools.cycle(itertools.permutations(COORDINATES))
        for i, (ns, order) in enumerate(zip(stamps, orders)):
            q, qd, _ = MOTION(ns)
            message = joint_state(ns, {name: q[name] for name in order}, qd)
            if i % 3 > 0:
                # What the robot lacks may hold anything, wherever it stands; the order of names
                # then is one of more than the node remembers.
                message.name.insert(i % 4, 'lamp')
                message.position.insert(i % 4, math.nan)
                message.velocity.insert(i % 4, math.inf)
            self.states.publish(message)
        self.expect_outputs(stamps[LAG:-LAG])

    def test_partial_messages_give_an_output_each_time_all_are_refreshed(self):
        self.start()
        drives, elbows, expected = [], [], []
        for i in range(30):
            # Two drivers; one knows no velocities, the other repeats itself at times.
            ns = EPOCH + 10 * MS * i
            for drive in [ns, ns + MS] if i % 4 == 3 else [ns]:
                self.publish(drive, ['slide', 'shoulder'])
                drives.append(drive)
            self.publish(ns + 3 * MS, ['elbow'], velocities=False)
            elbows.append(ns + 3 * MS)
            if len(elbows) >= WINDOW:
                # All at one instant: the earliest of the samples LAG behind the newest.
                expected.append(min(drives[-1 - LAG], elbows[-1 - LAG]))
        self.assertEqual(len(expected), 30 - WINDOW + 1)
        self.expect_outputs(expected)

    def test_a_joint_that_comes_more_often_is_fitted_at_the_common_instant(self):
        self.start()
        starts = [EPOCH + 10 * MS * i for i in range(25)]
        for ns in starts:
            for step in range(5):
                self.publish(ns + 2 * MS * step, ['shoulder'])
            self.publish(ns + 9 * MS, ['elbow', 'slide'])
        self.expect_outputs([ns + 9 * MS for ns in starts[LAG:-LAG]])

    def test_drivers_may_share_stamps(self):
        self.start()
        stamps = [EPOCH + 10 * MS * i for i in range(20)]
        for ns in stamps:
            self.publish(ns, ['elbow'])
            self.publish(ns, ['slide'])
            self.publish(ns, ['shoulder'])
        self.expect_outputs(stamps[LAG:-LAG])

    def test_back_in_time_and_gaps_start_a_new_window(self):
        self.start()
        # Another motion after the first restart, so that a window of both would show.
        other = Polynomials(EPOCH, shoulder=(-0.3, 1), elbow=(0.2, -2), slide=(0.1, 0.1))
        first = [EPOCH + 10 * MS * i for i in range(20)]
        second = [first[7] + 10 * MS * i + 1 for i in range(15)]
        third = [second[-1] + 251 * MS + 10 * MS * i for i in range(12)]
        # A step of exactly max_gap is none.
        fourth = [third[-1] + 250 * MS + 10 * MS * i for i in range(10)]
        for ns in first:
            self.publish(ns)
        for ns in second + third + fourth:
            self.publish(ns, motion=other)
        motions = {ns: MOTION(ns) for ns in first}
        motions.update((ns, other(ns)) for ns in second + third + fourth)
        self.expect_outputs(first[LAG:-LAG] + second[LAG:-LAG] + (third + fourth)[LAG:-LAG],
                            motions.get)
        values = self.node.wait_for_count('restarts', 2)
        self.assertEqual(values['restarts'], '2')
        self.assertEqual(values['dropped'], '0')

    def test_joint_states_at_10_hz_are_close_enough(self):
        self.start()
        stamps = [EPOCH + 100 * MS * i for i in range(15)]
        for ns in stamps:
            self.publish(ns)
        self.expect_outputs(stamps[LAG:-LAG])

    def test_joint_states_that_never_fill_a_window_are_warned_of(self):
        self.start()
        for i in range(15):
            self.publish(EPOCH + 400 * MS * i)
        self.node.wait_for_count('restarts', 14)
        wait_until(lambda: [line for line in self.node.lines('WARN') if 'a gap of 0.4 s is longer '
                            'than ~estimator/max_gap = 0.25 s' in line], 'the warning')
        self.assertTrue([status for status in self.node.statuses()
                         if status.level == DiagnosticStatus.WARN and
                         'no result from joint states' in status.message and
                         '~estimator/max_gap' in status.message])
        # After a full window, a gap is news and no more.
        last = EPOCH + 400 * MS * 14
        stamps = [last + 10 * MS * i for i in range(1, WINDOW)]
        for ns in stamps + [stamps[-1] + 300 * MS]:
            self.publish(ns)
        self.node.wait_for_count('restarts', 15)
        wait_until(lambda: [line for line in self.node.lines('INFO') if 'a gap of 0.3 s' in line],
                   'the line')
        self.assertFalse([line for line in self.node.lines('WARN') if '0.3 s' in line])

    def test_joint_states_as_they_come_when_no_acceleration_is_wanted(self):
        self.start({'estimator': {'acceleration': 'zero'}})
        # Farther apart than max_gap: there is no window that could start anew.
        stamps = [EPOCH + 300 * MS * i for i in range(5)]
        for ns in stamps:
            self.publish(ns)

        def motion(ns):
            q, qd, qdd = MOTION(ns)
            return q, qd, {name: 0.0 for name in qdd}
        self.expect_outputs(stamps, motion, EXACT)


if __name__ == '__main__':
    run(JointStates)
