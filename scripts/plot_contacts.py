#!/usr/bin/python3
"""Draws the examples that roll or stand on the ground, and the forces between both.

Usage: plot_contacts.py OFFLINE_TOOL FOLDER [EXAMPLE ...]

OFFLINE_TOOL is the executable inverse_dynamics_offline. For each example it computes the motion of
config/<example>_motion.csv, or of its trajectory, and draws FOLDER/<example>.png. Forces that rigid bodies
do not determine, and that the scene's policy chooses, are dashed.
"""
import csv
import glob
import os
import subprocess
import sys
import tempfile

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np
import yaml

from plot_closed_loops import PACKAGE, ROWS, STYLE, Robot, draw_all, motion_of


def read(rows):
    rows = list(csv.reader(rows))
    values = np.array([[float(cell or 'nan') for cell in row] for row in rows[1:]])
    return {name: values[:, i] for i, name in enumerate(rows[0])}


def run(tool, name, scene, motion):
    """Positions of all joints, and results in axes of the child links, row by row."""
    done = subprocess.run([tool, '--urdf', os.path.join(PACKAGE, 'urdf', name + '.urdf'), '--scene', scene,
                           '--motion', motion, '--axes', 'child', '--positions'], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, check=True, text=True)
    return read(done.stdout.splitlines())


def write_motion(name, path):
    """The rows of a trajectory through via points."""
    with open(os.path.join(PACKAGE, 'config', name + '_trajectory.yaml'), encoding='utf-8') as file:
        trajectory = yaml.safe_load(file)
    duration, law = motion_of(trajectory)
    t = np.linspace(0, duration, ROWS + 1)
    header = ['time'] + [kind + '.' + joint for kind in ('position', 'velocity', 'acceleration')
                         for joint in trajectory['joints']]
    np.savetxt(path, np.column_stack([t, law(t), law(t, 1), law(t, 2)]), delimiter=',',
               header=','.join(header), comments='', fmt='%.17g')


def compute(tool, name):
    """The robot, and its results; those of another scene have its name before their own."""
    config = os.path.join(PACKAGE, 'config', name)
    motion = config + '_motion.csv'
    with tempfile.TemporaryDirectory() as folder:
        if not os.path.exists(motion):
            motion = os.path.join(folder, 'motion.csv')
            write_motion(name, motion)
        results = run(tool, name, config + '_scene.yaml', motion)
        for scene in glob.glob(config + '_*_scene.yaml'):
            for column, values in run(tool, name, scene, motion).items():
                results[os.path.basename(scene)[len(name) + 1:-len('_scene.yaml')] + ' ' + column] = values
    return Robot(os.path.join(PACKAGE, 'urdf', name + '.urdf'), {'closures': []}), results


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
    axes.set(xlabel='x [m]', ylabel='y [m]', zlabel='z [m]', xticks=(-2, 0, 2), yticks=(-2, 0, 2),
             zticks=(0, 1), title='At %.2g s; red: force of the ground' % results['time'][rows[-1]])
    axes.set_aspect('equal')
    axes.view_init(28, -60)


def draw_biped(axes, robot, results):
    """From the front, its left at the right."""
    last = int(0.3 * ROWS)
    for row in (0, int(0.7 * ROWS), last):
        poses = state(robot, results, row)
        body = {'color': 'tab:blue' if row == last else '0.8', 'linewidth': 4 if row == last else 2,
                'solid_capstyle': 'round'}
        for side in ('left', 'right'):
            axes.plot(*outline(poses[side + '_leg'], [(0, 0, 0), (0, 0, -0.85)]).T[1:], **body)
        axes.plot(*np.array([poses['left_leg'][1], poses['right_leg'][1]]).T[1:], **body)
        axes.plot(*np.vstack([outline(poses['pelvis'], [(0, 0, 0)]),
                              outline(poses['trunk'], [(0, 0, 0), (0, 0, 0.6)])]).T[1:], **body)
    for side in ('left', 'right'):
        sole = outline(poses[side + '_leg'], [(0, 0, -0.85)])[0, 1:]
        force = [results['reaction.%s_sole.f%s' % (side, x)][last] for x in 'yz']
        draw_arrow(axes, [sole, sole + 0.001 * np.array(force)])
    axes.axhline(0, color='black', linewidth=1)
    axes.set(xlabel='y [m]', ylabel='z [m]',
             title='At %.2g s; red: forces of the ground' % results['time'][last])
    axes.set_aspect('equal', adjustable='datalim')


def draw_arrow(axes, ends):
    axes.annotate('', ends[1], ends[0], zorder=4,
                  arrowprops={'arrowstyle': '-|>', 'color': 'tab:red', 'linewidth': 1.8})


def turns(joint):
    return lambda results: results['position.' + joint] / (2 * np.pi)


def share(scene, sole):
    return lambda results: (np.abs(results['%sreaction.%s.fy' % (scene, sole)]) /
                            results['%sreaction.%s.fz' % (scene, sole)])


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
    'biped': ('Biped that stands on two feet and shifts its weight', draw_biped, [
        ('Normal forces', 'N', [('reaction.left_sole.fz', 'left_sole', '-'),
                                ('reaction.right_sole.fz', 'right_sole', '-')]),
        ('Forces along y; dashed: both hips push, not determined', 'N', [
            ('passive_hip reaction.left_sole.fy', 'left_sole,\npassive hip', '-'),
            ('passive_hip reaction.right_sole.fy', 'right_sole,\npassive hip', '-'),
            ('reaction.left_sole.fy', 'left_sole', '--'),
            ('reaction.right_sole.fy', 'right_sole', '--')]),
        ('Along the ground over normal, right hip passive', 'N/N', [
            (share('passive_hip ', 'left_sole'), 'left_sole', '-'),
            (share('passive_hip ', 'right_sole'), 'right_sole', '-'),
            (lambda results: 0 * results['time'] + 0.2, 'friction', 'k:')])]),
}


def draw(tool, name, path):
    title, picture, panels = EXAMPLES[name]
    robot, results = compute(tool, name)
    plt.rcParams.update(STYLE)
    figure = plt.figure(figsize=(12, 6.2))
    figure.suptitle(title, fontsize=12)
    grid = figure.add_gridspec(len(panels), 2, left=0.06, right=0.87, bottom=0.09, top=0.9, wspace=0.22,
                               hspace=0.4, width_ratios=(1, 1.1))
    flat = picture is not draw_disc
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
