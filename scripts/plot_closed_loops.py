#!/usr/bin/python3
"""Draws the examples with closed loops and the forces in them.

Usage: plot_closed_loops.py OFFLINE_TOOL FOLDER [EXAMPLE ...]

OFFLINE_TOOL is the executable inverse_dynamics_offline. For each example it computes the motion of
config/<example>_trajectory.yaml. FOLDER/<example>.png shows the mechanism, the efforts of its motors and
forces in its joints: the magnitudes of forces that rigid bodies determine and, dashed, components that
the scene's policy chooses.
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
import yaml
from matplotlib.ticker import MaxNLocator
from scipy.interpolate import make_interp_spline

PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ROWS = 400
STYLE = {'font.size': 9, 'axes.titlesize': 10, 'axes.spines.top': False, 'axes.spines.right': False,
         'axes.grid': True, 'grid.alpha': 0.3}
DRAWN_AT = 0.3  # of the duration
SHADOWS = (0.2, 0.62)

# For each example: title; joints or closures whose forces are shown; their components.
EXAMPLES = {
    'four_bar': ('Planar four-bar linkage',
                 ['crank_joint', 'coupler_joint', 'rocker_joint', 'rocker_pin'], 'xy'),
    'slider_crank': ('Slider-crank', ['crank_joint', 'rod_joint', 'wrist_pin', 'slider_joint'], 'xy'),
    'andrews_squeezer': ("Andrews' squeezing mechanism", ['beta', 'E_BDE', 'E_EG', 'E_HE'], 'xy'),
    'planar_3rrr': ('Planar 3-RRR manipulator', ['wrist_1', 'wrist_2', 'wrist_3'], 'xy'),
    'stewart_gough': ('Stewart-Gough platform',
                      ['ball_1_z', 'ball_2', 'ball_3', 'ball_4', 'ball_5', 'ball_6'], 'xyz'),
    'spatial_parallelogram': ('Spatial parallelogram', ['ball_1', 'ball_2', 'ball_3_z'], 'xyz'),
}


def rotation(axis, angle):
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def vector(text, default):
    return np.array([float(x) for x in (text or default).split()])


class Robot:
    """Positions of the links of a description with closures."""

    def __init__(self, urdf, scene):
        self.joints = []
        for joint in xml.parse(urdf).getroot().findall('joint'):
            origin, axis = joint.find('origin'), joint.find('axis')
            self.joints.append({
                'name': joint.get('name'), 'type': joint.get('type'),
                'parent': joint.find('parent').get('link'),
                'child': joint.find('child').get('link'),
                'xyz': vector(origin is not None and origin.get('xyz'), '0 0 0'),
                'axis': vector(axis is not None and axis.get('xyz'), '1 0 0')})
        children = {joint['child'] for joint in self.joints}
        self.root = next(j['parent'] for j in self.joints if j['parent'] not in children)
        self.names = [j['name'] for j in self.joints if j['type'] != 'fixed']
        self.closures = scene['closures']
        self.springs = scene.get('springs', [])

    def poses(self, q):
        poses = {self.root: (np.eye(3), np.zeros(3))}
        while len(poses) <= len(self.joints):
            for joint in self.joints:
                if joint['parent'] not in poses:
                    continue
                R, o = poses[joint['parent']]
                position = q.get(joint['name'], 0)
                o = o + R @ joint['xyz']
                if joint['type'] == 'prismatic':
                    o = o + R @ joint['axis'] * position
                elif joint['type'] != 'fixed':
                    R = R @ rotation(joint['axis'], position)
                poses[joint['child']] = (R, o)
        return poses

    def point(self, poses, link, xyz):
        R, o = poses[link]
        return o + R @ np.array(xyz, float)

    def frame_point(self, poses, frame):
        return self.point(poses, frame['link'], frame.get('xyz', (0, 0, 0)))

    def gaps(self, q):
        poses = self.poses(q)
        return np.concatenate([self.frame_point(poses, c['child']) -
                               self.frame_point(poses, c['parent']) for c in self.closures])

    def close(self, q, given):
        """Moves the joints that are not given until the closures' points meet."""
        passive = [name for name in self.names if name not in given]
        for _ in range(20):
            gaps = self.gaps(q)
            if np.abs(gaps).max() < 1e-10:
                return q
            step = 1e-6
            slopes = [(self.gaps({**q, name: q[name] + step}) - gaps) / step for name in passive]
            for name, change in zip(passive, np.linalg.lstsq(np.array(slopes).T, -gaps,
                                                             rcond=1e-6)[0]):
                q[name] += change
        raise SystemExit('The loops cannot be closed.')

    def drawing(self, q):
        """Polylines of links in space, and where each joint and closure is."""
        poses = self.poses(q)
        points = {link: [poses[link][1]] for link in poses if link != self.root}
        places = {}
        for joint in self.joints:
            R, o = poses[joint['parent']]
            foot = o + R @ joint['xyz']
            places[joint['name']] = poses[joint['child']][1]
            if joint['parent'] in points:
                points[joint['parent']].append(foot)
            if joint['type'] == 'prismatic' and joint['parent'] != self.root:
                points[joint['child']].append(foot)
        for closure in self.closures:
            places[closure['name']] = self.frame_point(poses, closure['child'])
            for frame in (closure['parent'], closure['child']):
                points[frame['link']].append(self.frame_point(poses, frame))
        for spring in self.springs:
            places['spring'] = [self.point(poses, spring['link_a'], spring['at_a']),
                                self.point(poses, spring['link_b'], spring['at_b'])]
            points[spring['link_b']].append(places['spring'][1])
        lines = []
        for corners in points.values():
            different = []
            for p in corners:
                if all(np.linalg.norm(p - other) > 1e-9 for other in different):
                    different.append(p)
            if len(different) > 2:  # a plate, with its corners in order around their middle
                centre = np.mean(different, axis=0)
                different.sort(key=lambda p: np.arctan2(*(p - centre)[1::-1]))
                different.append(different[0])
            lines.append(np.array(different))
        return lines, places


def motion_of(trajectory):
    """The minimum-jerk law through the via points: the quintic spline between rests."""
    times = [point['time'] for point in trajectory['via_points']]
    positions = np.array([point['positions'] for point in trajectory['via_points']])
    rest = [(1, np.zeros(positions.shape[1])), (2, np.zeros(positions.shape[1]))]
    return times[-1], make_interp_spline(times, positions, k=5, bc_type=(rest, rest))


def compute(tool, name, trajectory, folder, options=()):
    duration, law = motion_of(trajectory)
    t = np.linspace(0, duration, ROWS + 1)
    table = np.column_stack([t, law(t), law(t, 1), law(t, 2)])
    header = ['time'] + [kind + '.' + joint for kind in ('position', 'velocity', 'acceleration')
                         for joint in trajectory['joints']]
    path = os.path.join(folder, 'motion.csv')
    np.savetxt(path, table, delimiter=',', header=','.join(header), comments='', fmt='%.17g')
    config = os.path.join(PACKAGE, 'config', name + '_scene.yaml')
    done = subprocess.run([tool, '--urdf', os.path.join(PACKAGE, 'urdf', name + '.urdf'), '--scene',
                           config, '--motion', path, *options], stdout=subprocess.PIPE, check=True,
                          text=True)
    rows = list(csv.reader(done.stdout.splitlines()))
    values = np.array([[float(cell or 'nan') for cell in row] for row in rows[1:]])
    return t, law, {column: values[:, i] for i, column in enumerate(rows[0])}


def draw_mechanism(axes, robot, states, results, row, shown, flat):
    cut = slice(0, 2) if flat else slice(0, 3)
    for i, q in enumerate(states):
        lines, places = robot.drawing(q)
        last = i == len(states) - 1
        for line in lines:
            axes.plot(*line[:, cut].T, color='tab:blue' if last else '0.8', linewidth=3 if last else 2,
                      solid_capstyle='round', zorder=2 if last else 1)
    if 'spring' in places:
        axes.plot(*np.array(places.pop('spring'))[:, cut].T, ':', color='tab:green', linewidth=2)
    for joint in robot.joints:
        if joint['type'] == 'prismatic' and joint['parent'] == robot.root:
            axes.plot(*places[joint['name']][cut], 's', color='tab:blue', markersize=18, zorder=2)
    joints = np.array(list(places.values()))
    axes.plot(*joints[:, cut].T, 'o', color='white', markeredgecolor='black', markersize=5,
              linestyle='none', zorder=3)
    forces = {name: np.array([results['reaction.%s.f%s' % (name, x)][row] *
                              results['determined.%s.f%s' % (name, x)][row] for x in 'xyz'])
              for name in shown}
    size = np.ptp(joints[:, cut], axis=0).max()
    scale = 0.35 * size / max(np.linalg.norm(f[cut]) for f in forces.values())
    for name, force in forces.items():
        start, end = places[name][cut], places[name][cut] + scale * force[cut]
        if flat:
            axes.annotate('', end, start, zorder=4,
                          arrowprops={'arrowstyle': '-|>', 'color': 'tab:red', 'linewidth': 1.5})
        else:
            axes.quiver(*start, *(end - start), color='tab:red', linewidth=1.5,
                        arrow_length_ratio=0.15)
        axes.plot(*end[:, None], alpha=0)  # makes room
    pad = 4 if flat else 10
    axes.set_xlabel('x [m]', labelpad=pad)
    axes.set_ylabel('y [m]', labelpad=pad)
    if flat:
        axes.set_aspect('equal', adjustable='datalim')
    else:
        axes.set_zlabel('z [m]')
        axes.set_box_aspect([np.ptp(limits()) for limits in
                             (axes.get_xlim, axes.get_ylim, axes.get_zlim)])
        axes.view_init(20, -70)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_major_locator(MaxNLocator(4))


def draw(tool, name, path):
    title, shown, components = EXAMPLES[name]
    flat = components == 'xy'
    with open(os.path.join(PACKAGE, 'config', name + '_scene.yaml')) as file:
        scene = yaml.safe_load(file)
    with open(os.path.join(PACKAGE, 'config', name + '_trajectory.yaml')) as file:
        trajectory = yaml.safe_load(file)
    with tempfile.TemporaryDirectory() as folder:
        t, law, results = compute(tool, name, trajectory, folder)
    robot = Robot(os.path.join(PACKAGE, 'urdf', name + '.urdf'), scene)
    q = {joint: 0.0 for joint in robot.names}
    q.update({start['name']: start['position'] for start in scene.get('assembly', [])})
    states = {}
    for row in range(ROWS + 1):
        q.update(zip(trajectory['joints'], law(t[row])))
        states[row] = dict(robot.close(q, trajectory['joints']))
    row = int(DRAWN_AT * ROWS)

    plt.rcParams.update(STYLE)
    figure = plt.figure(figsize=(12, 5.4))
    figure.suptitle(title, fontsize=12)
    grid = figure.add_gridspec(2, 2, left=0.06, right=0.87, bottom=0.09, top=0.88, wspace=0.28,
                               hspace=0.32, width_ratios=(1, 1.15))
    left = figure.add_subplot(grid[:, 0], **({} if flat else {'projection': '3d'}))
    rows = [int(share * ROWS) for share in SHADOWS] + [row]
    draw_mechanism(left, robot, [states[i] for i in rows], results, row, shown, flat)
    left.set_title('At %.2g s (grey: %s s); red: forces on child links' % (
        t[row], ', '.join('%.2g' % t[i] for i in rows[:-1])))

    upper = figure.add_subplot(grid[0, 1])
    slides = [j['name'] for j in robot.joints if j['type'] == 'prismatic']
    for joint in scene['actuated']:
        upper.plot(t, results['effort.' + joint], label=joint)
    upper.set_ylabel('[N]' if scene['actuated'][0] in slides else '[N m]')
    upper.set_title('Efforts of the motors')
    lower = figure.add_subplot(grid[1, 1], sharex=upper)
    for i, joint in enumerate(shown):
        parts = np.array([results['reaction.%s.f%s' % (joint, x)] for x in components])
        known = np.array([results['determined.%s.f%s' % (joint, x)].min() for x in components])
        color = 'C%d' % i
        lower.plot(t, np.linalg.norm(parts[known == 1], axis=0), color=color, label=joint)
        for part, x, is_known in zip(parts, components, known):
            if not is_known:
                lower.plot(t, part, '--', color=color, label='%s, f%s' % (joint, x))
    lower.set_ylabel('[N]')
    lower.set_xlabel('time [s]')
    lower.xaxis.set_major_locator(MaxNLocator(6))
    lower.set_title('Forces in joints%s%s' % (
        ', in the plane' if flat else '',
        '; dashed: not determined' if len(lower.lines) > len(shown) else ''))
    for axes in (upper, lower):
        axes.axvline(t[row], color='0.6', linewidth=0.8)
        axes.legend(loc='center left', bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def draw_all(arguments, usage, examples, draw):
    """Draws the examples of a command line, OFFLINE_TOOL FOLDER [EXAMPLE ...]; its exit code."""
    if len(arguments) < 2 or arguments[0].startswith('-'):
        print(usage)
        return 2
    tool, folder = arguments[:2]
    unknown = set(arguments[2:]) - set(examples)
    if unknown:
        raise SystemExit('No such example: %s' % ', '.join(sorted(unknown)))
    os.makedirs(folder, exist_ok=True)
    for name in arguments[2:] or examples:
        draw(tool, name, os.path.join(folder, name + '.png'))
    return 0


if __name__ == '__main__':
    sys.exit(draw_all(sys.argv[1:], __doc__, EXAMPLES, draw))
