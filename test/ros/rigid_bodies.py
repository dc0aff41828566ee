"""Efforts and reactions of a robot by another way than the package's: the oracle of its ROS tests.

Every link is a cloud of points x(t) = T(t) s with a 4 x 4 second moment P = integral of s s^T dm,
s = (point in the link, 1). With T'' from the product rule along the tree,

    W = (T'' - gravity) P T^T = integral of (x'' - g) x^T dm

holds the force that moves the link (last column) and, in its antisymmetric part, that force's
moment about the root link's origin. A reaction is the sum of these over all links that the joint
carries. There is no recursion, no angular velocity and no Euler equation in it.
"""
import collections
import math
import xml.etree.ElementTree as ElementTree

import numpy as np

# force and torque (about the joint's origin) in root axes, the pose of the joint frame, and the
# velocity of its origin and its angular velocity in root axes.
Reaction = collections.namedtuple('Reaction', 'force torque pose linear angular')
_Joint = collections.namedtuple('_Joint', 'name kind parent child origin generator axis mimic')


def _numbers(element, attribute, default):
    text = default if element is None else element.get(attribute, default)
    return np.array([float(word) for word in text.split()])


def cross_matrix(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _antisymmetric(m):
    """The vector of integral x x f when m is the integral of f x^T."""
    return np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])


def _transform(origin):
    """URDF's <origin>: turned about the fixed axes x, y, z in this order."""
    r, p, y = _numbers(origin, 'rpy', '0 0 0')
    turn_x = np.array([[1, 0, 0], [0, math.cos(r), -math.sin(r)], [0, math.sin(r), math.cos(r)]])
    turn_y = np.array([[math.cos(p), 0, math.sin(p)], [0, 1, 0], [-math.sin(p), 0, math.cos(p)]])
    turn_z = np.array([[math.cos(y), -math.sin(y), 0], [math.sin(y), math.cos(y), 0], [0, 0, 1]])
    transform = np.eye(4)
    transform[:3, :3] = turn_z @ turn_y @ turn_x
    transform[:3, 3] = _numbers(origin, 'xyz', '0 0 0')
    return transform


def _second_moment(link):
    moment = np.zeros((4, 4))
    inertial = link.find('inertial')
    if inertial is None:
        return moment
    i = {key: float(value) for key, value in inertial.find('inertia').attrib.items()}
    inertia = np.array([[i['ixx'], i['ixy'], i['ixz']],
                        [i['ixy'], i['iyy'], i['iyz']],
                        [i['ixz'], i['iyz'], i['izz']]])
    mass = float(inertial.find('mass').get('value'))
    moment[:3, :3] = np.trace(inertia) / 2 * np.eye(3) - inertia
    moment[3, 3] = mass
    transform = _transform(inertial.find('origin'))
    return transform @ moment @ transform.T


def _joint(element):
    kind = element.get('type')
    axis = _numbers(element.find('axis'), 'xyz', '1 0 0')
    axis = axis / np.linalg.norm(axis)
    generator = np.zeros((4, 4))
    if kind == 'prismatic':
        generator[:3, 3] = axis
    elif kind != 'fixed':
        generator[:3, :3] = cross_matrix(axis)
    mimic = element.find('mimic')
    return _Joint(element.get('name'), kind, element.find('parent').get('link'),
                  element.find('child').get('link'), _transform(element.find('origin')), generator,
                  axis, None if mimic is None else
                  (mimic.get('joint'), float(mimic.get('multiplier', '1')),
                   float(mimic.get('offset', '0'))))


class RigidBodies:
    """A robot from its URDF text; gravity in root axes, m/s^2."""

    def __init__(self, urdf, gravity=(0, 0, -9.81)):
        robot = ElementTree.fromstring(urdf)
        self._moments = {link.get('name'): _second_moment(link) for link in robot.findall('link')}
        self._joints = {joint.get('name'): _joint(joint) for joint in robot.findall('joint')}
        self._carrier = {joint.child: joint for joint in self._joints.values()}
        self.root = next(link for link in self._moments if link not in self._carrier)
        self._gravity = np.zeros((4, 4))
        self._gravity[:3, 3] = gravity
        self._applied = []

    def apply(self, link, at, force, torque, root_axes=False):
        """A wrench of the world on a link from now on: at in the link, axes of the link or root."""
        self._applied.append((link, np.append(at, 1), np.array(force), np.array(torque), root_axes))

    def axis(self, name):
        """Of a joint, in its child link."""
        return self._joints[name].axis

    def slides(self, name):
        return self._joints[name].kind == 'prismatic'

    def _coordinate(self, joint, q, qd, qdd):
        """Position, velocity and acceleration of a joint from those of the coordinates."""
        if joint.kind == 'fixed':
            return 0, 0, 0
        if joint.mimic is None:
            return q[joint.name], qd[joint.name], qdd[joint.name]
        master, multiplier, offset = joint.mimic
        values = self._coordinate(self._joints[master], q, qd, qdd)
        return multiplier * values[0] + offset, multiplier * values[1], multiplier * values[2]

    def _motion(self, link, state):
        """T, T' and T'' of a link."""
        joint = self._carrier.get(link)
        if joint is None:
            return np.eye(4), np.zeros((4, 4)), np.zeros((4, 4))
        t0, t1, t2 = (t @ joint.origin for t in self._motion(joint.parent, state))
        q, qd, qdd = self._coordinate(joint, *state)
        x = joint.generator
        if joint.kind == 'prismatic':
            m0 = np.eye(4) + q * x
        else:
            m0 = np.eye(4) + math.sin(q) * x + (1 - math.cos(q)) * (x @ x)
        m1 = qd * x @ m0
        m2 = (qdd * x + qd ** 2 * x @ x) @ m0
        return t0 @ m0, t1 @ m0 + t0 @ m1, t2 @ m0 + 2 * t1 @ m1 + t0 @ m2

    def motion(self, link, state):
        """T, T' and T'' of a link, for maps q, q', q'' by joint."""
        return self._motion(link, state)

    def _carried(self, link):
        """The link and everything that hangs on it."""
        return [link] + [other for joint in self._joints.values() if joint.parent == link
                         for other in self._carried(joint.child)]

    def reaction(self, name, q, qd, qdd):
        """What the parent exerts on the child at a joint, or 'ground' on the root link."""
        link = self.root if name == 'ground' else self._joints[name].child
        state = (q, qd, qdd)
        total = np.zeros((4, 4))
        applied_force, applied_moment = np.zeros(3), np.zeros(3)
        for carried in self._carried(link):
            t0, _, t2 = self._motion(carried, state)
            total += (t2 - self._gravity) @ self._moments[carried] @ t0.T
            for where, at, force, torque, root_axes in self._applied:
                if where == carried:
                    turn = np.eye(3) if root_axes else t0[:3, :3]
                    applied_force += turn @ force
                    applied_moment += turn @ torque + np.cross((t0 @ at)[:3], turn @ force)
        pose, velocity, _ = self._motion(link, state)
        force = total[:3, 3] - applied_force
        moment = _antisymmetric(total) - applied_moment
        angular = _antisymmetric(velocity[:3, :3] @ pose[:3, :3].T) / 2
        torque = moment - np.cross(pose[:3, 3], force)
        return Reaction(force, torque, pose, velocity[:3, 3], angular)

    def effort(self, name, q, qd, qdd):
        """What the actuator of a joint must deliver, for the joints that mimic it, too."""
        total = 0
        for joint in self._joints.values():
            share = 1 if joint.name == name else 0
            if joint.mimic is not None and joint.mimic[0] == name:
                share = joint.mimic[1]
            if share:
                reaction = self.reaction(joint.name, q, qd, qdd)
                axis = reaction.pose[:3, :3] @ joint.axis
                total += share * axis @ (reaction.force if joint.kind == 'prismatic'
                                         else reaction.torque)
        return total
