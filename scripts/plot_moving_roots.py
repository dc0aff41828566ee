#!/usr/bin/python3
"""Draws the examples with a root that moves, and what they need.

Usage: plot_moving_roots.py OFFLINE_TOOL FOLDER [EXAMPLE ...]

OFFLINE_TOOL is the executable inverse_dynamics_offline. For each example it computes the motion of
config/<example>_motion.csv. FOLDER/<example>.png shows the robot, the efforts of its joints, and what the
world must exert on its root link.
"""
import csv
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np
from scipy.spatial.transform import Rotation

from plot_closed_loops import STYLE, draw_all, vector

PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# For each example: title, description, axes of the picture (0: x), joints whose efforts are shown, rows of
# the table that are drawn, the last one with its force.
EXAMPLES = {
    'arm_on_a_ship': ('Six-axis arm on a ship', 'six_axis_arm', (1, 2),
                      ['joint_1', 'joint_2', 'joint_3'], (0, 40, 100)),
    'balance_board': ('Balance board, by its inertial measurement unit', 'balance_board', (0, 2),
                      ['ankle', 'knee', 'hip', 'waist'], (60, 108, 145)),
    'quadruped': ('Quadruped that stands and trots', 'quadruped', (0, 2),
                  ['lf_hip', 'lf_thigh', 'lf_shank'], (0, 70, 90)),
}


def numbers(element, key, default):
    return vector(element is not None and element.get(key), default)


class Robot:
    """Where the joints of an open chain are."""

    def __init__(self, urdf):
        self._joints = []
        robot = xml.parse(urdf).getroot()
        self._centres = {link.get('name'): numbers(link.find('inertial/origin'), 'xyz', '0 0 0')
                         for link in robot.findall('link')}
        for joint in robot.findall('joint'):
            origin = joint.find('origin')
            self._joints.append((joint.get('name'), joint.get('type'), joint.find('parent').get('link'),
                                 joint.find('child').get('link'), numbers(origin, 'xyz', '0 0 0'),
                                 Rotation.from_euler('xyz', numbers(origin, 'rpy', '0 0 0')),
                                 numbers(joint.find('axis'), 'xyz', '1 0 0')))
        self._root = ({joint[2] for joint in self._joints} - {joint[3] for joint in self._joints}).pop()

    def lines(self, q, position, orientation):
        """A line from each joint to the next ones, or through the last link's middle; inertial axes."""
        poses, lines = {self._root: (orientation, position)}, []
        while len(poses) <= len(self._joints):
            for name, kind, parent, child, xyz, turn, axis in self._joints:
                if parent in poses and child not in poses:
                    outer, place = poses[parent]
                    own = Rotation.identity() if kind == 'fixed' else Rotation.from_rotvec(axis * q[name])
                    poses[child] = (outer * turn * own, place + outer.apply(xyz))
                    lines.append(np.array([place, poses[child][1]]))
        for child in set(poses) - {joint[2] for joint in self._joints}:
            turn, place = poses[child]
            lines.append(np.array([place, place + turn.apply(2 * self._centres[child])]))
        return lines


def read(rows):
    rows = list(csv.reader(rows))
    values = np.array([[float(cell or 'nan') for cell in row] for row in rows[1:]])
    return {name: values[:, i] for i, name in enumerate(rows[0])}


def compute(tool, name, robot):
    motion = os.path.join(PACKAGE, 'config', name + '_motion.csv')
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, 'results.csv')
        subprocess.run([tool, '--urdf', os.path.join(PACKAGE, 'urdf', robot + '.urdf'), '--scene',
                        os.path.join(PACKAGE, 'config', name + '_scene.yaml'), '--motion', motion,
                        '--output', output], check=True, stderr=subprocess.DEVNULL)
        with open(output, encoding='utf-8') as file:
            results = read(file)
    with open(motion, encoding='utf-8') as file:
        return read(file), results


def draw(tool, name, path):
    title, description, plane, shown, drawn = EXAMPLES[name]
    motion, results = compute(tool, name, description)
    robot = Robot(os.path.join(PACKAGE, 'urdf', description + '.urdf'))
    t = results['time']
    positions = np.column_stack([motion['root.position.' + x] for x in 'xyz'])
    turns = Rotation.from_quat(np.column_stack([motion['root.orientation.' + x] for x in 'xyzw']))
    force, moment = (turns.apply(np.column_stack([results['reaction.ground.' + kind + x] for x in 'xyz']))
                     for kind in 'ft')

    plt.rcParams.update(STYLE)
    figure = plt.figure(figsize=(12, 6.6))
    figure.suptitle(title, fontsize=12)
    grid = figure.add_gridspec(3, 2, left=0.06, right=0.88, bottom=0.08, top=0.9, wspace=0.25, hspace=0.42,
                               width_ratios=(1, 1.25))
    left = figure.add_subplot(grid[:, 0])
    for row in drawn:
        last = row == drawn[-1]
        q = {key[len('position.'):]: values[row] for key, values in motion.items()
             if key.startswith('position.')}
        for line in robot.lines(q, positions[row], turns[row]):
            left.plot(*line[:, plane].T, color='tab:blue' if last else '0.8', linewidth=3 if last else 2,
                      solid_capstyle='round', zorder=2 if last else 1)
        left.plot(*positions[row][list(plane)], 's', color='tab:blue' if last else '0.8', markersize=8)
    row = drawn[-1]
    size = max(np.ptp(left.get_xlim()), np.ptp(left.get_ylim()))
    start = positions[row][list(plane)]
    end = start + 0.35 * size * force[row][list(plane)] / np.linalg.norm(force, axis=1).max()
    left.annotate('', end, start, zorder=4,
                  arrowprops={'arrowstyle': '-|>', 'color': 'tab:red', 'linewidth': 1.8})
    left.set_aspect('equal', adjustable='datalim')
    left.set_xlabel('%s [m]' % 'xyz'[plane[0]])
    left.set_ylabel('%s [m]' % 'xyz'[plane[1]])
    left.set_title('At %.2f s (grey: %s s); red: force on the root link' % (
        t[row], ', '.join('%.2f' % t[i] for i in drawn[:-1])))

    plots = [figure.add_subplot(grid[i, 1]) for i in range(3)]
    for joint in shown:
        plots[0].plot(t, results['effort.' + joint], label=joint)
    plots[0].set_title('Efforts')
    for values, axes, what in ((force, plots[1], 'f'), (moment, plots[2], 't')):
        for i, x in enumerate('xyz'):
            axes.plot(t, values[:, i], label=what + x)
    plots[1].set_title("What the world must exert on the root link: force, inertial axes")
    plots[2].set_title("Moment about the root link's origin, inertial axes")
    for axes, unit in zip(plots, ('N m', 'N', 'N m')):
        axes.set_ylabel('[%s]' % unit)
        axes.axvline(t[row], color='0.6', linewidth=0.8)
        axes.legend(loc='center left', bbox_to_anchor=(1.0, 0.5), frameon=False)
    plots[2].set_xlabel('time [s]')
    figure.savefig(path, dpi=100)
    plt.close(figure)


if __name__ == '__main__':
    sys.exit(draw_all(sys.argv[1:], __doc__, EXAMPLES, draw))
