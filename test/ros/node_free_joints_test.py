#!/usr/bin/python3
"""Joints that turn freely, live: orientations by name, rates estimated, efforts and their deviations."""
import math

from geometry_msgs.msg import Quaternion, Transform, Twist, Vector3
import numpy as np
from sensor_msgs.msg import JointState, MultiDOFJointState

from node_under_test import EPOCH, Node, NodeTest, joint_state, ros_time, run

MS = 1000000
GRAVITY = np.array([0.0, 0.0, -9.81])
# An arm on a ball joint, with a wrist that turns about its own axis: a body of 2 kg with its centre beside
# the ball, another one of 1 kg on the wrist.
BALL = """<robot name="ball_arm"><link name="base"/>
  <link name="arm"><inertial><origin xyz="0.1 -0.2 0.3"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.05" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="wheel"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="ball" type="fixed"><parent link="base"/><child link="arm"/>
    <origin xyz="0.2 0.1 0.5" rpy="0.3 -0.4 0.9"/></joint>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="wheel"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 0 1"/></joint></robot>"""
SCENE = {'joint_types': [{'name': 'ball', 'type': 'spherical'}], 'reactions': 'none'}
FLOATING = """<robot name="drone"><link name="world"/>
  <link name="body"><inertial><mass value="3"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="free" type="floating"><parent link="world"/><child link="body"/></joint></robot>"""


def turn_about(axis, angle):
    """Rodrigues' formula."""
    x = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + math.sin(angle) * x + (1 - math.cos(angle)) * x @ x


def rpy(r, p, y):
    return (turn_about(np.array([0, 0, 1.0]), y) @ turn_about(np.array([0, 1.0, 0]), p) @
            turn_about(np.array([1.0, 0, 0]), r))


FRAME = rpy(0.3, -0.4, 0.9)  # of the ball on the base
TILT = np.array([2.0, -1.0, 2.0]) / 3


def attitude(t):
    """Of the child in the joint's frame: it tumbles, by two turns."""
    return (turn_about(np.array([0, 0, 1.0]), 1.3 * t + 0.4 * math.sin(2 * t)) @
            turn_about(TILT, 0.9 * math.sin(1.7 * t) + 0.8 * t))


def rates(t, h=1e-3):
    """Angular velocity and acceleration in axes of the parent, by differences of the matrices."""
    def velocity(at):
        slope = (8 * (attitude(at + h) - attitude(at - h)) -
                 (attitude(at + 2 * h) - attitude(at - 2 * h))) / (12 * h)
        spin = slope @ attitude(at).T
        return np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0],
                         spin[1, 0] - spin[0, 1]]) / 2
    return velocity(t), (8 * (velocity(t + h) - velocity(t - h)) -
                         (velocity(t + 2 * h) - velocity(t - 2 * h))) / (12 * h)


def quaternion(turn, sign=1):
    w = math.sqrt(max(0.0, 1 + np.trace(turn))) / 2
    if w > 0.1:
        x, y, z = ((turn[2, 1] - turn[1, 2]) / (4 * w), (turn[0, 2] - turn[2, 0]) / (4 * w),
                   (turn[1, 0] - turn[0, 1]) / (4 * w))
    else:
        values, vectors = np.linalg.eigh(turn + turn.T)
        x, y, z = vectors[:, np.argmax(values)] * math.sqrt(1 - w * w)
        if np.dot([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]],
                  [x, y, z]) * w < 0:
            x, y, z = -x, -y, -z
    return Quaternion(sign * x, sign * y, sign * z, sign * w)


def wrist(t):
    return 0.7 * math.sin(2.2 * t), 1.54 * math.cos(2.2 * t), -3.388 * math.sin(2.2 * t)


def ball_efforts(t):
    """Moments about the arm's axes at the ball, and the wrist's: by the change of angular momentum."""
    turn = FRAME @ attitude(t)
    omega, alpha = (FRAME @ v for v in rates(t))
    _, spin, spin_rate = wrist(t)
    axis = turn[:, 2]
    force_moment = np.zeros(3)
    for mass, inertia, at, w, e in (
            (2, np.diag([0.03, 0.05, 0.04]), [0.1, -0.2, 0.3], omega, alpha),
            (1, np.diag([0.01, 0.01, 0.02]), [0, 0, 0.4], omega + spin * axis,
             alpha + spin_rate * axis + np.cross(omega, spin * axis))):
        r = turn @ np.array(at)
        acceleration = np.cross(alpha, r) + np.cross(omega, np.cross(omega, r)) - GRAVITY
        body = turn @ inertia @ turn.T  # the wheel is round about its axis
        moment = body @ e + np.cross(w, body @ w)
        force_moment += mass * np.cross(r, acceleration) + moment
        own = axis @ moment
    return list(turn.T @ force_moment) + [own]


class FreeJoints(NodeTest):
    def start(self, robot=BALL, scene=None, parameters=None):
        self.noise = np.random.default_rng(3)
        self.node = Node(self, robot, dict({
            'scene': SCENE if scene is None else scene, 'diagnostic_period': 0.01},
                                           **(parameters or {})))
        self.turns = self.node.feed('multi_dof_joint_states', MultiDOFJointState)
        self.efforts = self.node.record('effort', JointState)

    def state(self, ns, noise=0.0, twist=False, names=('ball',)):
        t = (ns - EPOCH) / 1e9
        message = MultiDOFJointState(joint_names=list(names))
        message.header.stamp = ros_time(ns)
        error = noise * self.noise.normal(size=3)
        size = np.linalg.norm(error)
        turn = attitude(t) @ (turn_about(error / size, size) if size else np.eye(3))
        sign = 1 if self.noise.random() < 0.5 else -1
        message.transforms = [Transform(translation=Vector3(9, 9, 9),
                                        rotation=quaternion(turn, sign)) for _ in names]
        if twist:
            message.twist = [Twist(angular=Vector3(*rates(t)[0])) for _ in names]
        return message

    def send(self, count, noise=0.0, twist=False, jitter=0.0):
        """Orientations at 200 Hz and the wrist at 500 Hz, side by side as two drivers send them."""
        states = self.node.feed('joint_states', JointState)
        sent = 0
        for i in range(count):
            ns = EPOCH + i * 2 * MS
            while sent * 5 * MS <= i * 2 * MS:
                turn = EPOCH + sent * 5 * MS
                message = self.state(turn, noise, twist)
                message.header.stamp = ros_time(turn + int(jitter * self.noise.normal()))
                self.turns.publish(message)
                sent += 1
            q, qd, _ = wrist((ns - EPOCH) / 1e9)
            states.publish(joint_state(ns, {'wrist': q + noise / 10 * self.noise.normal()},
                                       {'wrist': qd}))
            if i % 20 == 19:  # less than the lag, so that neither gets ahead
                self.node.wait_for_count('joint states received', i + 1)
                self.node.wait_for_count('messages of joints that turn freely received', sent)

    def errors(self, messages, start):
        chosen = [m for m in messages if m.header.stamp.to_nsec() > EPOCH + start * MS][::11]
        self.assertGreater(len(chosen), 40)
        found = np.array([m.effort for m in chosen])
        right = np.array([ball_efforts((m.header.stamp.to_nsec() - EPOCH) / 1e9) for m in chosen])
        self.assertTrue(np.isfinite(found).all())
        self.assertGreater(np.abs(right).max(), 3)
        return chosen, found - right

    def test_efforts_are_those_of_the_turn(self):
        self.start()
        self.node.wait_for_plan('effort')
        self.send(1500)
        messages = self.efforts.wait(1400)
        self.assertEqual(messages[0].name, ['ball.rx', 'ball.ry', 'ball.rz', 'wrist'])
        _, errors = self.errors(messages, 1500)
        print('exact: %s' % np.abs(errors).max(axis=0))
        self.assertLess(np.abs(errors).max(), 0.005)
        values = self.node.diagnostics()
        self.assertEqual(values['dropped'], '0')
        self.assertIn('noise', values['samples of ball.rx'])

    def test_noise_and_deviations(self):
        self.start()
        recorder = self.node.record('effort_deviation', JointState)
        self.node.wait_for_plan('effort', 'effort_deviation')
        self.send(3000, noise=2e-4, jitter=5e4)
        messages = self.efforts.wait(2900)
        said = {m.header.stamp: m.effort for m in recorder.wait(2900)}
        chosen, errors = self.errors(messages, 2000)
        deviations = np.array([said[m.header.stamp] for m in chosen])
        inside = np.mean(np.abs(errors) <= 2 * deviations)
        print('noise: rms %s, within two %g' % (np.sqrt(np.mean(errors ** 2, axis=0)), inside))
        self.assertLess(np.sqrt(np.mean(errors ** 2)), 0.1)
        self.assertGreater(inside, 0.88)

    def test_a_joint_that_ceases_is_held_and_one_unknown_is_not_computed(self):
        self.start(parameters={'hold_after': 0.1})
        self.node.wait_for_plan('effort')
        states = self.node.feed('joint_states', JointState)
        for i in range(40):
            self.turns.publish(self.state(EPOCH + i * 5 * MS))
        self.node.wait_for_count('messages of joints that turn freely received', 40)
        for i in range(300):
            states.publish(joint_state(EPOCH + i * 2 * MS, {'wrist': 0.0}, {'wrist': 0.0}))
        self.node.wait_for_count('joint states received', 300)
        last = self.efforts.wait(200)[-1]
        self.assertClose(last.velocity, [0] * 4, 1e-9, 'rates of what is held')
        self.node.wait_for_count('samples with a joint held', 50)

    def test_floating(self):
        self.start(FLOATING, {'reactions': 'none'})
        self.node.wait_for_plan('effort')
        for i in range(400):
            ns = EPOCH + i * 5 * MS
            t = i * 0.005
            message = self.state(ns, names=('free', 'another'))
            message.transforms[0].translation = Vector3(2 * math.sin(t), t * t, 1.0)
            self.turns.publish(message)
        message = self.efforts.wait(300)[-1]
        t = (message.header.stamp.to_nsec() - EPOCH) / 1e9
        efforts = dict(zip(message.name, message.effort))
        self.assertClose([efforts['free.' + axis] for axis in 'xyz'],
                         [3 * -2 * math.sin(t), 6, 3 * 9.81], 1e-3, 'forces')
        omega, alpha = (attitude(t).T @ v for v in rates(t))
        inertia = np.diag([0.1, 0.2, 0.25])
        moment = inertia @ alpha + np.cross(omega, inertia @ omega)
        self.assertClose([efforts['free.r' + axis] for axis in 'xyz'], moment, 1e-3, 'moments')

    def test_bad_messages(self):
        self.start()
        self.node.wait_for_plan('effort')
        self.turns.publish(self.state(EPOCH))
        long, nan, twice, short, zero, again, unknown = (self.state(EPOCH + 5 * MS)
                                                         for _ in range(7))
        long.transforms[0].rotation = Quaternion(0, 0, 0, 1.1)
        nan.transforms[0].rotation.y = math.nan
        twice.joint_names = ['ball', 'ball']
        twice.transforms *= 2
        short.transforms = []
        zero.header.stamp = ros_time(0)
        again.header.stamp = ros_time(EPOCH)
        unknown.joint_names = ['wrist']
        for message, reason, text in (
                (long, 'orientation', "of joint 'ball', its rotation has the length 1.1, not 1"),
                (nan, 'not finite', "of joint 'ball', its rotation.y is nan"),
                (twice, 'joint twice', "it names 'ball' twice"),
                (short, 'array length', 'it has 0 transforms for 1 names'),
                (zero, 'zero stamp', 'its stamp is zero'),
                (again, 'equal stamp', 'was received before'),
                (unknown, 'no known joint', "it names no joint of robot 'ball_arm' that turns")):
            self.turns.publish(message)
            values = self.node.wait_for_count('dropped: ' + reason, 1)
            self.assertIn(self.node.namespace + '/multi_dof_joint_states: ', values['last drop'])
            self.assertIn(text, values['last drop'])
        nearly = self.state(EPOCH + 10 * MS)
        for axis in 'xyzw':
            value = getattr(nearly.transforms[0].rotation, axis)
            setattr(nearly.transforms[0].rotation, axis, 1.0005 * value)
        self.turns.publish(nearly)
        self.node.wait_for_line('WARN', 'scaled to 1')

    def test_thresholds_of_angles_are_refused(self):
        node = Node(self, BALL, {'scene': SCENE, 'external_effort': {
            'thresholds': [{'name': 'ball.rx', 'effort': 1}]}})
        self.assertEqual(node.wait(), 1)
        line, = node.lines('FATAL')
        self.assertIn("external_effort/thresholds: 'ball.rx' is an angle of 'ball'", line)


if __name__ == '__main__':
    run(FreeJoints)
