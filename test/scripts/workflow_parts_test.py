#!/usr/bin/python3
"""The workflow's own programs without snakemake: what the config may say, and which faults are a recording's."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'workflow'))
import recordings  # noqa: E402 (the folder has to be known first)

# In the place of the tool and of the program for reports: says a line and ends with a status.
SAYS = '#!/bin/sh\n%s\necho "tool: error: %s" >&2\nexit %d\n'
RESULTS = 'for last; do :; done\n: >"$last"'  # the option --output is the last one


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='workflow_parts_'))
        self.addCleanup(shutil.rmtree, self.folder)


class Config(InFolder):
    def test_true_and_false_are_read_as_text_too(self):
        for value, known in ((True, True), (False, False), ('true', True), ('false', False), ('True', True),
                             ('False', False), (1, True), (0, False)):
            self.assertIs(recordings.truth({'pages': value}, 'pages'), known, value)
        self.assertIs(recordings.truth({}, 'keep'), False)
        for value in ('yes', 'perhaps', 2, None, ['true']):
            with self.assertRaisesRegex(recordings.ConfigError, 'keep: .* is neither true nor false'):
                recordings.truth({'keep': value}, 'keep')

    def test_names_that_a_command_would_misread_are_refused(self):
        for name in ('run 005 (again).bag', 'a+b=c@d-e.csv', 'größe.npz'):
            self.assertEqual(list(recordings.motions_of({'motions': {name: ['x.bag']}})), [name])
        for name in ("it's.bag", 'a,b.bag', '{x}.bag', '$(touch x).bag', 'a;b.bag', 'a"b.bag', 'a\nb.bag', '.',
                     '..', 'a/b', ' a', 'a ', ''):
            with self.assertRaises(recordings.ConfigError) as caught:
                recordings.motions_of({'motions': {name: ['x.bag']}})
            self.assertEqual(len(str(caught.exception).splitlines()), 1)

    def test_a_file_with_such_a_name_can_be_named_by_motions(self):
        path = self.folder / "it's, {x}.bag"
        path.touch()
        with self.assertRaisesRegex(recordings.ConfigError, 'bags: .*it.s, .x..bag.*by motions'):
            recordings.motions_of({'bags': str(self.folder)})
        self.assertEqual(recordings.motions_of({'motions': {'its_x': str(path)}}), {'its_x': [str(path)]})

    def test_the_folder_of_a_name_is_that_of_its_file(self):
        (self.folder / 'motions').mkdir()
        (self.folder / 'motions' / 'a.bag').touch()
        self.assertEqual(list(recordings.motions_of({'bags': str(self.folder)})), ['motions__a.bag'])


class OneMotion(InFolder):
    def run_one(self, tool, report):
        """The exit status with the outcome, or nothing, for programs that are given as (line, status)."""
        for name, (line, status), before in (('tool', tool, RESULTS), ('report', report, ':')):
            path = self.folder / name
            path.write_text(SAYS % (before, line, status))
            path.chmod(0o755)
        ran = subprocess.run([sys.executable, str(ROOT / 'workflow/one_motion.py'), '--folder', 'motions/a.bag',
                              '--report', str(self.folder / 'report'), '--', str(self.folder / 'tool')],
                             cwd=str(self.folder), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             encoding='utf-8', check=False)
        outcome = self.folder / 'motions/a.bag/outcome.txt'
        return ran.returncode, outcome.read_text() if outcome.exists() else None

    def test_a_fault_of_the_recording_is_an_outcome(self):
        self.assertEqual(self.run_one(('', 0), ('', 0)), (0, 'done\n'))
        self.assertEqual(self.run_one(('cut off', 1), ('', 0)), (0, 'failed: cut off\n'))
        self.assertEqual(self.run_one(('', 0), ('no rows', 1)), (0, 'failed: no rows\n'))
        # The recording may be in a folder of the name that the workflow's own has.
        self.assertEqual(self.run_one(('/data/motions/a.bag: cut off', 1), ('', 0)),
                         (0, 'failed: /data/motions/a.bag: cut off\n'))

    def test_a_fault_of_the_machine_is_to_be_done_again(self):
        for tool, report in ((('motions/a.bag/results.npz: no space', 1), ('', 0)), (('wrong usage', 2), ('', 0)),
                             (('', 0), ('No space left on device', 2)), (('killed', 137), ('', 0))):
            status, outcome = self.run_one(tool, report)
            self.assertNotEqual(status, 0)
            self.assertIsNone(outcome)


if __name__ == '__main__':
    unittest.main()
