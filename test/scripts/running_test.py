"""scripts/running.sh: what a script has started ends with it, and leaves nothing half done."""
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

RUNNING = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'running.sh'
SCRIPT = '''set -euo pipefail
source '%s'
end_well test.sh "half of it"
temporary+=(result.part)
touch result.part
work() { exec >/dev/null 2>&1; echo $BASHPID >pid; sleep 1000 & sleep 1000; }
run work
''' % RUNNING


def lives(group):
    """Whether a process of the group is there and is not yet dead."""
    for stat in pathlib.Path('/proc').glob('[0-9]*/stat'):
        try:
            state, _, process_group = stat.read_text().rpartition(')')[2].split()[:3]
        except OSError:  # gone meanwhile
            continue
        if int(process_group) == group and state not in 'ZX':
            return True
    return False


def heed_signals():
    """Of those that are ignored from the start, as under nohup, bash takes no more notice."""
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, signal.SIG_DFL)


def ends(group):
    """Whether the group ends soon; a signal that was sent takes its time."""
    for _ in range(100):
        if not lives(group):
            return True
        time.sleep(0.1)
    return False


class RunningTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def bash(self, script):
        return subprocess.Popen(['bash', '-c', script], cwd=self.folder.name, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                preexec_fn=heed_signals)

    def test_what_runs_ends_with_the_script(self):
        for number, status in ((signal.SIGTERM, 143), (signal.SIGHUP, 143), (signal.SIGINT, 130)):
            with self.subTest(number):
                pid = pathlib.Path(self.folder.name) / 'pid'
                pid.unlink(missing_ok=True)
                script = self.bash(SCRIPT)
                while not pid.exists() or not pid.read_text().strip():
                    self.assertIsNone(script.poll())
                group = int(pid.read_text())
                script.send_signal(number)
                _, said = script.communicate(timeout=60)
                self.assertEqual(script.returncode, status)
                self.assertEqual(said.strip(), 'test.sh: interrupted; half of it')
                self.assertTrue(ends(group))
                self.assertFalse((pid.parent / 'result.part').exists())

    def test_a_status_is_handed_on(self):
        script = self.bash('source "%s"; run bash -c "exit 7" || echo "status $?"; run true && '
                           'echo well' % RUNNING)
        self.assertEqual(script.communicate()[0], 'status 7\nwell\n')

    def test_a_failure_ends_a_strict_script(self):
        script = self.bash('set -e; source "%s"; run false; echo on' % RUNNING)
        self.assertEqual(script.communicate()[0], '')
        self.assertEqual(script.returncode, 1)

    def test_of_a_build_a_log_has_the_finished_targets(self):
        script = self.bash('source "%s"; printf "%%s\\n" "[ 10%%] Building x" "[ 20%%] Built target '
                           'core" noise | show_build_progress' % RUNNING)
        self.assertEqual(script.communicate()[0], '[ 20%] Built target core\n')


if __name__ == '__main__':
    unittest.main()
