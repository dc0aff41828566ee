#!/usr/bin/python3
"""Bad messages are dropped whole, counted and named; the node goes on with right answers."""
import math
import time

from diagnostic_msgs.msg import DiagnosticStatus
import rospy
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from node_under_test import (EPOCH, Node, NodeTest, Polynomials, joint_state, read, ros_time, run,
                             trajectory_point)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
STEP = 10000000  # ns
LAG = 5  # samples: ~estimator/lag of 0.05 s
FIRST = 8  # good joint states before the bad ones
# The oracle's rounding, and the estimator's on a cubic; see node_joint_states_test.py.
EXACT = 1e-12
ESTIMATED = 1e-9
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1), elbow=(1.0, 0.9, -0.6, 1.3), slide=(0.05, 0.2))
# The last instant of a ROS stamp, s.
END_OF_TIME = 4294967295


# Stand for stamps that depend on the good joint states around: half a step after the last one, its
# own, or half a step before the first one of all.
LATER = 1
SAME = 2
BEFORE = 3


def state(names='shoulder elbow slide', position=(7, 7, 7), velocity=(7, 7, 7), stamp=LATER,
          effort=()):
    """A joint state far from the motion."""
    message = JointState(name=names.split(), position=list(position), velocity=list(velocity),
                         effort=list(effort))
    message.header.stamp = ros_time(stamp)
    return message


# Joint states: what is wrong, the message, the reason in diagnostics, and a part of the text.
BAD_STATES = [
    ('before the first', state(stamp=BEFORE), 'too late',
     'is too far behind those received before'),
    ('positions missing', state(position=(), velocity=()), 'array length',
     '3 names but 0 positions'),
    ('a position too few', state(position=(7, 7)), 'array length', '3 names but 2 positions'),
    ('a position too many', state(position=(7, 7, 7, 7)), 'array length',
     '3 names but 4 positions'),
    ('a velocity too few', state(velocity=(7, 7)), 'array length', '3 names but 2 velocities'),
    ('NaN position', state(position=(7, math.nan, 7)), 'not finite',
     "the position of 'elbow' is nan"),
    ('infinite position', state(position=(7, 7, -math.inf)), 'not finite',
     "the position of 'slide' is -inf"),
    ('a joint twice', state('shoulder elbow elbow'), 'joint twice', "names 'elbow' twice"),
    ('zero stamp', state(stamp=0), 'zero stamp', 'its stamp is zero'),
    ('equal stamp', state(stamp=SAME), 'equal stamp', 'was received before'),
    ('equal stamp of one joint', state('slide', (7,), (7,), stamp=SAME), 'equal stamp',
     'was received before'),
]


def point(seconds=1, positions=(7, 7, 7), velocities=(7, 7, 7), accelerations=(7, 7, 7),
          effort=()):
    result = JointTrajectoryPoint(positions=positions, velocities=velocities,
                                  accelerations=accelerations, effort=effort)
    result.time_from_start.secs = seconds
    return result


def trajectory(*points, names='shoulder elbow slide', stamp=EPOCH):
    message = JointTrajectory(joint_names=names.split(), points=list(points))
    message.header.stamp = ros_time(stamp)
    return message


BAD_TRAJECTORIES = [
    ('no points', trajectory(), 'no points', 'it has no points'),
    ('a position too few', trajectory(point(1), point(2, positions=(7, 7))), 'array length',
     'point 2 has 2 positions for 3 names'),
    ('no positions', trajectory(point(positions=())), 'array length',
     'point 1 has 0 positions for 3 names'),
    ('a velocity too many', trajectory(point(velocities=(7, 7, 7, 7))), 'array length',
     'point 1 has 4 velocities for 3 names'),
    ('an acceleration too few', trajectory(point(1), point(2), point(3, accelerations=(7,))),
     'array length', 'point 3 has 1 accelerations for 3 names'),
    ('an effort too few', trajectory(point(1), point(2, effort=(7, 7))), 'array length',
     'point 2 has 2 efforts for 3 names'),
    ('equal times', trajectory(point(1), point(2), point(2)), 'times', 'point 3 is 2 s'),
    ('times going back', trajectory(point(2), point(1)), 'times', 'point 2 is 1 s'),
    ('negative time', trajectory(point(-1), point(1)), 'times', 'point 1 is -1 s'),
    ('beyond the last stamp', trajectory(point(1), point(9), stamp=(END_OF_TIME - 5) * 10 ** 9),
     'times', 'point 2 is 9 s'),
    ('NaN position', trajectory(point(1), point(2, positions=(7, 7, math.nan))), 'not finite',
     "the position of 'slide' at point 2 is nan"),
    ('infinite velocity', trajectory(point(velocities=(math.inf, 7, 7))), 'not finite',
     "the velocity of 'shoulder' at point 1 is inf"),
    ('NaN acceleration', trajectory(point(accelerations=(7, math.nan, 7))), 'not finite',
     "the acceleration of 'elbow' at point 1 is nan"),
    ('unknown joints only', trajectory(point(), names='lamp bell 2nd.finger'), 'no known joint',
     'lamp, bell, 2nd.finger'),
    ('no joints', trajectory(point(1, (), (), ()), names=''), 'no known joint',
     "no joint of robot 'test_arm'"),
    ('a joint twice', trajectory(point(), names='shoulder elbow shoulder'), 'joint twice',
     "names 'shoulder' twice"),
    ('a joint that was never seen', trajectory(point(1, (7, 7), (7, 7), (7, 7)),
                                               names='shoulder elbow'),
     'joint never seen', "it leaves out 'slide'"),
]


class DroppedMessages(NodeTest):
    def setUp(self):
        self.bodies = RigidBodies(ARM)

    def start(self, parameters=None):
        self.node = Node(self, ARM, parameters)
        self.states = self.node.feed('joint_states', JointState)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.efforts = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort')
        self.dropped = {}
        self.reports = 0  # that were there when the latest drop was dealt with

    def expect_drop(self, kind, topic, reason, text):
        """One more of the reason, named in diagnostics and, unless throttled, in a warning."""
        self.dropped[reason] = self.dropped.get(reason, 0) + 1
        values = self.node.wait_for_count('dropped: ' + reason, self.dropped[reason])
        counts = {key[len('dropped: '):]: int(value) for key, value in values.items()
                  if key.startswith('dropped: ') and int(value) > 0}
        self.assertEqual(counts, self.dropped, kind)
        self.assertEqual(values['dropped'], str(sum(self.dropped.values())), kind)
        topic = self.node.namespace + '/' + topic + ': '
        self.assertTrue(values['last drop'].startswith(topic), values['last drop'])
        self.assertIn(text, values['last drop'], kind)
        self.node.wait_for_line('WARN', '(%s): ' % reason)
        # A report that is a warning says so, no later than the first that counts it.
        reports = [status for status in self.node.statuses()[self.reports:]
                   if text in status.message]
        self.assertTrue(reports, 'no summary says "%s"' % text)
        self.assertEqual(reports[0].level, DiagnosticStatus.WARN)
        self.assertIn('1 dropped, the last: ' + topic, reports[0].message)
        self.reports = len(self.node.statuses())

    def test_joint_states(self):
        self.start()
        sent = 0
        for kind, bad, reason, text in [(None,) * 4] * FIRST + BAD_STATES:
            if kind is not None:
                last = EPOCH + STEP * (sent - 1)
                stamp = {LATER: last + STEP // 2, SAME: last, BEFORE: EPOCH - STEP // 2}.get(
                    bad.header.stamp.to_nsec(), 0)
                bad.header.stamp = ros_time(stamp)
                self.states.publish(bad)
            ns = EPOCH + STEP * sent
            self.states.publish(joint_state(ns, *MOTION(ns)[:2]))
            sent += 1
            if kind is not None:
                # It left no trace in the estimator.
                message = self.efforts.wait(sent - LAG)[-1]
                self.assertEqual(message.header.stamp.to_nsec(), ns - STEP * LAG, kind)
                self.assertEffort(message, self.bodies, MOTION(ns - STEP * LAG), ESTIMATED)
                self.expect_drop(kind, 'joint_states', reason, text)
        self.assertEqual(len(self.efforts.messages()), FIRST + len(BAD_STATES) - LAG)
        values = self.node.diagnostics()
        for key in ('restarts', 'gaps', 'joint states put in order', 'joint states of other robots',
                    'joint states with velocities that are not finite'):
            self.assertEqual(values[key], '0', key)
        self.assertFalse(self.node.ended())

    def test_trajectories(self):
        self.start()
        sent = 0
        for kind, bad, reason, text in BAD_TRAJECTORIES:
            self.trajectories.publish(bad)
            ns = EPOCH + STEP * sent
            good = trajectory_point(0, COORDINATES, MOTION(ns))
            self.trajectories.publish(trajectory(good, stamp=ns))
            sent += 1
            message = self.efforts.wait(sent)[-1]
            self.assertEqual(message.header.stamp.to_nsec(), ns, kind)
            self.assertEffort(message, self.bodies, MOTION(ns), EXACT)
            self.expect_drop(kind, 'joint_trajectory', reason, text)
        self.assertEqual(len(self.efforts.messages()), len(BAD_TRAJECTORIES))
        self.assertFalse(self.node.ended())

    def test_what_looks_bad_but_is_legal(self):
        self.start({'estimator': {'acceleration': 'zero'}})
        names = ['lamp', 'shoulder', 'elbow', 'left-finger', 'slide', 'lamp']
        for i, position in enumerate((0.5, 1e6, -1e15)):
            ns = EPOCH + STEP * i
            # NaN where the robot looks at nothing, and efforts of any number.
            message = JointState(name=names, effort=[math.nan] * 4 * i,
                                 position=[math.nan, position, position, math.nan, 0.1, math.inf],
                                 velocity=[math.inf, 0.2, 0.3, math.nan, 0.4, math.nan])
            message.header.stamp = ros_time(ns)
            self.states.publish(message)
            output = self.efforts.wait(i + 1)[-1]
            self.assertEqual(output.header.stamp.to_nsec(), ns)
            self.assertEqual(output.name, COORDINATES)
            # The continuous joint goes the shorter way, unless no double tells its turns.
            unwrapped, tolerance = position, EXACT
            if abs(position) < 1e9:
                unwrapped = 0.5 + math.remainder(position - 0.5, 2 * math.pi)
                # What its turns are known to.
                tolerance = max(EXACT, math.ulp(position))
            q = dict(zip(COORDINATES, (position, unwrapped, 0.1)))
            qd = dict(zip(COORDINATES, (0.2, 0.3, 0.4)))
            self.assertEffort(output, self.bodies, (q, qd, dict.fromkeys(COORDINATES, 0)),
                              tolerance)
        # The next state keeps the diagnostics from being older than the last one.
        self.states.publish(message)
        values = self.node.wait_for_count('dropped: equal stamp', 1)
        self.assertEqual(values['dropped'], '1')
        # The disagreeing mimic joint is worth one warning.
        warnings = [line for line in self.node.lines('WARN') if 'left-finger' in line]
        self.assertEqual(len(warnings), 1)

    def test_before_the_first_clock(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        self.start()
        good = trajectory_point(0, COORDINATES, MOTION(EPOCH))
        self.trajectories.publish(trajectory(good, stamp=0))
        self.trajectories.publish(trajectory(good, stamp=EPOCH))
        self.assertStamps(self.efforts.wait(1), [EPOCH])
        self.expect_drop('no time', 'joint_trajectory', 'no time yet',
                         '/clock has not been received yet')
        # The log does not wait for the time either.
        for ns in (EPOCH + 100 * STEP, EPOCH):
            self.states.publish(joint_state(ns, *MOTION(ns)[:2]))
        self.node.wait_for_line('INFO', 'time went back')

    def test_results_that_overflow_are_not_published(self):
        self.start()
        motions = [(dict.fromkeys(COORDINATES, 0.1), dict.fromkeys(COORDINATES, velocity),
                    dict.fromkeys(COORDINATES, 0)) for velocity in (0.2, 1e200, 0.3)]
        for i, motion in enumerate(motions):
            self.trajectories.publish(trajectory(trajectory_point(0, COORDINATES, motion),
                                                 stamp=EPOCH + STEP * i))
        messages = self.efforts.wait(2)
        self.assertStamps(messages, [EPOCH, EPOCH + 2 * STEP])
        for message, motion in zip(messages, motions[::2]):
            self.assertEffort(message, self.bodies, motion, EXACT)
        self.expect_drop('overflow', 'joint_trajectory', 'overflow', 'not finite at point 1')

    def test_warnings_are_throttled_and_reasons_do_not_hide_each_other(self):
        self.start()
        start = time.monotonic()
        for _ in range(300):
            self.states.publish(state(stamp=0))
        self.states.publish(state('elbow elbow', (7, 7), (7, 7)))
        self.node.wait_for_count('dropped: joint twice', 1)
        self.node.wait_for_line('WARN', "'elbow' twice")
        self.assertThrottled([line for line in self.node.lines('WARN') if '(zero stamp)' in line],
                             start)
        values = self.node.wait_for_count('dropped: zero stamp', 300)
        self.assertEqual(values['dropped'], '301')


if __name__ == '__main__':
    run(DroppedMessages)
