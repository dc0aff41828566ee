"""What the workflow is asked for: recordings by name, and the commands for them."""
import os
import re
import shlex
import shutil

KINDS = ('.bag', '.csv', '.npz')
KNOWN = {'robot', 'bags', 'motions', 'scene', 'options', 'woehler', 'pages', 'keep', 'program'}
TRUTHS = {'true': True, 'false': False, '1': True, '0': False}  # --config gives them as text
# Names become folders and words of commands: Snakemake and Slurm read commas, braces and quotes as their own.
NAME = re.compile(r'[\w .()+=@-]+')


class ConfigError(Exception):
    """What is wrong with the config, in one line."""


class Settings:
    """The config, checked."""

    def __init__(self, config, here):
        unknown = sorted(set(config) - KNOWN)
        if unknown:
            raise ConfigError('unknown key %r; there are %s' % (unknown[0], ', '.join(sorted(KNOWN))))
        self.here = here
        self.robot = self._file(config, 'robot')
        self.scene = self._file(config, 'scene') if config.get('scene') else None
        self.options = shlex.split(str(config.get('options', '')))
        self.woehler = str(config.get('woehler', 5))
        self.pages, self.keep = truth(config, 'pages'), truth(config, 'keep')
        self.program = program(config.get('program'), here)
        self.motions = motions_of(config)

    @staticmethod
    def _file(config, key):
        if not config.get(key):
            raise ConfigError('%s is missing' % key)
        path = os.path.abspath(str(config[key]))
        if not os.path.isfile(path):
            raise ConfigError('%s: %s is not there' % (key, path))
        return path

    @property
    def described(self):
        return [self.robot] + ([self.scene] if self.scene else [])

    def _tool(self):
        words = [self.program, '--urdf', self.robot]
        return words + (['--scene', self.scene] if self.scene else [])

    def check_command(self):
        return quoted(self._tool() + self.options + ['--check'])

    def motion_command(self, motion):
        words = ['/usr/bin/python3', os.path.join(self.here, 'one_motion.py'), '--folder',
                 os.path.join('motions', motion), '--report', self._report(), '--woehler', self.woehler]
        words += ['--pages'] if self.pages else []
        words += ['--keep'] if self.keep else []
        return quoted(words + ['--'] + self._tool() + self.options + ['--motion'] + self.motions[motion])

    def merge_command(self, folder, names):
        return quoted([self._report(), '--merge', '@' + names, '--output', folder])

    def _report(self):
        """The program for reports: of this checkout, or beside the installed tool, or with its data."""
        tool = os.path.dirname(self.program)
        name = 'load_report.py'
        places = [os.path.join(os.path.dirname(self.here), 'scripts'), tool, os.path.dirname(self.here)]
        found = next((place for place in places if os.path.isfile(os.path.join(place, name))), None)
        if found is None:
            raise ConfigError('program: there is no %s beside %s' % (name, self.program))
        return os.path.join(found, name)


def quoted(words):
    return ' '.join(shlex.quote(str(word)) for word in words)


def truth(config, key):
    value = config.get(key, False)
    known = TRUTHS.get(str(value).lower())
    if known is None:
        raise ConfigError('%s: %r is neither true nor false' % (key, value))
    return known


def check_name(name, place):
    """Refuses what cannot be the name of a recording. `place`: what it is the name of, for the user."""
    if not NAME.fullmatch(name) or name in ('.', '..') or name != name.strip():
        raise ConfigError('%s: a name is made of letters, digits, blanks within and _ . ( ) + = @ -; '
                          'give it another one by motions' % place)


def program(named, here):
    """The offline tool: as named, beside this package's build, or by PATH."""
    name = 'inverse_dynamics_offline'
    if named:
        found = shutil.which(os.path.abspath(str(named)))
        if found is None:
            raise ConfigError('program: %s cannot be run' % named)
        return found
    built = os.path.join(os.path.dirname(here), 'build', '.catkin_ws', 'devel', 'lib', 'virtual_work_dynamics')
    prefixes = os.environ.get('CMAKE_PREFIX_PATH', '').split(os.pathsep)
    places = [os.path.join(p, 'lib', 'virtual_work_dynamics') for p in prefixes if p] + [built]
    found = shutil.which(name) or shutil.which(name, path=os.pathsep.join(places))
    if found is None:
        raise ConfigError('program: %s is not in PATH; source the setup.bash of its build, or name it' % name)
    return found


def motions_of(config):
    """Files of each recording by its name."""
    if config.get('motions'):
        motions = {str(name): [os.path.abspath(part) for part in ([parts] if isinstance(parts, str) else parts)]
                   for name, parts in config['motions'].items()}
        for name in motions:
            check_name(name, 'motions: %r' % name)
        return motions
    bags = config.get('bags')
    if not bags:
        raise ConfigError('bags is missing')
    if not isinstance(bags, str):
        return named([(path, os.path.basename(path)) for path in bags])
    if not os.path.isdir(bags):
        raise ConfigError('bags: %s is not a folder' % bags)
    files = []
    for folder, folders, names in os.walk(bags):
        folders.sort()
        files += [os.path.join(folder, name) for name in sorted(names) if name.endswith(KINDS)]
    if not files:
        raise ConfigError('bags: there are no %s in %s' % (', '.join('*' + kind for kind in KINDS), bags))
    return named([(path, os.path.relpath(path, bags).replace(os.sep, '__')) for path in files])


def named(files):
    motions = {}
    for path, name in files:
        check_name(name, 'bags: %r' % path)
        if name in motions:
            raise ConfigError('bags: two recordings are called %s; name them by motions' % name)
        motions[name] = [os.path.abspath(path)]
    return motions
