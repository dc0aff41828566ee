"""The six-axis arm on a carrier that moves through every attitude, and what its joints bear.

The oracle has the carrier as six joints without mass before the root of the arm: three slides along
inertial axes, then turns about z, y and x. So the root's motion is that of a link of a tree at rest,
by products of matrices and their derivatives; no quaternion's rate, no angular velocity.
"""
import collections
import math
import os

from geometry_msgs.msg import Quaternion, Transform, Twist, Vector3
import numpy as np

from node_under_test import EPOCH, HERE
from rigid_bodies import RigidBodies

with open(os.path.join(HERE, '..', '..', 'urdf', 'six_axis_arm.urdf'), encoding='utf-8') as _file:
    ARM = _file.read()
ROOT = 'base'
JOINTS = ['joint_%d' % i for i in range(1, 7)]
_CARRIER = [('x', 'prismatic', '1 0 0'), ('y', 'prismatic', '0 1 0'), ('z', 'prismatic', '0 0 1'),
            ('yaw', 'continuous', '0 0 1'), ('pitch', 'continuous', '0 1 0'),
            ('roll', 'continuous', '1 0 0')]

# Of the root's origin, in inertial axes; rotation matrix R and vectors.
Pose = collections.namedtuple('Pose', 'position rotation velocity angular acceleration '
                                      'angular_acceleration')


def _carried():
    text = '<link name="inertial"/>'
    parent = 'inertial'
    for i, (name, kind, axis) in enumerate(_CARRIER):
        child = ROOT if i == 5 else 'after_' + name
        if child != ROOT:
            text += '<link name="%s"/>' % child
        text += ('<joint name="%s" type="%s"><parent link="%s"/><child link="%s"/>'
                 '<axis xyz="%s"/></joint>' % (name, kind, parent, child, axis))
        parent = child
    return ARM.replace('</robot>', text + '</robot>')


def _vector_of(matrix):
    return np.array([matrix[2, 1], matrix[0, 2], matrix[1, 0]])


class CarriedArm:
    """In closed form, by the stamp in ns."""

    def __init__(self, speed=1.0, start=(0.4, 0.2, -0.3), start_ns=EPOCH):
        self.bodies = RigidBodies(_carried())
        self._speed = speed
        self._turns = start
        self._start_ns = start_ns

    def joints(self, ns):
        """q, q', q'' of the arm as maps by name."""
        return self._waves(ns, {name: (0.3 * i - 1, 0.6 - 0.05 * i, 1.1 + 0.3 * i, i)
                                for i, name in enumerate(JOINTS)})

    def _waves(self, ns, waves):
        """mean + amplitude sin(w t + phase) of each."""
        t = (ns - self._start_ns) / 1e9
        motion = ({}, {}, {})
        for name, (mean, amplitude, w, phase) in waves.items():
            motion[0][name] = mean + amplitude * math.sin(w * t + phase)
            motion[1][name] = amplitude * w * math.cos(w * t + phase)
            motion[2][name] = -amplitude * w * w * math.sin(w * t + phase)
        return motion

    def _carrier(self, ns):
        s = self._speed
        motion = self._waves(ns, {'x': (3, 0.5, 1.9 * s, 0), 'y': (-1, 0.3, 2.3 * s, 1),
                                  'z': (0, 0.2, 3.1 * s, 2), 'yaw': (self._turns[0], 0, 0, 0),
                                  'pitch': (self._turns[1], 0.3, 2 * s, 0),
                                  'roll': (self._turns[2], 0.8, 1.7 * s, 0)})
        for name, rate in (('yaw', 0.7 * s), ('pitch', 1.1 * s)):
            motion[0][name] += rate * (ns - self._start_ns) / 1e9
            motion[1][name] += rate
        return motion

    def root(self, ns):
        return self._pose(ROOT, self._carrier(ns))

    def link(self, name, ns):
        """Of a link of the arm, as root() of the root."""
        return self._pose(name, self.whole(ns))

    def _pose(self, link, state):
        pose, first, second = self.bodies.motion(link, state)
        turn = pose[:3, :3]
        spin = first[:3, :3] @ turn.T
        change = second[:3, :3] @ turn.T + first[:3, :3] @ first[:3, :3].T
        return Pose(pose[:3, 3], turn, first[:3, 3], _vector_of(spin), second[:3, 3],
                    _vector_of(change))

    def unit(self, ns, at, turn, link=ROOT):
        """Angular velocity and specific force that a unit on a link measures, in its axes, and these.

        It has its origin at `at` and its axes in the columns of `turn`, in the link.
        """
        pose, _, second = self.bodies.motion(link, self.whole(ns))
        axes = pose[:3, :3] @ turn
        acceleration = (second @ np.append(at, 1))[:3]
        return (axes.T @ self.link(link, ns).angular,
                axes.T @ (acceleration - np.array([0, 0, -9.81])), axes)

    def efforts(self, ns):
        """Of the arm's joints, in their order."""
        motion = self.whole(ns)
        return [self.bodies.effort(name, *motion) for name in JOINTS]

    def ground(self, ns):
        """Force and moment that the carrier exerts on the root, in the root's axes."""
        reaction = self.bodies.reaction('roll', *self.whole(ns))
        turn = reaction.pose[:3, :3].T
        return turn @ reaction.force, turn @ reaction.torque

    def whole_reaction(self, name, ns):
        """Of a joint of the carrier or the arm, in inertial axes."""
        return self.bodies.reaction(name, *self.whole(ns))

    def whole(self, ns):
        """q, q', q'' of carrier and arm as maps by name, for `bodies`."""
        return tuple(dict(one, **other)
                     for one, other in zip(self.joints(ns), self._carrier(ns)))


def quaternion(turn, error=(0, 0, 0)):
    """Of a rotation matrix, by its largest component (Shepperd 1978); with a small error, rad."""
    if any(error):
        cross = np.array([[0, -error[2], error[1]], [error[2], 0, -error[0]],
                          [-error[1], error[0], 0]])
        left, _, right = np.linalg.svd(turn @ (np.eye(3) + cross))
        turn = left @ right
    squares = [1 + np.trace(turn)] + [1 - np.trace(turn) + 2 * turn[i, i] for i in range(3)]
    largest = int(np.argmax(squares))
    if largest == 0:
        values = [squares[0], turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0],
                  turn[1, 0] - turn[0, 1]]
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        values = [0.0, 0.0, 0.0, 0.0]
        values[0] = turn[k, j] - turn[j, k]
        values[1 + i] = squares[largest]
        values[1 + j] = turn[j, i] + turn[i, j]
        values[1 + k] = turn[k, i] + turn[i, k]
    w, x, y, z = np.array(values) / (2 * math.sqrt(squares[largest]))
    return Quaternion(x=x, y=y, z=z, w=w)


def transform(pose):
    return Transform(translation=Vector3(*pose.position), rotation=quaternion(pose.rotation))


def twist(linear, angular):
    return Twist(linear=Vector3(*linear), angular=Vector3(*angular))
