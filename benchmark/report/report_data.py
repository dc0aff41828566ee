"""The report's CSV files, read and checked; errors are one line that names file, row and column."""
import collections
import copy
import csv
import math
import pathlib
import re
import xml.etree.ElementTree as ElementTree

WORK_PRECISION = 'work_precision.csv'
LEAVE_OUT = 'leave_out.csv'
INSTRUCTIONS = 'instructions.csv'
GENERATED_SIZES = 'generated_size.csv'
CLOSED_LOOPS = 'closed_loops.csv'
OWN = 'virtual_work'
GENERATED = 'generated'  # the package's, too: code for one robot
LAGRANGE = 'lagrange'  # the package's, too: the other route, which is no rival
# Peers that work_precision knows. A method that is not listed here is reported all the same.
KNOWN_PEERS = ('kdl_chain', 'kdl_tree', 'mujoco', 'dart', 'pinocchio', 'rbdl')
BASES = ('kdl_chain', 'kdl_tree')  # solvers that all times are compared with; the first one found
EFFORTS = 'efforts'
ALL = 'efforts+reactions'
MOTION = 'motion'  # of passive joints, from that of actuated ones
PRECISIONS = ('float', 'double', 'long_double')


class ReportError(Exception):
    """One line for the user."""


# One way to compute, as opposed to a scene in which it is measured.
Way = collections.namedtuple('Way', 'method precision mode outputs threads')
Measured = collections.namedtuple('Measured', 'scene way ns ns_min ns_max error')
Omission = collections.namedtuple(
    'Omission', 'scene left_out multiplications additions ns same_numbers')

LoopCounts = collections.namedtuple(
    'LoopCounts', 'coordinates actuated loops conditions redundant_constraints')

SINGLE = Way(OWN, 'double', 'single', ALL, 1)
SINGLE_EFFORTS = SINGLE._replace(outputs=EFFORTS)


class Table:
    """A CSV file whose cells are asked for by column, and complained about by line."""

    def __init__(self, path, columns):
        self.path = path
        try:
            with open(str(path), newline='') as file:
                lines = [row for row in csv.reader(file) if row]
        except (OSError, UnicodeDecodeError, csv.Error) as problem:
            raise ReportError('%s: %s' % (path, getattr(problem, 'strerror', None) or problem))
        if not lines:
            raise ReportError('%s: is empty' % path)
        header = [name.strip() for name in lines[0]]
        for column in columns:
            if column not in header:
                raise ReportError("%s: no column '%s'" % (path, column))
        if len(lines) == 1:
            raise ReportError('%s: has no rows' % path)
        self.rows = []
        for number, line in enumerate(lines[1:], 2):
            if len(line) != len(header):
                raise ReportError('%s: row %d has %d cells, the header has %d' % (
                    path, number, len(line), len(header)))
            self.rows.append((number, dict(zip(header, (cell.strip() for cell in line)))))

    def complain(self, number, column, text, wanted):
        raise ReportError("%s: row %d, column %s: '%s' is not %s" % (
            self.path, number, column, text, wanted))

    def number(self, row, column, positive=False):
        number, cells = row
        try:
            value = float(cells[column])
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or value < 0 or (positive and value == 0):
            self.complain(number, column, cells[column],
                          'a positive number' if positive else 'a number from 0 up')
        return value

    def name(self, row, column, allowed=None):
        number, cells = row
        if not cells[column] or (allowed and cells[column] not in allowed):
            self.complain(number, column, cells[column],
                          'one of ' + ', '.join(allowed) if allowed else 'a name')
        return cells[column]

    def count(self, row, column):
        number, cells = row
        if not re.fullmatch(r'\d+', cells[column]):
            self.complain(number, column, cells[column], 'a whole number')
        return int(cells[column])


class WorkPrecision:
    """What work_precision measured, by scene and way."""

    COLUMNS = ('scene', 'method', 'precision', 'mode', 'outputs', 'threads', 'ns_per_sample',
               'ns_min', 'ns_max', 'max_relative_error')

    def __init__(self, path):
        table = Table(path, self.COLUMNS)
        rows = {}
        for row in table.rows:
            way = Way(table.name(row, 'method'), table.name(row, 'precision', PRECISIONS),
                      table.name(row, 'mode'), table.name(row, 'outputs', (EFFORTS, ALL, MOTION)),
                      table.count(row, 'threads'))
            measured = Measured(table.name(row, 'scene'), way,
                                table.number(row, 'ns_per_sample', positive=True),
                                table.number(row, 'ns_min', positive=True),
                                table.number(row, 'ns_max', positive=True),
                                table.number(row, 'max_relative_error'))
            if not measured.ns_min <= measured.ns <= measured.ns_max:
                raise ReportError('%s: row %d: ns_per_sample is not between ns_min and ns_max' % (
                    path, row[0]))
            if (measured.scene, way) in rows:
                raise ReportError('%s: row %d repeats an earlier one' % (path, row[0]))
            rows[measured.scene, way] = measured
        self._take(rows)

    def _take(self, rows):
        self._found = rows
        self.rows = list(rows.values())
        self.scenes = list(dict.fromkeys(row.scene for row in self.rows))
        self.ways = list(dict.fromkeys(row.way for row in self.rows))
        self.methods = list(dict.fromkeys(way.method for way in self.ways))

    def of_scenes(self, wanted):
        """The same of the scenes for which wanted(scene) is true."""
        part = copy.copy(self)
        part._take({key: row for key, row in self._found.items() if wanted(row.scene)})
        return part

    def find(self, scene, way):
        """Measured, or None."""
        return self._found.get((scene, way))

    def of_scene(self, scene):
        return [row for row in self.rows if row.scene == scene]

    def base(self, scene):
        """What a scene's times are compared with: KDL's chain solver, or its tree solver where the
        robot is no chain; None when neither was measured."""
        for method in BASES:
            found = self.find(scene, Way(method, 'double', 'single', EFFORTS, 1))
            if found:
                return found
        return None

    def peers(self):
        return [method for method in self.methods if method not in (OWN, GENERATED, LAGRANGE)]

    def missing_peers(self):
        return [peer for peer in KNOWN_PEERS if peer not in self.methods]


class LeaveOut:
    """What leave_out measured: plans that compute less than all, by scene."""

    COLUMNS = ('scene', 'left_out', 'multiplications', 'additions', 'ns_per_sample',
               'same_numbers')

    def __init__(self, path):
        table = Table(path, self.COLUMNS)
        self.rows = [
            Omission(table.name(row, 'scene'), table.name(row, 'left_out'),
                     table.count(row, 'multiplications'), table.count(row, 'additions'),
                     table.number(row, 'ns_per_sample', positive=True),
                     self._same(table, row))
            for row in table.rows]
        self.scenes = list(dict.fromkeys(row.scene for row in self.rows))

    @staticmethod
    def _same(table, row):
        """'reference', 'yes', or the largest relative difference."""
        text = table.name(row, 'same_numbers')
        return text if text in ('reference', 'yes') else table.number(row, 'same_numbers')

    def of_scene(self, scene):
        return [row for row in self.rows if row.scene == scene]


class Instructions:
    """What callgrind counted, by scene and way."""

    COLUMNS = ('scene', 'method', 'precision', 'mode', 'outputs', 'instructions_per_sample')

    def __init__(self, path):
        table = Table(path, self.COLUMNS)
        self.counts = {}
        for row in table.rows:
            way = Way(table.name(row, 'method'), table.name(row, 'precision', PRECISIONS),
                      table.name(row, 'mode'), table.name(row, 'outputs', (EFFORTS, ALL)), 1)
            self.counts[table.name(row, 'scene'), way] = table.count(
                row, 'instructions_per_sample')
        self.scenes = list(dict.fromkeys(scene for scene, _ in self.counts))
        self.ways = list(dict.fromkeys(way for _, way in self.counts))


class GeneratedSizes:
    """How large generated code is, row by row."""

    COUNTS = ('multiplications', 'additions', 'sines_and_cosines', 'code', 'stack', 'block_code',
              'block_stack', 'small_code', 'small_stack')

    def __init__(self, path):
        table = Table(path, ('scene', 'outputs') + self.COUNTS)
        self.rows = [(table.name(row, 'scene'), table.name(row, 'outputs', (EFFORTS, ALL)),
                      [table.count(row, column) for column in self.COUNTS])
                     for row in table.rows]


class ClosedLoops:
    """What the scenes with closed loops consist of, by scene."""

    COLUMNS = ('scene',) + LoopCounts._fields

    def __init__(self, path):
        table = Table(path, self.COLUMNS)
        self.counts = {
            table.name(row, 'scene'): LoopCounts(
                *(table.count(row, column) for column in LoopCounts._fields))
            for row in table.rows}

    def row(self, name):
        """[(number of loops, scene)] of a row of linkages, shortest first."""
        pattern = re.compile(re.escape(name) + r'_\d+$')
        return sorted((counts.loops, scene) for scene, counts in self.counts.items()
                      if pattern.match(scene))

    def examples(self):
        """Scenes that are no rows of linkages."""
        return [scene for scene in self.counts if not re.search(r'_\d+$', scene)]


class JointCounts:
    """Number of moving joints of a scene: from its name, or from its description."""

    FILES = {'pendulum': 'composed_pendulum'}

    def __init__(self, folders):
        self._folders = [pathlib.Path(folder) for folder in folders]

    def of(self, scene):
        """None when it is neither in the name nor in a description."""
        chain = re.fullmatch(r'chain_(\d+)', scene)
        if chain:
            return int(chain.group(1))
        for folder in self._folders:
            path = folder / (self.FILES.get(scene, scene) + '.urdf')
            if path.is_file():
                return self._moving_joints(path)
        return None

    @staticmethod
    def _moving_joints(path):
        try:
            root = ElementTree.parse(str(path)).getroot()
        except (OSError, ElementTree.ParseError) as problem:
            raise ReportError('%s: %s' % (path, problem))
        return sum(joint.get('type') in ('revolute', 'continuous', 'prismatic')
                   for joint in root.findall('joint'))
