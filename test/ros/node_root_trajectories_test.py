#!/usr/bin/python3
"""A root that moves by trajectories: exact at their points, between them, what is bad or stale."""
import math

from carried_arm import ROOT, CarriedArm
from node_under_test import EPOCH, joint_state, run, wait_until
from root_messages import root_trajectory
from root_node import MS, RootTest

# Times that are no multiples of each other, ns.
UNEVEN = [0, 130 * MS + 1, 250 * MS + 77, 300 * MS, 710 * MS + 13]
# Rounding of the oracle and of quaternions, with efforts of some hundred N m.
EXACT = 1e-11


class RootTrajectories(RootTest):
    def test_trajectory_is_exact_at_its_points(self):
        self.start('trajectory', parameters={'certificates': True, 'cross_check_rate': 100})
        stamps = [EPOCH + ns for ns in UNEVEN]
        self.send(root_trajectory(self.arm, stamps, EPOCH - 5))
        self.play(stamps)
        messages = self.efforts.wait(len(stamps))
        self.assertStamps(messages, stamps)
        for message in messages:
            self.assertClose(message.effort, self.arm.efforts(message.header.stamp.to_nsec()),
                             EXACT, 'efforts')
        self.assertLess(self.worst(len(stamps))[1], 1e-9)
        values = self.node.diagnostics()
        self.assertEqual(values['samples with the root foreseen'], '0')
        self.assertEqual(values['dropped'], '0')

    def test_trajectory_at_another_rate_than_joint_states(self):
        """The joints at 500 Hz, the root's messages of one point at 50 Hz."""
        self.start('trajectory', CarriedArm(1.5), {'root': {
            'source': 'trajectory', 'inertial_frame': 'world', 'link': 'virtual_joint'}})
        for i in range(100):
            ns = EPOCH + i * 20 * MS
            self.roots.publish(root_trajectory(self.arm, [ns], frame='world',
                                               link='virtual_joint'))
        self.node.wait_for_count('root messages received', 100)
        for i in range(500, 900):
            ns = EPOCH + i * 2 * MS + 333
            self.states.publish(joint_state(ns, *self.arm.joints(ns)[:2]))
        # The lag of 0.05 s is 25 samples.
        self.assertLess(max(self.worst(370)), 0.02)

    def test_trajectory_between_the_points_of_joints(self):
        self.start('trajectory', parameters={'trajectory_sampling': 200})
        self.send(root_trajectory(self.arm, [EPOCH + i * 10 * MS for i in range(101)]))
        self.play([EPOCH + i * 50 * MS for i in range(21)])
        self.assertLess(max(self.worst(201)), 0.02)

    def test_what_is_stale_is_not_computed_with_and_said(self):
        self.start('trajectory')
        stamps = [EPOCH + i * 50 * MS for i in range(20)]
        self.play(stamps[:1])
        values = self.node.wait_for_count('dropped: no root motion', 1)
        self.assertIn(self.topic + ' has not told how the root link moves, at point 1',
                      values['last drop'])
        self.send(root_trajectory(self.arm, stamps[:7]))  # up to 0.3 s
        self.play(stamps)
        # Foreseen for ~root/timeout, 0.1 s: results up to 0.4 s.
        values = self.node.wait_for_count('dropped: no root motion', 12)
        self.assertStamps(self.efforts.wait(9), stamps[:9])
        self.assertEqual(values['dropped: no root motion'], '12')
        self.assertEqual(values['samples with the root foreseen'], '2')
        self.assertIn('tells how the root link moves from stamp', values['last drop'])
        self.assertIn('root/timeout is 0.1 s, at point 20', values['last drop'])
        said = [line for line in self.node.lines('WARN') if 'no root motion' in line]
        self.assertTrue(any('result dropped (no root motion)' in line for line in said), said)
        self.assertLessEqual(len(said), 2)
        later = [ns + 2000 * MS for ns in stamps]
        self.send(root_trajectory(self.arm, later))
        self.play(later)
        self.assertStamps(self.efforts.wait(29)[9:], later)

    def test_bad_trajectories(self):
        self.start('trajectory', parameters={'frame_prefix': 'left/'})
        stamps = [EPOCH, EPOCH + 50 * MS]

        def changed(change, link='left/' + ROOT):
            message = root_trajectory(self.arm, stamps, link=link)
            change(message)
            return message

        def rotation(message):
            return message.points[1].transforms[1].rotation

        cases = [
            (lambda m: setattr(m.header, 'frame_id', 'map'), 'unknown frame',
             "its frame 'map' is not the inertial frame 'odom'"),
            (lambda m: setattr(m, 'joint_names', ['a', ROOT]), 'unknown frame',
             "it does not name the root link 'left/base', but a, base"),
            (lambda m: setattr(m, 'joint_names', ['left/base'] * 2), 'joint twice',
             "it names 'left/base' twice"),
            (lambda m: setattr(m, 'points', []), 'no points', 'it has no points'),
            (lambda m: setattr(m.points[1], 'accelerations', []), 'array length',
             'point 2 has 0 accelerations for 2 names'),
            (lambda m: m.points[1].velocities.pop(), 'array length',
             'point 2 has 1 velocities for 2 names'),
            (lambda m: m.points[0].transforms.pop(), 'array length',
             'point 1 has 1 transforms for 2 names'),
            (lambda m: setattr(m.points[1].time_from_start, 'nsecs', 0), 'times',
             'time_from_start of point 2 is 0 s, not later than the point before'),
            (lambda m: setattr(rotation(m), 'y', math.nan), 'not finite',
             'its point 2 rotation.y is nan'),
            (lambda m: setattr(m.points[1].accelerations[1].angular, 'z', math.inf), 'not finite',
             'its point 2 acceleration.angular.z is inf'),
            (lambda m: setattr(rotation(m), 'w', rotation(m).w + 0.5), 'orientation',
             'its point 2 rotation has the length 1.'),
        ]
        for change, reason, text in cases:
            count = int(self.node.diagnostics()['dropped: ' + reason])
            self.send(changed(change))
            values = self.node.wait_for_count('dropped: ' + reason, count + 1)
            self.assertIn(self.topic + ': ', values['last drop'])
            self.assertIn(text, values['last drop'])
        self.assertEqual(int(self.node.diagnostics()['dropped']), len(cases))

        def stretch(message):
            for name in 'xyzw':
                setattr(rotation(message), name, getattr(rotation(message), name) * 1.0005)
        self.send(changed(stretch), changed(stretch))
        wait_until(lambda: self.node.lines('WARN'), self.node.output)
        self.play(stamps)
        self.worst(2)
        said = [line for line in self.node.lines('WARN') if 'scaled to 1' in line]
        self.assertEqual(len(said), 1, said)
        self.assertIn('the quaternion point 2 rotation has the length 1.0005', said[0])


if __name__ == '__main__':
    run(RootTrajectories)
