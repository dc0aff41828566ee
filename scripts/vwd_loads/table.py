"""Results of inverse_dynamics_offline, as .npz or CSV."""
import csv
import json
import zipfile
import zlib

import numpy as np

from vwd_loads.errors import ReportError

MECHANISM = 'mechanism.json'
# What an archive raises that is cut off, changed, of another kind or locked by a password.
UNREADABLE = (ValueError, KeyError, EOFError, NotImplementedError, RuntimeError, csv.Error, zipfile.BadZipFile,
              zlib.error)


class Table:
    """Columns of numbers by name, all of one length; NaN is a value that does not exist."""

    def __init__(self, path, columns, mechanism=None):
        self.path = path
        self.columns = columns
        self.mechanism = mechanism  # what an .npz says of it, or None
        if 'time' not in columns:
            raise ReportError('%s: no column time; is it a result of inverse_dynamics_offline?' % path)
        self.times = columns['time']
        _check_times(path, self.times)

    def __len__(self):
        return len(self.times)

    def get(self, name):
        """The column of a name, None where there is none."""
        return self.columns.get(name)


def _check_times(path, times):
    if len(times) == 0:
        raise ReportError('%s: no rows' % path)
    if not np.all(np.isfinite(times)):
        raise ReportError('%s: row %d has no time' % (path, 1 + np.argmin(np.isfinite(times))))
    back = np.flatnonzero(np.diff(times) <= 0)
    if len(back) > 0:
        raise ReportError('%s: row %d: time %r is not later than %r in the row before, and a report needs '
                          'rows in the order of time'
                          % (path, back[0] + 2, float(times[back[0] + 1]), float(times[back[0]])))


def read_table(path):
    """Reads results; what they are shows in their first bytes. Raises ReportError, or OSError."""
    try:
        with open(path, 'rb') as file:
            zipped = file.read(2) == b'PK'
        return _read_npz(path) if zipped else _read_csv(path)
    except OSError as error:
        raise OSError('%s: cannot be read: %s' % (path, _reason(error)))
    except UNREADABLE as error:
        raise ReportError('%s: cannot be read: %s' % (path, _reason(error)))


def _reason(error):
    return ' '.join(str(getattr(error, 'strerror', None) or error).split()) or type(error).__name__


def _read_npz(path):
    columns, mechanism = {}, None
    with np.load(path, allow_pickle=False) as file:
        for name in file.files:
            value = file[name]
            if name == MECHANISM:
                mechanism = json.loads(bytes(value).decode('utf-8'))
            elif not isinstance(value, np.ndarray):
                continue  # another file of an archive, as a spreadsheet is one
            elif value.ndim == 1 and value.dtype.kind in 'fiu':
                columns[name] = value.astype(float)
            elif value.ndim == 1 and value.dtype.kind == 'M':
                columns[name] = value.astype('datetime64[ns]').astype(np.int64) * 1e-9
    length = len(columns.get('time', next(iter(columns.values()), ())))
    for name, value in columns.items():
        if len(value) != length:
            raise ReportError('%s: %s has %d values, not %d' % (path, name, len(value), length))
    return Table(path, columns, mechanism)


def _read_csv(path):
    with open(path, newline='', encoding='utf-8-sig') as file:
        lines = (line for line in file if line.strip() and not line.startswith('#'))
        rows = csv.reader(lines)
        header = [name.strip() for name in next(rows, [])]
        if not header:
            raise ReportError('%s: the file is empty' % path)
        cells = []
        for number, row in enumerate(rows, 1):
            if len(row) != len(header):
                raise ReportError('%s: row %d has %d cells, the header has %d'
                                  % (path, number, len(row), len(header)))
            cells.append([_number(path, number, name, cell) for name, cell in zip(header, row)])
    values = np.array(cells, dtype=float).reshape(len(cells), len(header))
    return Table(path, {name: values[:, i].copy() for i, name in enumerate(header)})


def _number(path, row, name, cell):
    cell = cell.strip()
    if not cell:
        return float('nan')
    try:
        return float(cell)
    except ValueError:
        raise ReportError('%s: row %d: %s: %r is not a number' % (path, row, name, cell))
