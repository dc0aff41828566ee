#!/usr/bin/python3
"""Load reports of made results: files, page in a browser, gaps, doubts, bad input, reports of many."""
import csv
import html
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
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


class Page(html.parser.HTMLParser):
    """What a page would load, and the names that links lead to."""

    def __init__(self, text):
        super().__init__()
        self.sources, self.ids, self.tags = [], set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        for name, value in attributes:
            if name in ("src", "href", "srcset", "data", "action", "poster"):
                self.sources.append(value)
            elif name == "id":
                self.ids.add(value)


class Report(Shared):
    def test_figures_are_those_found_by_hand(self):
        loads = self.loads(self.made)
        turn, lift = loads["turn", "force"], loads["lift", "force"]
        self.assertAlmostEqual(float(turn["peak"]), 130, delta=1e-9)
        self.assertAlmostEqual(float(loads["turn", "radial_force"]["rms"]), 50, delta=1e-9)
        self.assertAlmostEqual(float(loads["turn", "axial_force"]["mean"]), 120, delta=1e-9)
        self.assertAlmostEqual(float(loads["turn", "tilting_moment"]["p50"]), 10, delta=1e-9)
        self.assertAlmostEqual(float(turn["equivalent_ball"]), 130, delta=1e-9)
        # Twice the joint it mimics: |2 sin| over 10 s; what is turned in the last row's time is missing.
        self.assertAlmostEqual(float(turn["travel"]), 2 * 10 * 2 / np.pi, delta=0.01)
        self.assertEqual(lift["equivalent_ball"], "")
        self.assertEqual(loads["pin", "force"]["equivalent_ball"], "")
        effort = loads["turn", "effort"]
        self.assertAlmostEqual(float(effort["rms"]), np.sqrt(2), delta=1e-3)
        self.assertAlmostEqual(float(effort["cycles"]), 10, delta=0.51)
        # Cycles of 4; the ends, which are less than half of one, take little away.
        self.assertAlmostEqual(float(effort["range"]), 4, delta=0.1)
        self.assertAlmostEqual(float(effort["at_peak.velocity.turn"]), np.sign(float(effort["peak"])), delta=1e-9)

    def test_all_files_are_there_and_the_page_needs_no_others(self):
        folder = self.made
        text = (folder / "report.html").read_text(encoding="utf-8")
        page = Page(text)
        self.assertFalse(page.tags & {"script", "link", "iframe", "object", "embed", "base"})
        for source in page.sources:
            self.assertTrue(source.startswith("data:image/svg+xml;base64,") or source[1:] in page.ids, source[:60])
        self.assertNotRegex(text, r"url\(|@import")
        self.assertIn("two &lt;axes&gt;", text)
        pictures = re.findall(r"!\[[^]]*\]\(([^)]*)\)", (folder / "report.md").read_text(encoding="utf-8"))
        self.assertEqual(len(pictures), len(page.sources) - len(page.ids))
        for picture in pictures:
            self.assertIn(b"<svg", (folder / picture).read_bytes())

    def test_a_csv_makes_the_same_figures(self):
        columns = results()
        (self.folder / "mechanism.json").write_text(json.dumps(MECHANISM))
        with open(self.folder / "r.csv", "w", encoding="utf-8") as file:
            file.write("# a comment\n" + ",".join(columns) + "\n")
            for row in zip(*columns.values()):
                file.write(",".join(repr(float(cell)) for cell in row) + "\n")
        ran = self.run_program("r.csv", "--mechanism", "mechanism.json", "--output", "csv", "--figures-only")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual((self.folder / "csv/loads.csv").read_text(), (self.made / "loads.csv").read_text())

    def test_without_the_mechanism_it_says_what_is_missing(self):
        folder = self.report("bare", only("turn", results()), mechanism=None)
        text = (folder / "report.md").read_text(encoding="utf-8")
        self.assertIn("Nothing is known of the joints", text)
        self.assertNotIn(("turn", "radial_force"), self.loads(folder))
        self.assertIn(("turn", "force"), self.loads(folder))

    def test_rows_beyond_limits_are_named(self):
        text = (self.made / "report.md").read_text(encoding="utf-8")
        self.assertRegex(text, r"`turn`: effort beyond the limit of 1\.5 N m in \d+ rows")
        self.assertNotIn("`lift`: effort beyond", text)

    def test_noise_hardly_changes_the_damage(self):
        columns = results()
        columns["effort.turn"] += 0.02 * np.random.default_rng(3).normal(size=2000)
        noisy = self.loads(self.report("noise", columns, "--figures-only"))["turn", "effort"]
        clean = self.loads(self.made)["turn", "effort"]
        self.assertGreater(float(noisy["cycles"]), 20 * float(clean["cycles"]))
        self.assertLess(float(noisy["range"]), 0.6 * float(clean["range"]))
        # Peaks of noise of one in a hundred add up to three of its deviations at either end of a cycle.
        self.assertAlmostEqual(float(noisy["range_once"]), float(clean["range_once"]),
                               delta=0.03 * float(clean["range_once"]))

    def test_gaps_and_missing_values(self):
        columns = results()
        columns["time"][1000:] += 5
        columns["reaction.turn.fx"][100:200] = np.nan
        folder = self.report("gap", columns)
        text = (folder / "report.md").read_text(encoding="utf-8")
        self.assertIn("1 gap longer than", text)
        self.assertRegex(text, r"turn: no value.*100 of 2000 rows, 0\.5 s to 0\.995 s")
        loads = self.loads(folder)
        self.assertEqual(loads["turn", "fx"]["missing"], "100")
        self.assertEqual(loads["lift", "fx"]["missing"], "0")
        self.assertAlmostEqual(float(loads["lift", "fz"]["seconds"]), 10 - 2 / RATE, delta=1e-9)

    def test_doubts_are_said_and_mark_peaks(self):
        columns = results()
        rows = np.arange(2000)
        columns["condition"] = np.where((rows > 3) & (rows < 14), 1e7, 1.0)
        columns["reaction.pin.fx"][5] = 50
        columns["determined.pin.fy"] = (rows >= 20).astype(float)
        columns["determined.lift.ty"] = np.zeros(2000)
        columns["deviation.effort.turn"] = np.where(rows == 1500, 5.0, 0.01)
        columns["one_sided"] = (rows >= 1990).astype(float)
        folder = self.report("doubt", columns)
        text = (folder / "report.md").read_text(encoding="utf-8")
        # Rows 0 to 19, 1500, and 1990 on; that ty of the lift is never determined says nothing of a row.
        self.assertEqual(json.loads((folder / "sums.json").read_text())["doubtful_rows"], 31)
        self.assertRegex(text, r"close to a singular position.*10 of 2000 rows")
        self.assertRegex(text, r"estimated from rows of one side: 10 of 2000 rows, 9\.95 s to 9\.995 s")
        self.assertRegex(text, r"pin: rigid-body mechanics does not determine fy; .*20 of 2000 rows")
        # Across the axis of the lift, what has ty in it; along it, nothing.
        self.assertRegex(text, r"tilting moment \| N m \| 3† ")
        self.assertRegex(text, r"axial force \| N \| 60 ")
        self.assertRegex(text, r"turn: the standard deviation.*1 of 2000 rows, 7\.5 s")
        self.assertIn("50†", text)
        self.assertIn("Standard deviations of efforts", text)

    def test_a_certificate_that_is_missing_hides_none_and_certifies_nothing(self):
        columns = results()
        for name in ("power", "ground_force"):
            columns["certificate." + name] = np.full(2000, 1e-14)
        columns["certificate.power"][100:110] = np.nan
        columns["certificate.ground_force"][105:130] = 1e-3
        folder = self.report("certified", only("pin", columns), mechanism=mechanism_of("pin"))
        self.assertRegex((folder / "report.md").read_text(encoding="utf-8"),
                         r"a certificate of the arithmetic is above .*30 of 2000 rows, 0\.5 s to 0\.645 s")

    def test_axes_and_points_of_moments_are_those_of_the_mechanism(self):
        one = mechanism_of("lift")
        elsewhere = json.loads(json.dumps(one))
        elsewhere["reactions"][0]["moment_elsewhere"] = True
        for name, mechanism, words, moved in (
                ("child", elsewhere, "in axes of the child link, moments", True),
                ("root", dict(one, axes="root"), "in axes of the root link, moments", False),
                ("inertial", dict(one, axes="inertial"), "in axes of the inertial frame", False),
                ("unknown", None, "in the axes of the results, moments", False)):
            with self.subTest(axes=name):
                text = (self.report(name, only("lift", results(2)), mechanism=mechanism) / "report.md").read_text(encoding="utf-8")
                last = text[text.index("How the figures are found"):]
                self.assertIn(words, last)
                self.assertEqual("or about the point of the scene" in last, moved)
                self.assertEqual("Reactions are in " in text, name in ("root", "inertial"))
                self.assertEqual("root link, in which axes" in text, name == "root")

    def test_names_with_any_letters(self):
        columns = {name.replace("turn", "a/b |<c>"): value for name, value in only("turn", results()).items()}
        mechanism = json.loads(json.dumps(mechanism_of("turn")).replace("turn\"", "a/b |<c>\"").replace(
            "\"a/b |<c>\": {", "\"turn\": {"))
        folder = self.folder / "odd"
        with open(self.folder / "odd.csv", "w", encoding="utf-8") as file:  # a zip has folders instead
            file.write(",".join(columns) + "\n")
            for row in zip(*columns.values()):
                file.write(",".join(repr(float(cell)) for cell in row) + "\n")
        (self.folder / "odd.json").write_text(json.dumps(mechanism))
        ran = self.run_program("odd.csv", "--mechanism", "odd.json", "--output", folder)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("a/b |&lt;c&gt;", (folder / "report.html").read_text(encoding="utf-8"))

    def test_equal_results_make_equal_files(self):
        first, second = self.made, self.report("one", results())
        for file in sorted((first / "figures").iterdir()):
            self.assertEqual(file.read_bytes(), (second / "figures" / file.name).read_bytes(), file.name)
        self.assertEqual((first / "loads.csv").read_bytes(), (second / "loads.csv").read_bytes())


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


PROBE = """<script>
window.addEventListener('load', () => {
  const images = [...document.images];
  document.body.dataset.probe = JSON.stringify({
    images: images.length, drawn: images.filter(i => i.complete && i.naturalWidth > 100).length,
    wide: document.documentElement.scrollWidth - window.innerWidth,
    tables: document.querySelectorAll('table').length, rows: document.querySelectorAll('tbody tr').length,
    font: getComputedStyle(document.body).fontSize, loaded: performance.getEntriesByType('resource').filter(
      entry => !entry.name.startsWith('data:')).map(entry => entry.name)});
});
</script>"""


class Browser(Shared):
    """The page in Chromium without a screen."""

    def setUp(self):
        self.chromium = shutil.which("chromium")
        if self.chromium is None:
            self.skipTest("chromium is not installed: scripts/install_dependencies.sh --workflow")
        super().setUp()

    def chromium_says(self, page, *words):
        ran = subprocess.run([self.chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                              "--user-data-dir=%s" % (self.folder / "profile"), *words, "file://%s" % page],
                             stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=120)
        return ran.stdout.decode("utf-8")

    def probe(self, width):
        page = self.made / "report.html"
        probed = self.folder / "probed.html"
        probed.write_text(page.read_text(encoding="utf-8").replace("</body>", PROBE + "</body>"), encoding="utf-8")
        dom = self.chromium_says(probed, "--window-size=%d,900" % width, "--virtual-time-budget=5000", "--dump-dom")
        said = re.search(r'data-probe="([^"]*)"', dom)
        self.assertIsNotNone(said, dom[-300:])
        return json.loads(html.unescape(said.group(1)))

    def test_every_picture_is_drawn_and_nothing_is_loaded(self):
        said = self.probe(1400)
        self.assertGreater(said["images"], 8)
        self.assertEqual(said["drawn"], said["images"])
        self.assertGreaterEqual(said["tables"], 6)
        self.assertGreater(said["rows"], 30)
        self.assertEqual(said["loaded"], [])

    def test_it_fits_screens_of_any_width(self):
        for width in (1400, 700):
            with self.subTest(width=width):
                self.assertLessEqual(self.probe(width)["wide"], 0)


if __name__ == "__main__":
    unittest.main()
