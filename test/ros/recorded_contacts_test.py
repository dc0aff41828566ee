#!/usr/bin/python3
"""Contacts in bags that inverse_dynamics_offline writes: their frames, where they stick, and their gaps;
and what noise, jitter and mixed rates make of their forces."""
import csv
import math
import os
import random
import shutil
import subprocess
import tempfile

import numpy as np
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
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')
ENCODER = 1.2e-5  # rad, standard deviation: 18 bits in a turn
JITTER = 1e-4  # s
FEET = ('left_sole', 'right_sole')


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


class Biped:
    """What urdf/biped.urdf does on both feet, in the plane of y and z: forces by Newton's and Euler's laws
    of its bodies, whose accelerations are differences of their places."""
    FEET = 0.1 + 0.85 * math.sin(0.12)
    # Mass, moment of inertia, place on the body.
    BODIES = {'pelvis': (12, 0.104, 0.04), 'left': (9, 0.54, -0.38), 'right': (9, 0.54, -0.38),
              'trunk': (35, 1.428, 0.3)}

    @staticmethod
    def joints(t):
        """Of the left hip and the waist, rad."""
        return 0.12 + 0.12 * np.sin(2.1 * t), 0.25 * np.sin(1.3 * t + 0.4)

    @staticmethod
    def along(angle, length):
        """The end of a way up the z axis of a body that has turned about x."""
        return np.array([-np.sin(angle) * length, np.cos(angle) * length])

    def bodies(self, t):
        """Angles and places."""
        hip, waist = self.joints(t)
        roll, right = -0.0 * t, -hip
        for _ in range(50):  # the right foot stays where it is
            def open_by(roll, right):
                left_hip = np.array([self.FEET + 0 * t, 0 * t]) - self.along(roll + hip, -0.85)
                across = 0.2 * np.array([np.cos(roll), np.sin(roll)])
                return left_hip - across + self.along(roll + right, -0.85) + np.array([self.FEET + 0 * t, 0 * t])
            e = open_by(roll, right)
            d = 1e-6
            a, b = (open_by(roll + d, right) - e) / d, (open_by(roll, right + d) - e) / d
            det = a[0] * b[1] - a[1] * b[0]
            roll = roll - (e[0] * b[1] - e[1] * b[0]) / det
            right = right - (a[0] * e[1] - a[1] * e[0]) / det
        left_hip = np.array([self.FEET + 0 * t, 0 * t]) - self.along(roll + hip, -0.85)
        pelvis = left_hip - 0.1 * np.array([np.cos(roll), np.sin(roll)])
        right_hip = left_hip - 0.2 * np.array([np.cos(roll), np.sin(roll)])
        angles = {'pelvis': roll, 'left': roll + hip, 'right': roll + right, 'trunk': roll + waist}
        roots = {'pelvis': pelvis, 'left': left_hip, 'right': right_hip,
                 'trunk': pelvis + self.along(roll, 0.12)}
        return {name: (angles[name], roots[name] + self.along(angles[name], body[2]))
                for name, body in self.BODIES.items()}

    def normals(self, t, h=1e-3):
        """The normal forces of the left and the right foot, N."""
        before, now, after = self.bodies(t - h), self.bodies(t), self.bodies(t + h)
        both = moment = 0
        for name, (mass, inertia, _) in self.BODIES.items():
            turn, a = [(after[name][i] - 2 * now[name][i] + before[name][i]) / h ** 2 for i in (0, 1)]
            y, z = now[name][1][0] + self.FEET, now[name][1][1]  # from the right foot
            both = both + mass * (a[1] + G)
            moment = moment + y * mass * (a[1] + G) - z * mass * a[0] + inertia * turn
        left = moment / (2 * self.FEET)
        return left, both - left


class RecordedContacts(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def compute(self, contact, states, others=(), motion='static'):
        """The messages of results, by topic, of joint states (ns, along, up)."""
        scene = {'contacts': [dict({'name': 'foot_point', 'link': 'foot', 'plane': {'link': 'rail'}},
                                   **contact)], 'motion': motion}
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
        _, text = self.compute({'closed': False}, states, [
            (closed_at, '/inverse_dynamics/contact/foot_point', Bool(True))], motion='full')
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

    def test_what_stands_beside_the_plane_violates_nothing(self):
        """Calibration has the foot stand off the plane; it stands there, and sticks or slips."""
        for stand in (0.0015, -0.003):
            for more in ({}, {'slip': 'all'}, {'closed': True}):
                ups = [max(stand, 0.02 - 0.0001 * i) for i in range(800)]
                states = [(EPOCH + i * STEP, 0.1, up) for i, up in enumerate(ups)]
                if 'closed' in more:
                    states = [(ns, along, stand) for ns, along, _ in states]
                _, text = self.compute(dict({'closed': False, 'gap': {'close': 0.002, 'open': 0.006}}, **more),
                                       states)
                # Samples that come down on a contact that is closed already move against it.
                violating = [int(line.split(' samples violate')[0].split()[-1])
                             for line in text.splitlines() if ' samples violate' in line]
                landing = 1 if 'closed' in more else (0.002 - stand) / 0.0001 + 30
                self.assertLessEqual(sum(violating), landing, (stand, more, text))

    def biped(self, rates, output=None):
        """What the tool makes of a recording with noise and jitter, of both joints in each message or, with
        two rates, of one."""
        noise = np.random.default_rng(4)
        messages = []
        for joint, rate in enumerate(rates):
            for i in range(8 * rate):
                t = (i + 0.3 * joint) / rate
                angles = [angle + noise.normal(0, ENCODER) for angle in Biped.joints(t)]
                given = {name: angle for k, (name, angle) in enumerate(zip(('left_hip', 'waist'), angles))
                         if len(rates) == 1 or k == joint}
                messages.append((EPOCH + int(1e9 * (t + noise.normal(0, JITTER))), i, given))
        with rosbag.Bag(self.path('run.bag'), 'w') as bag:
            for stamp, _, given in sorted(messages, key=lambda each: each[:2]):
                bag.write('/joint_states', joint_state(stamp, given), ros_time(stamp))
        with open(os.path.join(ROOT, 'config/biped_passive_hip_scene.yaml'), encoding='utf-8') as file:
            scene = yaml.safe_load(file)
        with open(self.path('s.yaml'), 'w', encoding='utf-8') as file:
            yaml.safe_dump(scene, file)
        result = subprocess.run(
            [executable('inverse_dynamics_offline'), '--urdf', os.path.join(ROOT, 'urdf/biped.urdf'),
             '--scene', self.path('s.yaml'), '--motion', self.path('run.bag'),
             *(['--output', self.path(output)] if output else ['--deviations', '--axes', 'child'])],
            capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def test_forces_of_feet_with_noise_and_jitter(self):
        rows = list(csv.DictReader(self.biped([250]).stdout.splitlines()))
        columns = {name: np.array([float(row[name] or 'nan') for row in rows]) for name in rows[0]}
        # A row is what the joints did when they were measured, at a tick of the clock, which the stamp
        # tells with an error of its own.
        stamps = np.array([int(row['stamp'].replace('.', '')) for row in rows]) - EPOCH
        ticks = np.round(stamps / 4e6) * 4e-3
        self.assertLess(np.max(np.abs(stamps * 1e-9 - ticks)), 6 * JITTER)
        for foot, expected in dict(zip(FEET, Biped().normals(ticks))).items():
            error = columns['reaction.%s.fz' % foot] - expected
            deviation = columns['deviation.%s.fz' % foot]
            self.assertTrue(np.all(deviation > 0))  # in the first row, too
            self.assertLess(deviation[0], 1.2 * deviation[1])
            within = np.mean(np.abs(error) <= 2 * deviation)
            inner = slice(50, -50)
            print('%s: rms error %.3g N of %.3g N, deviation %.3g N, within two deviations %.3f'
                  % (foot, rms(error[inner]), np.mean(expected), rms(deviation[inner]), within))
            self.assertLess(rms(error[inner]), 0.02)
            self.assertLess(rms(error[inner]), 1.1 * rms(deviation[inner]))
            self.assertGreater(within, 0.95)

    def test_joints_at_rates_of_their_own(self):
        self.biped([500, 200], output='out.bag')
        with rosbag.Bag(self.path('out.bag')) as bag:
            for foot in FEET:
                found = [(message.header.stamp.to_nsec(), message.wrench.force.z) for _, message, _ in
                         bag.read_messages('/inverse_dynamics/reaction/' + foot)][100:-100]
                self.assertGreater(len(found), 1000)
                t = (np.array([ns for ns, _ in found]) - EPOCH) * 1e-9
                expected = dict(zip(FEET, Biped().normals(t)))[foot]
                error = np.array([force for _, force in found]) - expected
                print('%s, live at 500 and 200 Hz: rms error %.3g N' % (foot, rms(error)))
                self.assertLess(rms(error), 0.5)


if __name__ == '__main__':
    run(RecordedContacts)
