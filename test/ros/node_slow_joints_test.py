#!/usr/bin/python3
"""A gripper that reports seldom or never beside an arm at 500 Hz."""
from diagnostic_msgs.msg import DiagnosticStatus

from encoder_streams import LAG, MS, STEP, Encoders, StreamTest, Swings
from node_under_test import EPOCH, joint_state, run

ARM_JOINTS = ['shoulder', 'elbow']
COUNT = 2000  # of the arm: 4 s
STAMPS = [EPOCH + STEP * i for i in range(COUNT)]
# The gripper is 'slide', which the fingers mimic.
GRIP = 0.02
STILL = Swings(shoulder=(0.3, 0.6, 0.7), elbow=(-0.5, 0.9, 0.5), slide=(GRIP, 0, 0))
MOVING = Swings(shoulder=(0.3, 0.6, 0.7), elbow=(-0.5, 0.9, 0.5), slide=(0.05, 0.04, 0.3))
SLOWLY = Swings(shoulder=(0.3, 0.6, 0.7), elbow=(-0.5, 0.9, 0.5), slide=(0.05, 0.1, 0.05))
# Of the rms effort: what encoders at 500 Hz allow within 50 ms, with a margin of three.
ACCURACY = 0.01


class SlowJoints(StreamTest):
    def publish_arm(self, motion, gripper=lambda i: None):
        """4 s of the arm, and of what the gripper says after some of its samples."""
        encoders = Encoders(motion)
        count = 0
        for i, ns in enumerate(STAMPS):
            q, _ = encoders(ns)
            self.publish(ns, {name: q[name] for name in ARM_JOINTS})
            grip = gripper(i)
            if grip is not None:
                self.publish(ns + 300000, {'slide': grip})
                count += 1
        return COUNT + count

    def expect_arm(self, motion, first=1):
        """A result for each sample of the arm from the gripper's first one on, all of them right."""
        messages = self.expect_stamps(
            [ns for ns in STAMPS[first:] if STAMPS[-1] - ns >= LAG])
        self.assertLess(max(self.effort_errors(messages, motion)), ACCURACY)
        return messages

    def test_at_1_hz(self):
        self.start()
        count = self.publish_arm(STILL, lambda i: GRIP if i % 500 == 0 else None)
        messages = self.expect_arm(STILL)
        # Held all the time: where it is between its samples nobody knows.
        for message in messages:
            self.assertEqual((message.position[2], message.velocity[2]), (GRIP, 0))
        values = self.values_after(count)
        self.assertEqual(values['samples with a joint held'], str(len(messages)))
        self.assertRegex(values['joints held at their last position'], r'^slide \([01]?\.?\d+ s\)$')
        self.assertEqual((values['dropped'], values['restarts'], values['gaps']), ('0', '0', '3'))
        self.assertEqual(values['joints waited for'], 'none')
        # Once a minute at the most, not with each of its samples.
        self.assertEqual(len([line for line in self.node.lines('INFO')
                              if "'slide' had a gap of 1 s" in line]), 1)
        self.assertEqual(self.node.lines('WARN'), [])
        self.assertEqual(self.node.statuses()[-1].level, DiagnosticStatus.OK)

    def test_that_stops(self):
        self.start()
        count = self.publish_arm(MOVING, lambda i: None if i >= 1000 or i % 5 else
                                 MOVING(STAMPS[i] + 300000)[0]['slide'])
        last = STAMPS[995] + 300000
        messages = self.expect_stamps([ns for ns in STAMPS[1:] if STAMPS[-1] - ns >= LAG])
        moving = [m for m in messages if m.header.stamp.to_nsec() < last]
        self.assertLess(max(self.effort_errors(moving, MOVING, EPOCH + 500 * MS)), ACCURACY)
        # Later than ~hold_after = 0.25 s after its last sample, and not before.
        held = [m for m in messages if m.header.stamp.to_nsec() > last + 250 * MS]
        for message in held:
            self.assertEqual((message.position[2], message.velocity[2]),
                             (MOVING(last)[0]['slide'], 0))
        values = self.values_after(count)
        self.assertGreaterEqual(int(values['samples with a joint held']), len(held))
        self.assertLess(int(values['samples with a joint held']), len(held) + 20)
        values = self.node.diagnostics(
            lambda v: v['joints held at their last position'] == 'slide (2 s)', 'the joint held')
        self.assertEqual((values['dropped'], values['restarts'], values['gaps']), ('0', '0', '0'))

    def test_at_10_hz(self):
        self.start()
        count = self.publish_arm(
            MOVING, lambda i: MOVING(STAMPS[i] + 300000)[0]['slide'] if i % 50 == 0 else None)
        messages = self.expect_arm(MOVING)
        # It moves on between its samples, by its own fit.
        for message in messages:
            ns = message.header.stamp.to_nsec()
            if ns < EPOCH + 1000 * MS:
                continue
            self.assertClose([message.position[2]], [MOVING(ns)[0]['slide']], 2e-4, 'slide')
            self.assertClose([message.velocity[2]], [MOVING(ns)[1]['slide']], 1e-2, 'its velocity')
        values = self.values_after(count)
        # Only before it has come four times.
        self.assertLess(int(values['samples with a joint held']), 200)
        self.assertEqual(values['joints held at their last position'], 'none')
        self.assertEqual((values['dropped'], values['restarts'], values['gaps']), ('0', '0', '0'))
        self.assertEqual(self.node.lines('WARN'), [])

    def test_at_2_hz_with_more_patience(self):
        self.start({'hold_after': 0.8, 'estimator': {'max_gap': 0.8}})
        count = self.publish_arm(
            SLOWLY, lambda i: SLOWLY(STAMPS[i] + 300000)[0]['slide'] if i % 250 == 0 else None)
        messages = self.expect_stamps([ns for ns in STAMPS[1:] if STAMPS[-1] - ns >= LAG])
        # Held until it has come four times, in 1.5 s; then it moves on between its samples.
        for message in messages:
            ns = message.header.stamp.to_nsec()
            if ns > EPOCH + 2500 * MS:
                self.assertClose([message.position[2]], [SLOWLY(ns)[0]['slide']], 2e-3, 'slide')
                self.assertNotEqual(message.velocity[2], 0)
        values = self.values_after(count)
        self.assertLess(int(values['samples with a joint held']), 800)
        self.assertEqual(values['joints held at their last position'], 'none')
        self.assertEqual((values['dropped'], values['restarts'], values['gaps']), ('0', '0', '0'))

    def test_that_never_comes_and_rests(self):
        self.start({'rest': [{'name': 'slide', 'position': GRIP}]})
        self.publish_arm(STILL)
        messages = self.expect_arm(STILL, first=0)
        for message in messages:
            self.assertEqual((message.position[2], message.velocity[2]), (GRIP, 0))
        values = self.values_after(COUNT)
        self.assertEqual(values['joints held at their last position'], 'slide')
        self.assertEqual(values['joints waited for'], 'none')
        self.assertEqual(self.node.statuses()[-1].level, DiagnosticStatus.OK)
        # Once it comes after all, it rests no longer.
        for i in range(100):
            ns = STAMPS[-1] + STEP * (i + 1)
            self.states.publish(joint_state(ns, dict(STILL(ns)[0], slide=0.1)))
        messages = self.efforts.wait(len(messages) + 100)
        self.assertClose([messages[-1].position[2]], [0.1], 1e-9, 'slide')

    def test_that_never_comes_is_named(self):
        self.start()
        self.publish_arm(STILL)
        values = self.values_after(COUNT)
        self.assertEqual(values['joints waited for'], 'slide')
        self.assertIn('waiting for joints: slide', self.node.statuses()[-1].message)
        self.node.wait_for_line(
            'WARN', 'joints slide have not been received in 5 s; nothing is published')
        self.assertEqual(self.efforts.messages(), [])
        self.assertEqual(len(self.node.lines('WARN')), 1)


if __name__ == '__main__':
    run(SlowJoints)
