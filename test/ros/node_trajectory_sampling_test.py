#!/usr/bin/python3
"""~trajectory_sampling: results on the curve between the points of a trajectory."""
import math

from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from closed_loops import CLOSED_FORM, JOINTS, L, LoopTest, R, SLIDER_CRANK_SCENE, SliderCrank
from node_under_test import (EPOCH, Node, NodeTest, Polynomials, read, ros_time, run,
                             trajectory_point)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
MS = 1000000
# Polynomials through points some 0.1 s apart, and the oracle's rounding: 1e-16 over 1e-2 s^2, and a
# margin of a hundred.
CURVE = 1e-11
# Of the fifth order, so that cubics from point to point differ from it.
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1, 0.2, 2.0, -3.0), elbow=(1.0, 0.9, -0.6, 0.3, 1.0, 2.0),
                     slide=(0.05, 0.02, -0.04, 0.01, 0.2, 0.1))
UNEVEN = [0, 301 * MS, 550 * MS, 1004 * MS]
# 250 Hz: the last point is a sample.
RATE, STEP = 250, 4 * MS
SAMPLES = [STEP * k for k in range(252)]


def message(times, names=COORDINATES, parts=3, motion=MOTION):
    trajectory = JointTrajectory(joint_names=list(names))
    trajectory.header.stamp = ros_time(EPOCH)
    trajectory.points = [trajectory_point(ns, names, motion(EPOCH + ns), parts) for ns in times]
    return trajectory


def cubics(times):
    """The curve of cubics through the points of MOTION, in Newton's form of each piece."""
    def curve(ns):
        start = max(t for t in times[:-1] if t <= ns)
        end = times[times.index(start) + 1]
        h, t = (end - start) / 1e9, (ns - start) / 1e9
        (q0, v0, _), (q1, v1, _) = MOTION(EPOCH + start), MOTION(EPOCH + end)
        motion = ({}, {}, {})
        for name in q0:
            slope = (q1[name] - q0[name]) / h
            b = (slope - v0[name]) / h
            c = (v1[name] - 2 * slope + v0[name]) / h ** 2
            motion[0][name] = q0[name] + v0[name] * t + b * t ** 2 + c * t ** 2 * (t - h)
            motion[1][name] = v0[name] + 2 * b * t + c * (3 * t ** 2 - 2 * t * h)
            motion[2][name] = 2 * b + c * (6 * t - 2 * h)
        return motion
    return curve


class SampledTrajectories(NodeTest):
    def start(self, *topics, parameters=None):
        kinds = {'effort': JointState, 'joint_trajectory': JointTrajectory}
        self.bodies = RigidBodies(ARM)
        self.node = Node(self, ARM, {'trajectory_sampling': RATE, **(parameters or {})})
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.recorders = {topic: self.node.record(topic, kinds[topic]) for topic in topics}
        self.node.wait_for_plan(*topics)

    def assertFollows(self, curve, messages, times=SAMPLES):
        self.assertStamps(messages, [EPOCH + ns for ns in times])
        for effort, ns in zip(messages, times):
            self.assertEffort(effort, self.bodies, curve(ns), CURVE)

    def test_quintics_with_accelerations(self):
        self.start('effort', 'joint_trajectory')
        self.trajectories.publish(message(UNEVEN))
        efforts = self.recorders['effort'].wait(len(SAMPLES))
        self.assertFollows(lambda ns: MOTION(EPOCH + ns), efforts)
        self.assertNoGaps(efforts)
        # The answer to the message is at its points.
        filled = self.recorders['joint_trajectory'].wait(1)[0]
        self.assertEqual(len(filled.points), len(UNEVEN))
        for point, ns in zip(filled.points, UNEVEN):
            motion = MOTION(EPOCH + ns)
            self.assertEqual(point.time_from_start.to_nsec(), ns)
            self.assertClose(point.effort, [self.bodies.effort(name, *motion)
                                            for name in COORDINATES], CURVE, 'at a point')
        values = self.node.wait_for_count('trajectory samples computed', len(SAMPLES))
        self.assertEqual(values['trajectory samples computed'], str(len(SAMPLES)))
        self.assertEqual(values['trajectory points computed'], str(len(UNEVEN)))
        self.assertEqual((values['samples computed'], values['dropped']), ('0', '0'))

    def test_cubics_with_velocities_played_at_a_rate(self):
        curve = cubics(UNEVEN)
        for parameters in ({}, {'trajectory_rate': 2000}):
            self.start('effort', 'joint_trajectory', parameters=parameters)
            for count in (1, 2):
                self.trajectories.publish(message(UNEVEN, parts=2))
                efforts = self.recorders['effort'].wait(count * len(SAMPLES))
                self.assertFollows(curve, efforts[-len(SAMPLES):])
            # At a point the acceleration is the one with which the curve goes on.
            filled = self.recorders['joint_trajectory'].wait(1)[0]
            for point, ns in zip(filled.points, UNEVEN):
                self.assertClose(point.effort, [self.bodies.effort(name, *curve(ns))
                                                for name in COORDINATES], CURVE, 'at a point')
            values = self.node.wait_for_count('trajectory samples computed', 2 * len(SAMPLES))
            self.assertEqual(values['trajectory samples computed'], str(2 * len(SAMPLES)))
            self.assertIn('cubics from point to point', ''.join(self.node.lines('INFO')))

    def test_the_peak_between_two_points_at_rest(self):
        self.start('effort')
        # Half a second from rest to rest: 3 s^2 - 2 s^3.
        ends = ({'shoulder': 0.1, 'elbow': -0.5, 'slide': 0.0},
                {'shoulder': 0.9, 'elbow': 1.0, 'slide': 0.1})
        h = 0.5

        def curve(ns):
            s = ns / 1e9 / h
            way = {name: ends[1][name] - ends[0][name] for name in COORDINATES}
            return ({name: ends[0][name] + way[name] * s * s * (3 - 2 * s) for name in way},
                    {name: way[name] * 6 * s * (1 - s) / h for name in way},
                    {name: way[name] * 6 * (1 - 2 * s) / h ** 2 for name in way})

        trajectory = message([0, 500 * MS], parts=0)
        for point, end in zip(trajectory.points, ends):
            point.positions = [end[name] for name in COORDINATES]
        self.trajectories.publish(trajectory)
        times = [STEP * k for k in range(126)]
        efforts = self.recorders['effort'].wait(len(times))
        self.assertFollows(curve, efforts, times)
        fastest = max(effort.velocity[0] for effort in efforts)
        self.assertGreater(fastest, 1.5 * 0.8 / h * 0.999)

    def test_a_single_point(self):
        self.start('effort')
        self.trajectories.publish(message([7 * MS]))
        self.assertFollows(lambda ns: MOTION(EPOCH + ns), self.recorders['effort'].wait(1), [7 * MS])

    def test_more_samples_than_a_trajectory_may_have(self):
        self.start('effort')
        self.trajectories.publish(message([0, 5000000 * MS]))
        values = self.node.wait_for_count('dropped: times', 1)
        self.assertIn('it lasts 5000 s, more than the 1000000 samples of %s/trajectory_sampling = 250 Hz'
                      % self.node.name,
                      values['last drop'])
        self.trajectories.publish(message([7 * MS]))
        self.recorders['effort'].wait(1)

    def test_more_samples_than_the_queue_holds(self):
        self.start('effort', parameters={'queue_size': {'output': 100}})
        self.trajectories.publish(message(UNEVEN))
        self.recorders['effort'].wait(100)
        self.node.wait_for_line('WARN', '252 samples are more than %s/queue_size/output = 100' %
                                self.node.name)

    def test_samples_behind_a_long_backlog_are_dropped(self):
        self.start('effort', parameters={'queue_size': {'output': 200}, 'trajectory_rate': 0.01})
        for _ in range(2):
            self.trajectories.publish(message(UNEVEN))
        values = self.node.wait_for_count('dropped: backlog', 1)
        self.assertRegex(values['last drop'], '25[12] points still wait to be played')

    def test_positions_that_wrap(self):
        self.start('effort', parameters={'trajectory_sampling': 0})
        names = ['elbow', 'shoulder', 'slide']
        trajectory = JointTrajectory(joint_names=names)
        trajectory.header.stamp = ros_time(EPOCH)
        for i, elbow in enumerate((3.1, -3.1, -3.0168)):
            trajectory.points.append(trajectory_point(
                100 * MS * i, names, ({'elbow': elbow, 'shoulder': 0.0, 'slide': 0.0},), 1))
        self.trajectories.publish(trajectory)
        turn = 6.283185307179586
        positions = [effort.position[1] for effort in self.recorders['effort'].wait(3)]
        self.assertClose(positions, [3.1, turn - 3.1, turn - 3.0168], 1e-15, 'positions')


class SampledLoops(LoopTest):
    def test_passive_joints_follow_between_the_points(self):
        angle = (0.4, 3.0, 2.0, 5.0)
        crank = Polynomials(crank_joint=angle)

        def at(ns):
            return SliderCrank(*(part['crank_joint'] for part in crank(EPOCH + ns)))

        times = [0, 150 * MS, 400 * MS]
        samples = [STEP * k for k in range(101)]
        for rate in (0, 2000):
            self.start('effort', parameters={'trajectory_sampling': RATE, 'trajectory_rate': rate})
            for sent, names in enumerate((['crank_joint'], JOINTS), 1):
                trajectory = JointTrajectory(joint_names=names)
                trajectory.header.stamp = ros_time(EPOCH)
                for ns in times:
                    motion = at(ns)
                    trajectory.points.append(trajectory_point(
                        ns, names, (motion.q, motion.qd, motion.qdd)))
                self.trajectories.publish(trajectory)
                results = self.recorders['effort'].wait(len(samples) * sent)[-len(samples):]
                self.assertStamps(results, [EPOCH + ns for ns in samples])
                for result, ns in zip(results, samples):
                    self.assertMatches(result, at(ns), 10 * CLOSED_FORM)
            values = self.node.wait_for_count('trajectory samples computed', 2 * len(samples))
            self.assertEqual(values['trajectory points computed'], '0')
            self.assertEqual(values['samples that violate a loop'], '0')

    def test_given_passive_joints_tell_the_branch(self):
        self.start('effort', parameters={'trajectory_sampling': RATE})
        # The rod points the other way, to a slider behind the crank.
        angle = 0.4
        closed = SliderCrank(angle, 0, 0).q
        rod = closed['rod_joint'] + angle
        q = {'crank_joint': angle, 'rod_joint': math.pi - rod - angle,
             'slider_joint': R * math.cos(angle) - L * math.cos(rod)}
        zero = dict.fromkeys(JOINTS, 0)
        trajectory = JointTrajectory(joint_names=JOINTS)
        trajectory.header.stamp = ros_time(EPOCH)
        trajectory.points = [trajectory_point(ns, JOINTS, (q, zero, zero)) for ns in (0, 20 * MS)]
        self.trajectories.publish(trajectory)
        for effort in self.recorders['effort'].wait(6):
            self.assertClose(effort.position, [q[name] for name in JOINTS], CLOSED_FORM, 'closed')

    def test_samples_where_a_loop_cannot_be_closed(self):
        # The slider is driven: 0.4 m is as far as crank and rod reach.
        scene = dict(SLIDER_CRANK_SCENE, actuated=['slider_joint'],
                     assembly=[{'name': 'crank_joint', 'position': 1.0}])
        self.start('effort', scene=scene, parameters={'trajectory_sampling': RATE})
        trajectory = JointTrajectory(joint_names=['slider_joint'])
        trajectory.header.stamp = ros_time(EPOCH)
        for ns, position in ((0, 0.3), (100 * MS, 0.45), (200 * MS, 0.3)):
            trajectory.points.append(trajectory_point(ns, ['slider_joint'],
                                                      ({'slider_joint': position},), 1))
        self.trajectories.publish(trajectory)
        count = 51
        values = self.node.wait_for_count('trajectory samples computed', count)
        # A symmetric hump: 3 s^2 - 2 s^3 up and down.
        way = [min(k, count - 1 - k) / 25 for k in range(count)]
        reached = [0.3 + 0.15 * s * s * (3 - 2 * s) < 0.4 for s in way]
        dropped = int(values['dropped: open loop'])
        self.assertEqual(dropped, reached.count(False))
        self.assertIn("closure 'wrist_pin' stays open by 0.0", values['last drop'])
        self.assertRegex(values['last drop'], r'at stamp 1600000000\.\d+$')
        self.assertStamps(self.recorders['effort'].wait(count - dropped),
                          [EPOCH + STEP * k for k in range(count) if reached[k]])


if __name__ == '__main__':
    run(SampledTrajectories, SampledLoops)
