"""A biped that sways while it stands on two feet, and what its feet bear.

The soles stay where they are, by the geometry of legs of two equal parts. The oracle has the torso on
six joints without mass, as carried_arm.py: what the last of them bears without feet is the wrench
that the ground must exert on the whole robot. It is divided among the feet as a gait laboratory would
measure it: the left one bears a share that changes, the right one what is left.
"""
import math

import numpy as np

from carried_arm import Pose
from node_under_test import EPOCH
from rigid_bodies import RigidBodies

ROOT = 'torso'
FEET = ['left', 'right']
JOINTS = [side + part for side in FEET for part in ('_hip', '_knee', '_ankle')]
LEG = 0.4  # m, thigh and shank
SOLE = 0.06  # m, below the ankle
ASIDE = {'left': 0.1, 'right': -0.1}
AHEAD = {'left': 0.08, 'right': -0.12}  # of the ankles, from below the torso
_STEP = 2e-3  # s, of differences


def _link(name, mass, at, inertia):
    return ('<link name="%s"><inertial><origin xyz="%r %r %r"/><mass value="%r"/><inertia '
            'ixx="%r" iyy="%r" izz="%r" ixy="0" ixz="0" iyz="0"/></inertial></link>' % (
                (name,) + tuple(at) + (mass,) + tuple(inertia)))


def _joint(name, kind, parent, child, at=(0.0, 0.0, 0.0), axis='0 1 0'):
    limit = '<limit lower="-3" upper="3" effort="1000" velocity="50"/>' if kind == 'revolute' else ''
    return ('<joint name="%s" type="%s"><parent link="%s"/><child link="%s"/><origin xyz="%r %r %r"'
            '/><axis xyz="%s"/>%s</joint>' % ((name, kind, parent, child) + tuple(at) + (axis, limit)))


def _robot():
    text = _link(ROOT, 30.0, (0.02, 0.0, 0.25), (1.1, 0.9, 0.5))
    for side in FEET:
        text += _link(side + '_thigh', 6.0, (0.01, 0.0, -0.18), (0.08, 0.08, 0.02))
        text += _link(side + '_shank', 3.5, (0.0, 0.0, -0.17), (0.05, 0.05, 0.01))
        text += _link(side + '_foot', 1.1, (0.04, 0.0, -0.03), (0.002, 0.005, 0.005))
        text += '<link name="%s_sole"/>' % side
        text += _joint(side + '_hip', 'revolute', ROOT, side + '_thigh', (0.0, ASIDE[side], 0.0))
        text += _joint(side + '_knee', 'revolute', side + '_thigh', side + '_shank',
                       (0.0, 0.0, -LEG))
        text += _joint(side + '_ankle', 'revolute', side + '_shank', side + '_foot',
                       (0.0, 0.0, -LEG))
        text += _joint(side + '_mount', 'fixed', side + '_foot', side + '_sole',
                       (0.0, 0.0, -SOLE))
    return '<robot name="biped">' + text + '</robot>'


BIPED = _robot()


def _carried():
    axes = [('x', 'prismatic', '1 0 0'), ('y', 'prismatic', '0 1 0'), ('z', 'prismatic', '0 0 1'),
            ('yaw', 'continuous', '0 0 1'), ('pitch', 'continuous', '0 1 0'),
            ('roll', 'continuous', '1 0 0')]
    text, parent = '<link name="inertial"/>', 'inertial'
    for name, kind, axis in axes:
        child = ROOT if name == 'roll' else 'after_' + name
        if child != ROOT:
            text += '<link name="%s"/>' % child
        text += _joint(name, kind, parent, child, axis=axis)
        parent = child
    return BIPED.replace('</robot>', text + '</robot>')


def _vector_of(matrix):
    return np.array([matrix[2, 1], matrix[0, 2], matrix[1, 0]])


class StandingBiped:
    """By the stamp in ns."""

    def __init__(self):
        self._bodies = RigidBodies(_carried())

    def _place(self, t):
        """All coordinates at a time, s."""
        x, z = 0.03 * math.sin(2.1 * t), 0.72 + SOLE + 0.025 * math.sin(3.3 * t + 1)
        pitch = 0.08 * math.sin(1.7 * t + 0.5)
        q = {'x': x, 'y': 0.0, 'z': z, 'yaw': 0.0, 'pitch': pitch, 'roll': 0.0}
        for side in FEET:
            back, down = x - AHEAD[side], z - SOLE
            knee = 2 * math.acos(math.hypot(back, down) / (2 * LEG))
            thigh = math.atan2(back, down) - knee / 2
            q[side + '_hip'] = thigh - pitch
            q[side + '_knee'] = knee
            q[side + '_ankle'] = -thigh - knee
        return q

    def _all(self, ns):
        """q, q', q'' as maps by name; the derivatives by differences of the sixth order."""
        t = (ns - EPOCH) / 1e9
        places = [self._place(t + k * _STEP) for k in range(-3, 4)]
        first = (-1, 9, -45, 0, 45, -9, 1)
        second = (2, -27, 270, -490, 270, -27, 2)

        def by(weights, divisor):
            return {name: sum(w * place[name] for w, place in zip(weights, places)) / divisor
                    for name in places[0]}
        return places[3], by(first, 60 * _STEP), by(second, 180 * _STEP ** 2)

    def joints(self, ns):
        return tuple({name: values[name] for name in JOINTS} for values in self._all(ns))

    def root(self, ns):
        pose, first, second = self._bodies.motion(ROOT, self._all(ns))
        turn = pose[:3, :3]
        spin = first[:3, :3] @ turn.T
        change = second[:3, :3] @ turn.T + first[:3, :3] @ first[:3, :3].T
        return Pose(pose[:3, 3], turn, first[:3, 3], _vector_of(spin), second[:3, 3],
                    _vector_of(change))

    def soles(self, ns):
        """What each foot bears, in axes of its sole and about its origin: force, moment."""
        motion = self._all(ns)
        whole = self._bodies.reaction('roll', *motion)
        at = whole.pose[:3, 3]
        poses = {side: self._bodies.motion(side + '_sole', motion)[0] for side in FEET}
        t = (ns - EPOCH) / 1e9
        share = 0.5 + 0.3 * math.sin(2.6 * t)
        force = {'left': share * whole.force + np.array([4 * math.sin(5 * t), 6.0, 0])}
        moment = {'left': np.array([3 * math.cos(4 * t), -2.0, 1.0])}
        arms = {side: poses[side][:3, 3] - at for side in FEET}
        force['right'] = whole.force - force['left']
        moment['right'] = (whole.torque - moment['left'] - np.cross(arms['left'], force['left']) -
                           np.cross(arms['right'], force['right']))
        return {side: (poses[side][:3, :3].T @ force[side], poses[side][:3, :3].T @ moment[side])
                for side in FEET}

    def efforts(self, ns):
        """Of JOINTS, with the feet on the ground."""
        bodies = RigidBodies(_carried())
        for side, (force, moment) in self.soles(ns).items():
            bodies.apply(side + '_sole', np.zeros(3), force, moment)
        motion = self._all(ns)
        return [bodies.effort(name, *motion) for name in JOINTS]
