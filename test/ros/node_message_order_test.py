#!/usr/bin/python3
"""Joint states out of order, of two publishers at once, and of other robots."""
import random

from diagnostic_msgs.msg import DiagnosticStatus
import numpy as np

from encoder_streams import COORDINATES, LATEST, MS, STEP, Encoders, StreamTest
from node_under_test import EPOCH, run

COUNT = 2500
STAMPS = [EPOCH + STEP * i for i in range(COUNT)]
# Of the rms effort: what encoders at 500 Hz allow within 50 ms, with a margin of three.
ACCURACY = 0.01
# With every pair exchanged, until all have been learnt from.
EVERY_PAIR = 0.02
# Errors over those of the same joint states in order, once all have been learnt from.
AS_IN_ORDER = 1.1
ALL_LEARNT = EPOCH + 2500 * MS


def exchanged(share):
    """The indices in an order in which neighbours are exchanged, and how many pairs are."""
    chance = random.Random(3)
    order, pairs, i = list(range(COUNT)), 0, 1  # what is before the first of all is dropped
    while i + 1 < COUNT:
        if chance.random() < share:
            order[i], order[i + 1] = order[i + 1], order[i]
            pairs += 1
            i += 1
        i += 1
    return order, pairs


class MessageOrder(StreamTest):
    def send(self, order):
        """Starts a node, sends it the joint states in this order, and returns the results."""
        self.start()
        encoders = Encoders()
        samples = [encoders(ns)[0] for ns in STAMPS]
        for i in order:
            self.publish(STAMPS[i], samples[i])
        return self.expect_stamps(STAMPS[:-LATEST])

    def test_neighbours_exchanged(self):
        in_order = self.effort_errors(self.send(range(COUNT)), start=ALL_LEARNT)
        for share in (0.05, 0.5, 1):
            order, pairs = exchanged(share)
            messages = self.send(order)
            accuracy = ACCURACY if share < 1 else EVERY_PAIR
            self.assertLess(max(self.effort_errors(messages)), accuracy)
            errors = self.effort_errors(messages, start=ALL_LEARNT)
            self.assertLess(max(errors / in_order), AS_IN_ORDER, 'share %g' % share)
            values = self.values_after(COUNT)
            self.assertEqual(values['joint states put in order'], str(pairs))
            self.assertEqual((values['restarts'], values['dropped'], values['gaps']),
                             ('0', '0', '0'))
            self.assertEqual(self.node.lines('WARN'), [])
            self.assertEqual(self.node.statuses()[-1].level, DiagnosticStatus.OK)

    def test_one_that_is_too_late_is_dropped_alone(self):
        late = 1200
        order = list(range(COUNT))
        order.remove(late)
        order.insert(late + 100, late)
        self.start()
        encoders = Encoders()
        samples = [encoders(ns)[0] for ns in STAMPS]
        for i in order:
            self.publish(STAMPS[i], samples[i])
        messages = self.expect_stamps([ns for i, ns in enumerate(STAMPS[:-LATEST]) if i != late])
        self.assertLess(max(self.effort_errors(messages)), ACCURACY)
        values = self.node.wait_for_count('dropped: too late', 1)
        self.assertEqual((values['dropped'], values['restarts']), ('1', '0'))
        self.assertEqual(len([line for line in self.node.lines('WARN')
                              if 'message dropped (too late): its stamp' in line]), 1)

    def test_two_publishers_that_contradict_each_other(self):
        self.start()
        encoders = Encoders()
        for ns in STAMPS[:500]:
            q, _ = encoders(ns)
            self.publish(ns, q)
            # The other one believes that the elbow is elsewhere.
            self.publish(ns + MS, dict(q, elbow=q['elbow'] + 0.3))
        text = "positions of 'elbow' jump to and fro: are there two publishers?"
        self.assertEqual(self.node.wait_for_status(text).level, DiagnosticStatus.WARN)
        self.node.wait_for_line('WARN', text)
        self.assertEqual([line for line in self.node.lines('WARN')], [text])
        # Results go on, and are finite.
        messages = self.efforts.wait(900)
        self.assertTrue(np.isfinite([m.effort for m in messages]).all())

    def test_two_publishers_with_clocks_of_their_own(self):
        self.start()
        encoders = Encoders()
        for ns in STAMPS[:200]:
            self.publish(ns, encoders(ns)[0])
            self.publish(ns - 10 ** 9, encoders(ns)[0])
        self.node.wait_for_count('restarts', 199)
        status = self.node.wait_for_status('went back', 'two publishers with clocks of their own')
        self.assertEqual(status.level, DiagnosticStatus.WARN)

    def test_joint_states_of_another_robot(self):
        self.start()
        encoders = Encoders()
        foreign = 0
        for i, ns in enumerate(STAMPS):
            self.publish(ns, encoders(ns)[0])
            if i % 4 == 0:
                # Stamps of another clock, positions that nobody could use.
                names = (['lamp', 'bell'], ['left-finger', 'flange'], [])[foreign % 3]
                self.publish(7 + 10 ** 9 * (foreign % 5), dict.fromkeys(names, float('nan')))
                foreign += 1
        messages = self.expect_stamps(STAMPS[:-LATEST])
        self.assertLess(max(self.effort_errors(messages)), ACCURACY)
        for message in messages:
            self.assertEqual(message.name, COORDINATES)
        values = self.values_after(COUNT + foreign)
        self.assertEqual(values['joint states of other robots'], str(foreign))
        self.assertEqual((values['dropped'], values['restarts']), ('0', '0'))
        lines = [line for line in self.node.lines('INFO') if 'a message is not used' in line]
        self.assertEqual(len(lines), 1)
        self.assertIn("it names no joint of robot 'test_arm' that moves by itself: lamp, bell; they are ",
                      lines[0])
        self.assertEqual(self.node.lines('WARN'), [])
        self.assertEqual(self.node.statuses()[-1].level, DiagnosticStatus.OK)


if __name__ == '__main__':
    run(MessageOrder)
