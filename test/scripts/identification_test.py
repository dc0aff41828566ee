#!/usr/bin/python3
"""What identify.py is made of: bodies, colours of residuals, base parameters, filters, fits."""
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import simulated_recordings as simulated

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from identification import bodies, files  # noqa: E402 (the folder has to be known first)
from identification.base import BaseParameters  # noqa: E402
from identification.colour import Colour  # noqa: E402
from identification.filtering import Filter, chosen_cutoff, pieces  # noqa: E402
from identification.problem import Coupling, Parameter, Piece  # noqa: E402
from identification.solver import Block, Solver  # noqa: E402

CLOSE = 1e-9  # a few roundings, of numbers of size one and of matrices with conditions up to 1e4
DIFFERENCE = 1e-6  # of central differences with steps of 1e-5


def points_of(random, count=8):
    """Masses at places: a body whose parameters are plain sums."""
    return random.uniform(0.1, 1, count), random.normal(size=(count, 3)) * 0.2


def sums(masses, places):
    inertia = sum(m * (p @ p * np.eye(3) - np.outer(p, p)) for m, p in zip(masses, places))
    return np.concatenate([[masses.sum()], masses @ places, inertia[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]])


class Bodies(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(4)
        self.masses, self.places = points_of(self.random)
        self.body = sums(self.masses, self.places)

    def test_pseudo_inertia_is_that_of_points(self):
        expected = sum(m * np.outer(np.append(p, 1), np.append(p, 1)) for m, p in zip(self.masses, self.places))
        np.testing.assert_allclose(bodies.pseudo_inertia(self.body), expected, atol=CLOSE)
        np.testing.assert_allclose(bodies.parameters_of(expected), self.body, atol=CLOSE)

    def test_coordinates_go_there_and_back_with_their_derivatives(self):
        at = bodies.to_coordinates(self.body)
        found, jacobian = bodies.from_coordinates(at)
        np.testing.assert_allclose(found, self.body, atol=CLOSE)
        for i, step in enumerate(1e-5 * np.eye(10)):
            change = bodies.from_coordinates(at + step)[0] - bodies.from_coordinates(at - step)[0]
            np.testing.assert_allclose(jacobian[:, i], change / 2e-5, atol=DIFFERENCE)

    def test_every_coordinate_is_a_body_that_can_be(self):
        for _ in range(50):
            parameters, _ = bodies.from_coordinates(self.random.normal(size=10) * 2)
            self.assertTrue(bodies.is_possible(parameters))
            moments = np.linalg.eigvalsh(bodies.described(parameters)[2])
            self.assertLessEqual(moments[2], (moments[0] + moments[1]) * (1 + 1e-6))
        self.assertFalse(bodies.is_possible(np.array([1, 0, 0, 0, 3, 0, 0, 1, 0, 1.0])))

    def test_mass_centre_and_inertia_about_it_with_their_derivatives(self):
        mass, centre, inertia = bodies.described(self.body)
        self.assertAlmostEqual(mass, self.masses.sum())
        np.testing.assert_allclose(centre, np.average(self.places, axis=0, weights=self.masses), atol=CLOSE)
        about = sums(self.masses, self.places - centre)
        np.testing.assert_allclose(inertia[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]], about[4:], atol=CLOSE)
        jacobian = bodies.described_jacobian(self.body)
        for i, step in enumerate(1e-5 * np.eye(10)):
            ends = [np.concatenate([[m], c, I[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]]) for m, c, I in
                    (bodies.described(self.body + step), bodies.described(self.body - step))]
            np.testing.assert_allclose(jacobian[:, i], (ends[0] - ends[1]) / 2e-5, atol=DIFFERENCE)

    def test_changes_count_relative_to_the_body_in_any_unit_and_place(self):
        change = 0.01 * self.random.normal(size=10)
        size = change @ bodies.metric(self.body) @ change
        moved, moved_with = (sums(m, 1000 * (self.places + 0.3)) for m in (self.masses, self.masses + 0.01))
        here, here_with = self.body, sums(self.masses + 0.01, self.places)
        self.assertAlmostEqual((moved_with - moved) @ bodies.metric(moved) @ (moved_with - moved) /
                               ((here_with - here) @ bodies.metric(here) @ (here_with - here)), 1, places=6)
        self.assertAlmostEqual(self.body @ bodies.metric(self.body) @ self.body, 4)  # the trace of a unit matrix
        self.assertGreater(size, 0)

    def test_the_nearest_body_of_an_impossible_one_can_be(self):
        impossible = np.array([1, 0, 0, 0, 3, 0, 0, 1, 0, 1.0])
        for parameters in (impossible, np.zeros(10), -self.body, self.body):
            near = bodies.nearest_possible(parameters, 0.5, 0.1)
            self.assertGreater(np.linalg.eigvalsh(bodies.pseudo_inertia(near))[0], 0)
        np.testing.assert_allclose(bodies.nearest_possible(self.body, 0.5, 0.1), self.body, atol=CLOSE)


DESCRIPTION = """<robot name="r"><link name="base"/>
  <link name="arm"><inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tool"><inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 3 4"/></joint>
  <joint name="f" type="fixed"><parent link="arm"/><child link="tool"/><origin xyz="0 0 1"/></joint>
</robot>"""


class Files(unittest.TestCase):
    def test_a_body_is_written_with_its_centre_and_what_fixed_joints_hold_is_part_of_it(self):
        masses, places = points_of(np.random.default_rng(6))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'r.urdf')
            pathlib.Path(path).write_text(DESCRIPTION)
            robot = files.Description(path)
            self.assertEqual(robot.size(), 6)
            self.assertEqual(robot.moving_joints(), ['j'])
            robot.with_bodies({'arm': sums(masses, places)}, path)
            links = {link.get('name'): link for link in files.Description(path).root.findall('link')}
        self.assertIsNone(links['tool'].find('inertial'))
        inertial = links['arm'].find('inertial')
        centre = np.average(places, axis=0, weights=masses)
        self.assertAlmostEqual(float(inertial.find('mass').get('value')), masses.sum())
        np.testing.assert_allclose([float(x) for x in inertial.find('origin').get('xyz').split()], centre, atol=CLOSE)
        written = [float(inertial.find('inertia').get(key)) for key in ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')]
        np.testing.assert_allclose(written, sums(masses, places - centre)[4:], atol=CLOSE)

    def test_a_scene_keeps_what_it_says_beside_what_was_found(self):
        scene = {'gravity': [0, 0, -1.62], 'joints': [{'name': 'on', 'stiffness': 3, 'coulomb_velocity': 0.1}]}
        fitted = files.scene_to_fit(scene, ['on', 'j'], 0.02, None)
        self.assertEqual([entry['coulomb_velocity'] for entry in fitted['joints']], [0.1, 0.02])
        found = files.found_scene(fitted, [('on', 'coulomb', 1.5)], {'link': 'arm', 'mass': 1})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 's.yaml')
            files.write_scene(path, found, ['a comment'])
            self.assertEqual(files.read_scene(path), {
                'gravity': [0, 0, -1.62], 'payload': [{'link': 'arm', 'mass': 1}],
                'joints': [{'name': 'on', 'stiffness': 3, 'coulomb_velocity': 0.1, 'coulomb': 1.5}]})


class Couplings(unittest.TestCase):
    def test_coupled_friction_acts_on_both_joints_by_the_work_that_it_takes(self):
        class Motion:
            coordinates = efforts = ['x', 'a', 'b']
            velocities = np.array([[5, 3, 1.0], [5, 0.001, -0.004]])
            described = np.zeros((2, 3))
        for sign in (1, -1):
            speed = Motion.velocities[:, 1] + sign * Motion.velocities[:, 2]
            viscous, dry = Coupling('a', 'b', sign).columns(Motion, 0.01)
            np.testing.assert_allclose(np.sum(viscous * Motion.velocities, axis=1), speed ** 2)
            np.testing.assert_allclose(viscous[:, 0], 0)
            s = np.clip(speed / 0.01, -1, 1)
            np.testing.assert_allclose(np.sum(dry * Motion.velocities, axis=1), speed * s * (3 - s ** 2) / 2)


class Colours(unittest.TestCase):
    def test_variance_of_a_mean_is_that_of_the_closed_form(self):
        random = np.random.default_rng(2)
        follows, rows = 0.8, 20000
        noise = simulated.coloured(random, (rows, 2), 1, follows) * [1, 3]
        few = 50
        columns = np.zeros((rows, 2))
        columns[rows // 2:rows // 2 + few, 1] = 1 / few
        found = np.sum(Colour([noise]).of_rows([columns]) ** 2)
        lags = np.arange(1, few)
        expected = 9 / few * (1 + 2 * np.sum((1 - lags / few) * follows ** lags))
        self.assertAlmostEqual(found / expected, 1, delta=0.1)  # of 20000 rows, 0.02 is one deviation

    def test_what_is_left_is_white(self):
        random = np.random.default_rng(3)
        noise = simulated.coloured(random, (4000, 1), 1, 0.9)
        colour = Colour([noise[:2500], noise[2500:]])
        white = colour.white_pieces([noise])[:, 0]
        self.assertGreaterEqual(colour.order, 1)
        self.assertLess(abs(np.corrcoef(white[1:], white[:-1])[0, 1]), 0.05)  # three deviations of 4000 rows

    def test_white_noise_has_no_order(self):
        self.assertEqual(Colour([np.random.default_rng(5).normal(size=(2000, 3))]).order, 0)


class Base(unittest.TestCase):
    def test_two_links_in_a_plane_have_six_and_their_sums(self):
        # Columns of the closed form, in order: Izz, hx, hy and m of link 1, then of link 2.
        random = np.random.default_rng(1)
        l, g = 0.7, 9.81
        rows = []
        for _ in range(40):
            q1, q2, v1, v2, a1, a2 = random.uniform(-3, 3, 6)
            c1, s1, c2, s2, c12, s12 = (f(x) for x in (q1, q2, q1 + q2) for f in (np.cos, np.sin))
            w, a = 2 * v1 * v2 + v2 ** 2, 2 * a1 + a2
            rows.append([a1, g * c1, -g * s1, 0, a1 + a2, l * (c2 * a - s2 * w) + g * c12,
                         -l * (s2 * a + c2 * w) - g * s12, l * l * a1 + g * l * c1])
            rows.append([0, 0, 0, 0, a1 + a2, l * (c2 * a1 + s2 * v1 ** 2) + g * c12,
                         l * (-s2 * a1 + c2 * v1 ** 2) - g * s12, 0])
        columns = np.array(rows).T
        for units in (np.ones(8), np.full(8, 1e-10), np.full(8, 1e10), 10.0 ** random.uniform(-5, 5, 8)):
            base = BaseParameters(columns * units[:, None])
            self.assertEqual(base.kept, [0, 1, 2, 4, 5, 6])
            self.assertEqual(base.unseen, [3])
            self.assertEqual(set(base.sums), {7})
            self.assertEqual(set(base.sums[7]), {0, 1})
            self.assertAlmostEqual(base.sums[7][0] * units[0] / units[7], l * l, places=7)
            self.assertAlmostEqual(base.sums[7][1] * units[1] / units[7], l, places=7)
        names = ['Izz1', 'hx1', 'hy1', 'm1', 'Izz2', 'hx2', 'hy2', 'm2']
        self.assertEqual(BaseParameters(columns).text(0, names), 'Izz1 + 0.49 m2')


class Filters(unittest.TestCase):
    def test_low_pass_keeps_phase_and_half_of_the_power_twice_at_the_cut_off(self):
        times = np.arange(0, 20, 0.002)
        low_pass = Filter(times, 5.0)
        rows = low_pass.rows(times)
        for frequency, gain in ((0.5, 1), (5, 0.5), (40, 0)):  # forward and back: the square of 1/sqrt(2)
            wave = np.sin(2 * np.pi * frequency * times)[:, None]
            expected = gain * np.sin(2 * np.pi * frequency * rows)
            inside = slice(5, -5)  # the ends, where the filter begins, are the same on both sides of a fit
            np.testing.assert_allclose(low_pass(times, wave)[inside, 0], expected[inside], atol=0.01)
        self.assertAlmostEqual(low_pass.period, 1 / 12.5)

    def test_uneven_rows_come_to_an_even_grid(self):
        random = np.random.default_rng(1)
        times = np.sort(np.arange(0, 10, 0.01) + random.uniform(-0.003, 0.003, 1000))
        low_pass = Filter(times, 3.0)
        rows = low_pass.rows(times)
        np.testing.assert_allclose(np.diff(rows), low_pass.period)
        np.testing.assert_allclose(low_pass(times, np.sin(times)[:, None])[:, 0], np.sin(rows), atol=1e-3)

    def test_nothing_is_filtered_across_gaps_and_rows_that_are_not_good(self):
        times = np.concatenate([np.arange(0, 1, 0.01), np.arange(2, 3, 0.01)])
        good = np.ones(len(times), dtype=bool)
        good[150] = False
        self.assertEqual(pieces(times, good), [slice(0, 100), slice(100, 150), slice(151, 200)])

    def test_cut_off_follows_the_motion(self):
        times = np.arange(0, 60, 0.002)
        slow = np.column_stack([np.sin(2 * np.pi * times), 1e-3 * np.random.default_rng(1).normal(size=len(times))])
        self.assertAlmostEqual(chosen_cutoff(times, slow), 5, delta=0.5)
        self.assertAlmostEqual(chosen_cutoff(times[::100], slow[::100]), 1)  # a fifth of the rate


class Fits(unittest.TestCase):
    """One effort and columns made up, without a robot."""

    def piece(self, columns, truth, noise):
        measured = truth @ columns[:, :, 0] + noise
        rows = len(measured)
        return Piece(np.arange(rows) * 0.02, measured[:, None], np.zeros((rows, 1)), columns)

    def speed(self, random, rows):
        times = np.arange(rows) * 0.02
        return sum(random.normal() * np.sin(2 * np.pi * k * times / 20 + random.uniform(0, 6)) for k in (1, 2, 3, 5))

    def columns(self, speed):
        return np.array([speed, np.tanh(speed / 0.02), np.ones_like(speed)])[:, :, None]

    def parameters(self):
        return [Parameter(kind, 'j', 0.0, i) for i, kind in enumerate(('damping', 'coulomb', 'offset'))]

    def test_deviations_are_those_of_repeated_draws_of_coloured_noise(self):
        random = np.random.default_rng(11)
        truth = np.array([2, 3, -1.0])
        columns = self.columns(self.speed(random, 800))
        off, plain = [], []
        for _ in range(150):
            noise = simulated.coloured(random, (800, 1), 1, 0.9)[:, 0]
            piece = self.piece(columns, truth, noise)
            solution = Solver(self.parameters(), [piece], [5, 5, 5]).solve()
            off.append([(solution.x[i] - truth[i]) / solution.deviation(i) for i in range(3)])
            naive = np.sqrt(np.diag(np.linalg.inv(columns[:, :, 0] @ columns[:, :, 0].T)) * noise.var())
            plain.append((solution.x - truth) / naive)
        # 450 numbers, correlated by three: one deviation of their rms is about 0.06.
        self.assertAlmostEqual(np.sqrt(np.mean(np.square(off))), 1, delta=0.18)
        self.assertGreater(np.mean(np.abs(off) < 3), 0.985)
        self.assertGreater(np.sqrt(np.mean(np.square(plain))), 2.5)  # as if rows were independent

    def test_a_joint_that_turns_one_way_has_an_offset_and_no_dry_friction(self):
        random = np.random.default_rng(3)
        speed = 1.5 + 0.5 * np.sin(np.arange(600) * 0.05)
        piece = self.piece(self.columns(speed), np.array([2, 3, -1.0]), 0.05 * random.normal(size=600))
        solution = Solver(self.parameters(), [piece], [1, 1, 1]).solve()
        self.assertEqual(solution.held, {1: 'cannot be told from offset of j'})
        self.assertAlmostEqual(solution.x[2], 2, delta=3 * solution.deviation(2))
        self.assertGreater(solution.deviation(2), 0.5)  # as dry friction might be part of it

    def test_what_moves_too_little_is_named(self):
        random = np.random.default_rng(3)
        piece = self.piece(self.columns(1e-4 * self.speed(random, 600)), np.array([2, 0, -1.0]),
                           0.05 * random.normal(size=600))
        solution = Solver(self.parameters(), [piece], [0.1, 0.1, 0.1]).solve()
        self.assertIn('too little motion', solution.held[0])
        self.assertAlmostEqual(solution.x[2], -1, delta=0.1)

    def test_friction_is_not_negative(self):
        random = np.random.default_rng(5)
        piece = self.piece(self.columns(self.speed(random, 600)), np.array([1.5, -0.5, 0.2]),
                           0.05 * random.normal(size=600))
        solution = Solver(self.parameters(), [piece], [1, 1, 1]).solve()
        self.assertEqual(solution.at_bound, {1})
        self.assertEqual(solution.x[1], 0)

    def test_a_body_stays_one_that_can_be(self):
        random = np.random.default_rng(8)
        truth = bodies.body(2.0, [0.1, 0, 0], 1e-5)  # nearly a point: noise alone makes it impossible
        columns = random.normal(size=(10, 400, 1))
        piece = self.piece(columns, truth, 0.5 * random.normal(size=400))
        free = np.linalg.lstsq(columns[:, :, 0].T, piece.measured[:, 0], rcond=None)[0]
        self.assertFalse(bodies.is_possible(free))
        parameters = [Parameter('payload_' + kind, 'l', 0.0, i) for i, kind in enumerate(bodies.KINDS)]
        block = Block(0, np.zeros(10), bodies.body(1.0, np.zeros(3), 0.01), 1e-4)
        solution = Solver(parameters, [piece], np.ones(10), [block]).solve()
        self.assertTrue(bodies.is_possible(solution.x))
        for i in range(4):
            self.assertAlmostEqual(solution.x[i], truth[i], delta=4 * solution.deviation(i))


if __name__ == '__main__':
    unittest.main()
