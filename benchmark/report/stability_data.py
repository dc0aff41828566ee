"""What the program `stability` measured: error over the bound, relative error, sensitivity."""
import csv
import math

from report_data import ReportError

COLUMNS = ('scene', 'parameter', 'value', 'path', 'precision', 'error_over_bound',
           'max_relative_error', 'one_ulp_sensitivity', 'kdl_relative_error')
CERTIFICATES = ('certificate_power', 'certificate_ground_force', 'certificate_ground_moment')
LOOP_COUNTS = ('loop_rank', 'loop_redundancy', 'loop_redundant_constraints', 'loop_free_motions',
               'loop_open', 'loop_components', 'loop_apart')
DETAIL_COLUMNS = ('scene', 'parameter', 'value') + CERTIFICATES + (
    'certificate_limit', 'kdl_error_over_bound', 'error_over_subtree_bound',
    'loop_condition') + LOOP_COUNTS + (
    'loop_residual_over_limit', 'loop_completed', 'loop_states')
PRECISIONS = ('double', 'float', 'long_double')  # in the order of the plots
DOUBLE = 'double'


class Row:
    def __init__(self, fields):
        self.scene, self.parameter = fields['scene'], fields['parameter']
        self.path, self.precision = fields['path'], fields['precision']
        self.value = float(fields['value'])
        self.over_bound = float(fields['error_over_bound'])
        self.relative = float(fields['max_relative_error'])
        self.sensitivity = float(fields['one_ulp_sensitivity'])
        kdl = fields['kdl_relative_error']
        self.kdl = float(kdl) if kdl else None


class Loops:
    """Of closed loops, the worst at one value of a scene's parameter."""

    def __init__(self, fields):
        self.value = float(fields['value'])
        self.condition = float(fields['loop_condition'])
        (self.rank, self.redundancy, self.redundant_constraints, self.free_motions, self.open,
         self.components, self.apart) = (int(fields[name]) for name in LOOP_COUNTS)
        self.residual_over_limit = float(fields['loop_residual_over_limit'])
        self.completed, self.states = int(fields['loop_completed']), int(fields['loop_states'])


class Detail:
    """Of trees, of double, the worst at one value of a scene's parameter."""

    def __init__(self, fields):
        self.scene, self.value = fields['scene'], float(fields['value'])
        self.certificate = max(float(fields[name]) for name in CERTIFICATES)
        self.over_limit = self.certificate / float(fields['certificate_limit'])
        kdl = fields['kdl_error_over_bound']
        self.kdl_over_bound = float(kdl) if kdl else None
        self.over_subtree_bound = float(fields['error_over_subtree_bound'])


class Curve:
    """Numbers over the values of a scene's parameter; None where there are none."""

    def __init__(self, values, numbers):
        self.values, self.numbers = values, numbers


class Scene:
    """The rows of one scene."""

    def __init__(self, name, rows, details, loops):
        self.name, self.rows, self.details, self.loops = name, rows, details, loops
        self.parameter = rows[0].parameter
        self.values = sorted({row.value for row in rows})
        self.precisions = [p for p in PRECISIONS if any(row.precision == p for row in rows)]

    def worst(self, precision=None):
        """The row that is closest to its bound, or furthest beyond."""
        rows = [row for row in self.rows if precision in (None, row.precision)]
        return max(rows, key=lambda row: row.over_bound) if rows else None

    def largest_relative(self, precision):
        return max((row.relative for row in self.rows if row.precision == precision), default=None)

    def largest_kdl(self):
        return max((row.kdl for row in self.rows if row.kdl is not None), default=None)

    def largest_certificate(self):
        return max((detail.certificate for detail in self.details), default=None)

    def largest_condition(self):
        """Of closed loops whose rank is full."""
        return max((loop.condition for loop in self.loops if not loop.free_motions), default=None)

    def apart(self):
        return sum(loop.apart for loop in self.loops)

    def largest_residual(self):
        """Over its limit; None where nothing was completed."""
        return max((loop.residual_over_limit for loop in self.loops if loop.completed),
                   default=None)

    def loop_curve(self, number):
        loops = sorted(self.loops, key=lambda loop: loop.value)
        return Curve([loop.value for loop in loops], [number(loop) for loop in loops])

    def right(self):
        """Whether closed loops have exact counts and flags and are closed by the completion."""
        return self.apart() == 0 and (self.largest_residual() or 0) <= 1

    def certified(self):
        return all(detail.over_limit <= 1 for detail in self.details)

    def largest_kdl_over_bound(self):
        return max((detail.kdl_over_bound for detail in self.details
                    if detail.kdl_over_bound is not None), default=None)

    def largest_over_subtree_bound(self):
        return max((detail.over_subtree_bound for detail in self.details), default=None)

    def curve(self, precision, number):
        """The worst of all paths at every value; number: what is taken of a row."""
        return Curve(self.values, [self._worst_at(value, precision, number)
                                   for value in self.values])

    def left_out(self, precision):
        """Values at which this precision was not computed."""
        computed = {row.value for row in self.rows if row.precision == precision}
        return [value for value in self.values if value not in computed]

    def _worst_at(self, value, precision, number):
        numbers = [number(row) for row in self.rows
                   if row.value == value and row.precision == precision]
        return max((n for n in numbers if n is not None), default=None)


def read(path, columns, row):
    """A row for each line of a CSV."""
    with open(str(path), newline='', encoding='utf-8') as file:
        reader = csv.DictReader(file)
        if tuple(reader.fieldnames or ()) != columns:
            raise ReportError('%s: its columns are not %s' % (path, ','.join(columns)))
        rows = [row(fields) for fields in reader]
    if not rows:
        raise ReportError('%s: there are no results' % path)
    return rows


class Stability:
    def __init__(self, path, details_path):
        rows = read(path, COLUMNS, Row)
        details, loops = [], []
        for fields in read(details_path, DETAIL_COLUMNS, dict):
            if fields['loop_condition']:
                loops.append((fields['scene'], Loops(fields)))
            else:
                details.append(Detail(fields))
        names = list(dict.fromkeys(row.scene for row in rows))
        self.scenes = [Scene(name, [row for row in rows if row.scene == name],
                             [detail for detail in details if detail.scene == name],
                             [loop for scene, loop in loops if scene == name])
                       for name in names]
        self.trees = [scene for scene in self.scenes if not scene.loops]
        self.closed_loops = [scene for scene in self.scenes if scene.loops]
        self.details = details
        self.row_count = len(rows)
        self.paths = list(dict.fromkeys((row.precision, row.path)
                                        for scene in self.trees for row in scene.rows))

    def scene(self, name):
        return next(scene for scene in self.scenes if scene.name == name)

    @staticmethod
    def worst_of(scenes):
        return max((scene.worst() for scene in scenes), key=lambda row: row.over_bound)

    def largest_certificate(self):
        return max(self.details, key=lambda detail: detail.certificate)

    def worst_certificate(self):
        """The one that is closest to its limit, or furthest beyond: limits are not all the same."""
        return max(self.details, key=lambda detail: detail.over_limit)

    def worst_of_subtrees(self):
        return max(self.details, key=lambda detail: detail.over_subtree_bound)

    @staticmethod
    def stable(scenes):
        return Stability.worst_of(scenes).over_bound <= 1 and not any(
            math.isnan(row.over_bound) for scene in scenes for row in scene.rows)
