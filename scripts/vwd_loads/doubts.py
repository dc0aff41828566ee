"""Rows of results that are not to be trusted, and why."""
import numpy as np

from vwd_loads.document import number_text
from vwd_loads.mechanism import COMPONENTS

CLOSE = 1e4  # condition from which on the tool says that a position is close to a singular one
CERTIFIED = 1e-9  # what a certificate of a right result is far below
UNCERTAIN = 0.5  # a deviation so large a part of the rms of its effort says little of the effort


class Doubt:
    """A reason, the rows that it holds for, and what they are about."""

    def __init__(self, words, rows, part=None, quantities=None):
        self.words = words
        self.rows = rows  # booleans
        self.part = part  # name; None: all
        self.quantities = quantities  # names; None: all of the part

    def concerns(self, part, quantity):
        return (self.part in (None, part)
                and (self.quantities is None or quantity is None or quantity in self.quantities))


def doubts_of(table, parts):
    """The doubts that hold for any row."""
    doubts = _missing(table, parts) + _singular(table) + _chosen(table, parts)
    doubts += _uncertified(table) + _uncertain(table, parts) + _one_sided(table)
    return [doubt for doubt in doubts if np.any(doubt.rows)]


def _missing(table, parts):
    doubts = []
    for part in parts:
        missing = np.zeros(len(table), dtype=bool)
        lacking = set()
        for quantity in part.quantities:
            of_quantity = ~np.isfinite(quantity.values)
            missing |= of_quantity
            if np.any(of_quantity):
                lacking.add(quantity.name)
        doubts.append(Doubt('%s: no value, as in a singular position or where it overflowed' % part.name,
                            missing, part.name, lacking))
    return doubts


def _singular(table):
    condition = table.get('condition')
    if condition is None:
        return []
    return [Doubt('close to a singular position (condition above %s): small errors of the motion make '
                  'large errors of the loads' % number_text(CLOSE), ~(condition <= CLOSE))]


def _one_sided(table):
    rows = table.get('one_sided')
    if rows is None:
        return []
    return [Doubt('near an end of the recording or a gap, where what the motion lacked was estimated from rows of '
                  'one side', rows == 1)]


def _chosen(table, parts):
    """What the policy of a scene chooses, by component, as in a plane mechanism only what is across it."""
    doubts = []
    for part in parts:
        rows, names = np.zeros(len(table), dtype=bool), []
        for name in (['effort'] if part.effort else []) + (list(COMPONENTS) if part.reaction else []):
            determined = table.get('determined.' + (part.effort.column if name == 'effort'
                                                    else '%s.%s' % (part.name, name)))
            if determined is not None and np.any(determined == 0):
                rows |= determined == 0
                names.append(name)
        if names:
            quantities = {q.name for q in part.quantities if q.components & set(names)}
            doubts.append(Doubt('%s: rigid-body mechanics does not determine %s; the policy of the scene chooses'
                                % (part.name, ', '.join(names)), rows, part.name, quantities))
    return doubts


def _uncertified(table):
    columns = [values for name, values in table.columns.items() if name.startswith('certificate.')]
    if not columns:
        return []
    # A certificate that is no number certifies nothing.
    with np.errstate(invalid='ignore'):
        certified = np.all(np.column_stack(columns) <= CERTIFIED, axis=1)
    return [Doubt('a certificate of the arithmetic is above %s, or there is none' % number_text(CERTIFIED),
                  ~certified)]


def deviation_of(table, part):
    """The standard deviation of an effort, by motion and description together; None: not in the table."""
    if part.effort is None:
        return None
    columns = [table.get(kind + part.effort.column) for kind in ('deviation.', 'tolerance.')]
    columns = [column for column in columns if column is not None]
    return np.sqrt(sum(column ** 2 for column in columns)) if columns else None


def _uncertain(table, parts):
    doubts = []
    for part in parts:
        deviation, effort = deviation_of(table, part), part.quantity('effort')
        if deviation is None or effort is None:
            continue
        rms = float(np.sqrt(np.nanmean(effort.values ** 2))) if np.any(np.isfinite(effort.values)) else 0.0
        with np.errstate(invalid='ignore'):
            doubts.append(Doubt('%s: the standard deviation of the effort is more than %.0f %% of its rms'
                                % (part.name, 100 * UNCERTAIN), deviation > UNCERTAIN * rms, part.name, {'effort'}))
    return doubts


def rows_of(doubts, part, quantity, length):
    """The rows that are doubted of a quantity of a part, of all of them where it is None."""
    rows = np.zeros(length, dtype=bool)
    for doubt in doubts:
        if doubt.concerns(part, quantity):
            rows |= doubt.rows
    return rows


def spans(rows, times, most=4):
    """Where rows are, in words: "0.5 s to 0.7 s, 1.2 s and 3 more places"."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], rows.astype(int), [0]))))
    found = list(zip(edges[::2], edges[1::2] - 1))
    words = ['%.4g s' % times[a] if a == b else '%.4g s to %.4g s' % (times[a], times[b])
             for a, b in found[:most]]
    if len(found) > most:
        words.append('%d more places' % (len(found) - most))
    return ' and '.join([', '.join(words[:-1]), words[-1]]) if len(words) > 1 else ''.join(words)
