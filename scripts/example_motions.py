#!/usr/bin/python3
"""Writes the motions of the examples with a root that moves, and of those on wheels.

Usage: example_motions.py FOLDER

FOLDER/<example>_motion.csv has positions of the joints, and position and orientation of the root link in
inertial axes, of which z points up; or, of examples on wheels, positions, velocities and accelerations of the
joints. Each motion ends as it begins, and can be looped.
"""
import os
import sys

import numpy as np

LEGS = {'lf': (1, 1), 'rf': (1, -1), 'lh': (-1, 1), 'rh': (-1, -1)}
# Of urdf/quadruped.urdf, m: hips in the trunk, from hip to thigh sideways, thigh and shank.
HIP = np.array([0.26, 0.08])
SIDE, BONE = 0.09, 0.3


def about(axis, angle):
    """The quaternion x, y, z, w of a turn about a coordinate axis."""
    q = np.zeros(4)
    q[axis], q[3] = np.sin(angle / 2), np.cos(angle / 2)
    return q


def product(a, b):
    w = a[3] * b[3] - a[:3] @ b[:3]
    return np.append(a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3]), w)


def attitude(yaw, pitch, roll):
    return product(product(about(2, yaw), about(1, pitch)), about(0, roll))


def matrix(q):
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def waves(t, *parts):
    """A sum of amplitude * sin(2 pi times / 12 s * t + phase)."""
    return sum(amplitude * np.sin(2 * np.pi * times / 12 * t + phase)
               for amplitude, times, phase in parts)


def sine(angle):
    """The sine of an angle that is given with its two derivatives by time, and those of the sine."""
    value, slope = np.sin(angle[0]), np.cos(angle[0])
    return np.array([value, slope * angle[1], slope * angle[2] - value * angle[1] ** 2])


def cosine(angle):
    return sine(angle + np.array([np.pi / 2, 0, 0]))


def swing(t, duration, middle, amplitude, times, phase=0):
    """middle + amplitude * sin(2 pi times / duration * t + phase), with its derivatives."""
    rate = 2 * np.pi * times / duration
    return np.array([middle, 0, 0]) + amplitude * sine(np.array([rate * t + phase, rate, 0]))


def arm_on_a_ship(t):
    """The six-axis arm at work on the deck of a ship that rolls, pitches and heaves."""
    joints = {'joint_1': waves(t, (0.8, 1, 0)), 'joint_2': -1.3 + waves(t, (0.5, 2, 1)),
              'joint_3': 1.6 + waves(t, (0.6, 2, 2)), 'joint_4': -1.8 + waves(t, (0.5, 3, 0)),
              'joint_5': -1.6 + waves(t, (0.4, 1, 2)), 'joint_6': waves(t, (1.0, 2, 0))}
    position = np.array([waves(t, (0.2, 1, 1)), waves(t, (0.4, 2, 0)), waves(t, (0.8, 2, 1), (0.2, 3, 0))])
    return joints, position, attitude(waves(t, (0.05, 1, 2)), waves(t, (0.08, 2, 2)),
                                      waves(t, (0.26, 2, 0.5)))


def balance_board(t):
    """A person on a board that rocks to and fro on a roller, 0.12 m below its upper side."""
    pitch, roll = waves(t, (0.14, 7, 0), (0.05, 11, 1)), waves(t, (0.06, 5, 2))
    knee = 0.5 + waves(t, (0.15, 7, 1))
    # The ankle keeps the shank from most of the board's pitch; hip and waist keep the trunk upright.
    joints = {'ankle': 0.25 - 0.9 * pitch, 'knee': knee, 'hip': knee - 0.25, 'waist': -0.8 * roll}
    orientation = attitude(0, pitch, roll)
    rolled = np.array([0.12 * pitch, -0.12 * roll, 0.12])
    return joints, rolled, orientation


def lifted(phase):
    """How far a foot is up, 0 to 1, in a step of phase 0 to 1; smooth up to accelerations."""
    phase = np.clip(phase, 0, 1)
    return 64 * (phase * (1 - phase)) ** 3


def leg_angles(foot, fore, left):
    """Hip, thigh and shank of a leg whose foot is at this place in axes of the trunk."""
    x, y, z = foot - np.array([HIP[0] * fore, HIP[1] * left, 0])
    down = np.sqrt(y * y + z * z - SIDE * SIDE)  # in the plane of the leg
    hip = np.arctan2(z, y) + np.arctan2(down, SIDE * left)
    length = np.hypot(x, down)
    bend = np.arccos(length * length / (2 * BONE * BONE) - 1)
    return (hip + np.pi) % (2 * np.pi) - np.pi, np.arctan2(-x, down) + bend / 2, -bend


def quadruped(t):
    """It stands, shifts its weight, and trots on the spot from 1.2 s to 3.6 s."""
    start, step, steps, height = 1.2, 0.4, 6, 0.06
    k = (t - start) / step
    fade = 1 if 0 <= k < steps else 0
    standing = np.sin(2 * np.pi * t / 4.8)
    position = np.array([0.02 * standing, 0.015 * np.sin(4 * np.pi * t / 4.8),
                         0.5 + 0.008 * fade * lifted(k % 1)])
    orientation = attitude(0, 0.03 * standing, 0.02 * np.sin(4 * np.pi * t / 4.8))
    turn, joints = matrix(orientation), {}
    for leg, (fore, left) in LEGS.items():
        swings = fade and (int(k) % 2 == (fore * left > 0))
        foot = np.array([HIP[0] * fore, (HIP[1] + SIDE) * left,
                         height * lifted(k % 1) if swings else 0])
        angles = leg_angles(turn.T @ (foot - position), fore, left)
        joints.update(zip((leg + '_hip', leg + '_thigh', leg + '_shank'), angles))
    return joints, position, orientation


def mobile_manipulator(t):
    """It drives along an arc and back, while its arm swings."""
    duration, circle, wheel, track = 8, 1.2, 0.08, 0.2  # s, m; half the track
    yaw = swing(t, duration, 0.75, 0.75, 1, -np.pi / 2)
    return {'base_x': circle * sine(yaw), 'base_y': np.array([circle, 0, 0]) - circle * cosine(yaw),
            'base_yaw': yaw, 'left_wheel': (circle - track) / wheel * yaw,
            'right_wheel': (circle + track) / wheel * yaw, 'pan': swing(t, duration, 0, 1.2, 2),
            'shoulder': swing(t, duration, -0.9, 0.4, 1, 1), 'elbow': swing(t, duration, 1.4, 0.6, 2, 2)}


def turning_rate(m=3, r=0.5, lean=0.3, circle=2, g=9.81):
    """How fast a thin disc, whose contact runs along a circle, goes around it when nothing holds it."""
    across, about = m * r * r / 4, m * r * r / 2
    centre = circle - r * np.sin(lean)  # the circle of its centre
    inertia = (m * r * centre * np.cos(lean) + about * np.cos(lean) * (circle / r - np.sin(lean))
               + across * np.sin(lean) * np.cos(lean))
    return np.sqrt(m * g * r * np.sin(lean) / inertia)


def rolling_disc(t):
    """Steady, once around its circle, in which it spins four times."""
    rate, radius, lean, circle = turning_rate(), 0.5, 0.3, 2
    heading = np.array([rate * t, rate, 0])
    centre = circle - radius * np.sin(lean)
    return {'disc_x': centre * sine(heading), 'disc_y': -centre * cosine(heading),
            'disc_z': np.array([radius * np.cos(lean), 0, 0]), 'heading': heading,
            'lean': np.array([lean, 0, 0]), 'spin': circle / radius * heading}


# Duration and time from row to row, s.
EXAMPLES = {'arm_on_a_ship': (arm_on_a_ship, 12, 0.05), 'balance_board': (balance_board, 12, 0.02),
            'quadruped': (quadruped, 4.8, 0.02), 'mobile_manipulator': (mobile_manipulator, 8, 0.05),
            'rolling_disc': (rolling_disc, 2 * np.pi / turning_rate(), 2 * np.pi / turning_rate() / 120)}


def columns(of):
    """Names and values of a row."""
    if isinstance(of, dict):
        return {kind + '.' + joint: values[i] for i, kind in enumerate(('position', 'velocity', 'acceleration'))
                for joint, values in of.items()}
    joints, position, orientation = of
    return {**{'position.' + joint: value for joint, value in joints.items()},
            **{'root.position.' + axis: value for axis, value in zip('xyz', position)},
            **{'root.orientation.' + axis: value for axis, value in zip('xyzw', orientation)}}


def table(name):
    """The text of the CSV."""
    motion, duration, step = EXAMPLES[name]
    lines = []
    for i in range(round(duration / step) + 1):
        row = columns(motion(i * step))
        if not lines:
            lines.append(','.join(['time', *row]))
        # Wheels that roll tie positions and rates to each other.
        digits = 9 if 'acceleration' in lines[0] else 6
        values = np.round([*row.values()], digits) + 0.0  # no -0
        time = '%.*f' % (2 if step == round(step, 2) else 9, i * step)
        lines.append(','.join([time] + ['%.*f' % (digits, value) for value in values]))
    return '\n'.join(lines) + '\n'


def main(arguments):
    if len(arguments) != 2 or arguments[1].startswith('-'):
        print(__doc__.strip(), file=sys.stderr if len(arguments) != 2 else sys.stdout)
        return 2 if len(arguments) != 2 else 0
    for name in EXAMPLES:
        path = os.path.join(arguments[1], name + '_motion.csv')
        with open(path, 'w', encoding='utf-8') as file:
            file.write(table(name))
        print('wrote', path)
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv))
