#!/usr/bin/python3
"""Intervals of forces of tables on many legs against SciPy's linear programs on balances of their own."""
import csv
import math
import pathlib
import random
import subprocess
import tempfile
import unittest

import numpy as np
from scipy.optimize import linprog

from simulated_recordings import tool

SIDES = 256  # of the pyramid that a cone counts as, see doc/conditions.md
GRAVITY = 9.81
PEG_TOLERANCE = 1e-6  # of the weight; bounds are up to hundreds of weights
TOLERANCE = 1e-7  # of the largest force; HiGHS meets its constraints to 1e-7
TABLE = '''<robot name="table"><link name="floor"/><link name="top"><inertial>
<origin xyz="{x} {y} 0"/><mass value="{mass}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="stand" type="floating"><parent link="floor"/><child link="top"/></joint></robot>'''


class Table:
    """Feet anywhere on the floor, each with its friction, and a push that the table stands against."""

    def __init__(self, seed):
        r = random.Random(seed)
        self.mass = r.uniform(1, 50)
        self.centre = [r.uniform(-0.45, 0.45), r.uniform(-0.45, 0.45)]
        self.height = r.uniform(0.3, 1.2)
        self.feet = [[x + r.uniform(-0.1, 0.1), y + r.uniform(-0.1, 0.1)]
                     for x, y in r.sample([(-0.4, -0.4), (-0.4, 0.4), (0.4, -0.4), (0.4, 0.4), (0, 0)],
                                          r.choice([4, 4, 5]))]
        self.friction = [r.choice([0.1, 0.3, 0.6, 1.0]) for _ in self.feet]
        self.push = [r.choice([0, 0.1, 0.3]) * self.mass * GRAVITY * r.uniform(-1, 1) for _ in range(2)]

    def files(self, folder):
        (folder / 'r.urdf').write_text(TABLE.format(x=self.centre[0], y=self.centre[1], mass=self.mass))
        contacts = ''.join(
            f'  - {{name: foot_{i}, link: top, at: [{x}, {y}, {-self.height}], friction: {mu},'
            ' plane: {link: floor}}\n'
            for i, ((x, y), mu) in enumerate(zip(self.feet, self.friction)))
        (folder / 's.yaml').write_text(
            'actuated: []\nmotion: static\ncontact_intervals: true\nassembly: [{name: stand.z, position: %r}]\n'
            'applied_wrenches: [{link: top, force: [%r, %r, 0]}]\ncontacts:\n%s'
            % (self.height, self.push[0], self.push[1], contacts))
        names = ['stand.x', 'stand.y', 'stand.z']
        head = ['time'] + [f'position.{name}' for name in names]
        head += [f'orientation.stand.{axis}' for axis in 'xyzw']
        cells = [0, 0, 0, self.height, 0, 0, 0, 1]
        with open(folder / 'm.csv', 'w', newline='') as file:
            csv.writer(file).writerows([head, cells])

    def balance(self):
        """A x = b for the forces of the feet, by component; moments about the table's origin."""
        A = np.zeros((6, 3 * len(self.feet)))
        for i, (x, y) in enumerate(self.feet):
            A[:3, 3 * i:3 * i + 3] = np.eye(3)
            A[3:, 3 * i:3 * i + 3] = [[0, self.height, y], [-self.height, 0, -x], [-y, x, 0]]
        weight = self.mass * GRAVITY
        b = [-self.push[0], -self.push[1], weight,
             weight * self.centre[1], -weight * self.centre[0], 0]
        return A, np.array(b)

    def cones(self):
        """G x <= 0."""
        rows = []
        for i, mu in enumerate(self.friction):
            for side in range(SIDES):
                row = np.zeros(3 * len(self.feet))
                angle = 2 * math.pi * side / SIDES
                row[3 * i:3 * i + 3] = [math.cos(angle), math.sin(angle), -mu]
                rows.append(row)
        return np.array(rows)

    def extreme(self, objective):
        A, b = self.balance()
        scale = self.mass * GRAVITY
        return linprog(objective, A_ub=self.cones(), b_ub=np.zeros(SIDES * len(self.feet)), A_eq=A,
                       b_eq=b / scale, bounds=(None, None), method='highs'), scale


PEG = '''<robot name="peg"><link name="bench"/><link name="peg"><inertial>
<origin xyz="{x} {y} 0"/><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="stand" type="floating"><parent link="bench"/><child link="peg"/></joint></robot>'''


class Peg:
    """Pads around a peg: some can squeeze by any force, others only by what the weight makes them."""
    CENTRE = (0.01, 0.02)
    RADIUS = 0.1
    WEIGHT = 2 * GRAVITY

    def __init__(self, pads, seed):
        r = random.Random(100 * seed + pads)
        self.at, self.axes, self.friction = [], [], []
        for i in range(pads):
            turn = 2 * math.pi * i / pads
            self.at.append([self.RADIUS * math.cos(turn), self.RADIUS * math.sin(turn), r.uniform(-0.05, 0.05)])
            normal = np.array([-math.cos(turn), -math.sin(turn), r.uniform(-0.2, 0.5)])
            normal /= np.linalg.norm(normal)
            side = np.array([normal[2], 0, -normal[0]]) / math.hypot(normal[0], normal[2])  # x of the contact
            self.axes.append(np.array([side, np.cross(normal, side), normal]).T)
            self.friction.append(r.choice([0.01, 0.1, 0.3, 0.5, 1.0]))

    def files(self, folder):
        (folder / 'r.urdf').write_text(PEG.format(x=self.CENTRE[0], y=self.CENTRE[1]))
        contacts = ''.join(
            f'  - {{name: pad_{i}, link: peg, at: {at}, friction: {mu}, plane: {{link: bench, point: {at},'
            f' normal: {axes[:, 2].tolist()}}}}}\n'
            for i, (at, axes, mu) in enumerate(zip(self.at, self.axes, self.friction)))
        (folder / 's.yaml').write_text('actuated: []\nmotion: static\ncontact_intervals: true\ncontacts:\n' + contacts)
        head = ['time'] + [f'position.stand.{axis}' for axis in 'xyz']
        head += [f'orientation.stand.{axis}' for axis in 'xyzw']
        with open(folder / 'm.csv', 'w', newline='') as file:
            csv.writer(file).writerows([head, [0, 0, 0, 0, 0, 0, 0, 1]])

    def normal(self, pad, sign):
        """SciPy's least of sign times what a pad presses with; forces in units of the weight."""
        count = 3 * len(self.at)
        A = np.zeros((6, count))
        rows = []
        for i, (at, axes, mu) in enumerate(zip(self.at, self.axes, self.friction)):
            A[:3, 3 * i:3 * i + 3] = axes
            for j in range(3):
                A[3:, 3 * i + j] = np.cross(at, axes[:, j]) / self.RADIUS
            for side in range(SIDES):
                angle = 2 * math.pi * side / SIDES
                rows.append(np.zeros(count))
                rows[-1][3 * i:3 * i + 3] = [math.cos(angle), math.sin(angle), -mu]
        b = [0, 0, 1, self.CENTRE[1] / self.RADIUS, -self.CENTRE[0] / self.RADIUS, 0]
        objective = np.zeros(count)
        objective[3 * pad + 2] = sign
        found = linprog(objective, A_ub=np.array(rows), b_ub=np.zeros(len(rows)), A_eq=A, b_eq=b,
                        bounds=(None, None), method='highs',
                        options={'primal_feasibility_tolerance': 1e-10, 'dual_feasibility_tolerance': 1e-10})
        return {0: found.fun, 2: math.nan, 3: -math.inf}[found.status]


class ContactIntervals(unittest.TestCase):
    def test_pegs_agree_with_linear_programs(self):
        bounded = unbounded = fails = 0
        for pads, seed in [(n, s) for n in (4, 5, 6, 7, 9) for s in range(8)]:
            peg = Peg(pads, seed)
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                peg.files(folder)
                run = subprocess.run(
                    [tool(), '--urdf', 'r.urdf', '--scene', 's.yaml', '--motion', 'm.csv', '--axes', 'child'],
                    cwd=folder, capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
            row = next(csv.DictReader(run.stdout.splitlines()))
            for i in range(pads):
                for sign, found in ((1, 'lower'), (-1, 'upper')):
                    least = peg.normal(i, sign)
                    cell = row[f'{found}.pad_{i}.fz']
                    if math.isnan(least):
                        fails += 1
                        self.assertEqual(cell, '', (pads, seed, i))
                    elif math.isinf(least):
                        unbounded += 1
                        self.assertEqual(cell, '-inf' if sign > 0 else 'inf', (pads, seed, i, found))
                    else:
                        bounded += 1
                        self.assertLess(abs(float(cell) / peg.WEIGHT - sign * least), PEG_TOLERANCE,
                                        (pads, seed, i, found))
        print(f'{bounded} bounds of pads are finite, {unbounded} are not, {fails} are of pegs that fall')
        self.assertGreater(bounded, 100)
        self.assertGreater(unbounded, 20)

    def test_tables_agree_with_linear_programs(self):
        holds = fails = 0
        worst = 0
        for seed in range(40):
            table = Table(seed)
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                table.files(folder)
                run = subprocess.run(
                    [tool(), '--urdf', 'r.urdf', '--scene', 's.yaml', '--motion', 'm.csv'],
                    cwd=folder, capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
            row = next(csv.DictReader(run.stdout.splitlines()))
            any_forces, _ = table.extreme(np.zeros(3 * len(table.feet)))
            can = any_forces.status == 0
            self.assertIn('can hold' if can else 'cannot hold', run.stderr, f'{seed}: {run.stderr}')
            if not can:
                fails += 1
                self.assertEqual(row['lower.foot_0.fx'], '', seed)
                continue
            holds += 1
            for i in range(len(table.feet)):
                for j, axis in enumerate('xyz'):
                    objective = np.zeros(3 * len(table.feet))
                    objective[3 * i + j] = 1
                    least, scale = table.extreme(objective)
                    most, _ = table.extreme(-objective)
                    for bound, found in ((least.fun, 'lower'), (-most.fun, 'upper')):
                        error = abs(float(row[f'{found}.foot_{i}.f{axis}']) / scale - bound)
                        worst = max(worst, error)
                        self.assertLess(error, TOLERANCE, (seed, i, axis, found))
        self.assertGreater(holds, 8)
        self.assertGreater(fails, 8)
        print(f'{holds} tables hold, {fails} do not; intervals agree to {worst:.1e} of the weight')


if __name__ == '__main__':
    unittest.main()
