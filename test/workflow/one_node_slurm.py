"""A Slurm of one node, this machine, with its own folders and ports, for tests: munged, slurmctld and slurmd
in the foreground, ended with the test. A start that fails is an error with the last lines of the logs."""
import ctypes
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

CONFIG = """
ClusterName=test
SlurmctldHost={host}
SlurmctldPort={controller}
SlurmdPort={node}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
MailProg=/bin/true
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MinJobAge=300
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
PATIENCE = 60  # s, for all of it to start


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    try:
        for one in sockets:
            one.bind(('127.0.0.1', 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()


def memory_of_machine():
    """MiB"""
    return os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') // 2 ** 20


def end_with_parent():
    """In a child: it is ended when its parent is, however that ends."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class OneNodeSlurm:
    """A context; `environment` is for programs that use it."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.daemons = []
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / 'slurm.conf'),
                                PATH='/usr/sbin:' + os.environ['PATH'])

    def __enter__(self):
        try:
            self._prepare()
            self._munge()
            self._start('slurmctld', '-D', '-i')
            self._start('slurmd', '-D', '-N', self.host)
            self._wait('node', lambda: 'idle' in self._asked('sinfo', '--noheader', '--format=%T'))
        except BaseException:
            self.__exit__()
            raise
        return self

    def _prepare(self):
        for name in ('state', 'spool', 'logs'):
            (self.folder / name).mkdir(parents=True)
        for folder in (self.folder, self.folder / 'logs'):
            folder.chmod(0o755)  # as munged demands it
        self.host = socket.gethostname().split('.')[0]
        controller, node = free_ports(2)
        user = 'root' if os.getuid() == 0 else os.environ.get('USER', 'nobody')
        (self.folder / 'slurm.conf').write_text(CONFIG.format(
            host=self.host, controller=controller, node=node, folder=self.folder, cpus=os.cpu_count(),
            memory=memory_of_machine() * 9 // 10, user=user))
        (self.folder / 'cgroup.conf').write_text('CgroupAutomount=no\n')

    def _munge(self):
        key = self.folder / 'munge.key'
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self._start('munged', '--foreground', '--force', '--key-file=%s' % key,
                    '--socket=%s/munge.socket' % self.folder, '--pid-file=%s/munged.pid' % self.folder,
                    '--log-file=%s/logs/munged.own' % self.folder, '--seed-file=%s/munged.seed' % self.folder)
        self._wait('munged', (self.folder / 'munge.socket').exists)

    def _start(self, program, *words):
        found = shutil.which(program, path=self.environment['PATH'])
        if found is None:
            raise RuntimeError('%s is not installed: scripts/install_dependencies.sh --workflow' % program)
        log = open(self.folder / 'logs' / program, 'wb')
        process = subprocess.Popen([found] + list(words), stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                   env=self.environment, start_new_session=True,
                                   preexec_fn=end_with_parent)
        log.close()
        self.daemons.append((program, process))

    def _asked(self, *words):
        ran = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding='utf-8',
                             env=self.environment)
        return ran.stdout

    def _wait(self, what, ready):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            for program, process in self.daemons:
                if process.poll() is not None:
                    raise RuntimeError('%s ended with status %d:\n%s'
                                       % (program, process.returncode, self.logs()))
            if ready():
                return
            time.sleep(0.2)
        raise RuntimeError('%s is not ready after %d s:\n%s' % (what, PATIENCE, self.logs()))

    def logs(self):
        return '\n'.join('%s: %s' % (log.name, '\n  '.join(log.read_text(errors='replace').splitlines()[-8:]))
                         for log in sorted((self.folder / 'logs').iterdir()))

    def __exit__(self, *_):
        for _, process in reversed(self.daemons):
            if process.poll() is None:
                process.terminate()
                try:
                    process.wait(10)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
