#!/usr/bin/python3
"""An excavator whose boom has no encoder at its pin, but one that reads the length of its ram."""
import math
import os
import random
import shutil
import subprocess
import tempfile

import numpy as np
import rosbag
from trajectory_msgs.msg import JointTrajectory
import yaml

from closed_loops import SLIDER_CRANK, SLIDER_CRANK_SCENE, STEP, LoopTest, by_name
from encoder_streams import LAG, MS, Swings
from node_under_test import (EPOCH, Node, Polynomials, executable, joint_state, read, ros_time, run,
                             trajectory_point)
from rigid_bodies import RigidBodies

EXCAVATOR = read('..', '..', 'urdf', 'excavator.urdf')
JOINTS = ['boom_joint', 'stick_joint', 'bucket_joint']
MEASURED = ['stick_joint', 'bucket_joint']
RAMS = ['boom_ram', 'stick_ram', 'bucket_ram']
# Where each joint is on its parent: x and z, m.
PINS = {'boom_ram': (0.3, 1.0), 'stick_ram': (2.3, 0), 'bucket_ram': (1.2, 0)}
MOTION = Swings(boom_joint=(-0.4, 0.2, 0.3), stick_joint=(1.4, 0.3, 0.4),
                bucket_joint=(0.6, 0.4, 0.5))
LEARNT = EPOCH + 1500 * MS
# Forces of cubics: the rounding of the estimator, as in tests of joints.
ESTIMATED = 1e-8
# What the closures tell is found to some roundings.
EXACT = 1e-11
# Of the largest force of each ram, with noise: two to three times what comes out.
ACCURACY = [0.01, 0.02, 0.04]


def scene():
    loaded = yaml.safe_load(read('..', '..', 'config', 'excavator_scene.yaml'))
    del loaded['payload']
    loaded['given'] = ['boom_ram'] + MEASURED
    return loaded


def ram(name, angle):
    """Length of a ram, and its first two derivatives to the angle of the joint that it moves."""
    entry = next(c for c in scene()['cylinders'] if c['name'] == name)
    x, _, z = entry['at_b']
    c, s = math.cos(angle), math.sin(angle)
    arm = np.array([x * c + z * s, z * c - x * s])
    tangent = np.array([arm[1], -arm[0]])
    span = np.array(PINS[name]) + arm - np.array(entry['at_a'])[[0, 2]]
    length = math.sqrt(span @ span)
    slope = span @ tangent / length
    return length, slope, (tangent @ tangent - span @ arm - slope ** 2) / length


def forces(motion):
    """Of the rams, N, by virtual work at each joint: each ram moves one."""
    bodies = RigidBodies(EXCAVATOR)
    return [bodies.effort(joint, *motion) / ram(name, motion[0][joint])[1]
            for joint, name in zip(JOINTS, RAMS)]


def efforts(message):
    values = by_name(message, message.effort)
    return [values[name] for name in RAMS]


class GivenLengths(LoopTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name, content=None):
        path = os.path.join(self.folder, name)
        if content is not None:
            with open(path, 'w', encoding='utf-8') as file:
                file.write(content)
        return path

    def tool(self, motion, output):
        subprocess.run([executable('inverse_dynamics_offline'), '--urdf',
                        self.path('robot.urdf', EXCAVATOR), '--scene',
                        self.path('scene.yaml', yaml.safe_dump(scene())), '--motion', motion,
                        '--output', output], check=True)

    def assertBagMatches(self, states, messages):
        """Results of a bag of joint states are the node's, to the last bit."""
        with rosbag.Bag(self.path('run.bag'), 'w') as bag:
            for state in states:
                bag.write('/joint_states', state, state.header.stamp)
        self.tool(self.path('run.bag'), self.path('results.bag'))
        with rosbag.Bag(self.path('results.bag')) as bag:
            recorded = [m for topic, m, _ in bag.read_messages() if topic.endswith('/effort')]
        self.assertStamps(recorded, [m.header.stamp.to_nsec() for m in messages])
        for one, other in zip(recorded, messages):
            self.assertEqual((one.name, one.position, one.velocity, one.effort),
                             (other.name, other.position, other.velocity, other.effort))

    def test_noise_and_mixed_rates(self):
        self.start('effort', robot=EXCAVATOR, scene=scene())
        noise = random.Random(3)
        states = []
        for i in range(1000):  # of 250 Hz
            ns = EPOCH + 4 * MS * i
            q, _, _ = MOTION(ns)
            states.append(joint_state(ns, {name: q[name] + noise.gauss(0, 2e-5) for name in MEASURED}))
        for i in range(400):  # of 100 Hz
            ns = EPOCH + 10 * MS * i + 300000
            q, qd, _ = MOTION(ns)
            length, slope, _ = ram('boom_ram', q['boom_joint'])
            states.append(joint_state(ns, {'boom_ram': length + noise.gauss(0, 1e-5)},
                                      {'boom_ram': slope * qd['boom_joint'] + noise.gauss(0, 1e-3)}))
        states.sort(key=lambda state: state.header.stamp)
        for state in states:
            self.states.publish(state)
        newest = EPOCH + 4 * MS * 999
        # The first instant is that of a joint after the first length.
        stamps = [ns for ns in range(EPOCH + 4 * MS, newest - LAG + 1, 4 * MS)]
        messages = self.recorders['effort'].wait(len(stamps))
        self.assertStamps(messages, stamps)
        largest, worst = np.zeros(3), np.zeros(3)
        angle = 0
        for message in messages:
            ns = message.header.stamp.to_nsec()
            if ns < LEARNT:
                continue
            expected = np.array(forces(MOTION(ns)))
            largest = np.maximum(largest, abs(expected))
            worst = np.maximum(worst, abs(expected - efforts(message)))
            angle = max(angle, abs(by_name(message, message.position)['boom_joint'] -
                                   MOTION(ns)[0]['boom_joint']))
        print('forces off by', worst, 'N of', largest, 'N, boom by %.2g rad' % angle)
        for error, force, share in zip(worst, largest, ACCURACY):
            self.assertLess(error, share * force)
        self.assertLess(angle, 1e-4)
        self.assertBagMatches(states, messages)
        values = self.node.diagnostics()
        self.assertEqual(values['joints waited for'], 'none')
        self.assertEqual(values['passive joints'], 'from the closures')
        self.assertRegex(values['samples of boom_ram'], r'10[0-9.]* ms|100[0-9.]* Hz')
        self.assertIn('or lengths are given', self.node.output())

    def test_exact_states_against_a_table(self):
        self.start('effort', robot=EXCAVATOR, scene=scene())
        motion = Polynomials(boom_ram=(1.0, 0.05, -0.04, 0.03), stick_joint=(1.4, -0.3, 0.2),
                             bucket_joint=(0.6, 0.5, -0.4, 0.2))
        stamps = [EPOCH + STEP * i for i in range(60)]
        states = [joint_state(ns, *motion(ns)[:2]) for ns in stamps]
        # Of the boom they may say what they like.
        for state in states:
            state.name.append('boom_joint')
            state.position.append(-1.0)
            state.velocity.append(0)
            self.states.publish(state)
        messages = self.recorders['effort'].wait(len(stamps) - 5)
        self.assertStamps(messages, stamps[:-5])
        names = ['boom_ram'] + MEASURED
        rows = ['time,' + ','.join('%s.%s' % (kind, name) for kind in
                                   ('position', 'velocity', 'acceleration') for name in names)]
        for ns in stamps:
            rows.append(','.join('%.17g' % value for value in [(ns - EPOCH) / 1e9] + [
                values[name] for values in motion(ns) for name in names]))
        self.tool(self.path('motion.csv', '\n'.join(rows) + '\n'), self.path('results.csv'))
        with open(self.path('results.csv'), encoding='utf-8') as file:
            header, *lines = [line.split(',') for line in file.read().splitlines()]
        columns = [header.index('effort.' + name) for name in RAMS]
        for line, message in zip(lines, messages):
            wanted = [float(line[column]) for column in columns]
            self.assertClose(efforts(message), wanted, ESTIMATED, 'forces')
            self.assertGreater(min(map(abs, wanted)), 50)
        self.assertBagMatches(states, messages)

    def test_trajectories_have_joints(self):
        self.start('effort', robot=EXCAVATOR, scene=scene())
        for names in (JOINTS, MEASURED):
            message = JointTrajectory(joint_names=names)
            message.header.stamp = ros_time(EPOCH)
            for i in range(5):
                message.points.append(trajectory_point(STEP * i, names, MOTION(EPOCH + STEP * i)))
            self.trajectories.publish(message)
        for i, effort in enumerate(self.recorders['effort'].wait(5)):
            expected = forces(MOTION(EPOCH + STEP * i))
            self.assertClose(efforts(effort), expected, EXACT, 'forces')
        values = self.node.wait_for_count('dropped: passive joints', 1)
        self.assertIn("too little is given: the motion of 'boom_joint' does not follow from it",
                      values['last drop'])

    def test_what_is_missing_or_wrong_is_named(self):
        self.start('effort', robot=EXCAVATOR, scene=scene())
        self.states.publish(joint_state(EPOCH, {'stick_joint': 1.4, 'bucket_joint': 0.6}))
        self.node.diagnostics(lambda v: v['joints waited for'] == 'boom_ram', 'what is waited for')
        self.node.wait_for_line('WARN', 'joints boom_ram have not been received in 5 s')
        self.states.publish(joint_state(EPOCH, {'boom_ram': float('nan')}))
        values = self.node.wait_for_count('dropped: not finite', 1)
        self.assertIn("the position of 'boom_ram' is nan", values['last drop'])

    def test_angles_and_poses_stop_the_start(self):
        pose = dict(scene(), given=['pose.bucket'])
        pin = dict(SLIDER_CRANK_SCENE, given=['wrist_pin'])
        for robot, refused, words in (
                (EXCAVATOR, pose, "the pose of 'bucket'"),
                (SLIDER_CRANK, pin, "the angle of 'wrist_pin'")):
            node = Node(self, robot, {'scene': refused})
            self.assertNotEqual(node.wait(), 0)
            fatal = node.lines('FATAL')
            self.assertEqual(len(fatal), 1, node.output())
            self.assertIn('given: joint states have joints and lengths of cylinders and slides, but '
                          'not ' + words, fatal[0])


if __name__ == '__main__':
    run(GivenLengths)
