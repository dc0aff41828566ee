#!/usr/bin/python3
"""The motion that efforts belong to, and how far they may be off: ~motion, ~effort_deviation,
~effort_tolerance."""
import re

from diagnostic_msgs.msg import DiagnosticStatus
import numpy as np
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from encoder_streams import (ARM, COORDINATES, LATEST, LEARNT, MOTION, STEP, Encoders, StreamTest,
                             Swings)
from node_under_test import EPOCH, ros_time, run, trajectory_point, wait_until
from rigid_bodies import RigidBodies

# The oracle's rounding.
EXACT = 1e-12
COUNT = 1500
STAMPS = [EPOCH + STEP * i for i in range(COUNT)]
# A motion that repeats itself each second, under another noise.
ROUND = 500
PERIODIC = Swings(shoulder=(0.3, 0.3, 1), elbow=(-0.5, 0.5, 1), slide=(0.05, 0.05, 1))
# Standard deviations of sums of masses with random factors, by differences of rounded efforts.
DIFFERENCES = 1e-9


class Deviations(StreamTest):
    def send(self, stamps, motion=MOTION):
        encoders = Encoders(motion)
        for ns in stamps:
            self.publish(ns, *encoders(ns))

    def test_motion_is_the_one_of_the_efforts(self):
        self.start()
        motions = self.node.record('motion', JointTrajectory)
        self.node.wait_for_plan('effort', 'motion')
        self.send(STAMPS)
        efforts = self.expect_stamps(STAMPS[:-LATEST])
        messages = motions.wait(len(efforts))
        self.assertStamps(messages, STAMPS[:-LATEST])
        self.assertNoGaps(messages)
        for message, effort in list(zip(messages, efforts))[::10]:
            self.assertEqual(message.joint_names, COORDINATES)
            self.assertEqual(message.header.frame_id, effort.header.frame_id)
            point, = message.points
            self.assertEqual(point.time_from_start.to_nsec(), 0)
            self.assertEqual((point.positions, point.velocities, point.effort),
                             (effort.position, effort.velocity, ()))
            used = [dict(zip(COORDINATES, values)) for values in
                    (point.positions, point.velocities, point.accelerations)]
            self.assertEffort(effort, self.bodies, used, EXACT)

    def test_motion_alone_and_of_trajectories(self):
        self.start()
        self.efforts.stop()
        motions = self.node.record('motion', JointTrajectory)
        values = self.node.wait_for_plan('motion')
        self.assertEqual(values['computed'], 'motions')
        self.send(STAMPS[:100])
        self.assertStamps(motions.wait(100 - LATEST), STAMPS[:100 - LATEST])
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        message = JointTrajectory(joint_names=COORDINATES[::-1])
        message.header.stamp = ros_time(EPOCH)
        message.points = [trajectory_point(ns, COORDINATES[::-1], MOTION(EPOCH + ns))
                          for ns in (0, STEP)]
        trajectories.publish(message)
        messages = motions.wait(100 - LATEST + 2)[-2:]
        self.assertStamps(messages, STAMPS[:2])
        for ns, message in zip(STAMPS, messages):
            self.assertEqual(message.joint_names, COORDINATES)
            point = message.points[0]
            for got, right in zip((point.positions, point.velocities, point.accelerations),
                                  MOTION(ns)):
                self.assertEqual(list(got), [right[name] for name in COORDINATES])

    def test_deviations_are_those_of_repeated_noise(self):
        self.start()
        deviations = self.node.record('effort_deviation', JointState)
        self.node.wait_for_plan('effort', 'effort_deviation')
        rounds = 12
        stamps = [EPOCH + STEP * i for i in range(rounds * ROUND + LATEST)]
        self.send(stamps, PERIODIC)
        efforts = self.expect_stamps(stamps[:-LATEST])
        messages = deviations.wait(len(efforts))
        self.assertStamps(messages, stamps[:-LATEST])
        # Of the first instant of all too little is known.
        for message, effort in list(zip(messages, efforts)):
            self.assertEqual(message.name, effort.name)
            self.assertEqual((message.header.frame_id, message.position, message.velocity),
                             (effort.header.frame_id, (), ()))
            self.assertTrue(all(deviation > 0 for deviation in message.effort))
        # By round, phase and joint; the first rounds are learnt from.
        shape = (rounds - 3, ROUND, len(COORDINATES))
        values = np.array([m.effort for m in efforts[3 * ROUND:]]).reshape(shape)
        said = np.array([m.effort for m in messages[3 * ROUND:]]).reshape(shape)
        scatter = np.sqrt(np.mean(np.var(values, axis=0, ddof=1), axis=0))
        ratio = scatter / np.sqrt(np.mean(said ** 2, axis=(0, 1)))
        for name, value in zip(COORDINATES, ratio):
            self.assertTrue(0.5 < value < 1.5, '%s: %g' % (name, value))
        # The truth is within two deviations, as the bias is small.
        for joint, name in enumerate(COORDINATES):
            inside = [abs(values[r, k, joint] - right) <= 2 * said[r, k, joint]
                      for k in range(0, ROUND, 20)
                      for right in [self.bodies.effort(name, *PERIODIC(stamps[k]))]
                      for r in range(rounds - 3)]
            self.assertGreater(np.mean(inside), 0.85, name)

    def test_deviations_are_computed_for_subscribers_only(self):
        self.start()
        self.send(STAMPS[:200])
        values = self.values_after(200)
        self.assertEqual(values['efforts in doubt'], 'no deviations are computed')
        self.assertEqual(values['computed'], 'efforts')
        deviations = self.node.record('effort_deviation', JointState)
        values = self.node.wait_for_plan('effort', 'effort_deviation')
        self.assertEqual(values['computed'], 'efforts, deviations')
        self.send(STAMPS[200:400])
        self.assertStamps(deviations.wait(200), STAMPS[200 - LATEST:400 - LATEST])

        def said():
            return {entry.value for status in self.node.statuses() for entry in status.values
                    if entry.key == 'efforts in doubt'}
        wait_until(lambda: 'none' in said(), lambda: 'no doubts, there are %s' % said())
        self.assertEqual(said(), {'no deviations are computed', 'none'})
        deviations.stop()
        self.assertEqual(self.node.wait_for_plan('effort')['computed'], 'efforts')
        # A point of a trajectory is taken as exact.
        self.assertEqual(len(deviations.messages()), 200)

    def test_doubtful_efforts_are_named(self):
        self.start({'deviation_warn': 1e-9})
        self.node.record('effort_deviation', JointState)
        self.node.wait_for_plan('effort', 'effort_deviation')
        self.send(STAMPS[:200])
        wait_until(lambda: [
            status for status in self.node.statuses()
            if status.level == DiagnosticStatus.WARN and
            re.search("'(shoulder|elbow|slide)'.*(position|velocity|acceleration) of '",
                      status.message)], 'the doubt')

    def test_tolerances_are_those_of_links_that_differ(self):
        tolerances = {'mass': 0.02, 'inertia': 0.1}
        self.start({'scene': {'tolerances': tolerances}})
        recorder = self.node.record('effort_tolerance', JointState)
        self.node.wait_for_plan('effort', 'effort_tolerance')
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        stamps = [LEARNT + 50 * STEP * i for i in range(5)]
        message = JointTrajectory(joint_names=COORDINATES)
        message.header.stamp = ros_time(stamps[0])
        message.points = [trajectory_point(ns - stamps[0], COORDINATES, MOTION(ns))
                          for ns in stamps]
        trajectories.publish(message)
        messages = recorder.wait(len(stamps))
        self.assertStamps(messages, stamps)
        # Efforts are linear in each of them, so that a robot with one of them changed tells.
        variances = np.zeros((len(stamps), len(COORDINATES)))
        for changed in changed_robots(ARM, tolerances):
            bodies = RigidBodies(changed)
            for row, ns in enumerate(stamps):
                variances[row] += [(bodies.effort(name, *MOTION(ns)) -
                                    self.bodies.effort(name, *MOTION(ns))) ** 2
                                   for name in COORDINATES]
        for message, row in zip(messages, variances):
            self.assertEqual(message.name, COORDINATES)
            self.assertClose(message.effort, np.sqrt(row), DIFFERENCES, 'tolerance')


def changed_robots(urdf, tolerances):
    """The robot with the mass of one link changed, or its inertia, for each link."""
    changes = ((r'<mass value="([^"]*)"/>', tolerances['mass']),
               (r'<inertia [^>]*/>', tolerances['inertia']))
    for pattern, tolerance in changes:
        for found in re.finditer(pattern, urdf):
            text = re.sub(r'(\s|")(-?\d[\d.]*)"',
                          lambda number, factor=1 + tolerance: '%s%.17g"' % (
                              number.group(1), factor * float(number.group(2))), found.group(0))
            yield urdf[:found.start()] + text + urdf[found.end():]


if __name__ == '__main__':
    run(Deviations)
