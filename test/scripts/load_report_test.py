#!/usr/bin/python3
"""Load reports of made results: files, figures, page, gaps, doubts."""
import html.parser
import json
import re
import unittest

import numpy as np

from made_loads import MECHANISM, RATE, Shared, mechanism_of, only, results


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


if __name__ == "__main__":
    unittest.main()
