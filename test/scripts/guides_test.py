#!/usr/bin/env python3
"""README and guides: short where they must be, links that lead somewhere, names that exist."""
import pathlib
import re
import sys
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import architecture  # noqa: E402 (the path has to be set first)

PAGES = [ROOT / "README.md"] + sorted((ROOT / "doc").glob("*.md"))
MOST_LINES_OF_README = 150
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def without_code(text):
    return FENCE.sub("", text)


def anchors(page):
    """As GitHub makes them of headings."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", without_code(page.read_text()), re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)).lower()
        found.add(words.strip().replace(" ", "-"))
    return found


class Guides(unittest.TestCase):
    def test_the_readme_is_short(self):
        lines = (ROOT / "README.md").read_text().splitlines()
        self.assertLessEqual(len(lines), MOST_LINES_OF_README)

    def test_links_lead_to_files_and_headings(self):
        for page in PAGES:
            for link in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
                if re.match(r"https?://", link):
                    continue
                with self.subTest(page=page.name, link=link):
                    file, _, anchor = link.partition("#")
                    target = (page.parent / file).resolve() if file else page
                    self.assertTrue(target.exists(), f"{target} is not there")
                    if anchor and target.suffix == ".md":
                        self.assertIn(anchor, anchors(target))

    def test_the_readme_names_every_guide(self):
        text = (ROOT / "README.md").read_text()
        for page in PAGES[1:]:
            with self.subTest(page=page.name):
                self.assertIn(f"doc/{page.name}", text)

    def test_files_that_are_named_exist(self):
        places = (r"(?:src|include|scripts|config|launch|urdf|examples|test|benchmark|doc)"
                  r"/[\w./-]+\w(?![\w*])")
        for page in PAGES:
            if page.name == "adding.md":  # names files that are still to be made
                continue
            for name in re.findall(rf"(?<![\w/.-])({places})", page.read_text()):
                with self.subTest(page=page.name, file=name):
                    self.assertTrue((ROOT / name).exists())

    def test_launch_files_that_are_named_exist(self):
        for page in PAGES:
            for name in re.findall(r"(\w+\.launch)\b", page.read_text()):
                with self.subTest(page=page.name, file=name):
                    self.assertTrue((ROOT / "launch" / name).exists())

    def test_yaml_can_be_read(self):
        for page in PAGES:
            for language, code in FENCE.findall(page.read_text()):
                if language == "yaml":
                    with self.subTest(page=page.name):
                        self.assertIsInstance(yaml.safe_load(code), dict)

    def test_the_four_bars_scene_is_the_file(self):
        page = (ROOT / "doc/closed_loops.md").read_text()
        code = next(code for language, code in FENCE.findall(page) if language == "yaml")
        shipped = yaml.safe_load((ROOT / "config/four_bar_scene.yaml").read_text())
        del shipped["reactions"]
        self.assertEqual(yaml.safe_load(code), shipped)

    def test_the_rooms_are_those_of_the_architecture(self):
        text = (ROOT / "doc" / "developer_guide.md").read_text()
        rows = re.findall(r"^\| `(\w+)` \| [^|]+ \| ([^|]+) \|$", text, re.MULTILINE)
        rooms = {room: set(re.findall(r"`(\w+)`", cell)) for room, cell in rows}
        self.assertEqual(rooms, architecture.MAY_INCLUDE)
        self.assertEqual([room for room, _ in rows], list(architecture.MAY_INCLUDE))


if __name__ == "__main__":
    unittest.main()
