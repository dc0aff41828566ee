"""A private ROS master and the processes that talk to it, all ended and forgotten together."""
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import xmlrpc.client

CALLER = '/measure_ros'
COLOURS = re.compile('\033\\[[0-9;]*m')
REAL_TIME = ['chrt', '--fifo', '10']
START_PATIENCE = 30.0  # s
STOP_PATIENCE = 60.0  # s: a recorder may have gigabytes to write


class SessionError(Exception):
    """One line that says what could not be started or went away."""


class Process:
    """A child in a process group of its own, so that Ctrl-C reaches it only through stop()."""

    def __init__(self, name, command, environment, folder):
        self.name = name
        self.log = folder / (name + '.log')
        with open(self.log, 'wb') as log:
            self.popen = subprocess.Popen(
                [str(word) for word in command], env=environment, cwd=folder, stdout=log,
                stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, start_new_session=True)

    def running(self):
        return self.popen.poll() is None

    def output(self):
        return COLOURS.sub('', self.log.read_text(errors='replace'))

    def stop(self):
        for number, patience in ((signal.SIGINT, STOP_PATIENCE), (signal.SIGKILL, 5.0)):
            if not self.running():
                return
            self.popen.send_signal(number)
            try:
                self.popen.wait(patience)
            except subprocess.TimeoutExpired:
                pass

    def cpu_seconds(self):
        """User and system time of all threads so far."""
        # The name, in brackets, may contain blanks.
        fields = pathlib.Path('/proc/%d/stat' % self.popen.pid).read_text().rpartition(')')[2]
        user, system = fields.split()[11:13]
        return (int(user) + int(system)) / os.sysconf('SC_CLK_TCK')

    def resident_mb(self):
        pages = pathlib.Path('/proc/%d/statm' % self.popen.pid).read_text().split()[1]
        return int(pages) * os.sysconf('SC_PAGE_SIZE') / 1e6


class Session:
    """With statement: a master on a free port, and a folder that is gone afterwards."""

    def __init__(self, real_time):
        """real_time: what is measured runs before everything else on the machine."""
        self.real_time = real_time

    def __enter__(self):
        self.processes = []
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='measure_ros_'))
        with socket.socket() as probe:
            probe.bind(('localhost', 0))
            port = probe.getsockname()[1]
        uri = 'http://localhost:%d' % port
        self.environment = dict(os.environ, ROS_MASTER_URI=uri, ROS_HOSTNAME='localhost',
                                ROS_HOME=str(self.folder), ROS_LOG_DIR=str(self.folder / 'log'),
                                ROSCONSOLE_FORMAT='${message}')
        self.environment.pop('ROS_IP', None)
        self.environment.pop('ROS_NAMESPACE', None)
        self.master = xmlrpc.client.ServerProxy(uri)
        try:
            self.start('rosmaster', ['rosmaster', '--core', '-p', port])
            self.wait('the ROS master', self._master_answers)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        # A second Ctrl-C must not leave processes behind.
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        for process in reversed(self.processes):
            process.stop()
        shutil.rmtree(self.folder, ignore_errors=True)
        handle_signals()

    def start(self, name, command, measured=False):
        prefix = REAL_TIME if measured and self.real_time else []
        process = Process(name, prefix + command, self.environment, self.folder)
        self.processes.append(process)
        return process

    def set_parameter(self, name, value):
        self._ask(self.master.setParam(CALLER, name, value))

    def published(self):
        """Topics that somebody advertises."""
        return {topic for topic, _ in self._ask(self.master.getSystemState(CALLER))[0]}

    def subscribers(self, topic):
        """Names of the nodes that subscribe to a topic."""
        for name, nodes in self._ask(self.master.getSystemState(CALLER))[1]:
            if name == topic:
                return set(nodes)
        return set()

    def bus_stats(self, node):
        """What a roscpp node counts of its connections: [[topic, [connection]] of the topics it
        publishes, the same of those it subscribes to]. Entry 3 of a connection is the number of
        messages sent, or of messages that found the subscriber's queue full."""
        uri = self._ask(self.master.lookupNode(CALLER, node))
        answer = xmlrpc.client.ServerProxy(uri).getBusStats(CALLER)
        # roscpp leaves the code and the message away that the ROS API puts first.
        return self._ask(answer) if answer[0] == 1 else answer

    def check(self, may_end=None):
        """Raises if a process, other than the one that may, has ended by itself."""
        for process in self.processes:
            if process is not may_end and not process.running():
                lines = process.output().strip().splitlines() or ['it said nothing']
                raise SessionError('%s has ended: %s' % (process.name, lines[-1]))

    def wait(self, what, condition, patience=START_PATIENCE):
        end = time.monotonic() + patience
        while not condition():
            self.check()
            if time.monotonic() > end:
                raise SessionError('%s: not there after %.0f s' % (what, patience))
            time.sleep(0.05)

    def _master_answers(self):
        try:
            return self.master.getPid(CALLER)[0] == 1
        except OSError:
            return False

    @staticmethod
    def _ask(answer):
        code, message, value = answer
        if code != 1:
            raise SessionError('ROS master: %s' % message)
        return value


def _interrupt(number, _frame):
    raise KeyboardInterrupt(number)


def handle_signals():
    """Ctrl-C and kill end the measurement by way of KeyboardInterrupt, whatever was inherited."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
