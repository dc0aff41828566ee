"""Measured efforts of a CSV file, where the offline tool does not read them itself."""
import csv
import re

import numpy as np

from .refusal import Refusal, in_quotes, listed

LONGEST_EFFORT_GAP = 0.05  # s: farther from a measured effort, a row has none
PREFIX = 'effort.'


def read_csv(path):
    """The names of the columns, without quotes, and the numbers; an empty cell is not a number."""
    try:
        with open(path, newline='', encoding='utf-8', errors='replace') as file:
            skip = 0
            header = None
            for row in csv.reader(file):
                skip += 1
                if row and not row[0].startswith('#'):
                    header = [name.strip() for name in row]
                    break
    except OSError as problem:
        raise Refusal('%s: %s' % (path, problem.strerror or problem)) from None
    if header is None:
        raise Refusal('%s: is empty' % path)
    numbers = read_numbers(path, skip)
    if numbers.size == 0:
        raise Refusal('%s: has no rows' % path)
    return header, numbers


def read_numbers(path, skip):
    """Rows of a CSV after `skip` lines; an empty cell is not a number."""
    try:
        return np.loadtxt(path, delimiter=',', skiprows=skip, ndmin=2)
    except ValueError:  # the other reader takes empty cells, and ten times as long
        return np.atleast_2d(np.genfromtxt(path, delimiter=',', skip_header=skip, invalid_raise=False))


def renamed(name, rules):
    """The name of a joint by the first rule PATTERN=NAME that matches it as a whole."""
    for rule in rules:
        pattern, _, new = rule.partition('=')
        try:
            match = re.fullmatch(pattern, name)
            if match:
                return match.expand(new)
        except re.error as problem:
            raise Refusal('--rename: %s: %s' % (in_quotes(rule), problem)) from None
    return name


def effort_columns(path, header, width, named, rules):
    """The indices of the columns of efforts by the joints that they belong to."""
    if named:
        if len(named) != width - 1:
            raise Refusal('--effort-columns: %d names, but %s has %d columns after the time'
                          % (len(named), path, width - 1))
        return {name: i + 1 for i, name in enumerate(named)}
    if len(header) != width and not (len(header) == width + 1 and header[-1] == ''):
        raise Refusal('%s: the header has %d names and rows have %d numbers; --effort-columns names them'
                      % (path, len(header), width))
    return {renamed(name[len(PREFIX):], rules): i for i, name in enumerate(header)
            if name.startswith(PREFIX)}


def csv_efforts(path, times, efforts, named=(), rules=()):
    """Measured efforts at the times of the motion: rows x efforts, not a number where there is none."""
    if path.endswith('.bag'):
        raise Refusal('%s: this inverse_dynamics_offline reads no efforts of bags: give them by --efforts '
                      'FILE.csv' % path)
    header, numbers = read_csv(path)
    columns = effort_columns(path, header, numbers.shape[1], list(named), rules)
    if not columns:
        raise Refusal('%s: no measured efforts: there is no column effort.<joint>' % path)
    if header[0] != 'time':
        raise Refusal('%s: the first column is %s, not time' % (path, in_quotes(header[0])))
    known = [name for name in efforts if name in columns]
    if not known:
        raise Refusal('%s: no joint of the robot has a column of efforts: they are of %s; the robot has %s'
                      % (path, listed(columns), listed(efforts)))
    stamps = numbers[:, 0]
    if not np.all(np.diff(stamps) > 0):
        row = int(np.argmin(np.diff(stamps) > 0)) + 2
        raise Refusal('%s: times do not increase at row %d' % (path, row))
    result = np.full((len(times), len(efforts)), np.nan)
    for name in known:
        values = numbers[:, columns[name]]
        good = np.isfinite(values)
        if good.sum() < 2:
            continue
        i = efforts.index(name)
        result[:, i] = np.interp(times, stamps[good], values[good])
        result[far_from(times, stamps[good]), i] = np.nan
    if not np.isfinite(result).any():
        raise Refusal('%s: no measured effort is at a time of the motion, which goes from %g s to %g s'
                      % (path, times[0], times[-1]))
    return result


def far_from(times, stamps):
    """Which times lie outside of the stamps, or in a gap of theirs."""
    after = np.clip(np.searchsorted(stamps, times), 1, len(stamps) - 1)
    usual = max(LONGEST_EFFORT_GAP, 2.5 * np.median(np.diff(stamps)))
    gap = stamps[after] - stamps[after - 1] > usual
    exact = (times == stamps[after]) | (times == stamps[after - 1])
    return (times < stamps[0]) | (times > stamps[-1]) | (gap & ~exact)
