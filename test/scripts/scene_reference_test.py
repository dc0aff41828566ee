#!/usr/bin/env python3
"""doc/scene_file.md names every key that the scene reader accepts, with its default, and no other.

The keys are those of src/scene/*reader*.cpp, the defaults those of scene.h and of the scene that
config/inverse_dynamics.yaml shows.
"""
import pathlib
import re
import shutil
import tempfile
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
HEADER = "include/virtual_work_dynamics/scene.h"
PAGE = "doc/scene_file.md"

# Lists of keys in the reader, and the maps of a scene that have them.
MAPS = {
    "kSceneKeys": ("",),
    "kMomentKeys": ("moments_about",),
    "kWrenchKeys": ("applied_wrenches",),
    "kWrenchDeviationKeys": ("applied_wrenches.deviation",),
    "kPayloadKeys": ("payload",),
    "kJointKeys": ("joints",),
    "kTypeKeys": ("joint_types",),
    "kToleranceKeys": ("tolerances",),
    "kClosureKeys": ("closures",),
    "kFrameKeys": ("closures.parent", "closures.child"),
    "kSpringKeys": ("springs",),
    "kRollingKeys": ("rolling",),
    "kPlaneKeys": ("rolling.plane",),
    "kKnifeEdgeKeys": ("knife_edges",),
    "kContactKeys": ("contacts",),
    "kGapKeys": ("contacts.gap",),
    "kCylinderKeys": ("cylinders",),
    "kCouplingKeys": ("couplings",),
    "kDriveKeys": ("drives",),
    "kRedundancyKeys": ("redundancy",),
}
# Lists of {name, <quantity>} that readNamedNumbers() reads.
NAMED_NUMBERS = {"position": "assembly", "stiffness": "redundancy.stiffness",
                 "weight": "redundancy.effort_weights", "factor": "couplings.terms"}
STRUCTS = {"": "Scene", "moments_about": "MomentPoint", "applied_wrenches": "AppliedWrench",
           "applied_wrenches.deviation": "WrenchDeviation",
           "payload": "Payload", "joints": "JointTerms",
           "tolerances": "Tolerances",
           "rolling": "Touch", "contacts": "Touch",
           "closures.parent": "LinkFrame", "closures.child": "LinkFrame", "springs": "PointSpring",
           "couplings": "Coupling", "drives": "DriveLaw",
           "redundancy": "Redundancy"}
# Members that have other names, or other values, than their keys.
MEMBERS = {"motion": "static_motion", "root": "root_moves", "payload": "payloads"}
VALUES = {"motion": {False: "full", True: "static"}, "root": {False: "fixed", True: "moving"}}
# Which tables of the page stand for which maps: the heading, or the line before a table in it.
TABLES = {"Top level": [""], "moments_about": ["moments_about"],
          "applied_wrenches": ["applied_wrenches", "applied_wrenches.deviation"], "payload": ["payload"], "joints": ["joints"],
          "joint_types": ["joint_types"],
          "tolerances": ["tolerances"],
          "closures": ["closures", ("closures.parent", "closures.child")], "springs": ["springs"],
          "couplings": ["couplings", "couplings.terms"],
          "rolling": ["rolling", "rolling.plane"], "knife_edges": ["knife_edges"],
          "contacts": ["contacts", "contacts.gap"], "cylinders": ["cylinders"],
          "drives": ["drives"],
          "assembly": ["assembly"],
          "redundancy": ["redundancy", "redundancy.stiffness", "redundancy.effort_weights"]}
HEAD = "| key | value | default | meaning |"


def accepted_keys(root):
    """Every path that the reader accepts, and what in the reader this program cannot place."""
    paths, unplaced, known = set(), [], set()
    for source in sorted((root / "src" / "scene").glob("*reader*.cpp")):
        text = source.read_text()
        for name, body in re.findall(r"const Names (k\w*Keys) = \{([^}]*)\}", text):
            keys = re.findall(r'"(\w+)"', body)
            known.update(keys)
            if name not in MAPS:
                unplaced.append(f"{source.name}: {name}")
            paths.update((place, key) for place in MAPS.get(name, ()) for key in keys)
        for quantity in re.findall(r'readNamedNumbers\(value, \w+, "(\w+)"\)', text):
            known.update(("name", quantity))
            if quantity not in NAMED_NUMBERS:
                unplaced.append(f"{source.name}: a list of names with '{quantity}'")
                continue
            paths.update({(NAMED_NUMBERS[quantity], "name"), (NAMED_NUMBERS[quantity], quantity)})
        # Keys of the top level that are read one by one.
        loop = re.search(r"bool read(?:Loop|Touch)Entry\(.*?\n}", text, re.DOTALL)
        if loop:
            keys = re.findall(r'key == "(\w+)"', loop.group())
            known.update(keys)
            paths.update(("", key) for key in keys)
        unplaced += [f"{source.name}: key '{key}' is in no list" for key in
                     sorted(set(re.findall(r'key == "(\w+)"', text)) - known)]
    return paths, unplaced


def documented_keys(root):
    """(map, key) -> default as the page writes it, without its backquotes; and what is wrong."""
    found, problems = {}, []
    heading, tables = "", 0
    places = None
    for line in (root / PAGE).read_text().splitlines():
        if line.startswith("## "):
            heading, tables, places = line[3:].strip(), 0, None
        elif line == HEAD:
            maps = TABLES.get(heading, [])
            if tables >= len(maps):
                problems.append(f"{PAGE}: a table of keys under '{heading}' that is not expected")
                places = ()
            else:
                places = maps[tables] if isinstance(maps[tables], tuple) else (maps[tables],)
            tables += 1
        elif not line.startswith("|"):
            places = None
        elif places is not None and not line.startswith("|---"):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            for place in places:
                found[place, cells[0].strip("`")] = cells[2].strip("`")
    return found, problems


def members(root):
    """struct -> member -> initializer; None where there is none."""
    structs = {}
    text = re.sub(r"//.*", "", (root / HEADER).read_text())
    for name, body in re.findall(r"^struct (\w+) \{(.*?)^\};", text, re.DOTALL | re.MULTILINE):
        structs[name] = {}
        for declaration in body.split(";"):
            match = re.match(r"\s*([\w:<>, ]+?)\s+(\w+(?:, \w+)*)\s*(?:=\s*(.+)|\{(.+)\})?$",
                             declaration.strip(), re.DOTALL)
            if match:
                kind, names, value, braces = match.groups()
                for member in names.split(", "):
                    structs[name][member] = (kind, f"[{braces}]" if braces else value)
    return structs


def default_of(kind, initializer):
    """What a key has that is not given, as YAML would read it; None: the header does not say."""
    if initializer is None:
        return [] if kind.startswith("std::vector") else None
    if initializer.endswith("Zero()"):
        return [0] * (6 if "Matrix3d" in initializer else 3)  # of a symmetric matrix
    if re.fullmatch(r"\w+::k\w+", initializer):
        word = initializer.split("::k")[1]
        return re.sub(r"(?<!^)([A-Z])", r"_\1", word).lower()
    return number(yaml.safe_load(initializer))


def number(value):
    """YAML 1.1 takes 1e-10 for a text."""
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return value
    return value


def problems_of(root):
    """Everything in which page, reader, header and configuration disagree."""
    accepted, unplaced = accepted_keys(root)
    documented, problems = documented_keys(root)
    problems += [f"the test cannot place {what}" for what in unplaced]

    def path(place, key):
        return f"{place}.{key}" if place else key

    problems += [f"{PAGE} lacks the key {path(*key)}" for key in sorted(accepted - set(documented))]
    problems += [f"{PAGE} has the key {path(*key)}, which the reader does not know"
                 for key in sorted(set(documented) - accepted)]

    structs = members(root)
    for (place, key), text in sorted(documented.items()):
        if not text:
            problems.append(f"{PAGE}: {path(place, key)} has no default")
        kind_and_value = structs.get(STRUCTS.get(place), {}).get(MEMBERS.get(key, key))
        if kind_and_value is None or text == "required":
            continue
        expected = default_of(*kind_and_value)
        if key in VALUES:
            expected = VALUES[key][expected]
        if expected is not None and number(yaml.safe_load(text)) != expected:
            problems.append(f"{PAGE}: default of {path(place, key)} is {text}, in {HEADER} it is "
                            f"{expected}")
    return problems + problems_of_configuration(root, documented)


def problems_of_configuration(root, documented):
    name = "config/inverse_dynamics.yaml"
    lines = (root / name).read_text().splitlines()
    start = lines.index("# scene:")
    shown = yaml.safe_load("\n".join(line[2:] for line in lines[start:]))["scene"]
    problems = []
    for place, values in (("", shown), ("redundancy", shown["redundancy"])):
        keys = {key for where, key in documented if where == place}
        problems += [f"{name}: the scene's {place or 'top level'} lacks or has too much: {key}"
                     for key in sorted(keys ^ set(values))]
        for key in sorted(keys & set(values) - {"actuated", "given", "redundancy"}):
            if number(values[key]) != number(yaml.safe_load(documented[place, key])):
                problems.append(f"{name}: {key} is {values[key]}, in {PAGE} it is "
                                f"{documented[place, key]}")
    return problems


# (file, text, what takes its place, what must be said)
BROKEN = [
    (PAGE, "| `strict_inertia` |", "| `strict_inertias` |", "lacks the key strict_inertia"),
    (PAGE, "| `strict_inertia` |", "| `strict_inertias` |",
     "the key strict_inertias, which the reader does not know"),
    (PAGE, "| `rpy` |", "| `quaternion` |", "lacks the key closures.child.rpy"),
    (PAGE, "| `weight` |", "| `weights` |", "lacks the key redundancy.effort_weights.weight"),
    (PAGE, "| `0.001` |", "| `0.01` |", "default of joints.coulomb_velocity is 0.01"),
    (PAGE, "| `1e-10` |", "| `1e-9` |", "default of redundancy.rank_tolerance is 1e-9"),
    (PAGE, "| `[0, 0, -9.81]` |", "| `[0, 0, 9.81]` |", "default of gravity"),
    (PAGE, "`link` or `root` | `link` |", "`link` or `root` | `root` |",
     "default of applied_wrenches.axes is root"),
    (PAGE, "| `full` or `static` | `full` |", "| `full` or `static` | `static` |",
     "default of motion is static"),
    (PAGE, "| `rest_length` | number, m | `0` |", "| `rest_length` | number, m | |",
     "springs.rest_length has no default"),
    (PAGE, "| `roller_angle` |", "| `roller` |", "lacks the key rolling.roller_angle"),
    (PAGE, "`rolling`, `lateral` or `all` | `none` |", "`rolling`, `lateral` or `all` | `all` |",
     "default of rolling.slip is all"),
    (HEADER, "bool closed = true;", "bool closed = false;", "default of contacts.closed is true"),
    (HEADER, "double coulomb_velocity = 1e-3;", "double coulomb_velocity = 1e-2;",
     "default of joints.coulomb_velocity"),
    ("src/scene/closure_reader.cpp", '{"link", "xyz", "rpy"}', '{"link", "xyz", "rpy", "axis"}',
     "lacks the key closures.parent.axis"),
    ("src/scene/closure_reader.cpp", "const Names kSpringKeys = ",
     'const Names kGearKeys = {"ratio"};\nconst Names kSpringKeys = ', "cannot place"),
    ("src/scene/scene_reader.cpp", 'if (key == "motion")', 'if (key == "haste")', "key 'haste'"),
    ("config/inverse_dynamics.yaml", "#   include_active: true", "#   include_active: false",
     "include_active is False"),
    ("config/inverse_dynamics.yaml", "#   strict_inertia: false", "#   strict_inertai: false",
     "lacks or has too much: strict_inertai"),
]


class SceneReference(unittest.TestCase):
    def test_the_page_is_what_the_reader_reads(self):
        self.assertEqual(problems_of(ROOT), [])
        self.assertGreater(len(documented_keys(ROOT)[0]), 50)

    def test_every_disagreement_is_seen(self):
        for place, text, other, words in BROKEN:
            with self.subTest(place=place, text=text), tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                for part in ("src/scene", "include", "doc", "config"):
                    shutil.copytree(ROOT / part, root / part,
                                    ignore=shutil.ignore_patterns("*.png"))
                path = root / place
                before = path.read_text()
                self.assertIn(text, before)
                path.write_text(before.replace(text, other, 1))
                self.assertTrue(any(words in problem for problem in problems_of(root)),
                                problems_of(root))


if __name__ == "__main__":
    unittest.main()
