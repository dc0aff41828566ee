#!/usr/bin/python3
"""Bags as they are found: messages that cannot be, topics of other types and other names, wrenches
in frames of tf, contacts that would have to pull. What inverse_dynamics_offline makes of them."""
import os
import shutil
import struct
import subprocess
import tempfile

from geometry_msgs.msg import Vector3Stamped
import numpy as np
import rosbag
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory
import yaml

from closed_loops import SLIDER_CRANK, SLIDER_CRANK_SCENE, SliderCrank
from node_live_wrenches_test import (AXES, COORDINATES, MOTION, MS, UNEVEN, live, ramp, trajectory,
                                     wrench)
from node_loop_positions_test import ASSEMBLY
from node_under_test import EPOCH, NodeTest, executable, joint_state, read, ros_time, run
from node_wrench_frames_test import AT, EXACT, TURN, efforts, frame, pose_of
from recorded_inputs_test import planned, states_of_arm
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
# 10 kg, half a metre out on a beam that turns about y.
BEAM = '''<robot name="beam"><link name="base"/>
  <link name="beam"><inertial><origin xyz="0.5 0 0"/><mass value="10"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pin" type="continuous"><parent link="base"/><child link="beam"/>
    <axis xyz="0 1 0"/></joint></robot>'''
CABLE = '''gravity: [0, 0, -10]
actuated: []
cylinders: [{name: cable, link_a: base, at_a: [0.5, 0, 1], link_b: beam, at_b: [0.5, 0, 0],
             pulls_only: true}]'''


class RecordedFaults(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)
        self.write('arm.urdf', ARM)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), 'w', encoding='utf-8') as file:
            file.write(text)

    def bag(self, messages, name='run.bag'):
        """Of messages by topic, each 10 ms after the one before."""
        with rosbag.Bag(self.path(name), 'w') as bag:
            for i, (topic, message) in enumerate(messages):
                bag.write(topic, message, ros_time(EPOCH + i * 10 * MS), raw=isinstance(message, tuple))

    def tool(self, *options, code=0, motion=('run.bag',)):
        words = [executable('inverse_dynamics_offline'), '--motion', *motion, '--output', 'results.bag',
                 *options]
        if '--urdf' not in options and '--rosparam' not in options:
            words += ['--urdf', 'arm.urdf']
        done = subprocess.run(words, cwd=self.folder, stderr=subprocess.PIPE, encoding='utf-8',
                              check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(os.path.exists(self.path('results.bag')), code == 0)
        return done.stderr

    def results(self, topic='/inverse_dynamics/effort'):
        with rosbag.Bag(self.path('results.bag')) as bag:
            return [message for _, message, _ in bag.read_messages(topics=[topic])]

    def states(self, first=0, last=60, topic='/joint_states'):
        return [(topic, message) for _, message in states_of_arm(first, last)]

    def test_a_stamp_that_ros_cannot_have(self):
        class Raw:
            data = b''

            def write(self, data):
                self.data += data
        good, raw = self.states(), Raw()
        good[50][1].serialize(raw)
        data = raw.data[:4] + struct.pack('<II', 0xffffffff, 4000000000) + raw.data[12:]
        bad = (JointState._type, data, JointState._md5sum, JointState)
        self.bag(good[:50] + [('/joint_states', bad)] + good[50:])
        text = self.tool()
        self.assertIn('/joint_states: 1 message dropped (internal), first message 51: Time is out of '
                      'dual 32-bit range', text)
        damaged = [message.effort for message in self.results()]
        self.bag(good)
        self.tool()
        self.assertEqual(damaged, [message.effort for message in self.results()])
        self.assertGreater(len(damaged), 30)

    def test_wrenches_in_frames_of_tf(self):
        """Told after the wrenches, which wait; placed against a link or moving beside the robot."""
        def plate(ns):
            t = (ns - EPOCH) / 1e9
            return pose_of(TURN, AT + np.array([t, -2 * t, 0.5 * t]))
        stamps = [EPOCH + i * 70 * MS for i in range(-1, 6)]
        still = [('/tf_static', TFMessage([frame('forearm', 'sensor', 0, pose_of(TURN, AT))]))]
        moving = [('/tf', TFMessage([frame('world', 'stand', ns, np.eye(4)),
                                     frame('world', 'plate', ns, plate(ns))]))
                  for ns in (EPOCH + i * 10 * MS for i in range(-30, 60))]
        taken = [ns - EPOCH for ns in stamps[1:]]
        bodies = RigidBodies(ARM)
        self.write('scene.yaml', repr(live()))
        for name, frames, times, pose in (
                ('sensor', still, UNEVEN, lambda motion, ns: bodies.reaction(
                    'elbow', *motion).pose @ pose_of(TURN, AT)),
                ('plate', moving, taken, lambda motion, ns: plate(ns))):
            pushes = [('/inverse_dynamics/wrench/push', wrench(ns, *ramp(ns), frame=name))
                      for ns in stamps]
            self.bag(pushes + frames + [('/joint_trajectory', trajectory(times))])
            text = self.tool('--scene', 'scene.yaml')
            self.assertNotIn('dropped', text)
            messages = self.results()
            self.assertEqual(len(messages), len(times))
            for message in messages:
                ns = message.header.stamp.to_nsec()
                self.assertClose(message.effort, efforts(
                    bodies, MOTION(ns), COORDINATES, AXES, ['slide'], pose(MOTION(ns), ns),
                    *ramp(ns)), EXACT, '%s at %d' % (name, ns))
        lost = [('/inverse_dynamics/wrench/push', wrench(ns, frame='nowhere')) for ns in stamps]
        self.bag(pushes[:1] + lost + frames + [('/joint_trajectory', trajectory([0]))])
        text = self.tool('--scene', 'scene.yaml')
        self.assertIn("wrench/push: 7 messages dropped (unknown frame), first message 2: its frame "
                      "'nowhere' is not a link", text)
        self.assertIn('and tf tells of no way from it to one at stamp', text)

    def test_topics_of_other_types(self):
        self.bag(self.states(0, 30) + [('/joint_trajectory', String('home'))] + self.states(30))
        note = ("note: run.bag: topic '/joint_trajectory' is of 'std_msgs/String', and "
                'joint_trajectory is read from trajectory_msgs/JointTrajectory; it is left alone\n')
        self.assertIn(note, self.tool())
        os.remove(self.path('results.bag'))
        self.assertNotIn(note, self.tool('--remap', 'joint_trajectory:='))
        os.remove(self.path('results.bag'))
        self.tool('--remap', 'joint_trajectory:=/joint_trajectory', code=1)
        # Another type in the second part only.
        self.bag(self.states(0, 30) + [('/joint_trajectory', planned(EPOCH))], 'a.bag')
        self.bag([('/joint_trajectory', String('home'))] + self.states(30), 'b.bag')
        self.assertIn("topic '/joint_trajectory' is of 'std_msgs/String'",
                      self.tool(motion=('a.bag', 'b.bag')))
        os.remove(self.path('results.bag'))
        self.bag([('/joint_states', Float64(1))], 'b.bag')
        text = self.tool(motion=('a.bag', 'b.bag'), code=1)
        self.assertIn("topic '/joint_states' is of 'std_msgs/Float64'", text)
        self.write('scene.yaml', repr(live()))
        text = self.tool('--scene', 'scene.yaml', '--remap', 'wrench/push:=', code=2)
        self.assertIn("--remap wrench/push:= leaves out what has the applied wrench 'push'", text)

    def test_joint_states_of_the_namespace(self):
        other = [('/joint_states', joint_state(EPOCH + 4 * MS * i, {
            'shoulder': 0.0, 'elbow': 0.0, 'slide': 0.0})) for i in range(60)]
        own = self.states(topic='/cell/joint_states')
        self.bag([message for pair in zip(other, own) for message in pair])
        node = ('--node', '/cell/inverse_dynamics')
        for options, topic in ((node, '/cell/joint_states'), ((), '/joint_states'),
                               (('--remap', 'joint_states:=/cell/joint_states'), '/cell/joint_states'),
                               ((*node, '--topic', '/joint_states'), '/joint_states')):
            self.assertIn('note: run.bag: %s: 60 messages;' % topic, self.tool(*options))
        os.remove(self.path('results.bag'))
        self.tool('--topic', '/joint_states', '--remap', 'joint_states:=/x', code=2)

    def test_trajectories_only(self):
        self.bag([('/joint_trajectory', planned(EPOCH)), ('/joint_trajectory', planned(EPOCH, 5))])
        # Trajectories are exact: nothing is written on topics of deviations.
        text = self.tool('--deviations')
        self.assertIn("note: run.bag: /joint_trajectory: 2 messages; 25 results each on "
                      "'/inverse_dynamics/", text)
        self.assertIn('2 results on', text)
        self.assertNotIn(' 0 results', text)
        with rosbag.Bag(self.path('results.bag')) as bag:
            for topic, info in bag.get_type_and_topic_info().topics.items():
                self.assertTrue(info.message_count == 0 or topic == '/tf_static' or
                                "'%s'" % topic in text, topic)
        os.remove(self.path('results.bag'))
        self.bag([('/joint_trajectory', JointTrajectory(joint_names=['shoulder']))])
        text = self.tool(code=1)
        self.assertIn('error: run.bag: /joint_trajectory: no result of 1 message\n', text)

    def test_cables_that_would_push(self):
        self.write('beam.urdf', BEAM)
        self.write('cable.yaml', CABLE)
        # Held, and then accelerated downwards by three times what gravity does.
        angles = [0.0] * 50 + [50.0 * (0.004 * i) ** 2 for i in range(25)]
        self.bag([('/joint_states', joint_state(EPOCH + 4 * MS * i, {'pin': angle}))
                  for i, angle in enumerate(angles)])
        text = self.tool('--urdf', 'beam.urdf', '--scene', 'cable.yaml')
        found = [line for line in text.splitlines() if "the force of 'cable'" in line]
        self.assertEqual(len(found), 1, text)
        self.assertRegex(found[0], r"^warning: run.bag: the force of 'cable' would have to act the "
                                   r'other way in \d+ samples$')
        pushes = sum(value > 0 for message in self.results()
                     for name, value in zip(message.name, message.effort) if name == 'cable')
        self.assertIn(' in %d samples' % pushes, found[0])

    def test_closed_loops(self):
        """A dead centre in one sample, and a slider that is a millimetre off in five."""
        self.write('dump.yaml', yaml.safe_dump({
            'robot_description': SLIDER_CRANK, 'inverse_dynamics': {
                'estimator': {'acceleration': 'zero'},
                'scene': dict(SLIDER_CRANK_SCENE, actuated=['slider_joint'], assembly=ASSEMBLY)}}))
        motions = [SliderCrank(angle, 0, 0).q for angle in (-0.04, -0.02, 0, 0.02, 0.04, 0.06, 0.08)]

        def lines():
            self.bag([('/joint_states', joint_state(EPOCH + 10 * MS * i, q))
                      for i, q in enumerate(motions)])
            text = self.tool('--rosparam', 'dump.yaml')
            self.assertEqual(len(self.results()), 7, text)
            return [line for line in text.splitlines() if line.startswith('warning: ')]
        singular = lines()
        self.assertEqual(len(singular), 1, singular)
        self.assertRegex(singular[0], 'warning: run.bag: 1 sample in singular positions; left out: '
                                      'effort of crank_joint, effort of rod_joint, effort of slider_joint, '
                                      'reaction of crank_joint')
        motions = [dict(q, slider_joint=q['slider_joint'] + 1e-3 * (i != 1 and i != 2))
                   for i, q in enumerate(motions)]
        found = lines()
        self.assertEqual(len(found), 2, found)
        self.assertEqual(found[1], singular[0])
        self.assertRegex(found[0], '^warning: run.bag: 5 samples violate a closed loop by more than 1e-06, '
                                   "positions of closure 'wrist_pin' the most, by 0.00[0-9]+ relative$")

    def test_dumps(self):
        self.bag(self.states())
        robot = 'robot_description: %r\n' % ARM.replace('\n', ' ')
        self.write('dump.yaml', robot + 'inverse_dynamics: {estimator: {lag: 0.1}}')
        self.assertNotIn('has no parameters', self.tool('--rosparam', 'dump.yaml'))
        text = self.tool('--rosparam', 'dump.yaml', '--node', 'inverse_dynamic')
        self.assertIn('note: dump.yaml: has no parameters of /inverse_dynamic, so that all are the '
                      'default ones\n', text)
        os.remove(self.path('results.bag'))
        # As rosparam has them: y is a text, on is true.
        self.write('dump.yaml', robot + 'inverse_dynamics: {certificates: y}')
        self.assertIn("got the text 'y'", self.tool('--rosparam', 'dump.yaml', code=1))
        for text in ('1e3', '1.5e3', '+.5', 'N'):
            self.write('dump.yaml', robot + 'inverse_dynamics: {frame_prefix: %s, certificates: on}' % text)
            self.assertEqual(yaml.safe_load(text), text)
            self.tool('--rosparam', 'dump.yaml')
            self.assertEqual(self.results()[0].header.frame_id, text + 'stand')
            os.remove(self.path('results.bag'))
        for text in ('1.5e+3', '1.', '.5', '-7', 'Off'):
            self.write('dump.yaml', robot + 'inverse_dynamics: {frame_prefix: %s}' % text)
            self.assertNotIsInstance(yaml.safe_load(text), str)
            self.assertIn('~frame_prefix: expected text, got the ',
                          self.tool('--rosparam', 'dump.yaml', code=1))

    def test_gravity_from_many_messages(self):
        """Scenes that no sample needs are not compiled."""
        down = []
        for i in range(20):
            message = Vector3Stamped()
            message.header.frame_id, message.vector.z = 'stand', -9.0 - i
            down.append(('/inverse_dynamics/gravity', message))
        self.bag(self.states(0, 30) + down + self.states(30))
        text = self.tool()
        self.assertIn('/inverse_dynamics/gravity: 1 change of the scene, first message 20:', text)
        self.write('scene.yaml', 'gravity: [0, 0, -28]')
        changed = self.results()[-1].effort
        self.tool('--scene', 'scene.yaml', '--remap', 'gravity:=')
        self.assertEqual(changed, self.results()[-1].effort)


if __name__ == '__main__':
    run(RecordedFaults)
