#!/usr/bin/python3
"""Bags and files in which encoders of wheels, odometry and the joints of an arm contradict each other by their
noise, jitter and rates: efforts against those of the motion itself."""
import csv
import os
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
from sensor_msgs.msg import JointState

from node_under_test import executable, run

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')
URDF = os.path.join(ROOT, 'urdf', 'mobile_manipulator.urdf')
SCENE = os.path.join(ROOT, 'config', 'mobile_manipulator_scene.yaml')
RADIUS, HALF_TRACK = 0.08, 0.2  # m, those of the description
JOINTS = ('base_x', 'base_y', 'base_yaw', 'left_wheel', 'right_wheel', 'pan', 'shoulder', 'elbow')
LENGTH = 8.0  # s
EPOCH = 1600000000.5  # s
SPLIT = (  # joints, Hz, step of the encoder and standard deviation, rad or m
    (('base_x', 'base_y', 'base_yaw'), 50, 0, 5e-4),
    (('left_wheel', 'right_wheel'), 100, 2 * np.pi / 4096, 0),
    (('pan', 'shoulder', 'elbow'), 200, 2 * np.pi / 65536, 0))


class Course:
    """A base that speeds up, slows down and turns, with its arm swinging: all joints, exactly as wheels that do
    not slip demand, by integrals of the base's speeds."""

    def __init__(self):
        self.t = np.linspace(0, LENGTH, 80001)
        t = self.t
        v, w = 0.5 * np.sin(0.8 * t) + 0.3, 0.6 * np.sin(1.1 * t + 0.3)
        a, turn = 0.4 * np.cos(0.8 * t), 0.66 * np.cos(1.1 * t + 0.3)
        yaw = self.integral(w)
        c, s = np.cos(yaw), np.sin(yaw)
        left, right = (v - HALF_TRACK * w) / RADIUS, (v + HALF_TRACK * w) / RADIUS
        self.q = {'base_x': self.integral(v * c), 'base_y': self.integral(v * s), 'base_yaw': yaw,
                  'left_wheel': self.integral(left), 'right_wheel': self.integral(right),
                  'pan': 0.9 * np.sin(1.3 * t), 'shoulder': -0.4 + 0.3 * np.sin(1.7 * t),
                  'elbow': 0.8 + 0.4 * np.cos(1.1 * t)}
        self.qd = {'base_x': v * c, 'base_y': v * s, 'base_yaw': w, 'left_wheel': left, 'right_wheel': right,
                   'pan': 1.17 * np.cos(1.3 * t), 'shoulder': 0.51 * np.cos(1.7 * t),
                   'elbow': -0.44 * np.sin(1.1 * t)}
        self.qdd = {'base_x': a * c - v * w * s, 'base_y': a * s + v * w * c, 'base_yaw': turn,
                    'left_wheel': (a - HALF_TRACK * turn) / RADIUS,
                    'right_wheel': (a + HALF_TRACK * turn) / RADIUS,
                    'pan': -1.521 * np.sin(1.3 * t), 'shoulder': -0.867 * np.sin(1.7 * t),
                    'elbow': -0.484 * np.cos(1.1 * t)}

    def integral(self, rate):
        """By Simpson's rule, with the middle of each step from the neighbours: errors of 1e-12."""
        h = self.t[1] - self.t[0]
        steps = (rate[1:] + rate[:-1]) * h / 2
        slope = np.gradient(rate, h, edge_order=2)
        steps -= (slope[1:] - slope[:-1]) * h * h / 12
        return np.concatenate([[0], np.cumsum(steps)])

    def at(self, joint, times):
        return np.interp(times, self.t, self.q[joint])


class RecordedWheels(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.course = Course()

    def path(self, name):
        return os.path.join(self.folder, name)

    def tool(self, *arguments):
        done = subprocess.run([executable('inverse_dynamics_offline'), '--urdf', URDF, '--scene', SCENE, *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        return done.returncode, done.stderr

    def efforts(self, path):
        with open(path) as file:
            rows = list(csv.DictReader(file))
        times = np.array([float(row['time']) for row in rows])
        return times, {name: np.array([float(row['effort.' + name]) for row in rows]) for name in JOINTS}

    def truth(self):
        course, every = self.course, slice(None, None, 20)
        columns = [course.t[every]]
        header = ['time']
        for kind, values in (('position', course.q), ('velocity', course.qd), ('acceleration', course.qdd)):
            for joint in JOINTS:
                header.append(kind + '.' + joint)
                columns.append(values[joint][every])
        np.savetxt(self.path('exact.csv'), np.column_stack(columns), delimiter=',', header=','.join(header),
                   comments='', fmt='%.17g')
        code, text = self.tool('--motion', self.path('exact.csv'), '--output', self.path('truth.csv'))
        self.assertEqual(code, 0, text)
        return self.efforts(self.path('truth.csv'))

    def record(self, groups, seed, slip=None):
        """Joint states of each group at its rate, with jitter; slip: rad/s by which the left wheel runs ahead."""
        rng = np.random.default_rng(seed)
        messages = []
        for joints, rate, step, deviation in groups:
            times = np.arange(int(LENGTH * rate)) / rate
            times = np.clip(times + rng.normal(0, 0.05 / rate, times.size), 0, LENGTH)
            times.sort()
            columns = []
            for joint in joints:
                values = self.course.at(joint, times) + rng.normal(0, deviation, times.size)
                if slip and joint == 'left_wheel':
                    values += slip * np.maximum(times - 4, 0)
                columns.append(np.round(values / step) * step if step else values)
            for time, values in zip(times, np.column_stack(columns)):
                message = JointState(name=list(joints), position=list(values))
                message.header.stamp = rospy.Time.from_sec(EPOCH + time)
                messages.append((time, message))
        messages.sort(key=lambda one: one[0])
        path = self.path('states.bag')
        with rosbag.Bag(path, 'w') as bag:
            for time, message in messages:
                bag.write('/joint_states', message, rospy.Time.from_sec(EPOCH + time + 0.002))
        return path

    def computed(self, bag):
        code, text = self.tool('--motion', bag, '--output', self.path('results.bag'))
        self.assertEqual(code, 0, text)
        times, rows = [], []
        with rosbag.Bag(self.path('results.bag')) as results:
            for _, message, _ in results.read_messages('/inverse_dynamics/effort'):
                times.append(message.header.stamp.to_sec() - EPOCH)
                rows.append(dict(zip(message.name, message.effort)))
        return text, np.array(times), {name: np.array([row[name] for row in rows]) for name in JOINTS}

    def test_wheels_and_odometry_agree(self):
        exact_times, exact = self.truth()
        for seed in (1, 2, 3):
            text, times, found = self.computed(self.record(SPLIT, seed))
            self.assertIn('fitted to closures and couplings: ', text)
            middle = (times > 1) & (times < LENGTH - 0.5)
            self.assertGreater(np.count_nonzero(middle), 1000)
            for joint, most in (('left_wheel', 0.04), ('right_wheel', 0.04), ('pan', 0.05), ('shoulder', 0.01),
                                ('elbow', 0.005)):
                expected = np.interp(times, exact_times, exact[joint])[middle]
                error = np.sqrt(np.mean(np.square(found[joint][middle] - expected)))
                print('seed %d: %s: rms error %.4f of %.3f N m' % (seed, joint, error, np.sqrt(np.mean(expected**2))))
                self.assertLess(error, most * np.sqrt(np.mean(np.square(expected))), joint)

    def test_wheel_that_slips_is_told(self):
        text, _, _ = self.computed(self.record(SPLIT, 4, slip=2.0))
        self.assertRegex(text, r'warning: .*violate closures or couplings by more than noise explains: the velocity of '
                               r'.* m/s|rad/s, .* of its standard deviations; wheels slip, or zeros of encoders')

    def test_wrong_radius_is_told(self):
        """Wheels that are three hundredths larger than the description has them: each sample fits its noise, all do not."""
        self.course.q['left_wheel'] = self.course.q['left_wheel'] / 1.03
        self.course.q['right_wheel'] = self.course.q['right_wheel'] / 1.03
        groups = ((JOINTS, 200, 0, 1e-5),)
        text, _, _ = self.computed(self.record(groups, 6))
        self.assertRegex(text, r'warning: .*wheels slip, or zeros of encoders, dimensions or delays are wrong')

    def test_file_of_positions(self):
        """The offline tool estimates and fits, too: its rows had been refused."""
        rng = np.random.default_rng(5)
        times = np.arange(0, LENGTH, 0.005)
        columns = [times]
        for joint in JOINTS:
            columns.append(self.course.at(joint, times) + rng.normal(0, 1e-5, times.size))
        np.savetxt(self.path('noisy.csv'), np.column_stack(columns), delimiter=',', fmt='%.17g',
                   header='time,' + ','.join('position.' + joint for joint in JOINTS), comments='')
        code, text = self.tool('--motion', self.path('noisy.csv'), '--output', self.path('noisy_out.csv'))
        self.assertEqual(code, 0, text)
        self.assertRegex(text, r'note: .*1600 rows fitted to closures and couplings: the ')
        exact_times, exact = self.truth()
        found_times, found = self.efforts(self.path('noisy_out.csv'))
        middle = (found_times > 0.3) & (found_times < LENGTH - 0.3)
        for joint in ('left_wheel', 'right_wheel', 'pan', 'shoulder', 'elbow'):
            expected = np.interp(found_times, exact_times, exact[joint])[middle]
            error = np.sqrt(np.mean(np.square(found[joint][middle] - expected)))
            print('%s: rms error %.5f of %.3f N m' % (joint, error, np.sqrt(np.mean(expected**2))))
            self.assertLess(error, 0.01 * np.sqrt(np.mean(np.square(expected))), joint)


if __name__ == '__main__':
    run(RecordedWheels)
