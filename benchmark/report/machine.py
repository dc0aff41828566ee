"""What the report says about the machine and the programs, as found where it is written."""
import os
import pathlib
import platform
import re
import subprocess

GOVERNOR = pathlib.Path('/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor')
INSTRUCTIONS = (('avx2', 'AVX2'), ('fma', 'FMA'), ('avx512f', 'AVX-512F'),
                ('avx512dq', 'AVX-512DQ'))
LIBRARIES = (  # name, Debian package, pkg-config module, folder in CMake's cache
    ('Eigen', 'libeigen3-dev', 'eigen3', 'Eigen3_DIR'),
    ('Google Benchmark', 'libbenchmark-dev', 'benchmark', 'benchmark_DIR'),
    ('orocos_kdl', 'liborocos-kdl-dev', 'orocos-kdl', 'orocos_kdl_DIR'),
    ('MuJoCo', 'libmujoco-dev', 'mujoco', 'mujoco_DIR'),
    ('DART', 'libdart-dev', 'dart', 'dart_DIR'),
    ('Pinocchio', 'libpinocchio-dev', 'pinocchio', 'pinocchio_DIR'),
    ('RBDL', 'librbdl-dev', 'rbdl', 'RBDL_DIR'),
)


def _run(*command):
    """First line that a command prints; None when it fails or is not there."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              timeout=20)
    except (OSError, subprocess.TimeoutExpired):
        return None
    lines = done.stdout.decode(errors='replace').strip().splitlines()
    return lines[0].strip() if done.returncode == 0 and lines else None


def _read(path):
    try:
        return pathlib.Path(path).read_text(errors='replace')
    except OSError:
        return ''


class Build:
    """The folder in which the programs were built; its cache says with what."""

    def __init__(self, folder):
        self._cache = dict(re.findall(r'^([^#/:\n][^:\n]*):[A-Z]+=(.*)$',
                                      _read(pathlib.Path(folder) / 'CMakeCache.txt'), re.M))

    def value(self, name):
        found = self._cache.get(name, '')
        return '' if found.endswith('-NOTFOUND') else found

    def compiler(self):
        path = self.value('CMAKE_CXX_COMPILER')
        return (path and _run(path, '--version')) or 'not readable'

    def flags(self):
        kind = self.value('CMAKE_BUILD_TYPE')
        flags = ' '.join(filter(None, (self.value('CMAKE_CXX_FLAGS'),
                                       self.value('CMAKE_CXX_FLAGS_' + kind.upper()))))
        return '%s (%s)' % (kind or 'no build type', flags or 'no flags')


def _library(build, package, module, folder):
    """Version; None when it is not there."""
    debian = _run('dpkg-query', '--show', '--showformat', '${db:Status-Status} ${Version}', package)
    if debian and debian.startswith('installed '):
        return '%s (Debian package %s)' % (debian.split(' ', 1)[1], package)
    version = _run('pkg-config', '--modversion', module)
    if version:
        return version
    return 'version not readable' if build.value(folder) else None


def libraries(build):
    """[(name, version or None)]"""
    return [(name, _library(build, package, module, folder))
            for name, package, module, folder in LIBRARIES]


def _cpu():
    text = _read('/proc/cpuinfo')
    model = re.search(r'^model name\s*:\s*(.*)$', text, re.M)
    flags = re.search(r'^flags\s*:\s*(.*)$', text, re.M)
    flags = flags.group(1).split() if flags else []
    name = model.group(1) if model else platform.processor() or platform.machine()
    return name, [label for flag, label in INSTRUCTIONS if flag in flags], 'hypervisor' in flags


def _system():
    name = re.search(r'^PRETTY_NAME="?([^"\n]*)', _read('/etc/os-release'), re.M)
    return '%s, Linux %s' % (name.group(1) if name else 'unknown system', platform.release())


def facts(build, repository, load):
    """[(what, value)]: the machine, the system, the build. load: the average before, or None."""
    cpu, instructions, virtual = _cpu()
    version = re.search(r'<version>(.*)</version>', _read(repository / 'package.xml'))
    commit = _run('git', '-C', str(repository), 'describe', '--always', '--dirty', '--abbrev=12')
    return [
        ('CPU', cpu + (', in a virtual machine' if virtual else '')),
        ('Cores', '%d' % os.cpu_count()),
        ('Vector instructions', ', '.join(instructions) or 'none of those asked for'),
        ('Frequency governor', _read(GOVERNOR).strip() or 'not readable'),
        ('System', _system()),
        ('Load average before the run', load or 'not known'),
        ('Compiler', build.compiler()),
        ('Build type', build.flags()),
        ('Package', 'virtual_work_dynamics %s%s' % (
            version.group(1) if version else 'of unknown version',
            ', commit ' + commit if commit else '')),
    ]
