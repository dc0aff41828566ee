#!/usr/bin/python3
"""plot_residuals.py runs the tool with its options and draws what the table holds."""
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'plot_residuals.py'

# In the place of the tool: writes a table to --output, and its words beside it.
TOOL = '''#!/usr/bin/python3
import sys
words = sys.argv[1:]
if '--fail' in words:
    print('said by the tool', file=sys.stderr)
    sys.exit(1)
output = words[words.index('--output') + 1]
measured = '--residuals' in words
with open(output, 'w') as file:
    file.write('time,effort.elbow' + (',measured_effort.elbow,measured_residual.elbow,'
                                      'deviation.measured_residual.elbow' if measured else '') + '\\n')
    for i in range(9000):
        row = [i / 100, 1]
        if measured:
            row += ['', '', ''] if i < 10 else [0.9, 0.1, 0.02]
        file.write(','.join(str(cell) for cell in row) + '\\n')
'''


class PlotResiduals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.tool = self.path('tool')
        with open(self.tool, 'w', encoding='utf-8') as file:
            file.write(TOOL)
        os.chmod(self.tool, os.stat(self.tool).st_mode | stat.S_IXUSR)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_script(self, *words):
        return subprocess.run([sys.executable, str(SCRIPT), *words], stderr=subprocess.PIPE,
                              stdout=subprocess.PIPE, encoding='utf-8', check=False)

    def test_a_picture_comes_of_one_command_and_the_table_goes(self):
        done = self.run_script(self.tool, self.path('p.png'), '--residuals')
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path('p.png'), 'rb') as file:
            self.assertEqual(file.read(8), b'\x89PNG\r\n\x1a\n')
        self.assertEqual(sorted(os.listdir(self.folder)), ['p.png', 'tool'])

    def test_a_table_that_is_asked_for_stays(self):
        done = self.run_script(self.tool, self.path('p.png'), '--output', self.path('r.csv'), '--residuals')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(os.path.exists(self.path('r.csv')))

    def test_a_table_that_is_no_csv_is_refused_before_the_tool_runs(self):
        for words in (['--output', self.path('r.npz')], ['--output=' + self.path('r.bag')]):
            done = self.run_script(self.tool, self.path('p.png'), *words, '--fail')
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn('drawn from a CSV', done.stderr)

    def test_the_tools_failure_is_the_commands(self):
        done = self.run_script(self.tool, self.path('p.png'), '--fail')
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, 'said by the tool\n')
        self.assertFalse(os.path.exists(self.path('p.png')))

    def test_nothing_measured_is_said_in_a_line(self):
        done = self.run_script(self.tool, self.path('p.png'), '--urdf', 'x')
        self.assertEqual(done.returncode, 2)
        self.assertIn('--residuals or --measured FILE', done.stderr)
        self.assertEqual(self.run_script(self.tool).returncode, 2)
        self.assertEqual(self.run_script('--help').returncode, 0)


if __name__ == '__main__':
    unittest.main()
