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
# The estimator takes the fourth derivative of the motion for noise, so cubics have no error but that
# of rounding: 1e-16 of a position over the squared step, 1e-4 s^2, and a margin of a thousand.
ESTIMATED = 1e-9
MS = 1000000
LAG = 50 * MS  # ~estimator/lag
LATEST = 5  # samples at 100 Hz that are younger than the lag
# Continuous beyond half a turn, so that nothing may wrap it.
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1, 0.7), elbow=(3.0, 1.9, -0.6, 1.3),
                     slide=(0.05, 0.2, -0.4, -0.5))
# For seconds, without turns from sample to sample.
SLOW = Polynomials(shoulder=(0.3, -0.2, 0.03), elbow=(3.0, 0.3, -0.04), slide=(0.05, 0.02))


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
        self.expect_outputs(stamps[:-LATEST])

    def test_partial_messages_give_an_output_at_each_stamp_of_the_first_of_equals(self):
        self.start()
        drives, elbows = [], []
        for i in range(30):
            # Two drivers; one knows no velocities, the other repeats itself at times.
            ns = EPOCH + 10 * MS * i
            for drive in [ns, ns + MS] if i % 4 == 3 else [ns]:
                self.publish(drive, ['slide', 'shoulder'])
                drives.append(drive)
            self.publish(ns + 3 * MS, ['elbow'], velocities=False)
            elbows.append(ns + 3 * MS)
        # From when all have come to LAG behind the newest.
        self.expect_outputs([ns for ns in drives if elbows[0] <= ns <= drives[-1] - LAG])

    def test_a_joint_that_comes_more_often_sets_the_instants(self):
        self.start()
        starts = [EPOCH + 10 * MS * i for i in range(25)]
        fast = []
        for ns in starts:
            for step in range(5):
                self.publish(ns + 2 * MS * step, ['shoulder'])
                fast.append(ns + 2 * MS * step)
            self.publish(ns + 9 * MS, ['elbow', 'slide'])
        first = starts[0] + 9 * MS
        self.expect_outputs([ns for ns in fast if first <= ns <= fast[-1] - LAG])

    def test_a_faster_joint_takes_over_from_the_first_one(self):
        self.start()
        slow = [EPOCH + 10 * MS * i for i in range(40)]
        for ns in slow:
            self.publish(ns, ['elbow', 'slide'])
            for step in range(5):
                self.publish(ns + MS + 2 * MS * step, ['shoulder'])
        fast = [ns + MS + 2 * MS * step for ns in slow for step in range(5)]
        # Until its rate is known, the instants are those of the one that came first.
        messages = self.efforts.wait(20)
        taken_over = next(message.header.stamp.to_nsec() for message in messages
                          if message.header.stamp.to_nsec() in set(fast))
        self.assertLess(taken_over, slow[10])
        self.expect_outputs([ns for ns in slow if fast[0] <= ns < taken_over] +
                            [ns for ns in fast if taken_over <= ns <= fast[-1] - LAG])

    def test_drivers_may_share_stamps(self):
        self.start()
        stamps = [EPOCH + 10 * MS * i for i in range(20)]
        for ns in stamps:
            self.publish(ns, ['elbow'])
            self.publish(ns, ['slide'])
            self.publish(ns, ['shoulder'])
        self.expect_outputs(stamps[:-LATEST])

    def test_back_in_time_and_gaps_start_anew(self):
        self.start()
        # Another motion after the restart, and after the gap, so that a fit to both would show.
        other = Polynomials(EPOCH, shoulder=(-0.3, 1), elbow=(0.2, -2), slide=(0.1, 0.1))
        third_one = Polynomials(EPOCH, shoulder=(0.5, -1), elbow=(-0.4, 1), slide=(0, -0.1))
        first = [EPOCH + 10 * MS * i for i in range(40)]
        # Further back than max_gap.
        second = [first[7] + 10 * MS * i + 1 for i in range(15)]
        third = [second[-1] + 251 * MS + 10 * MS * i for i in range(12)]
        # A step of exactly max_gap is none.
        fourth = [third[-1] + 250 * MS + 10 * MS * i for i in range(10)]
        motions = {ns: MOTION(ns) for ns in first}
        motions.update((ns, other(ns)) for ns in second)
        motions.update((ns, third_one(ns)) for ns in third + fourth)
        for ns in first:
            self.publish(ns)
        for ns in second:
            self.publish(ns, motion=other)
        for ns in third + fourth:
            self.publish(ns, motion=third_one)
        # What was within the lag is lost where time goes back, and is not where there is a gap.
        stamps = first[:-LATEST] + (second + third + fourth)[:-LATEST]
        self.expect_outputs(stamps, motions.get)
        values = self.node.wait_for_count('gaps', 1)
        self.assertEqual((values['restarts'], values['gaps'], values['dropped']), ('1', '1', '0'))
        self.assertEqual(len([line for line in self.node.lines('INFO')
                              if 'time went back to stamp' in line]), 1)
        self.assertEqual(len([line for line in self.node.lines('INFO') if
                              "'shoulder' had a gap of 0.251 s, longer than %s/estimator/max_gap = "
                              '0.25 s' % self.node.name in line]), 1)
        self.assertEqual(self.node.lines('WARN'), [])

    def test_positions_before_encoders_are_read_are_no_part_of_the_motion(self):
        self.start()
        stamps = [EPOCH + 10 * MS * i for i in range(80)]
        zeros = Polynomials(shoulder=(0,), elbow=(0,), slide=(0,))
        for i, ns in enumerate(stamps):
            self.publish(ns, velocities=False, motion=zeros if i < 3 else SLOW)
        messages = self.efforts.wait(len(stamps) - LATEST)
        self.assertStamps(messages, stamps[:-LATEST])
        for message in messages[3:]:
            ns = message.header.stamp.to_nsec()
            self.assertEffort(message, self.bodies, SLOW(ns), ESTIMATED)
        values = self.node.diagnostics(lambda values: 'samples of elbow' in values)
        for joint in COORDINATES:
            self.assertIn(', jumps 1', values['samples of ' + joint])
            self.assertIn("position of '%s' jumps as no motion does: nothing is assumed of the "
                          'motion across it' % joint, self.node.lines('WARN'))

    def test_positions_in_another_unit_are_asked_about_once(self):
        self.start()
        for i in range(30):
            ns = EPOCH + 10 * MS * i
            q = dict(SLOW(ns)[0], slide=50, elbow=200)  # the elbow may turn on and on
            self.states.publish(joint_state(ns, q))
        self.efforts.wait(30 - LATEST)
        self.assertEqual(self.node.lines('WARN'), [
            self.node.namespace + "/joint_states: positions of 'slide' reach 50, its limit is 0.3 m: are "
            'they millimetres?'])

    def test_joint_states_at_10_hz_are_close_enough(self):
        self.start()
        stamps = [EPOCH + 100 * MS * i for i in range(15)]
        for ns in stamps:
            self.publish(ns)
        # The newest one is younger than the lag.
        self.expect_outputs(stamps[:-1])

    def test_joint_states_too_far_apart_are_warned_of(self):
        self.start()
        for i in range(15):
            self.publish(EPOCH + 400 * MS * i, motion=SLOW)
        self.node.wait_for_count('gaps', 14)
        self.node.wait_for_line('INFO', "'shoulder' had a gap of 0.4 s, longer than "
                                '%s/estimator/max_gap = 0.25 s' % self.node.name)
        status = self.node.wait_for_status('no result from joint states',
                                           self.node.name + '/estimator/max_gap')
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertEqual(self.efforts.messages(), [])
        # After enough samples without one, a gap is news and no more.
        last = EPOCH + 400 * MS * 14
        stamps = [last + 10 * MS * i for i in range(20)]
        for ns in stamps[1:] + [stamps[-1] + 300 * MS]:
            self.publish(ns, motion=SLOW)
        values = self.node.wait_for_count('gaps', 15)
        self.assertEqual((values['gaps'], values['restarts'], values['dropped']), ('15', '0', '0'))
        seen = len(self.node.statuses())
        self.node.diagnostics()
        self.assertFalse([status for status in self.node.statuses()[seen:]
                          if status.level != DiagnosticStatus.OK])
        # Within the stretch, up to the lag before its end; of those before nothing is known but
        # where they were.
        def within():
            return [m for m in self.efforts.messages() if m.header.stamp.to_nsec() >= last]
        wait_until(lambda: len(within()) >= len(stamps) - LATEST, lambda: '%s' % within())
        messages = within()
        apart = len(self.efforts.messages()) - len(messages)
        self.assertEqual(values['samples with a joint held'], str(apart))
        self.assertStamps(messages, stamps[:-LATEST])
        for message in messages:
            self.assertEffort(message, self.bodies, SLOW(message.header.stamp.to_nsec()),
                              ESTIMATED)

    def test_joint_states_as_they_come_when_no_acceleration_is_wanted(self):
        self.start({'estimator': {'acceleration': 'zero'}})
        # Farther apart than max_gap, which does not matter to what is not estimated.
        stamps = [EPOCH + 300 * MS * i for i in range(5)]
        for ns in stamps:
            self.publish(ns)

        def motion(ns):
            q, qd, qdd = MOTION(ns)
            return q, qd, {name: 0.0 for name in qdd}
        self.expect_outputs(stamps, motion, EXACT)


if __name__ == '__main__':
    run(JointStates)
