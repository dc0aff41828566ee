#!/usr/bin/python3
"""Draws the examples with cylinders and contacts, and the forces in them.

Usage: plot_conditions.py OFFLINE_TOOL FOLDER [EXAMPLE ...]

OFFLINE_TOOL is the executable inverse_dynamics_offline. For each example it computes the motion of
config/<example>_trajectory.yaml. FOLDER/<example>.png shows the mechanism from its side, what the
cylinders exert and what the joints bear.
"""
import os
import sys
import tempfile

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np
import yaml

from plot_closed_loops import PACKAGE, ROWS, STYLE, Robot, compute

DRAWN_AT = (0.0, 0.3, 0.65, 1.0)  # of the duration; the last one in colour
# For each example: title; joints whose forces are shown.
EXAMPLES = {'excavator': ('Excavator: three rams move its arm',
                          ['boom_joint', 'stick_joint', 'bucket_joint'])}


def draw_side(axes, robot, scene, q, last):
    """Links, and cylinders from end to end, in the x-z plane."""
    poses = robot.poses(q)
    drawn = {'color': 'tab:blue' if last else '0.8', 'linewidth': 4 if last else 2}
    for joint in robot.joints:
        ends = [poses[joint['child']][1]]
        below = [j for j in robot.joints if j['parent'] == joint['child']]
        ends += [poses[j['child']][1] for j in below]
        if not below:
            R, o = poses[joint['child']]
            ends.append(o + R @ np.array([0.55, 0, 0.05]))
        axes.plot(*np.array(ends)[:, [0, 2]].T, solid_capstyle='round', **drawn)
        if last:
            axes.plot(*ends[0][[0, 2]], 'o', color='white', markeredgecolor='black', markersize=6, zorder=3)
    for cylinder in scene['cylinders']:
        ends = np.array([robot.point(poses, cylinder['link_' + end], cylinder['at_' + end])
                         for end in 'ab'])
        axes.plot(*ends[:, [0, 2]].T, color='tab:red' if last else '0.88', linewidth=2.5 if last else 1.5)
        for end, link in zip(ends, (cylinder['link_a'], cylinder['link_b'])):
            axes.plot(*np.array([poses[link][1], end])[:, [0, 2]].T, ':', linewidth=1,
                      color=drawn['color'])
        if last:
            axes.annotate(cylinder['name'], ends.mean(axis=0)[[0, 2]], xytext=(6, 6),
                          textcoords='offset points', color='tab:red', zorder=5,
                          bbox={'facecolor': 'white', 'alpha': 0.8, 'linewidth': 0, 'pad': 1})


def draw(tool, name, path):
    title, shown = EXAMPLES[name]
    with open(os.path.join(PACKAGE, 'config', name + '_scene.yaml')) as file:
        scene = yaml.safe_load(file)
    with open(os.path.join(PACKAGE, 'config', name + '_trajectory.yaml')) as file:
        trajectory = yaml.safe_load(file)
    with tempfile.TemporaryDirectory() as folder:
        t, law, results = compute(tool, name, trajectory, folder)
    robot = Robot(os.path.join(PACKAGE, 'urdf', name + '.urdf'), dict(scene, closures=[]))

    plt.rcParams.update(STYLE)
    figure = plt.figure(figsize=(12, 5.4))
    figure.suptitle(title, fontsize=12)
    grid = figure.add_gridspec(2, 2, left=0.06, right=0.87, bottom=0.09, top=0.88, wspace=0.28,
                               hspace=0.32, width_ratios=(1, 1.15))
    left = figure.add_subplot(grid[:, 0])
    rows = [int(share * ROWS) for share in DRAWN_AT]
    for row in rows:
        draw_side(left, robot, scene, dict(zip(trajectory['joints'], law(t[row]))), row == rows[-1])
    left.set_aspect('equal', adjustable='datalim')
    left.set_xlabel('x [m]')
    left.set_ylabel('z [m]')
    left.set_title('At %.2g s (grey: %s s)' % (t[rows[-1]],
                                               ', '.join('%.2g' % t[row] for row in rows[:-1])))
    upper = figure.add_subplot(grid[0, 1])
    for cylinder in scene['cylinders']:
        upper.plot(t, results['effort.' + cylinder['name']] / 1e3, label=cylinder['name'])
    upper.set_ylabel('[kN]')
    upper.set_title('Forces of the rams: positive ones push')
    lower = figure.add_subplot(grid[1, 1], sharex=upper)
    for joint in shown:
        force = np.array([results['reaction.%s.f%s' % (joint, x)] for x in 'xyz'])
        lower.plot(t, np.linalg.norm(force, axis=0) / 1e3, label=joint)
    lower.set_ylabel('[kN]')
    lower.set_xlabel('time [s]')
    lower.set_title('What the pins bear')
    for axes in (upper, lower):
        axes.legend(loc='center left', bbox_to_anchor=(1, 0.5), frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    if len(sys.argv) < 3 or not set(sys.argv[3:]) <= set(EXAMPLES):
        raise SystemExit(__doc__.strip())
    for name in sys.argv[3:] or EXAMPLES:
        draw(sys.argv[1], name, os.path.join(sys.argv[2], name + '.png'))


if __name__ == '__main__':
    main()
