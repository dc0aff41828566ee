#!/usr/bin/python3
"""Wrenches that are measured while the robot moves: instant, frame, what is stale, what is bad."""
import math

from geometry_msgs.msg import WrenchStamped
import numpy as np
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory

from node_under_test import (EPOCH, Node, NodeTest, Polynomials, joint_state, read, ros_time, run,
                             trajectory_point, vector)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
AXES = {'shoulder': [0, 1, 0], 'elbow': [0.6, 0, 0.8], 'slide': [0, 0, -1]}
# The oracle's rounding.
EXACT = 1e-12
# The estimator's rounding on a cubic; see node_joint_states_test.py.
ESTIMATED = 1e-9
# Rounding of both formalisms, and of the laws of conservation.
CHECKED = 1e-12
MS = 1000000
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1, 0.2), elbow=(1.0, 0.9, -0.6, 0.3),
                     slide=(0.05, 0.02, -0.04, 0.01))
# Times that are no multiples of each other, ns.
UNEVEN = [0, 130 * MS + 1, 250 * MS + 77, 300 * MS]
FORCE, TORQUE = [30.0, -4.0, 12.5], [0.5, -2.0, 1.0]


def live(**more):
    return {'applied_wrenches': [dict({'name': 'push', 'link': 'hand', 'live': True}, **more)]}


def wrench(ns, force=FORCE, torque=TORQUE, frame='hand'):
    message = WrenchStamped()
    message.header.stamp = ros_time(ns)
    message.header.frame_id = frame
    message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = force
    message.wrench.torque.x, message.wrench.torque.y, message.wrench.torque.z = torque
    return message


def ramp(ns):
    """Force and torque that grow with time."""
    t = (ns - EPOCH) / 1e9
    return np.array([30, -4, 12.5]) * (1 + 2 * t), np.array([0.5, -2, 1]) * (1 - 3 * t)


def trajectory(times, start=EPOCH):
    message = JointTrajectory(joint_names=COORDINATES)
    message.header.stamp = ros_time(start)
    message.points = [trajectory_point(ns, COORDINATES, MOTION(start + ns)) for ns in times]
    return message


class LiveWrenches(NodeTest):
    def start(self, scene, parameters=None):
        node = Node(self, ARM, dict({'scene': scene}, **(parameters or {})))
        node.trajectories = node.feed('joint_trajectory', JointTrajectory)
        node.efforts = node.record('effort', JointState)
        node.reactions = node.record('reactions', MultiDOFJointState)
        node.wait_for_plan('effort', 'reactions')
        return node

    def send(self, node, *messages):
        """Sends wrenches and waits until the node has them."""
        if not hasattr(node, 'wrenches'):
            node.wrenches = node.feed('inverse_dynamics/wrench/push', WrenchStamped)
            node.sent = 0
        for message in messages:
            node.wrenches.publish(message)
        node.sent += len(messages)
        return node.wait_for_count('wrenches received', node.sent)

    def expected_efforts(self, bodies, motion, force, torque, frame):
        """By the oracle without the wrench, less the wrench's work on each joint's unit motion."""
        link_joint = {'hand': 'slide', 'forearm': 'elbow'}
        pose = np.eye(4) if frame == 'stand' else bodies.reaction(link_joint[frame], *motion).pose
        force, torque = pose[:3, :3] @ force, pose[:3, :3] @ torque
        efforts = []
        for name in COORDINATES:
            joint = bodies.reaction(name, *motion).pose
            axis = joint[:3, :3] @ np.array(AXES[name])
            moment = torque + np.cross(pose[:3, 3] - joint[:3, 3], force)
            work = axis @ (force if name == 'slide' else moment)
            efforts.append(bodies.effort(name, *motion) - work)
        return efforts

    def test_constants_are_those_of_the_scene(self):
        fixed = self.start({'applied_wrenches': [
            {'link': 'hand', 'force': FORCE, 'torque': TORQUE}]})
        measured = self.start(live())
        inverted = self.start(live(invert=True))
        self.send(measured, *[wrench(EPOCH + i * 60 * MS) for i in range(-1, 6)])
        self.send(inverted, *[wrench(EPOCH + i * 60 * MS, [-x for x in FORCE],
                                     [-x for x in TORQUE]) for i in range(-1, 6)])
        for node in (fixed, measured, inverted):
            node.trajectories.publish(trajectory(UNEVEN))
        for node in (measured, inverted):
            for topic in ('efforts', 'reactions'):
                pairs = list(zip(getattr(node, topic).wait(len(UNEVEN)),
                                 getattr(fixed, topic).wait(len(UNEVEN))))
                self.assertEqual(len(pairs), len(UNEVEN))
                for got, wanted in pairs:
                    self.assertEqual(got.header.stamp, wanted.header.stamp)
                    if topic == 'efforts':
                        self.assertClose(got.effort, wanted.effort, EXACT, 'efforts')
                        continue
                    for one, other in zip(got.wrench, wanted.wrench):
                        self.assertClose(vector(one.force), vector(other.force), EXACT, 'force')
                        self.assertClose(vector(one.torque), vector(other.torque), EXACT, 'torque')

    def test_ramps_are_interpolated_in_any_frame_of_the_robot(self):
        bodies = RigidBodies(ARM)
        for frame in ('hand', 'stand', 'forearm'):
            node = self.start(live())
            stamps = [EPOCH + i * 70 * MS for i in range(-1, 6)]
            self.send(node, *[wrench(ns, *ramp(ns), frame=frame) for ns in stamps])
            node.trajectories.publish(trajectory(UNEVEN))
            for message in node.efforts.wait(len(UNEVEN)):
                ns = message.header.stamp.to_nsec()
                self.assertClose(message.effort, self.expected_efforts(
                    bodies, MOTION(ns), *ramp(ns), frame), EXACT, '%s at %d' % (frame, ns))

    def test_joint_states(self):
        bodies = RigidBodies(ARM)
        node = self.start(live(), {'certificates': True, 'cross_check_rate': 100})
        states = node.feed('joint_states', JointState)
        stamps = [EPOCH + i * 10 * MS for i in range(40)]
        self.send(node, *[wrench(ns - 3 * MS, *ramp(ns - 3 * MS)) for ns in stamps])
        for ns in stamps:
            q, qd, _ = MOTION(ns)
            states.publish(joint_state(ns, q, qd))
        messages = node.efforts.wait(30)
        self.assertGreaterEqual(len(messages), 30)
        for message in messages:
            ns = message.header.stamp.to_nsec()
            self.assertClose(message.effort, self.expected_efforts(
                bodies, MOTION(ns), *ramp(ns), 'hand'), ESTIMATED, 'at %d' % ns)
        values = node.wait_for_count('cross-checks done', 1)
        self.assertLess(float(values['cross-check, largest difference (relative)']), CHECKED)
        for law in ('power', 'ground force', 'ground moment'):
            self.assertLess(float(values['certificate: %s (largest, relative)' % law]), CHECKED)
        self.assertEqual(values['dropped: no wrench'], '0')
        self.assertEqual(values['samples with a wrench held'], '0')

    def test_what_is_stale_is_not_computed_with_and_said(self):
        node = self.start(live())
        times = [i * 50 * MS for i in range(20)]
        self.send(node, *[wrench(EPOCH + ns) for ns in times[:7]])  # up to 0.3 s
        node.trajectories.publish(trajectory(times))
        # Held for ~wrench_timeout, 0.1 s: results up to 0.4 s.
        values = node.wait_for_count('dropped: no wrench', 11)
        messages = node.efforts.wait(9)
        self.assertStamps(messages, [EPOCH + ns for ns in times[:9]])
        self.assertEqual(values['dropped: no wrench'], '11')
        self.assertEqual(values['samples with a wrench held'], '2')
        self.assertIn(node.name + '/wrench/push is known from stamp', values['last drop'])
        self.assertIn('wrench_timeout is 0.1 s, at point 20', values['last drop'])
        said = [line for line in node.lines('WARN') if 'no wrench' in line]
        self.assertEqual(len(said), 1, said)
        self.assertIn('result dropped (no wrench)', said[0])
        self.assertIn('at point 10', said[0])
        # It goes on when the wrench does.
        later = EPOCH + 2000 * MS
        self.send(node, *[wrench(later + ns) for ns in times])
        node.trajectories.publish(trajectory(times, later))
        self.assertStamps(node.efforts.wait(29)[9:], [later + ns for ns in times])

    def test_nothing_is_computed_before_the_first(self):
        node = self.start(live(), {'wrench_timeout': 0.5})
        node.trajectories.publish(trajectory([0]))
        values = node.wait_for_count('dropped: no wrench', 1)
        self.assertIn('/wrench/push has not been received, at point 1', values['last drop'])
        self.assertEqual(node.efforts.messages(), [])
        self.send(node, wrench(EPOCH - 400 * MS))
        node.trajectories.publish(trajectory([0]))
        node.efforts.wait(1)

    def test_bad_messages(self):
        node = self.start(live(), {'frame_prefix': 'left/'})
        self.send(node, wrench(EPOCH, frame='left/hand'))
        bad = [
            (wrench(EPOCH + MS, [0, math.nan, 0], frame='left/hand'), 'not finite',
             'its force.y is nan'),
            (wrench(EPOCH + MS, torque=[0, 0, math.inf], frame='left/hand'), 'not finite',
             'its torque.z is inf'),
            (wrench(EPOCH + MS, frame='left/hnad'), 'unknown frame',
             "its frame 'left/hnad' is not 'left/' and a link of robot 'test_arm'"),
            (wrench(EPOCH + MS, frame='hand'), 'unknown frame', "its frame 'hand' is not"),
            (wrench(EPOCH + MS, frame=''), 'unknown frame', "its frame '' is not"),
            (wrench(0, frame='left/hand'), 'zero stamp', 'its stamp is zero'),
            (wrench(EPOCH, frame='left/hand'), 'equal stamp', 'was received before'),
            (wrench(EPOCH - MS, frame='left/hand'), 'too late', 'is behind one received before'),
        ]
        for message, reason, text in bad:
            count = int(node.diagnostics()['dropped: ' + reason])
            self.send(node, message)
            values = node.wait_for_count('dropped: ' + reason, count + 1)
            self.assertIn(node.name + '/wrench/push: ', values['last drop'])
            self.assertIn(text, values['last drop'])
        self.assertEqual(int(node.diagnostics()['dropped']), len(bad))
        for text in ('its force.y is nan', "its frame 'left/hnad'"):
            node.wait_for_line('WARN', text)
        node.trajectories.publish(trajectory([0, 50 * MS]))
        self.assertEqual(len(node.efforts.wait(2)), 2)


if __name__ == '__main__':
    run(LiveWrenches)
