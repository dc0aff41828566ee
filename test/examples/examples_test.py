#!/usr/bin/env python3
"""Runs the numbered examples and compares what they print with formulas that stand here.

Usage: examples_test.py FOLDER_OF_BINARIES [UNITTEST_ARGUMENT ...]
"""
import math
import pathlib
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import composed_pendulum_closed_form as pendulum  # noqa: E402 (the path has to be set first)

EXAMPLES = ("01_efforts", "02_reactions", "03_closed_loop", "04_blocks", "05_certificates")
MOST_LINES = 59
NINE_DIGITS = 0.6e-9  # half a unit of the last digit that is printed, and rounding errors
SIX_DIGITS = 0.6e-6
NUMBER = re.compile(r"[-+]?\d+\.\d+(?:e[-+]\d+)?")

folder = None  # of the binaries


def run(name, *arguments):
    return subprocess.run([str(folder / name), *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=60)


def output(name, *arguments):
    found = run(name, *arguments)
    if found.returncode != 0:
        raise AssertionError(f"{name} failed: {found.stderr}")
    return found.stdout.splitlines()


def numbers(line):
    return [float(text) for text in NUMBER.findall(line)]


def derivative(function, x, step=1e-3):
    """By five points; the error is of the order step^4."""
    return (8 * (function(x + step) - function(x - step))
            - (function(x + 2 * step) - function(x - 2 * step))) / (12 * step)


def turn(axis, angle):
    """Rotation matrix about a unit vector, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def vector(element, name, default):
    return np.array([float(x) for x in (default if element is None
                                        else element.get(name, default)).split()])


class Links:
    """Where the links of an open chain are, straight from its description; turning joints only."""

    def __init__(self, urdf, angle):
        robot = ElementTree.parse(urdf).getroot()
        self.origins, self.axes, self.masses = {}, {}, {}  # root axes
        self.children = {}  # of joints
        joints = robot.findall("joint")
        children = {joint.find("child").get("link") for joint in joints}
        root = next(link.get("name") for link in robot.findall("link")
                    if link.get("name") not in children)
        self.origins[root], self.axes[root] = np.zeros(3), np.eye(3)
        while len(self.origins) <= len(joints):
            for joint in joints:
                parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
                if parent in self.origins and child not in self.origins:
                    self._place(joint, parent, child, angle)
        for link in robot.findall("link"):
            inertial = link.find("inertial")
            if inertial is not None:
                centre = vector(inertial.find("origin"), "xyz", "0 0 0")
                name = link.get("name")
                self.masses[name] = (float(inertial.find("mass").get("value")),
                                     self.origins[name] + self.axes[name] @ centre)

    def _place(self, joint, parent, child, angle):
        origin = joint.find("origin")
        roll, pitch, yaw = vector(origin, "rpy", "0 0 0")
        self.origins[child] = (self.origins[parent]
                               + self.axes[parent] @ vector(origin, "xyz", "0 0 0"))
        self.axes[child] = (self.axes[parent] @ turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch)
                            @ turn((1, 0, 0), roll))
        if joint.get("type") != "fixed":
            self.axes[child] = self.axes[child] @ turn(vector(joint.find("axis"), "xyz", "1 0 0"),
                                                       angle)
            self.children[joint.get("name")] = child


class FourBar:
    """urdf/four_bar.urdf by circles and balances; the crank turns at a constant rate."""
    BASE, CRANK, COUPLER, ROCKER = 0.40, 0.12, 0.36, 0.28  # m
    MASSES, INERTIAS = (0.30, 0.90, 0.70), (0.00036, 0.00972, 0.00457)  # about centres, kg m^2
    GRAVITY, RATE = 9.81, 2.0

    def angles(self, crank):
        """Of crank, coupler and rocker against x; the pin above the base."""
        b = self.CRANK * np.array([math.cos(crank), math.sin(crank)])
        d = np.array([self.BASE, 0]) - b
        distance = np.linalg.norm(d)
        along = (distance ** 2 + self.COUPLER ** 2 - self.ROCKER ** 2) / (2 * distance)
        across = math.sqrt(self.COUPLER ** 2 - along ** 2)
        c = b + (along * d + across * np.array([-d[1], d[0]])) / distance
        return np.array([crank, math.atan2(c[1] - b[1], c[0] - b[0]),
                         math.atan2(c[1], c[0] - self.BASE)])

    def centres(self, crank):
        e = [np.array([math.cos(angle), math.sin(angle)]) for angle in self.angles(crank)]
        return np.array([self.CRANK / 2 * e[0], self.CRANK * e[0] + self.COUPLER / 2 * e[1],
                         np.array([self.BASE, 0]) + self.ROCKER / 2 * e[2]])

    def rates(self, function, crank):
        return self.RATE * derivative(function, crank)

    def energy(self, crank):
        velocities, turns = self.rates(self.centres, crank), self.rates(self.angles, crank)
        return sum(m / 2 * v @ v + i / 2 * w ** 2 + m * self.GRAVITY * p[1]
                   for m, i, v, w, p in zip(self.MASSES, self.INERTIAS, velocities, turns,
                                            self.centres(crank)))

    def effort(self, crank):
        return derivative(self.energy, crank)  # power over rate

    def pin_force(self, crank):
        """What the coupler exerts on the rocker: moments of the rocker about its joint on the base,
        and of the coupler about its joint on the crank."""
        angles, centres = self.angles(crank), self.centres(crank)
        accelerations = self.rates(lambda x: self.rates(self.centres, x), crank)
        turns = self.rates(lambda x: self.rates(self.angles, x), crank)
        matrix, moments = np.empty((2, 2)), np.empty(2)
        pivots = {1: self.CRANK * np.array([math.cos(crank), math.sin(crank)]),
                  2: np.array([self.BASE, 0])}
        for row, (body, length, sign) in enumerate(((1, self.COUPLER, -1), (2, self.ROCKER, 1))):
            arm = length * np.array([math.cos(angles[body]), math.sin(angles[body])])
            centre = centres[body] - pivots[body]
            inertial = self.MASSES[body] * (accelerations[body] + np.array([0, self.GRAVITY]))
            matrix[row] = sign * -arm[1], sign * arm[0]
            moments[row] = (self.INERTIAS[body] * turns[body] + centre[0] * inertial[1]
                            - centre[1] * inertial[0])
        return np.linalg.solve(matrix, moments)


class Sources(unittest.TestCase):
    def test_there_are_no_other_examples(self):
        self.assertEqual(sorted(path.stem for path in (ROOT / "examples").glob("*.cpp")),
                         list(EXAMPLES))

    def test_each_is_short_has_numbered_steps_and_knows_public_headers_only(self):
        public = {f"virtual_work_dynamics/{path.name}"
                  for path in (ROOT / "include" / "virtual_work_dynamics").glob("*.h")}
        for name in EXAMPLES:
            with self.subTest(example=name):
                text = (ROOT / "examples" / f"{name}.cpp").read_text()
                self.assertLessEqual(len(text.splitlines()), MOST_LINES)
                steps = [int(step) for step in re.findall(r"^ *// (\d+)\. ", text, re.MULTILINE)]
                self.assertEqual(steps, list(range(1, len(steps) + 1)))
                self.assertGreaterEqual(len(steps), 3)
                headers = re.findall(r'#include [<"]([^>"]+)[>"]', text)
                for header in headers:
                    self.assertTrue(header in public or re.fullmatch(r"[a-z]+", header), header)

    def test_they_link_the_library_only_and_what_is_generated_not_even_that(self):
        text = (ROOT / "examples" / "CMakeLists.txt").read_text()
        linked = re.findall(r"target_link_libraries\(\S+ PRIVATE ([^)]*)\)", text)
        self.assertEqual(linked, ["virtual_work_dynamics", "generated_arm", "generated_crank"])


class Numbers(unittest.TestCase):
    def test_efforts_are_the_papers_closed_form(self):
        rows = output("01_efforts")[2:]
        self.assertEqual(len(rows), 7)
        for t, row in enumerate(rows):
            m10_z, m21_z = pendulum.closed_form(np.array([float(t)]))[:2, 0]
            found = numbers(row)
            self.assertEqual(len(found), 2)
            self.assertAlmostEqual(found[0], m10_z, delta=NINE_DIGITS)
            self.assertAlmostEqual(found[1], m21_z, delta=NINE_DIGITS)

    def test_reactions_bear_weights_and_push(self):
        links = Links(ROOT / "urdf" / "six_axis_arm.urdf", 0.5)
        ground, last, last_in_child_axes = map(numbers, output("02_reactions")[1:])
        loads = [(np.array([0, 0, -9.81 * mass]), at) for mass, at in links.masses.values()]
        tip = links.children["joint_6"]
        push = np.array([50.0, 0, 0]), links.origins[tip] + links.axes[tip] @ np.array([0, 0, 0.1])
        self.compare(ground, loads + [push], np.zeros(3))
        mass, at = links.masses[tip]
        wrist = [(np.array([0, 0, -9.81 * mass]), at), push]
        self.compare(last, wrist, links.origins[tip])
        for part in (slice(0, 3), slice(3, 6)):
            turned = links.axes[tip] @ np.array(last_in_child_axes[part])
            np.testing.assert_allclose(turned, last[part], atol=3 * SIX_DIGITS, rtol=0)

    def compare(self, found, loads, about):
        force = -sum(load for load, _ in loads)
        moment = -sum(np.cross(at - about, load) for load, at in loads)
        np.testing.assert_allclose(found, np.concatenate([force, moment]), atol=SIX_DIGITS, rtol=0)

    def test_the_loop_moves_by_circles_and_bears_what_balances_demand(self):
        linkage = FourBar()
        rows = output("03_closed_loop")[1:]
        self.assertEqual(len(rows), 13)
        for step, row in enumerate(rows):
            with self.subTest(step=step):
                crank, rocker, effort, fx, fy, fz = numbers(row)
                exact = step * math.pi / 6
                self.assertAlmostEqual(crank, exact, delta=SIX_DIGITS)
                self.assertAlmostEqual(rocker, linkage.angles(exact)[2], delta=SIX_DIGITS)
                self.assertAlmostEqual(effort, linkage.effort(exact), delta=SIX_DIGITS)
                np.testing.assert_allclose([fx, fy], linkage.pin_force(exact), atol=SIX_DIGITS,
                                           rtol=0)
                self.assertEqual(fz, 0)  # the least norm of what a plane linkage leaves open
                self.assertEqual(row.count("not determined"), 1)
                self.assertTrue(row.endswith("(not determined)"))

    def test_peaks_are_those_of_the_closed_form(self):
        m10, m21, f10_x, f10_y, f21_x, f21_y = pendulum.closed_form(np.arange(6001) / 1000)
        expected = [max(abs(m10)), max(abs(m21)), max(np.hypot(f10_x, f10_y)),
                    max(np.hypot(f21_x, f21_y))]
        found = [numbers(row)[0] for row in output("04_blocks")]
        np.testing.assert_allclose(found, expected, atol=NINE_DIGITS, rtol=0)

    def test_certificates_tell_right_from_wrong(self):
        for files in ([], [ROOT / "urdf" / "four_bar.urdf", ROOT / "config" / "four_bar_scene.yaml"]):
            with self.subTest(files=files):
                sound, wrong, largest, difference = [numbers(row)[0]
                                                     for row in output("05_certificates", *files)]
                self.assertLess(sound, 1e-13)
                # A thousandth of terms that are a part of all terms.
                self.assertGreater(wrong, 1e-5)
                self.assertLess(wrong, 1e-3)
                self.assertGreater(largest, 0.1)
                self.assertLess(difference, 1e-12 * largest)

    def test_the_generated_arm_carries_what_hangs_on_its_column(self):
        lines = output("06_generated")
        self.assertEqual(len(lines), 10)
        arm = ElementTree.parse(ROOT / "urdf" / "six_axis_arm.urdf").getroot()
        root = ({link.get("name") for link in arm.findall("link")}
                - {joint.find("child").get("link") for joint in arm.findall("joint")})
        mass = sum(float(link.find("inertial/mass").get("value")) for link in arm.findall("link")
                   if link.find("inertial") is not None and link.get("name") not in root)
        for at_rest in (lines[1], lines[-1]):
            self.assertAlmostEqual(numbers(at_rest)[-1], 9.81 * mass, delta=SIX_DIGITS)
        self.assertGreater(abs(numbers(lines[5])[-1] - 9.81 * mass), 1)  # half-way it brakes
        # Turning about the vertical alone takes nothing but what pulls back the lag of the encoder.
        self.assertAlmostEqual(numbers(lines[0])[0], 200 * 0.01, delta=SIX_DIGITS)

    def test_the_generated_linkage_takes_no_work_in_a_turn(self):
        found = [numbers(line) for line in output("06_generated_loop")]
        self.assertEqual(len(found), 24)
        torques = [row[0] for row in found]
        # Equal steps: the mean of a periodic function is exact up to its 24th harmonic.
        self.assertAlmostEqual(sum(torques) / len(torques), 0, delta=SIX_DIGITS)
        self.assertGreater(max(torques), 1)
        self.assertLess(min(torques), -1)
        for row in found:
            self.assertGreater(row[1], 0.1)


class Files(unittest.TestCase):
    def test_a_file_that_is_not_there_is_named(self):
        for name in EXAMPLES:
            with self.subTest(example=name):
                found = run(name, "/nowhere/robot")
                self.assertEqual(found.returncode, 1)
                self.assertIn("/nowhere/robot", found.stderr)

    def test_every_open_example_takes_other_robots(self):
        arm = [ROOT / "urdf" / "six_axis_arm.urdf", ROOT / "config" / "six_axis_arm_scene.yaml"]
        self.assertEqual(len(numbers(output("01_efforts", *arm)[-1])), 6)
        self.assertEqual(len(output("04_blocks", *arm)), 12)


if __name__ == "__main__":
    if len(sys.argv) < 2 or not pathlib.Path(sys.argv[1]).is_dir():
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
