#!/usr/bin/python3
"""The tables of the examples: as the script makes them, with feet that stand and wheels that roll."""
import csv
import importlib.util
import pathlib
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]


def script():
    spec = importlib.util.spec_from_file_location("example_motions", ROOT / "scripts/example_motions.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def turn(axis, angle):
    """Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def vector(element, key):
    return np.array([float(x) for x in element.get(key).split()])


def place(urdf, link, row):
    """Where the origin of a link of an open chain is, in inertial axes, by the joints above it."""
    joints = {joint.find("child").get("link"): joint for joint in urdf.findall("joint")}
    point = np.zeros(3)
    while link in joints:
        joint = joints[link]
        if joint.get("type") != "fixed":
            angle = float(row["position." + joint.get("name")])
            point = turn(vector(joint.find("axis"), "xyz"), angle) @ point
        point = vector(joint.find("origin"), "xyz") + point
        link = joint.find("parent").get("link")
    x, y, z, w = (float(row["root.orientation." + name]) for name in "xyzw")
    axis = np.array([x, y, z])
    point = point + 2 * np.cross(axis, np.cross(axis, point) + w * point)
    return point + [float(row["root.position." + name]) for name in "xyz"]


class ExampleMotions(unittest.TestCase):
    def test_tables_are_what_the_script_makes(self):
        examples = script()
        for name in examples.EXAMPLES:
            with self.subTest(example=name):
                self.assertEqual((ROOT / "config" / (name + "_motion.csv")).read_text(), examples.table(name))

    def test_tables_have_every_joint_and_end_as_they_begin(self):
        for name, robot in (("arm_on_a_ship", "six_axis_arm"), ("balance_board", "balance_board"),
                            ("quadruped", "quadruped"), ("mobile_manipulator", "mobile_manipulator"),
                            ("rolling_disc", "rolling_disc")):
            with self.subTest(example=name), open(ROOT / "config" / (name + "_motion.csv")) as file:
                rows = list(csv.DictReader(file))
                urdf = ElementTree.parse(ROOT / "urdf" / (robot + ".urdf")).getroot()
                joints = {j.get("name") for j in urdf.findall("joint") if j.get("type") != "fixed"}
                self.assertEqual({key[9:] for key in rows[0] if key.startswith("position.")}, joints)
                turning = {"position." + j.get("name") for j in urdf.findall("joint")
                           if j.get("type") == "continuous"}
                for key, value in rows[0].items():
                    if key != "time":
                        change = float(rows[-1][key]) - float(value)
                        if key in turning:
                            change -= 2 * np.pi * round(change / (2 * np.pi))
                        self.assertAlmostEqual(change, 0, delta=2e-6, msg=key)

    def test_feet_of_the_quadruped_stand_while_they_carry(self):
        urdf = ElementTree.parse(ROOT / "urdf/quadruped.urdf").getroot()
        with open(ROOT / "config/quadruped_motion.csv") as file:
            rows = list(csv.DictReader(file))
        stand = {leg: place(urdf, leg + "_foot", rows[0]) for leg in ("lf", "rf", "lh", "rh")}
        lifts = dict.fromkeys(stand, 0.0)
        for row in rows:
            standing = 0
            for leg, start in stand.items():
                foot = place(urdf, leg + "_foot", row)
                self.assertLess(np.abs(foot[:2] - start[:2]).max(), 1e-5, row["time"])
                self.assertGreater(foot[2], -1e-5)
                standing += foot[2] < 1e-5
                lifts[leg] = max(lifts[leg], foot[2])
            self.assertIn(standing, (2, 4), row["time"])
        for leg, lift in lifts.items():
            self.assertAlmostEqual(lift, 0.06, delta=1e-3, msg=leg)

    def test_wheels_of_the_manipulator_roll(self):
        with open(ROOT / "config/mobile_manipulator_motion.csv") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        for row in rows:
            yaw, turning = row["position.base_yaw"], row["velocity.base_yaw"]
            for wheel, side in (("left", 1), ("right", -1)):
                # What the rim does where it touches, which is 0.2 m from the middle of the axle.
                rim = 0.08 * row["velocity.%s_wheel" % wheel]
                along = rim + side * 0.2 * turning
                self.assertAlmostEqual(row["velocity.base_x"], along * np.cos(yaw), delta=1e-8)
                self.assertAlmostEqual(row["velocity.base_y"], along * np.sin(yaw), delta=1e-8)
        self.check_rates(rows)

    def check_rates(self, rows):
        """Rates of a table against differences of its rows."""
        step = rows[1]["time"] - rows[0]["time"]
        for key in (key[9:] for key in rows[0] if key.startswith("position.")):
            values = [np.array([row[kind + "." + key] for row in rows])
                      for kind in ("position", "velocity", "acceleration")]
            for value, rate in zip(values, values[1:]):
                # Central differences of fourth order.
                slope = (8 * (value[3:-1] - value[1:-3]) - (value[4:] - value[:-4])) / (12 * step)
                self.assertLess(np.abs(slope - rate[2:-2]).max(), 3e-4 * (1 + np.abs(rate).max()), key)

    def test_the_disc_rolls_on_its_rim(self):
        with open(ROOT / "config/rolling_disc_motion.csv") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        for row in rows:
            heading, lean = row["position.heading"], row["position.lean"]
            ahead = np.array([np.cos(heading), np.sin(heading), 0])
            left = np.array([-np.sin(heading), np.cos(heading), 0])
            axle = np.cos(lean) * left - np.sin(lean) * np.array([0, 0, 1])
            turning = row["velocity.heading"] * np.array([0, 0, 1]) - row["velocity.lean"] * ahead \
                + row["velocity.spin"] * axle
            down = 0.5 * np.cross(axle, ahead)
            centre = [np.array([row[kind + ".disc_" + x] for x in "xyz"]) for kind in ("position", "velocity")]
            lowest = centre[0] + down
            self.assertAlmostEqual(lowest[2], 0, delta=1e-8)
            self.assertAlmostEqual(np.hypot(*lowest[:2]), 2, delta=1e-8)
            self.assertLess(np.abs(centre[1] + np.cross(turning, down)).max(), 1e-8, row["time"])
        self.check_rates(rows)


if __name__ == "__main__":
    unittest.main()
