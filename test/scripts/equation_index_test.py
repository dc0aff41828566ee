#!/usr/bin/env python3
"""From README to the line of an equation in two hops, and each rule of scripts/equation_index.py seen
to fail: one change is planted at a time, in code or document."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / "scripts" / "equation_index.py"
DOCUMENT = "doc/theory.md"
LISTING = "test/core/reference_recursion.h"
RECURSION = "src/tree/kernel/recursion.h"

# Equations of the paper that happen in code; the others define symbols or are of its example.
IN_CODE = ["(2.1)", "(2.2)", "(2.3)", "(2.5)", "(2.6)", "(2.7)", "(3.1)", "(3.2)", "(3.3)", "(3.5)", "(3.6)",
           "(3.7)", "(3.8)", "(4.1)", "(4.2)", "(4.3)"]
REACH = 10  # lines by which a link may miss

ADDED_TAG = "\n/// Another place of (2.6).\ninline void another() {}\n"
# (file, what is replaced, by what, what the program must say)
PLANTED = [
    (RECURSION, "// (2.5), + qd u3", "// + qd u3", "(2.5) has 3 lines of propagateMotion()"),
    (RECURSION, "#pragma once\n", "#pragma once\n" + ADDED_TAG, "lacks (2.6) in another()"),
    (RECURSION, "#pragma once\n", "#pragma once\n" + "\n" * (REACH + 1), "(2.7) has moved"),
    (RECURSION, "propagateMotion(const", "carryMotion(const",
     "(2.5) is no longer in propagateMotion()"),
    ("src/tree/kernel/poses.h", "(2.6)", "velocity", "(2.6) is no longer in propagatePose()"),
    (LISTING, "2 * slide[1]", "slide[1]", "the listing is not " + LISTING),
    (DOCUMENT, "2 * slide[1]", "slide[1]", "the listing is not " + LISTING),
    (DOCUMENT, "| (3.7) | `addEffort()`", "| (3.7) | `addForce()`", "lacks (3.7) in addEffort()"),
    (DOCUMENT, "<!-- end index -->", "", "needs '<!-- begin index"),
    (DOCUMENT, "<!-- begin listing: scripts/equation_index.py -->", "", "needs '<!-- begin listing"),
]
# What changes no entry and moves no link by too much.
ALLOWED = [
    (RECURSION, "#pragma once\n", "#pragma once\n" + "\n" * REACH),
    (RECURSION, "#pragma once\n", "#pragma once\n// The chapters (2.5)-(2.7).\n"),
    (RECURSION, "#pragma once\n", '#pragma once\nconst char* const kText = "(2.6)";\n'),
    (DOCUMENT, "# Theory", "# The theory (2.6)"),
]


class EquationIndex(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        for part in ("src", "include", "doc"):
            shutil.copytree(ROOT / part, self.root / part)
        (self.root / LISTING).parent.mkdir(parents=True)
        shutil.copy(ROOT / LISTING, self.root / LISTING)

    def tearDown(self):
        self.folder.cleanup()

    def run_program(self, option, root):
        return subprocess.run([sys.executable, str(PROGRAM), option, "--root", str(root)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def plant(self, place, old, new):
        """Returns what the file was before."""
        path = self.root / place
        before = path.read_text(encoding="utf-8")
        self.assertIn(old, before)
        path.write_text(before.replace(old, new), encoding="utf-8")
        return before

    def restore(self, place, before):
        (self.root / place).write_text(before, encoding="utf-8")

    def test_the_document_is_in_step_with_the_code(self):
        found = self.run_program("--check", ROOT)
        self.assertEqual(found.returncode, 0, found.stderr)

    # README links to the document, and the document to lines that name the equation, or to their screen.
    def test_two_hops_lead_from_the_readme_to_every_equation(self):
        self.assertIn("](" + DOCUMENT, (ROOT / "README.md").read_text(encoding="utf-8"))
        text = (ROOT / DOCUMENT).read_text(encoding="utf-8")
        for equation in IN_CODE:
            with self.subTest(equation=equation):
                rows = [line for line in text.splitlines() if line.startswith(f"| {equation} |")]
                links = re.findall(r"\]\(\.\./([^)#]+)#L(\d+)\)", " ".join(rows))
                self.assertTrue(links)
                for place, number in links:
                    lines = (ROOT / place).read_text(encoding="utf-8").splitlines()
                    first = max(0, int(number) - 1 - REACH)
                    screen = lines[first:int(number) + REACH]
                    self.assertTrue(any(equation in line for line in screen), (place, number))

    def test_every_departure_from_the_print_says_why(self):
        departures = {}
        for path in sorted((ROOT / "src").rglob("*.h")) + sorted((ROOT / "src").rglob("*.cpp")):
            for equation, why in re.findall(r"// *Departs from (\([2-5]\.\d+\)): *(\S*)",
                                            path.read_text(encoding="utf-8")):
                self.assertTrue(why, path)
                departures.setdefault(equation, path)
        self.assertGreaterEqual(set(departures), {"(2.7)", "(3.5)", "(3.6)", "(3.8)"})

    def test_every_rule_is_seen_to_fail(self):
        for place, old, new, words in PLANTED:
            with self.subTest(place=place, words=words):
                before = self.plant(place, old, new)
                found = self.run_program("--check", self.root)
                self.restore(place, before)
                self.assertEqual(found.returncode, 1)
                self.assertIn(words, found.stderr)

    def test_small_moves_and_ranges_are_allowed(self):
        for place, old, new in ALLOWED:
            with self.subTest(place=place, new=new):
                before = self.plant(place, old, new)
                found = self.run_program("--check", self.root)
                self.restore(place, before)
                self.assertEqual(found.returncode, 0, found.stderr)

    def test_writing_mends_what_the_check_finds(self):
        self.plant(RECURSION, "#pragma once\n", "#pragma once\n" + ADDED_TAG + "\n" * REACH)
        self.plant(LISTING, "2 * slide[1]", "slide[1]")
        found = self.run_program("--check", self.root)
        self.assertEqual(found.returncode, 1)
        self.assertIn("scripts/equation_index.py --write", found.stderr)
        self.assertEqual(self.run_program("--write", self.root).returncode, 0)
        self.assertEqual(self.run_program("--check", self.root).returncode, 0)


if __name__ == "__main__":
    unittest.main()
