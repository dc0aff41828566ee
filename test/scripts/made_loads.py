"""Made results whose load reports are known by hand, and the program that makes reports, for its tests."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import zipfile

import numpy as np

from forked_program import run_forked

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "scripts/load_report.py"
MECHANISM = {
    "format": 1, "robot": "two <axes>", "axes": "child", "max_gap": 0.25,
    "reactions": [
        {"name": "lift", "kind": "joint", "type": "prismatic", "axis": [0, 0, 1]},
        {"name": "turn", "kind": "joint", "type": "revolute", "axis": [0, 0, 2],
         "turn": {"velocity": "velocity.turn", "factor": -2}},
        {"name": "pin", "kind": "closure", "type": "revolute", "axis": [0, 0, 1]}],
    "efforts": [
        {"name": "lift", "column": "effort.lift", "unit": "m", "motion": "lift", "effort_limit": 90},
        {"name": "turn", "column": "effort.turn", "unit": "rad", "motion": "turn", "effort_limit": 1.5,
         "velocity_limit": 4}]}
RATE = 200.0


def load_report(words):
    from vwd_loads.command import main
    return main(words)


def results(seconds=10.0, start=0.0, phase=0.0):
    """Results whose figures are known by hand."""
    times = start + np.arange(int(seconds * RATE)) / RATE
    wave = np.sin(2 * np.pi * times + phase)
    columns = {"time": times, "effort.lift": 60 + 20 * wave, "effort.turn": 2 * wave,
               "position.lift": 0.1 * wave, "velocity.lift": 0.0 * wave,
               "position.turn": -np.cos(2 * np.pi * times + phase) / (2 * np.pi), "velocity.turn": wave}
    for name, wrench in (("lift", (0, 0, 60, 0, 3, 0)), ("turn", (30, 40, 120, 6, 8, 2)), ("pin", (1, 0, 0, 0, 0, 0))):
        for component, size in zip(("fx", "fy", "fz", "tx", "ty", "tz"), wrench):
            columns["reaction.%s.%s" % (name, component)] = size * (np.ones_like(wave) if component != "tz" else wave)
    return columns


def only(joint, columns):
    """Results of one joint, whose report has few pictures to draw."""
    return {name: column for name, column in columns.items()
            if name.split(".")[0] in ("time", "position", "velocity", "certificate") or name.split(".")[1] == joint}


def mechanism_of(joint):
    return dict(MECHANISM, **{key: [entry for entry in MECHANISM[key] if entry["name"] == joint]
                              for key in ("reactions", "efforts")})


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="load_report_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def npz(self, name, columns, mechanism=MECHANISM):
        path = self.folder / name
        np.savez(path, **columns)
        if mechanism is not None:
            with zipfile.ZipFile(path, "a") as file:
                file.writestr("mechanism.json", json.dumps(mechanism))
        return path

    def run_program(self, *words, **environment):
        """The program; by itself where the environment matters, else in a fork of this test, which has read
        what it needs."""
        if not environment:
            return run_forked(load_report, [str(word) for word in words], str(self.folder), str(ROOT / "scripts"),
                              ("scipy.signal", "vwd_loads.command", "vwd_loads.plots"))
        return self.run_alone(*words, **environment)

    def run_alone(self, *words, **environment):
        return subprocess.run([str(PROGRAM)] + [str(word) for word in words], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, encoding="utf-8", cwd=str(self.folder),
                              env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1", LC_ALL="C.UTF-8", **environment))

    def report(self, name, columns, *words, mechanism=MECHANISM):
        ran = self.run_program(self.npz(name + ".npz", columns, mechanism), "--output", self.folder / name, *words)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(ran.stderr, "")
        return self.folder / name

    @staticmethod
    def loads(folder):
        with open(folder / "loads.csv", newline="", encoding="utf-8") as file:
            return {(row["name"], row["quantity"]): row for row in csv.DictReader(file)}

    def refused(self, why, *words, **environment):
        ran = self.run_program(*words, **environment)
        self.assertNotEqual(ran.returncode, 0)
        lines = ran.stderr.splitlines()
        self.assertEqual(len(lines), 1, ran.stderr)
        self.assertRegex(lines[0], why)


class Shared(Folder):
    """Tests that look at one report."""

    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(tempfile.mkdtemp(prefix="load_report_shared_"))
        cls.addClassCleanup(shutil.rmtree, cls.shared)
        maker = Folder()
        maker.folder = cls.shared
        cls.made = maker.report("one", results())
