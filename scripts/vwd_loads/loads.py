"""All figures of all quantities of one motion."""
import csv
import json

import numpy as np

from vwd_loads import bearings, rainflow, statistics
from vwd_loads.pieces import gap_length, pieces_of, weights_of
from vwd_loads.quantities import parts_of, state_columns

SUMS = 'sums.json'
SUMS_FORMAT = 1
WOEHLER = 5.0  # exponent where none is given
ROUNDING = 1e-12  # of the largest load of a unit


class Settings:
    """What figures are found with."""

    def __init__(self, woehler=WOEHLER, max_gap=None):
        self.woehler = woehler  # exponent
        self.max_gap = max_gap  # s; None: as the results say


class Load:
    """The figures of one quantity; None is what does not exist."""

    def __init__(self, part, quantity):
        self.part = part
        self.quantity = quantity
        self.seconds = self.mean = self.rms = self.least = self.most = None
        self.percentiles = [None] * len(statistics.PERCENTILES)
        self.peak = self.peak_row = self.peak_time = None
        self.ball = self.roller = self.travel = None
        self.range = self.range_once = self.cycles = None
        self.ranges = self.counts = None  # of cycles
        self.missing = 0  # rows without a value
        self.pieces = []
        self.weights = None


class Loads:
    """The loads of a table."""

    def __init__(self, table, mechanism, settings, progress=None):
        self.table = table
        self.mechanism = mechanism
        self.settings = settings
        self.gap = gap_length(table.times, settings.max_gap or mechanism.max_gap)
        self.parts = parts_of(table, mechanism)
        self.pieces = pieces_of(table.times, np.ones(len(table), dtype=bool), self.gap)
        self.of = {}  # (name of the part, name of the quantity) -> Load
        total = sum(len(part.quantities) for part in self.parts)
        for part in self.parts:
            for quantity in part.quantities:
                self.of[part.name, quantity.name] = self._load(part, quantity)
                if progress:
                    progress.update(len(self.of), total)

        self._largest = {}  # by unit
        for load in self.of.values():
            unit = load.quantity.unit
            self._largest[unit] = max(self._largest.get(unit, 0.0), abs(load.peak or 0.0))

    def is_rounding(self, load, value):
        """Whether a value is nothing beside the largest of its unit: zero, but for rounding."""
        return value is not None and abs(value) <= ROUNDING * self._largest[load.quantity.unit]

    def matters(self, load):
        """Whether a load exists and is more than rounding."""
        return load is not None and load.peak is not None and not self.is_rounding(load, load.peak)

    def get(self, part, quantity):
        return self.of.get((part.name, quantity))

    def _load(self, part, quantity):
        load = Load(part, quantity)
        times = self.table.times
        exists = np.isfinite(quantity.values)
        load.missing = int(np.sum(~exists))
        load.pieces = pieces_of(times, exists, self.gap)
        if not load.pieces:
            return load
        load.weights = weights_of(times, load.pieces)
        values, weights = quantity.values[exists], load.weights[exists]
        load.seconds = float(np.sum(times[[p.stop - 1 for p in load.pieces]]
                                    - times[[p.start for p in load.pieces]]))
        load.mean = statistics.weighted_mean(values, weights)
        load.rms = statistics.weighted_rms(values, weights)
        load.least, load.most = float(np.min(values)), float(np.max(values))
        load.percentiles = statistics.weighted_percentiles(values, weights)
        load.peak_row = statistics.peak_row(quantity.values)
        load.peak = float(quantity.values[load.peak_row])
        load.peak_time = float(times[load.peak_row])
        if quantity.loads_bearing:
            self._wear(load)
        if quantity.signed:
            self._count(load)
        return load

    def _wear(self, load):
        turning = load.part.turning
        if turning is None:
            return
        times, values = self.table.times, load.quantity.values
        pieces = pieces_of(times, np.isfinite(values) & np.isfinite(turning), self.gap)
        load.travel = bearings.travel_integrals(values, turning, times, pieces, 1.0)[1]
        load.ball = bearings.equivalent_load(values, turning, times, pieces, bearings.BALL)
        load.roller = bearings.equivalent_load(values, turning, times, pieces, bearings.ROLLER)

    def _count(self, load):
        load.ranges, load.counts = rainflow.count_pieces(load.quantity.values, load.pieces)
        load.cycles = float(np.sum(load.counts))
        load.range = rainflow.equivalent_range(load.ranges, load.counts, self.settings.woehler)
        load.range_once = rainflow.range_applied_once(load.ranges, load.counts, self.settings.woehler)


FIGURES = ('seconds', 'missing', 'least', 'most', 'mean', 'rms') + tuple(
    'p%d' % percentile for percentile in statistics.PERCENTILES) + (
        'equivalent_ball', 'equivalent_roller', 'travel', 'woehler', 'range', 'cycles', 'range_once',
        'peak', 'peak_time', 'peak_row')


def figures_of(load, settings):
    """The figures of a load in the order of FIGURES."""
    counted = load.cycles is not None
    return ([load.seconds, load.missing, load.least, load.most, load.mean, load.rms] + load.percentiles
            + [load.ball, load.roller, load.travel, settings.woehler if counted else None,
               load.range, load.cycles, load.range_once, load.peak, load.peak_time,
               None if load.peak_row is None else load.peak_row + 1])


def write_csv(loads, path):
    """Writes a row for each quantity, with the state of all joints at its peak."""
    state = state_columns(loads.table)
    with open(path, 'w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['name', 'quantity', 'unit'] + list(FIGURES) + ['at_peak.' + name for name in state])
        for load in loads.of.values():
            row = load.peak_row
            at_peak = [None if row is None else float(loads.table.columns[name][row]) for name in state]
            figures = figures_of(load, loads.settings) + at_peak
            writer.writerow([load.part.name, load.quantity.name, load.quantity.unit]
                            + ['' if figure is None or figure != figure else repr(figure)
                               for figure in figures])


def sums_of(loads, doubtful_rows):
    """What the report of many motions needs of this one: figures and sums that add up."""
    rows = []
    for load in loads.of.values():
        if load.rms is None:
            continue
        rows.append({
            'name': load.part.name, 'quantity': load.quantity.name, 'unit': load.quantity.unit,
            'words': load.quantity.words, 'seconds': load.seconds, 'mean': load.mean, 'rms': load.rms,
            'least': load.least, 'most': load.most, 'peak': load.peak, 'peak_time': load.peak_time,
            'ball': load.ball, 'roller': load.roller, 'travel': load.travel,
            'cycles': load.cycles, 'range_once': load.range_once, 'missing': load.missing})
    return {'format': SUMS_FORMAT, 'results': loads.table.path, 'robot': loads.mechanism.robot,
            'motion': dict(loads.mechanism.sources).get('motion', loads.table.path),
            'rows': len(loads.table), 'doubtful_rows': doubtful_rows,
            'seconds': float(loads.table.times[-1] - loads.table.times[0]),
            'woehler': loads.settings.woehler, 'loads': rows}


def write_json(content, path):
    with open(path, 'w', encoding='utf-8') as file:
        json.dump(content, file, indent=1, sort_keys=True)
        file.write('\n')
