#!/usr/bin/env python3
"""Prints the folders of the package and the includes between them, and checks them against the rules.

A folder may include the folders that stand for it in MAY_INCLUDE, and no others. A header of
include/ belongs to the folder that has its source file, or to the one that HEADERS_WITHOUT_SOURCE
names. The exit code is 1 when an include breaks a rule, or when a file lies in no known folder.
"""
import argparse
import pathlib
import re
import sys
from collections import Counter

# From the ground up. A mechanism with closed loops is the tree's recursion and algebra; witnesses
# share nothing with either; whatever talks to users goes through `dynamics`.
MAY_INCLUDE = {
    "base": set(),
    "algebra": {"base"},
    "results": set(),
    "robot": {"base"},
    "motion": {"base", "robot"},
    "scene": {"base", "robot", "motion", "results"},
    "tree": {"base", "robot", "motion", "scene", "results"},
    "generate": {"algebra", "base", "loops", "motion", "results", "robot", "scene", "tree"},
    "loops": {"base", "algebra", "robot", "motion", "scene", "results", "tree"},
    "witness": {"base", "robot", "motion", "scene", "results"},
    "dynamics": {"base", "robot", "motion", "scene", "results", "tree", "loops", "witness"},
    "identification": {"base", "robot", "motion", "scene", "results", "dynamics"},
    "bag": {"base"},
    "npz": {"base"},
    "offline": {"base", "robot", "motion", "scene", "results", "witness", "dynamics", "identification",
                "bag", "npz", "generate"},
    "ros": {"base", "robot", "motion", "scene", "results", "witness", "dynamics"},
    "replay": {"base", "robot", "motion", "scene", "results", "dynamics", "bag", "offline", "ros"},
    "programs": {"base", "offline", "ros", "replay"},
}
KNOWS_ROS = {"ros", "replay", "programs"}
HEADERS_WITHOUT_SOURCE = {
    "error": "base",
    "given": "scene",
    "motion": "motion",
    "motion_covariance": "motion",
    "noise_settings": "motion",
    "motion_table": "motion",
    "notation": "results",
    "plan_summary": "tree",
    "request": "results",
}
PUBLIC = "virtual_work_dynamics/"
ROS_HEADER = re.compile(
    r"^(ros|ros\w+|\w+_msgs|diagnostic_updater|tf|tf2|tf2_ros|xmlrpcpp|XmlRpc\w*)(/|\.h$)")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)


class Architecture:
    """The includes of a checkout, by folder."""

    def __init__(self, root):
        self.files = {}  # path below root -> folder
        self.includes = []  # (path, folder, included, its folder)
        self.problems = []
        source = root / "src"
        self._homes = {
            path.stem: self._folder_of(path.relative_to(source))
            for path in sorted(source.rglob("*.cpp"))
        }
        for top in ("include", "src"):
            for path in sorted((root / top).rglob("*")):
                if path.suffix in (".h", ".cpp"):
                    self._read(root, path)

    @staticmethod
    def _folder_of(below_src):
        return below_src.parts[0] if len(below_src.parts) > 1 else "programs"

    def _home_of_public(self, name):
        stem = pathlib.PurePath(name).stem
        return HEADERS_WITHOUT_SOURCE.get(stem) or self._homes.get(stem)

    def _read(self, root, path):
        place = path.relative_to(root)
        folder = (self._home_of_public(place.name) if place.parts[0] == "include"
                  else self._folder_of(place.relative_to("src")))
        if folder not in MAY_INCLUDE:
            self.problems.append(f"{place}: its folder, '{folder}', has no rule in {__file__}")
            return
        self.files[place] = folder
        for quote, name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            if quote == "<":
                if ROS_HEADER.match(name) and folder not in KNOWS_ROS:
                    self.problems.append(f"{place} includes <{name}>: {folder} knows no ROS")
                continue
            target = (self._home_of_public(name) if name.startswith(PUBLIC)
                      else self._folder_of(pathlib.PurePath(name)))
            self.includes.append((place, folder, name, target))
            if target != folder and target not in MAY_INCLUDE[folder]:
                allowed = ", ".join(sorted(MAY_INCLUDE[folder])) or "no other folder"
                self.problems.append(
                    f'{place} includes "{name}": {folder} must not include {target}, '
                    f"only {allowed}")

    def table(self):
        """Lines: each folder, how many files and lines it has, and whom it includes how often."""
        files = Counter(self.files.values())
        between = Counter((folder, target) for _, folder, _, target in self.includes
                          if folder != target)
        lines = []
        for folder in MAY_INCLUDE:
            if files[folder] == 0:
                continue
            uses = ", ".join(f"{target} {between[folder, target]}" for target in MAY_INCLUDE
                             if between[folder, target])
            lines.append(f"{folder:<10}{files[folder]:>4} files   includes {uses or 'no other folder'}")
        return lines


def main():
    parser = argparse.ArgumentParser(
        description="Prints the folders of src/ and include/, and how often each includes the others; "
        "checks that no include is against the rules, which stand at the top of this program.")
    parser.add_argument("--root", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent.parent,
                        help="checkout to look at (default: this one)")
    architecture = Architecture(parser.parse_args().root)
    print("\n".join(architecture.table()))
    for problem in architecture.problems:
        print(problem, file=sys.stderr)
    count = len(architecture.problems)
    print(f"{len(architecture.includes)} includes, {count} against the rules")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
