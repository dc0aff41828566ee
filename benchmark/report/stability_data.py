"""What the program `stability` measured: error over the bound, relative error, sensitivity."""
import csv
import math

from report_data import ReportError

COLUMNS = ('scene', 'parameter', 'value', 'path', 'precision', 'error_over_bound',
           'max_relative_error', 'one_ulp_sensitivity', 'kdl_relative_error')
CERTIFICATE_COLUMNS = ('scene', 'parameter', 'value', 'power', 'ground_force', 'ground_moment',
                       'limit')
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


class Certificate:
    """The worst at one value of a scene's parameter."""

    def __init__(self, fields):
        self.scene, self.value = fields['scene'], float(fields['value'])
        self.largest = max(float(fields[name])
                           for name in ('power', 'ground_force', 'ground_moment'))
        self.over_limit = self.largest / float(fields['limit'])


class Curve:
    """Numbers over the values of a scene's parameter; None where there are none."""

    def __init__(self, values, numbers):
        self.values, self.numbers = values, numbers


class Scene:
    """The rows of one scene."""

    def __init__(self, name, rows, certificates):
        self.name, self.rows, self.certificates = name, rows, certificates
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
        return max((found.largest for found in self.certificates), default=None)

    def certified(self):
        return all(found.over_limit <= 1 for found in self.certificates)

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
    def __init__(self, path, certificates_path):
        rows = read(path, COLUMNS, Row)
        certificates = read(certificates_path, CERTIFICATE_COLUMNS, Certificate)
        names = list(dict.fromkeys(row.scene for row in rows))
        self.scenes = [Scene(name, [row for row in rows if row.scene == name],
                             [found for found in certificates if found.scene == name])
                       for name in names]
        self.certificates = certificates
        self.row_count = len(rows)
        self.paths = list(dict.fromkeys((row.precision, row.path) for row in rows))

    def scene(self, name):
        return next(scene for scene in self.scenes if scene.name == name)

    def worst(self):
        return max((scene.worst() for scene in self.scenes), key=lambda row: row.over_bound)

    def largest_certificate(self):
        return max(self.certificates, key=lambda found: found.largest)

    def worst_certificate(self):
        """The one that is closest to its limit, or furthest beyond: limits are not all the same."""
        return max(self.certificates, key=lambda found: found.over_limit)

    def stable(self):
        return self.worst().over_bound <= 1 and not any(
            math.isnan(row.over_bound) for scene in self.scenes for row in scene.rows)
