#!/usr/bin/python3
"""Contacts in bags that inverse_dynamics_offline writes: their frames, where they stick, and their gaps."""
import math
import os
import random
import shutil
import subprocess
import tempfile

import rosbag
from std_msgs.msg import Bool
import yaml

from node_under_test import EPOCH, NodeTest, executable, joint_state, ros_time, run

G = 9.81
STEP = 2000000  # ns
LAG = 0.05  # s
SLIDER = """<robot name="slider"><link name="rail"/><link name="column"/><link name="foot"><inertial>
  <origin xyz="0 0 0"/><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="along" type="prismatic"><parent link="rail"/><child link="column"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="up" type="prismatic"><parent link="column"/><child link="foot"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>"""
EXACT = 1e-9  # of the estimator, for joints that rest


class RecordedContacts(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def compute(self, contact, states, others=()):
        """The messages of results, by topic, of joint states (ns, along, up)."""
        scene = {'contacts': [dict({'name': 'foot_point', 'link': 'foot', 'plane': {'link': 'rail'}},
                                   **contact)], 'motion': 'static'}
        for name, text in (('r.urdf', SLIDER), ('s.yaml', yaml.safe_dump(scene))):
            with open(self.path(name), 'w', encoding='utf-8') as file:
                file.write(text)
        with rosbag.Bag(self.path('run.bag'), 'w') as bag:
            messages = [(ns, '/joint_states', joint_state(ns, {'along': along, 'up': up}))
                        for ns, along, up in states]
            for ns, topic, message in sorted(messages + list(others), key=lambda each: each[0]):
                bag.write(topic, message, ros_time(ns))
        result = subprocess.run(
            [executable('inverse_dynamics_offline'), '--urdf', self.path('r.urdf'), '--scene',
             self.path('s.yaml'), '--motion', self.path('run.bag'), '--output', self.path('out.bag'),
             '--lag', str(LAG)], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = {}
        with rosbag.Bag(self.path('out.bag')) as bag:
            for topic, message, _ in bag.read_messages():
                found.setdefault(topic, []).append(message)
        return found, result.stderr

    def test_frames_are_recorded(self):
        states = [(EPOCH + i * STEP, 0.3, 0) for i in range(200)]
        found, _ = self.compute({'slip': 'all'}, states)
        frames = found['/tf']
        stamps = [each.transforms[0].header.stamp.to_nsec() for each in frames]
        self.assertGreaterEqual(len(frames), 5)  # 0.35 s of results, at 20 Hz
        self.assertLessEqual(len(frames), 9)
        self.assertGreaterEqual(min(b - a for a, b in zip(stamps, stamps[1:])), 49000000)
        transform = frames[-1].transforms[0]
        self.assertEqual((transform.header.frame_id, transform.child_frame_id), ('rail', 'foot_point'))
        self.assertAlmostEqual(transform.transform.translation.x, 0.3, delta=EXACT)

    def test_what_sticks_does_so_where_it_is_at_the_message(self):
        # It comes to 0.3 m, rests there, and is closed. Then it is where it sticks.
        states = []
        for i in range(600):
            x = 0.3 * min(1, i / 200)
            states.append((EPOCH + i * STEP, x, 0))
        closed_at = EPOCH + 205 * STEP + 1
        found, text = self.compute({'closed': False}, states, [
            (closed_at, '/inverse_dynamics/contact/foot_point', Bool(True))])
        self.assertNotIn('violat', text)
        self.assertIn('touches', text)

    def test_gaps_close_and_open(self):
        noise = random.Random(2)

        def height(i):
            """Down from 2 cm, on the floor, and up again."""
            return 0.02 * (max(0, 1 - i / 300) if i < 700 else min(1, (i - 700) / 300))
        states = [(EPOCH + i * STEP + int(noise.gauss(0, 1e5)), 0.1, height(i) + noise.gauss(0, 2e-5))
                  for i in range(1000)]
        found, text = self.compute({'slip': 'all', 'closed': False, 'gap': {'close': 0.001, 'open': 0.004}},
                                   states)
        efforts = [(each.header.stamp.to_nsec(), each.effort[1])
                   for each in found['/inverse_dynamics/effort']]
        held = [ns for ns, effort in efforts if abs(effort) < 1e-9]  # floor and motor: least efforts
        free = [ns for ns, effort in efforts if abs(effort - 2 * G) < 1e-9]
        self.assertEqual(len(held) + len(free), len(efforts))
        changes = sum(a != b for a, b in zip([abs(e) < 1e-9 for _, e in efforts],
                                             [abs(e) < 1e-9 for _, e in efforts][1:]))
        self.assertEqual(changes, 2)
        for ns, expected in ((held[0], 285), (held[-1], 760)):
            self.assertAlmostEqual((ns - EPOCH) / STEP, expected, delta=3)
        self.assertEqual(text.count("'foot_point' touches"), 1)
        self.assertTrue(math.isfinite(held[0]))


if __name__ == '__main__':
    run(RecordedContacts)
