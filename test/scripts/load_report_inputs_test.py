#!/usr/bin/python3
"""Load reports of bad input, each refused in one line, and of many motions: merged as if they were one."""
import json
import unittest
import zipfile

import numpy as np

from made_loads import MECHANISM, Folder, results


class BadInput(Folder):
    def test_one_line_names_what_is_wrong(self):
        self.refused("not_there.npz: cannot be read: No such file", "not_there.npz", "--output", "x")
        columns = results()
        del columns["reaction.pin.ty"]
        self.refused("column reaction.pin.ty is missing", self.npz("p.npz", columns), "--output", "x")
        self.refused("no column time", self.npz("t.npz", {"effort.a": np.ones(3)}), "--output", "x")
        self.refused("no column effort", self.npz("e.npz", {"time": np.arange(3.0)}), "--output", "x")
        back = dict(results(), time=-results()["time"])
        self.refused("row 2: time .* is not later", self.npz("b.npz", back), "--output", "x")
        (self.folder / "c.csv").write_text("time,effort.a\n0,1\n1\n")
        self.refused("c.csv: row 2 has 1 cells, the header has 2", "c.csv", "--output", "x")
        (self.folder / "n.csv").write_text("time,effort.a\n0,one\n")
        self.refused("n.csv: row 1: effort.a: 'one' is not a number", "n.csv", "--output", "x")
        (self.folder / "h.csv").write_text("time,effort.a\n")
        self.refused("h.csv: no rows", "h.csv", "--output", "x")
        (self.folder / "z.npz").write_bytes(b"PK\x03\x04 cut off")
        self.refused("z.npz: cannot be read", "z.npz", "--output", "x")
        self.refused("format 7", self.npz("f.npz", results(), {"format": 7}), "--output", "x")
        self.refused("the mechanism is not a map", self.npz("m.npz", results(), [1]), "--output", "x")
        for key in ("reactions", "efforts"):
            self.refused("the mechanism's %s are not a list of maps" % key,
                         self.npz("l.npz", results(), dict(MECHANISM, **{key: ["turn"]})), "--output", "x")
        (self.folder / "m.json").write_text("[1, 2]\n")
        self.refused("m.json: is not a map of keys", self.npz("r.npz", results()), "--mechanism", "m.json",
                     "--output", "x")
        with zipfile.ZipFile(self.folder / "s.xlsx", "w") as file:
            file.writestr("xl/workbook.xml", "<workbook/>")
        self.refused("s.xlsx: no column time", "s.xlsx", "--output", "x")
        (self.folder / "q.csv").write_text('time,effort.a\n0,"' + 200000 * "1" + '"\n')
        self.refused("q.csv: cannot be read: field larger", "q.csv", "--output", "x")

    def test_the_exit_status_says_whose_fault_it_is(self):
        good = self.npz("r.npz", results(2))
        (self.folder / "h.csv").write_text("time,effort.a\n")
        (self.folder / "taken").write_text("")
        for status, words in ((0, (good, "--output", "x")), (1, ("h.csv", "--output", "x")),
                              (2, (good, "--output", "taken")), (2, ("not_there.npz", "--output", "x"))):
            self.assertEqual(self.run_alone(*words, "--figures-only").returncode, status, words)

    def test_a_missing_package_is_named(self):
        (self.folder / "fake").mkdir()
        (self.folder / "fake/scipy.py").write_text("raise ImportError(\"No module named 'scipy'\", name='scipy')\n")
        self.refused("apt install python3-scipy", self.npz("r.npz", results()), "--output", "x",
                     PYTHONPATH=str(self.folder / "fake"))
        (self.folder / "fake/numpy.py").write_text("raise ImportError(\"No module named 'numpy'\", name='numpy')\n")
        ran = self.run_program("r.npz", "--output", "x", "--figures-only", PYTHONPATH=str(self.folder / "fake"))
        self.assertEqual(ran.returncode, 2)
        self.assertIn("apt install python3-numpy", ran.stderr)


class Merged(Folder):
    def test_it_is_the_report_of_all_in_one(self):
        first, second = results(7, 0, 0.3), results(4, 20, 1.0)
        second["reaction.turn.fx"] *= 3
        both = {name: np.concatenate((first[name], second[name])) for name in first}
        whole = self.loads(self.report("whole", both, "--figures-only"))
        a, b = (self.report(name, of, "--figures-only") for name, of in (("a", first), ("b", second)))
        broken = self.folder / "broken"
        broken.mkdir()
        (broken / "outcome.txt").write_text("failed: it was cut off\n")
        (self.folder / "list.txt").write_text("%s\n%s\n%s\n" % (b, broken, self.folder / "lost"))
        ran = self.run_program("--merge", a, "@list.txt", "--output", "merged")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("2 motions, 2 without a report", ran.stdout)
        merged = self.loads(self.folder / "merged")
        self.assertEqual(merged.keys(), whole.keys())
        for key, row in merged.items():
            for figure in ("seconds", "mean", "rms", "equivalent_ball", "equivalent_roller", "travel", "cycles",
                           "range", "range_once", "peak", "peak_time"):
                with self.subTest(key=key, figure=figure):
                    expected = whole[key][figure]
                    if not expected:
                        self.assertEqual(row[figure], "")
                    else:
                        self.assertAlmostEqual(float(row[figure]), float(expected),
                                               delta=1e-10 * max(1, abs(float(expected))))
        self.assertEqual(merged["turn", "force"]["peak_motion"], "b")
        text = (self.folder / "merged/report.md").read_text(encoding="utf-8")
        self.assertIn("`broken`: it was cut off", text)
        self.assertIn("`lost`: no report", text)

    def test_sums_that_are_no_map_are_listed(self):
        a = self.report("a", results(2), "--figures-only")
        (self.folder / "odd").mkdir()
        (self.folder / "odd/sums.json").write_text("[1]\n")
        ran = self.run_program("--merge", a, "odd", "--output", "merged")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("`odd`: its sums.json has another format",
                      (self.folder / "merged/report.md").read_text(encoding="utf-8"))

    def test_sums_without_their_keys_are_listed(self):
        a = self.report("a", results(2), "--figures-only")
        whole = json.loads((a / "sums.json").read_text())
        broken = {"none": {"format": 1}, "no_seconds": dict(whole), "text": dict(whole, woehler="five"),
                  "word": dict(whole, loads=["turn"]), "no_peak": json.loads(json.dumps(whole))}
        del broken["no_seconds"]["seconds"]
        del broken["no_peak"]["loads"][1]["peak"]
        for name, sums in broken.items():
            (self.folder / name).mkdir()
            (self.folder / name / "sums.json").write_text(json.dumps(sums))
        ran = self.run_program("--merge", a, *broken, "--output", "merged")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        text = (self.folder / "merged/report.md").read_text(encoding="utf-8")
        for name, lacks in (("none", "robot"), ("no_seconds", "seconds"), ("text", "woehler"), ("word", "load 1"),
                            ("no_peak", "peak of load 2")):
            self.assertIn("`%s`: its sums.json is incomplete: %s" % (name, lacks), text)

    def test_options_of_one_motion_are_refused_by_name(self):
        for words in (("--woehler", "3"), ("--max-gap", "1"), ("--mechanism", "m.json"), ("--figures-only",)):
            self.refused("error: %s .* cannot be used with --merge" % words[0], "--merge", "a", "--output", "x",
                         *words)

    def test_different_robots_or_exponents_are_not_merged(self):
        a = self.report("a", results(), "--figures-only")
        b = self.report("b", results(), "--figures-only", "--woehler", "3")
        c = self.report("c", results(), "--figures-only", mechanism=dict(MECHANISM, robot="another"))
        self.refused("different Wöhler exponents: 3, 5", "--merge", a, b, "--output", "x")
        self.refused("different robots: another, two <axes>", "--merge", a, c, "--output", "x")


if __name__ == "__main__":
    unittest.main()
