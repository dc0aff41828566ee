"""Recordings of the six-axis arm whose truth is known: exciting motion, quantised encoders, noisy efforts."""
import csv
import os
import pathlib
import subprocess

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARM = ROOT / 'urdf/six_axis_arm.urdf'
JOINTS = ['joint_%d' % i for i in range(1, 7)]
ENCODER = 2 * np.pi / 2 ** 18  # rad
RATE = 250  # Hz
# Of harmonics of one period; amplitudes fall, so that accelerations stay what an arm can do.
HARMONICS = np.arange(1, 6)


def tool():
    given = os.environ.get('OFFLINE_TOOL')
    places = [pathlib.Path(given)] if given else [
        ROOT / 'build/.catkin_ws/devel/lib/virtual_work_dynamics/inverse_dynamics_offline',
        ROOT / 'build/core/inverse_dynamics_offline']
    return next((str(place) for place in places if os.access(place, os.X_OK)), None)


class Motion:
    """A Fourier series of each joint: positions with exact derivatives."""

    def __init__(self, seed=3, seconds=20.0, period=10.0, size=1.0, rate=RATE):
        random = np.random.default_rng(seed)
        self.times = np.arange(int(seconds * rate)) / rate
        w = 2 * np.pi / period * HARMONICS
        shape = random.normal(size=(6, 2, len(w))) * size / HARMONICS
        angles = np.outer(self.times, w)
        sines, cosines = np.sin(angles), np.cos(angles)
        a, b = shape[:, 0], shape[:, 1]
        self.q = cosines @ a.T + sines @ b.T + random.uniform(-1, 1, 6)
        self.qd = -(sines * w) @ a.T + (cosines * w) @ b.T
        self.qdd = -(cosines * w ** 2) @ a.T - (sines * w ** 2) @ b.T


def write_table(path, header, numbers, digits='%.10g'):
    np.savetxt(path, numbers, delimiter=',', header=','.join(header), comments='', fmt=digits)


def efforts(folder, motion, scene, urdf=ARM):
    """What the arm needs for a motion, by the offline tool."""
    table = os.path.join(folder, 'exact.csv')
    out = os.path.join(folder, 'exact_efforts.csv')
    header = ['time'] + [kind + '.' + name for kind in ('position', 'velocity', 'acceleration') for name in JOINTS]
    write_table(table, header, np.column_stack([motion.times, motion.q, motion.qd, motion.qdd]), '%.17g')
    scene_file = os.path.join(folder, 'truth.yaml')
    pathlib.Path(scene_file).write_text(scene)
    subprocess.run([tool(), '--urdf', str(urdf), '--motion', table, '--scene', scene_file, '--reactions', 'none',
                    '--output', out], check=True, stderr=subprocess.DEVNULL)
    with open(out, newline='') as file:
        rows = list(csv.reader(file))
    columns = [rows[0].index('effort.' + name) for name in JOINTS]
    return np.array([[float(row[i]) for i in columns] for row in rows[1:]])


def coloured(random, shape, deviation, follows):
    """Noise in which each row follows the one before: autoregression of order one."""
    noise = random.normal(size=shape) * deviation * np.sqrt(1 - follows ** 2)
    for i in range(1, len(noise)):
        noise[i] += follows * noise[i - 1]
    return noise


def record(path, motion, efforts_known, noise, seed, follows=0.9, encoder=ENCODER):
    """Writes a recording: positions as encoders have them, efforts with half white and half coloured noise."""
    random = np.random.default_rng(seed)
    positions = np.round((motion.q + random.uniform(-0.5, 0.5, 6) * encoder) / encoder) * encoder
    shape = efforts_known.shape
    measured = efforts_known + np.asarray(noise) * np.sqrt(0.5) * (
        random.normal(size=shape) + coloured(random, shape, 1, follows))
    header = ['time'] + ['position.' + name for name in JOINTS] + ['effort.' + name for name in JOINTS]
    write_table(path, header, np.column_stack([motion.times, positions, measured]))
