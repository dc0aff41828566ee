#!/usr/bin/python3
"""Draws the examples that roll or stand on the ground, and the forces between both.

Usage: plot_contacts.py OFFLINE_TOOL FOLDER [EXAMPLE ...]

OFFLINE_TOOL is the executable inverse_dynamics_offline. For each example it computes the motion of
config/<example>_motion.csv and draws FOLDER/<example>.png. Forces that rigid bodies do not determine,
and that the scene's policy chooses, are dashed.
"""
import csv
import os
import subprocess
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np
import yaml

from plot_closed_loops import PACKAGE, STYLE, Robot, draw_all


def read(rows):
    rows = list(csv.reader(rows))
    values = np.array([[float(cell or 'nan') for cell in row] for row in rows[1:]])
    return {name: values[:, i] for i, name in enumerate(rows[0])}


def compute(tool, name):
    """Positions of all joints, and results, row by row."""
    files = {key: os.path.join(PACKAGE, folder, name + end) for key, folder, end in (
        ('urdf', 'urdf', '.urdf'), ('scene', 'config', '_scene.yaml'), ('motion', 'config', '_motion.csv'))}
    done = subprocess.run([tool, *(word for key, path in files.items() for word in ('--' + key, path)),
                           '--axes', 'child', '--positions'], stdout=subprocess.PIPE, check=True, text=True)
    with open(files['scene'], encoding='utf-8') as file:
        scene = yaml.safe_load(file)
    return Robot(files['urdf'], dict(scene, closures=[])), read(done.stdout.splitlines())


def state(robot, results, row):
    return robot.poses({joint: results['position.' + joint][row] for joint in robot.names})


def outline(pose, corners):
    R, o = pose
    return np.array([o + R @ np.array(corner) for corner in corners])


def draw_manipulator(axes, robot, results):
    """From above: path, base, wheels and arm."""
    axes.plot(results['position.base_x'], results['position.base_y'], ':', color='0.5')
    rows = (0, 30, 45, 62)
    for row in rows:
        poses, last = state(robot, results, row), row == rows[-1]
        frame = {'color': 'tab:blue' if last else '0.8', 'linewidth': 2 if last else 1}
        base = outline(poses['base'], [(x, y, 0) for x, y in ((-.16, -.17), (.3, -.17), (.3, .17), (-.16, .17),
                                                              (-.16, -.17))])
        axes.plot(*base.T[:2], **frame)
        for side, y in (('left', 0.2), ('right', -0.2)):
            axes.plot(*outline(poses['base'], [(-.08, y, 0), (.08, y, 0)]).T[:2],
                      color='black' if last else '0.7', linewidth=5 if last else 3)
        arm = np.vstack([poses['turret'][1], poses['forearm'][1],
                         outline(poses['forearm'], [(0.32, 0, 0)])])
        axes.plot(*arm.T[:2], 'o-', color='tab:orange' if last else '0.8', linewidth=3, markersize=4)
    row = rows[-1]
    R, o = state(robot, results, row)['base']
    forces = [[results['reaction.%s_tread.f%s' % (side, x)][row] for x in 'xy'] for side in ('left', 'right')]
    for (along, _), y in zip(forces, (0.2, -0.2)):
        draw_arrow(axes, outline((R, o), [(0, y, 0), (0.03 * along, y, 0)])[:, :2])
    draw_arrow(axes, outline((R, o), [(0, 0, 0), (0, 0.03 * sum(force[1] for force in forces), 0)])[:, :2])
    axes.set(xlabel='x [m]', ylabel='y [m]',
             title='From above, at %.2g s; red: forces on the wheels' %
             results['time'][row])
    axes.set_aspect('equal', adjustable='datalim')


def draw_disc(axes, robot, results):
    """The disc on its circle, seen obliquely."""
    around = np.linspace(0, 2 * np.pi, 61)
    rim = 0.5 * np.column_stack([np.cos(around), 0 * around, np.sin(around)])
    centre = np.column_stack([results['position.disc_' + x] for x in 'xyz'])
    axes.plot(*centre.T, ':', color='0.5')
    rows = (20, 45, 70, 95, 110)
    for row in rows:
        poses, last = state(robot, results, row), row == rows[-1]
        axes.plot(*outline(poses['disc'], rim).T, color='tab:blue' if last else '0.75', linewidth=2)
        axes.plot(*outline(poses['disc'], [(0, 0, 0), (0.5, 0, 0)]).T,
                  color='tab:orange' if last else '0.75', linewidth=2)
        touching = outline(poses['leaning'], [(0, 0, -0.5)])[0]
        force = 0.04 * poses['headed'][0] @ [results['reaction.rim.f' + x][row] for x in 'xyz']
        axes.quiver(*touching, *force, color='tab:red' if last else '0.6', linewidth=1.8, arrow_length_ratio=0.1)
    contact = [outline(state(robot, results, row)['leaning'], [(0, 0, -0.5)])[0]
               for row in range(len(centre))]
    axes.plot(*np.array(contact).T, color='black', linewidth=1)
    axes.set(xlabel='x [m]', ylabel='y [m]', zlabel='z [m]', xticks=(-2, 0, 2), yticks=(-2, 0, 2), zticks=(0, 1),
             title='At %.2g s; red: force of the ground' % results['time'][rows[-1]])
    axes.set_aspect('equal')
    axes.view_init(28, -60)


def draw_arrow(axes, ends):
    axes.annotate('', ends[1], ends[0], zorder=4,
                  arrowprops={'arrowstyle': '-|>', 'color': 'tab:red', 'linewidth': 1.8})


def turns(joint):
    return lambda results: results['position.' + joint] / (2 * np.pi)


def both(first, second):
    return lambda results: results[first] + results[second]


# For each example: title, what draws it, and for each panel its title, unit, and curves: column (or what makes
# one of the results), label, style.
EXAMPLES = {
    'mobile_manipulator': ('Mobile manipulator: two wheels drive base and arm along an arc and back',
                           draw_manipulator, [
        ('Efforts of the wheels', 'N m', [('effort.left_wheel', 'left_wheel', '-'),
                                          ('effort.right_wheel', 'right_wheel', '-')]),
        ('Forces along the treads', 'N', [('reaction.left_tread.fx', 'left_tread', '-'),
                                          ('reaction.right_tread.fx', 'right_tread', '-')]),
        ('Forces across them; dashed: not determined', 'N', [
            (both('reaction.left_tread.fy', 'reaction.right_tread.fy'), 'both together', '-'),
            ('reaction.left_tread.fy', 'left_tread', '--'),
            ('reaction.right_tread.fy', 'right_tread', ':')])]),
    'rolling_disc': ('Disc that leans and rolls in a steady turn, with nothing that drives it', draw_disc, [
        ('Force of the ground, axes of the contact', 'N', [
            ('reaction.rim.fx', 'along', '-'), ('reaction.rim.fy', 'inwards', '-'),
            ('reaction.rim.fz', 'normal', '-')]),
        ('Angles', 'turns', [(turns('heading'), 'heading', '-'), (turns('lean'), 'lean', '-'),
                             (turns('spin'), 'spin', '-')]),
        ('Residuals of the motion: the last digits of the table', 'N m', [('residual.motion.' + angle, angle, '-')
                                            for angle in ('heading', 'lean', 'spin')])]),
}


def draw(tool, name, path):
    title, picture, panels = EXAMPLES[name]
    robot, results = compute(tool, name)
    plt.rcParams.update(STYLE)
    figure = plt.figure(figsize=(12, 6.2))
    figure.suptitle(title, fontsize=12)
    grid = figure.add_gridspec(len(panels), 2, left=0.06, right=0.87, bottom=0.09, top=0.9, wspace=0.22,
                               hspace=0.4, width_ratios=(1, 1.1))
    flat = picture in (draw_manipulator,)
    picture(figure.add_subplot(grid[:, 0], projection=None if flat else '3d'), robot, results)
    for i, (heading, unit, curves) in enumerate(panels):
        axes = figure.add_subplot(grid[i, 1])
        for column, label, style in curves:
            values = column(results) if callable(column) else results[column]
            axes.plot(results['time'], values, style, label=label)
        axes.set(title=heading, ylabel='[%s]' % unit)
        axes.legend(loc='center left', bbox_to_anchor=(1, 0.5), frameon=False)
    axes.set_xlabel('time [s]')
    figure.savefig(path, dpi=100)
    plt.close(figure)


if __name__ == '__main__':
    sys.exit(draw_all(sys.argv[1:], __doc__, EXAMPLES, draw))
