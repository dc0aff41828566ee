"""A recording by the offline tool: its motion, efforts as described, the regressor, measured efforts."""
import csv
import json
import os
import shutil
import subprocess

import numpy as np

from .refusal import Refusal, in_quotes

TOOL = 'inverse_dynamics_offline'
MEASURED = 'measured_effort.'


def find_tool(given, program):
    """The path of the offline tool: as given, beside this program, of the workspace, or in PATH."""
    if given:
        if not os.access(given, os.X_OK):
            raise Refusal('--tool: %s is not a program' % in_quotes(given))
        return given
    folder = os.path.dirname(os.path.realpath(program))
    places = [os.path.join(os.path.dirname(os.path.abspath(program)), TOOL), os.path.join(folder, TOOL)]
    for prefix in os.environ.get('CMAKE_PREFIX_PATH', '').split(':'):
        if prefix:
            places.append(os.path.join(prefix, 'lib', 'virtual_work_dynamics', TOOL))
    build = os.path.join(os.path.dirname(folder), 'build')
    places += [os.path.join(build, '.catkin_ws', 'devel', 'lib', 'virtual_work_dynamics', TOOL),
               os.path.join(build, 'core', TOOL)]
    for place in places:
        if os.access(place, os.X_OK):
            return place
    found = shutil.which(TOOL)
    if not found:
        raise Refusal('%s is not found: source the setup.bash of its workspace, or give --tool' % TOOL)
    return found


def read_numbers(path):
    """Rows of a CSV after its header; an empty cell is not a number."""
    try:
        return np.loadtxt(path, delimiter=',', skiprows=1, ndmin=2)
    except ValueError:  # the other reader takes empty cells, and ten times as long
        return np.atleast_2d(np.genfromtxt(path, delimiter=',', skip_header=1, invalid_raise=False))


class Tool:
    """Runs the offline tool on a robot."""

    def __init__(self, path, options, show):
        self._path = path
        self._options = options  # of the motion, handed on as they are
        self._show = show  # whether what the tool notes is shown

    def regressor(self, urdf, scene, motion, folder, parameters, recorded):
        """Writes the folder of --regressor. Options of the motion are for those that were recorded."""
        self._run(['--urdf', urdf, '--scene', scene, '--regressor', folder, '--parameters',
                   ','.join(parameters), '--motion'] + list(motion) + (self._options if recorded else []))

    def measured(self, urdf, static_scene, motion, efforts, regressor):
        """Measured efforts at the rows of a regressor: rows x efforts, not a number where there is none.

        efforts: options of the tool that say where they are."""
        table = static_scene + '.csv'
        self._run(['--urdf', urdf, '--scene', static_scene, '--reactions', 'none', '--output', table] + efforts +
                  ['--motion'] + list(motion) + self._options)
        with open(table, newline='', encoding='utf-8') as file:
            header = next(csv.reader(file))
        columns = {name[len(MEASURED):]: i for i, name in enumerate(header) if name.startswith(MEASURED)}
        numbers = read_numbers(table)
        result = np.full((len(regressor.times), len(regressor.efforts)), np.nan)
        for i, name in enumerate(regressor.efforts):
            if name in columns:
                result[:, i] = numbers[:, columns[name]]
        return result

    def _run(self, arguments):
        """The tool's own line says what is wrong."""
        result = subprocess.run([self._path] + arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                check=False)
        said = result.stderr.decode('utf-8', 'replace')
        if result.returncode != 0:
            lines = [line for line in said.splitlines() if ': error: ' in line] or said.splitlines()[-1:]
            raise Refusal(lines[0].split(': error: ', 1)[-1] if lines else 'the offline tool ended with '
                          'status %d' % result.returncode)
        if self._show:
            for line in said.splitlines():
                self._show(line)


class Regressor:
    """The folder that --regressor writes. Columns are read from the file as they are needed."""

    def __init__(self, folder):
        with open(os.path.join(folder, 'names.json'), encoding='utf-8') as file:
            names = json.load(file)
        self.efforts = names['efforts']
        self.units = dict(zip(names['coordinates'], names['units']))
        self.coordinates = names['coordinates']
        self.bodies = names['bodies']
        self.parameters = [(entry['kind'], entry['of'], entry['value']) for entry in names['parameters']]
        self.times = self._array(folder, 'time')[:, 0]
        self.described = self._array(folder, 'effort')
        self.positions = self._array(folder, 'position')
        self.velocities = self._array(folder, 'velocity')
        self.accelerations = self._array(folder, 'acceleration')
        self.columns = np.load(os.path.join(folder, 'regressor.npy'), mmap_mode='r')

    @staticmethod
    def _array(folder, name):
        return np.load(os.path.join(folder, name + '.npy'))
