#!/usr/bin/python3
"""The workflow over many recordings, one of them broken and one whose job is killed: on this machine and on a
Slurm of one node. All others complete, starting again does only what is missing, results are equal.

Usage: workflow_test.py [--tool inverse_dynamics_offline] [--recordings N]   (default: 24; 200 take minutes)
"""
import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from make_recordings import make_recordings  # noqa: E402 (the path has to be set first)
from one_node_slurm import OneNodeSlurm  # noqa: E402

OPTIONS = argparse.Namespace(tool=None, recordings=24)
BROKEN, KILLED, BLANKS = 3, 11, 5  # recordings by number; BLANKS has some in its name
PATIENCE = 3000  # s

# The tool, which of one recording waits for its end when it is first started.
TOOL = """#!/bin/bash
for word in "$@"; do
  if [[ $word == *"{killed}" && ! -e "{folder}/was_killed" ]]; then
    echo $$ >"{folder}/to_kill.part"
    mv "{folder}/to_kill.part" "{folder}/to_kill"
    exec sleep 3000
  fi
done
exec "{tool}" "$@"
"""


def name_of(number):
    return ('run_%03d.bag' if number != BLANKS else 'run %03d (again).bag') % number


def job_of(motion, log):
    """The number that snakemake has given to the job of a recording."""
    return re.search(r'^    output: motions/%s/outcome\.txt\n    jobid: (\d+)$' % re.escape(motion), log,
                     re.MULTILINE).group(1)


class Run:
    """Snakemake in a folder of its own."""

    def __init__(self, folder, recordings, environment, *words):
        self.folder = folder
        folder.mkdir()
        self.environment = dict(environment, HOME=str(folder), XDG_CACHE_HOME=str(folder / 'cache'))
        tool = folder / 'tool.sh'
        tool.write_text(TOOL.format(killed=name_of(KILLED), folder=folder, tool=OPTIONS.tool))
        tool.chmod(0o755)
        self.work = folder / 'work'
        self.command = ['/usr/bin/snakemake', '--snakefile', str(ROOT / 'workflow/Snakefile'), '--directory',
                        str(self.work)] + list(words) + [
                            '--config', 'robot=%s' % (ROOT / 'urdf/six_axis_arm.urdf'), 'bags=%s' % recordings,
                            'program=%s' % tool]

    def start(self, log):
        with open(self.folder / log, 'wb') as file:
            return subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=file,
                                    stderr=subprocess.STDOUT, env=self.environment)

    def log(self, log):
        return (self.folder / log).read_text(errors='replace')

    def outcomes(self):
        return {path.parent.name: (path.read_text(), path.stat().st_mtime_ns)
                for path in self.work.glob('motions/*/outcome.txt')}

    def merged(self):
        return (self.work / 'merged/loads.csv').read_bytes()


class Workflow(unittest.TestCase):
    results = {}  # merged loads by where they were computed

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix='workflow_'))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.recordings = cls.folder / 'recordings'
        make_recordings(cls.recordings, OPTIONS.recordings, name_of)
        broken = cls.recordings / name_of(BROKEN)
        broken.write_bytes(broken.read_bytes()[:3000])  # the first record of a bag is longer

    def wait_for(self, what, process, log):
        end = time.monotonic() + PATIENCE
        while not what():
            self.assertIsNone(process.poll(), log())
            self.assertLess(time.monotonic(), end, log())
            time.sleep(0.2)

    def check_run(self, run, kill):
        """The whole story; `kill` ends the job of a process."""
        process = run.start('first.log')
        self.addCleanup(process.kill)
        self.wait_for((run.folder / 'to_kill').exists, process, lambda: run.log('first.log')[-3000:])
        (run.folder / 'was_killed').touch()
        kill(int((run.folder / 'to_kill').read_text()))
        self.assertNotEqual(process.wait(PATIENCE), 0)
        first = run.outcomes()
        self.assertEqual(sorted(set(map(name_of, range(OPTIONS.recordings))) - set(first)), [name_of(KILLED)],
                         run.log('first.log')[-3000:])
        self.assertFalse((run.work / 'merged').exists() and list((run.work / 'merged').iterdir()))
        again = run.start('second.log')
        self.addCleanup(again.kill)
        self.assertEqual(again.wait(PATIENCE), 0, run.log('second.log')[-3000:])
        self.assertEqual(len(re.findall(r'^rule loads:', run.log('second.log'), re.MULTILINE)), 1)
        second = run.outcomes()
        self.assertEqual(len(second), OPTIONS.recordings)
        for name, outcome in first.items():
            self.assertEqual(second[name], outcome, 'was done again: ' + name)
        self.check_outcomes(run, second)
        third = run.start('third.log')
        self.assertEqual(third.wait(PATIENCE), 0)
        self.assertIn('Nothing to be done', run.log('third.log'))

    def check_outcomes(self, run, outcomes):
        for name, (text, _) in outcomes.items():
            self.assertEqual(text.startswith('failed: '), name == name_of(BROKEN), name + ': ' + text)
        report = (run.work / 'merged/report.md').read_text(encoding='utf-8')
        self.assertIn('1 without a report', report)
        self.assertRegex(report, '`%s`: .' % re.escape(name_of(BROKEN)))
        self.assertIn('in %d motions' % (OPTIONS.recordings - 1), report)
        self.assertFalse(list(run.work.glob('motions/*/results.npz')))
        if Workflow.results:
            where, merged = next(iter(Workflow.results.items()))
            self.assertEqual(run.merged(), merged, 'not as ' + where)
        Workflow.results[run.folder.name] = run.merged()

    def test_on_this_machine(self):
        run = Run(self.folder / 'local', self.recordings, os.environ, '--cores', 'all', '--keep-going')
        self.check_run(run, lambda process: os.kill(process, signal.SIGKILL))

    def test_on_a_slurm_of_one_node(self):
        with OneNodeSlurm(self.folder / 'slurm_of_test') as slurm:
            run = Run(self.folder / 'slurm', self.recordings, slurm.environment,
                      '--profile', str(ROOT / 'workflow/slurm'), '--latency-wait', '20')

            def cancel(_):
                job = job_of(name_of(KILLED), run.log('first.log'))
                subprocess.run(['scancel', '--name', 'loads.loads.%s' % job], check=True, env=slurm.environment)
            self.check_run(run, cancel)
            jobs = list(run.work.glob('slurm_logs/*.loads.log'))
            self.assertEqual(len(jobs), OPTIONS.recordings + 1)  # that it was Slurm who did it

    def test_a_wrong_config_is_one_line(self):
        for words, why in ((['robot=/not/there'], 'robot: /not/there is not there'),
                           (['bags=/not/there'], 'bags: /not/there is not a folder'),
                           (['pages=perhaps'], "pages: 'perhaps' is neither true nor false"),
                           (['nonsense=1'], "unknown key 'nonsense'")):
            run = Run(self.folder / ('config_' + words[0].split('=')[0]), self.recordings, os.environ,
                      '--cores', '1')
            run.command += words
            self.assertNotEqual(run.start('log').wait(PATIENCE), 0)
            self.assertIn('config: ' + why, run.log('log'))


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--tool', default=str(
        ROOT / 'build/.catkin_ws/devel/lib/virtual_work_dynamics/inverse_dynamics_offline'))
    parser.add_argument('--recordings', type=int, default=OPTIONS.recordings)
    known, others = parser.parse_known_args(namespace=OPTIONS)
    unittest.main(argv=sys.argv[:1] + others)
