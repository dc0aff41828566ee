#!/usr/bin/env python3
"""Each rule of scripts/architecture.py is seen to fail: one forbidden include is planted at a time."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = ROOT / "scripts" / "architecture.py"

# (file, what is planted, what the program must say)
PLANTED = [
    ("src/algebra/least_norms.h", '#include "virtual_work_dynamics/mechanism.h"',
     "algebra must not include robot"),
    ("src/witness/error_bound.cpp", '#include "tree/plan.h"', "witness must not include tree"),
    ("include/virtual_work_dynamics/certificates.h",
     '#include "virtual_work_dynamics/inverse_dynamics.h"', "witness must not include tree"),
    ("src/witness/certificates.cpp", '#include "loops/kinematics.h"',
     "witness must not include loops"),
    ("src/loops/kinematics.cpp", '#include "dynamics/dynamics.h"',
     "loops must not include dynamics"),
    ("src/base/text_file.cpp", '#include "motion/simplex_search.h"',
     "base must not include motion"),
    ("src/tree/plan.cpp", "#include <ros/time.h>", "tree knows no ROS"),
    ("src/offline/rows.cpp", "#include <sensor_msgs/JointState.h>", "offline knows no ROS"),
    ("src/offline/rows.cpp", '#include "tree/plan.h"', "offline must not include tree"),
    ("src/ros/outputs.cpp", '#include "loops/forces.h"', "ros must not include loops"),
    ("src/offline/rows.cpp", '#include "ros/counters.h"', "offline must not include ros"),
    ("src/ros/counters.h", '#include "offline/rows.h"', "ros must not include offline"),
    ("src/attic/old.h", "", "'attic', has no rule"),
]


class Architecture(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        for part in ("src", "include"):
            shutil.copytree(ROOT / part, self.root / part)

    def tearDown(self):
        self.folder.cleanup()

    def look(self):
        return subprocess.run([sys.executable, str(PROGRAM), "--root", str(self.root)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def test_the_checkout_keeps_the_rules(self):
        found = self.look()
        self.assertEqual(found.returncode, 0, found.stderr)

    def test_every_rule_is_seen_to_fail(self):
        for place, line, words in PLANTED:
            with self.subTest(place=place, line=line):
                path = self.root / place
                before = path.read_text() if path.exists() else None
                path.parent.mkdir(exist_ok=True)
                path.write_text(line + "\n" + (before or ""))
                found = self.look()
                self.assertEqual(found.returncode, 1)
                self.assertIn(words, found.stderr)
                self.assertIn(place, found.stderr)
                if before is None:
                    path.unlink()
                else:
                    path.write_text(before)


if __name__ == "__main__":
    unittest.main()
