#!/usr/bin/python3
"""Trajectories in, one result for every point out: stamps, order, what the message leaves out."""
from geometry_msgs.msg import WrenchStamped
import rospy
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory

from node_under_test import (EPOCH, Node, NodeTest, Polynomials, joint_state, read, ros_time, run,
                             trajectory_point, wait_until)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
# The oracle's rounding.
EXACT = 1e-12
# Splines reproduce polynomials of up to their own order except for rounding: 1e-16 of a position
# over the squared step, 1e-2 s^2 and more, and a margin of a thousand.
SPLINE = 1e-11
# The estimator's rounding on a cubic; see node_joint_states_test.py.
ESTIMATED = 1e-9
LAG = 5  # samples of 10 ms: ~estimator/lag of 0.05 s
MS = 1000000
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1, 0.2), elbow=(1.0, 0.9, -0.6, 0.3),
                     slide=(0.05, 0.02, -0.04, 0.01))
# Times that are no multiples of each other, ns.
UNEVEN = [0, 300 * MS + 1, 550 * MS + 77, 1000 * MS - 3, 1234567891]


def message(times, names=COORDINATES, parts=3, motion=MOTION, stamp=EPOCH):
    """A trajectory of the motion that starts at EPOCH."""
    trajectory = JointTrajectory(joint_names=list(names))
    trajectory.header.stamp = ros_time(stamp)
    trajectory.points = [trajectory_point(ns, names, motion(EPOCH + ns), parts) for ns in times]
    return trajectory


class Trajectories(NodeTest):
    def start(self, *topics, parameters=None):
        kinds = {'effort': JointState, 'reactions': MultiDOFJointState,
                 'joint_trajectory': JointTrajectory, 'reaction/elbow': WrenchStamped}
        self.bodies = RigidBodies(ARM)
        self.node = Node(self, ARM, parameters)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.recorders = {topic: self.node.record(topic, kinds[topic]) for topic in topics}
        self.node.wait_for_plan(*topics)

    def wait_for_line(self, severity, *parts):
        wait_until(lambda: [line for line in self.node.lines(severity)
                            if all(part in line for part in parts)],
                   lambda: '%s in %s' % (parts, self.node.output()))

    def efforts_of(self, trajectory):
        """The messages of ~effort for a trajectory, after checking their stamps."""
        recorder = self.recorders['effort']
        before = len(recorder.messages())
        self.trajectories.publish(trajectory)
        messages = recorder.wait(before + len(trajectory.points))[before:]
        start = trajectory.header.stamp.to_nsec()
        self.assertStamps(messages, [start + point.time_from_start.to_nsec()
                                     for point in trajectory.points])
        return messages

    def test_every_point_of_long_trajectories_in_order(self):
        self.start('effort', 'reactions', 'reaction/elbow', 'joint_trajectory')
        # Names in another order, with joints among them that have no coordinate.
        names = ['slide', 'lamp', 'shoulder', 'left-finger', 'elbow']
        motion = Polynomials(shoulder=(0.3, -0.8, 0.1), elbow=(1.0, 0.9), slide=(0.05, 0.02),
                             **{'lamp': (5, 5), 'left-finger': (6, 6)})
        times = [1234567 * i for i in range(2000)]
        starts = [EPOCH, EPOCH + 10 ** 10, EPOCH - 10 ** 10]
        for start in starts:
            self.trajectories.publish(message(times, names, motion=motion, stamp=start))
        stamps = [start + time for start in starts for time in times]
        for topic in ('effort', 'reactions', 'reaction/elbow'):
            messages = self.recorders[topic].wait(len(stamps))
            self.assertStamps(messages, stamps)
            self.assertNoGaps(messages)
        for i in range(0, len(stamps), 97):
            state = motion(EPOCH + times[i % len(times)])
            effort, reactions, wrench = (self.recorders[topic].messages()[i] for topic in
                                         ('effort', 'reactions', 'reaction/elbow'))
            self.assertEqual(effort.name, COORDINATES)
            self.assertEffort(effort, self.bodies, state, EXACT)
            self.assertReactions(reactions, self.bodies, state, EXACT)
            self.assertWrench(wrench, self.bodies, 'elbow', state, EXACT)
        self.expect_filled_trajectories(starts, times, motion)

    def expect_filled_trajectories(self, starts, times, motion):
        messages = self.recorders['joint_trajectory'].wait(len(starts))
        self.assertStamps(messages, starts)
        efforts = iter(self.recorders['effort'].messages())
        names = ['slide', 'shoulder', 'elbow']
        for trajectory in messages:
            self.assertEqual(trajectory.joint_names, names)
            self.assertEqual(len(trajectory.points), len(times))
            for ns, point, effort in zip(times, trajectory.points, efforts):
                self.assertEqual(point.time_from_start.to_nsec(), ns)
                expected = trajectory_point(ns, names, motion(EPOCH + ns))
                self.assertEqual(list(point.positions), expected.positions)
                self.assertEqual(list(point.velocities), expected.velocities)
                self.assertEqual(list(point.accelerations), expected.accelerations)
                values = dict(zip(effort.name, effort.effort))
                self.assertEqual(list(point.effort), [values[name] for name in names])

    def test_zero_stamp_counts_from_the_receipt(self):
        self.start('effort', 'joint_trajectory')
        before = rospy.Time.now().to_nsec()
        for _ in range(2):
            self.trajectories.publish(message(UNEVEN[1:], stamp=0))
        stamps = [m.header.stamp.to_nsec()
                  for m in self.recorders['effort'].wait(2 * len(UNEVEN[1:]))]
        after = rospy.Time.now().to_nsec()
        starts = [stamp - time for stamp, time in zip(stamps, 2 * UNEVEN[1:])]
        # One receipt for each message, and between the sending and now.
        count = len(UNEVEN[1:])
        self.assertEqual(starts, count * starts[:1] + count * starts[-1:])
        self.assertLessEqual(before, starts[0])
        self.assertLessEqual(starts[0], starts[-1])
        self.assertLessEqual(starts[-1], after)
        for effort, ns in zip(self.recorders['effort'].messages(), 2 * UNEVEN[1:]):
            self.assertEffort(effort, self.bodies, MOTION(EPOCH + ns), EXACT)
        for trajectory in self.recorders['joint_trajectory'].wait(2):
            self.assertEqual(trajectory.header.stamp.to_nsec(), 0)

    def test_without_accelerations(self):
        self.start('effort')
        trajectory = message(UNEVEN, parts=2)
        # A point that happens to have them does not count while others lack them.
        trajectory.points[2].accelerations = [9, 9, 9]
        for effort in self.efforts_of(trajectory):
            ns = effort.header.stamp.to_nsec()
            self.assertEffort(effort, self.bodies, MOTION(ns), SPLINE)
        self.wait_for_line('INFO', '5 points', 'quintic spline')

    def test_without_velocities(self):
        self.start('effort', 'joint_trajectory')
        # From rest to rest through one point, at even steps: the C2 cubic in closed form.
        h = 0.5
        p = {'shoulder': (0.1, 0.7, -0.4), 'elbow': (1.0, -1.0, 0.5), 'slide': (0, 0.1, 0.15)}
        trajectory = message([0, 500 * MS, 1000 * MS], parts=0)
        for i, point in enumerate(trajectory.points):
            point.positions = [p[name][i] for name in COORDINATES]
        efforts = self.efforts_of(trajectory)
        middle = {name: 3 * (p[name][2] - p[name][0]) / (4 * h) for name in p}
        zero = dict.fromkeys(p, 0)
        q = [{name: p[name][i] for name in p} for i in range(3)]
        qdd = [
            {name: 6 * (p[name][1] - p[name][0]) / h ** 2 - 2 * middle[name] / h for name in p},
            {name: 6 * (p[name][2] - p[name][1]) / h ** 2 - 4 * middle[name] / h for name in p},
            {name: 2 * middle[name] / h - 6 * (p[name][2] - p[name][1]) / h ** 2 for name in p}]
        for effort, *motion in zip(efforts, q, (zero, middle, zero), qdd):
            self.assertEffort(effort, self.bodies, motion, SPLINE)
        self.wait_for_line('INFO', '3 points', 'cubic spline')
        filled = self.recorders['joint_trajectory'].wait(1)[0]
        for point, effort in zip(filled.points, efforts):
            self.assertEqual((len(point.velocities), len(point.accelerations)), (0, 0))
            self.assertEqual(point.effort, effort.effort)

    def test_without_velocities_but_at_the_ends(self):
        self.start('effort')
        # With its end velocities given, the cubic spline is the cubic.
        trajectory = message(UNEVEN, parts=1)
        for point, ns in ((trajectory.points[0], UNEVEN[0]), (trajectory.points[-1], UNEVEN[-1])):
            point.velocities = [MOTION(EPOCH + ns)[1][name] for name in COORDINATES]
        for effort in self.efforts_of(trajectory):
            ns = effort.header.stamp.to_nsec()
            self.assertEffort(effort, self.bodies, MOTION(ns), SPLINE)

    def test_joints_left_out_rest_where_they_were_seen_last(self):
        self.start('effort', 'joint_trajectory')
        states = self.node.feed('joint_states', JointState)
        for count, position in enumerate((0.12, -0.07), start=1):
            states.publish(joint_state(EPOCH + count, {'slide': position, 'elbow': 9.0},
                                       {'slide': 3.0, 'elbow': 3.0}))
            self.node.wait_for_count('joint states received', count)
            # The count comes before the sample is taken in, the state after it tells for sure.
            states.publish(joint_state(EPOCH + 10 ** 9, {'lamp': 0.0}))
            self.node.wait_for_count('joint states of other robots', count)
            for effort in self.efforts_of(message(UNEVEN, ['elbow', 'shoulder'])):
                q, qd, qdd = MOTION(effort.header.stamp.to_nsec())
                q['slide'], qd['slide'], qdd['slide'] = position, 0, 0
                self.assertEqual(effort.name, COORDINATES)
                self.assertEffort(effort, self.bodies, (q, qd, qdd), EXACT)
            filled = self.recorders['joint_trajectory'].wait(count)[-1]
            self.assertEqual(filled.joint_names, ['elbow', 'shoulder'])
            self.assertEqual(len(filled.points[0].effort), 2)

    def test_trajectories_do_not_disturb_the_estimator(self):
        self.start('effort')
        states = self.node.feed('joint_states', JointState)
        stamps = [EPOCH + 10 * MS * i for i in range(20)]
        for i, ns in enumerate(stamps):
            states.publish(joint_state(ns, *MOTION(ns)[:2]))
            if i == 10:
                self.recorders['effort'].wait(6)  # all that are due
                self.efforts_of(message(UNEVEN, stamp=EPOCH - 10 ** 9))
        count = len(stamps) - LAG
        messages = self.recorders['effort'].wait(count + len(UNEVEN))
        messages = messages[:6] + messages[6 + len(UNEVEN):]
        self.assertStamps(messages, stamps[:-LAG])
        for effort in messages:
            self.assertEffort(effort, self.bodies, MOTION(effort.header.stamp.to_nsec()),
                              ESTIMATED)

    def test_more_points_than_the_queue_holds_are_warned_of(self):
        self.start('effort', parameters={'queue_size': {'output': 4}})
        self.trajectories.publish(message(UNEVEN))
        self.wait_for_line('WARN', '5 points are more than %s/queue_size/output = 4' % self.node.name)

    def test_trajectories_played_at_a_rate_take_turns_with_joint_states(self):
        self.start('effort', 'joint_trajectory', parameters={
            'trajectory_rate': 100, 'estimator': {'acceleration': 'zero'}})
        states = self.node.feed('joint_states', JointState)
        times = [10 * MS * i for i in range(100)]
        starts = [EPOCH, EPOCH + 10 ** 10, EPOCH - 10 ** 10]
        for start in starts:
            self.trajectories.publish(message(times, stamp=start))
        # The answer to each whole trajectory does not wait for its points.
        filled = self.recorders['joint_trajectory'].wait(len(starts))
        self.assertStamps(filled, starts)
        live = EPOCH + 5 * 10 ** 9
        states.publish(joint_state(live, *MOTION(live)[:2]))
        messages = self.recorders['effort'].wait(len(starts) * len(times) + 1)
        stamps = [effort.header.stamp.to_nsec() for effort in messages]
        self.assertLess(stamps.index(live), len(stamps) - 1)
        efforts = [effort for effort in messages if effort.header.stamp.to_nsec() != live]
        self.assertStamps(efforts, [start + ns for start in starts for ns in times])
        self.assertNoGaps(messages)
        points = [point for trajectory in filled for point in trajectory.points]
        for i, (effort, point) in enumerate(zip(efforts, points)):
            self.assertEffort(effort, self.bodies, MOTION(EPOCH + times[i % len(times)]), EXACT)
            self.assertEqual(effort.effort, point.effort)
        # At rest again, and played anew.
        self.assertEqual(len(self.efforts_of(message(UNEVEN))), len(UNEVEN))

    def test_trajectories_behind_a_long_backlog_are_dropped(self):
        self.start('effort', parameters={'queue_size': {'output': 4}, 'trajectory_rate': 0.01})
        for _ in range(2):
            self.trajectories.publish(message(UNEVEN + [2000 * MS]))
        values = self.node.wait_for_count('dropped: backlog', 1)
        self.assertIn('points still wait to be played, more than %s/queue_size/output = 4' % self.node.name,
                      values['last drop'])
        self.assertNotIn('subscribers may lose some', self.node.output())


if __name__ == '__main__':
    run(Trajectories)
