"""Streams of joint states of the test arm as its drivers would send them: swings read by encoders."""
import math
import random

import numpy as np
from sensor_msgs.msg import JointState

from node_under_test import EPOCH, Node, NodeTest, joint_state, read
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
MS = 1000000  # ns
STEP = 2 * MS  # 500 Hz
LAG = 50 * MS  # ~estimator/lag
LATEST = 25  # samples at 500 Hz that are younger than the lag
# The estimator has learnt the noise, and what precedes is forgotten.
LEARNT = EPOCH + 1500 * MS
# Of positions, rad or m: 18 bits in a turn.
QUANTUM = 2.4e-5


class Swings:
    """A motion whose coordinates are sines, given as centre, amplitude and frequency in Hz."""

    def __init__(self, **swings):
        self._swings = swings

    def __call__(self, ns):
        """q, q', q'' as maps by name."""
        t = (ns - EPOCH) / 1e9
        motion = ({}, {}, {})
        for name, (centre, amplitude, frequency) in self._swings.items():
            rate = 2 * math.pi * frequency
            motion[0][name] = centre + amplitude * math.sin(rate * t)
            motion[1][name] = amplitude * rate * math.cos(rate * t)
            motion[2][name] = -amplitude * rate ** 2 * math.sin(rate * t)
        return motion


MOTION = Swings(shoulder=(0.3, 0.6, 0.7), elbow=(-0.5, 0.9, 0.5), slide=(0.05, 0.08, 0.4))


class Encoders:
    """Positions and velocities with the noise of an encoder, the same ones for the same seed."""

    def __init__(self, motion=MOTION, seed=1, velocity_noise=2e-3):
        self._motion = motion
        self._random = random.Random(seed)
        self._velocity_noise = velocity_noise

    def __call__(self, ns):
        """q and q' as maps by name."""
        q, qd, _ = self._motion(ns)
        noisy = {name: QUANTUM * round(value / QUANTUM + self._random.gauss(0, 0.5))
                 for name, value in q.items()}
        return noisy, {name: value + self._random.gauss(0, self._velocity_noise)
                       for name, value in qd.items()}


class StreamTest(NodeTest):
    """With a node for the test arm and ~effort recorded."""

    def start(self, parameters=None):
        self.bodies = RigidBodies(ARM)
        self.node = Node(self, ARM, parameters)
        self.states = self.node.feed('joint_states', JointState)
        self.efforts = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort')

    def publish(self, ns, positions, velocities=None):
        self.states.publish(joint_state(ns, positions, velocities))

    def expect_stamps(self, stamps):
        """Exactly these results."""
        messages = self.efforts.wait(len(stamps))
        self.assertStamps(messages, stamps)
        self.assertNoGaps(messages)
        return messages

    def effort_errors(self, messages, motion=MOTION, start=LEARNT):
        """Of each joint rms error over rms effort, from when the noise is learnt."""
        chosen = [m for m in messages if m.header.stamp.to_nsec() >= start][::7]
        self.assertGreater(len(chosen), 100)
        right = np.array([[self.bodies.effort(name, *motion(m.header.stamp.to_nsec()))
                           for name in COORDINATES] for m in chosen])
        got = np.array([m.effort for m in chosen])
        self.assertTrue(np.isfinite(got).all())
        for message in chosen:
            self.assertEqual(message.name, COORDINATES)
        return np.sqrt(np.mean((got - right) ** 2, axis=0) / np.mean(right ** 2, axis=0))

    def values_after(self, count):
        """Diagnostics from after so many joint states."""
        return self.node.wait_for_count('joint states received', count)
