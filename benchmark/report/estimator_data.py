"""The CSV of estimator_error, read and checked, and what can be concluded from it."""
import collections
import math
import statistics

from report_data import ReportError, Table

GRID = 'grid'
HARD = ('uneven', 'white', 'dropped', 'fourier', 'trapezoids', 'still')
DEFAULT = 'default'
FILTER = 'savitzky_golay'
HINDSIGHT = 'hindsight'
NODE = 'node'
CONTENDERS = ('local_polynomial', 'white_jerk', 'white_snap', 'white_fifth', 'spline',
              'nine_samples')
WRONG = ('zero', 'degrees', 'too_large', 'noisy')
OFFLINE_LAG = -1.0  # ms
NODE_LAG = 50.0  # ms, the default

# Bounds that the estimator was built to.
MEDIAN_BOUND, WORST_BOUND, HARD_BOUND = 1.0, 1.25, 1.3
NODE_BOUND, WRONG_BOUND = 1.3, 1.2
WITHIN = (0.9, 0.99)

Stream = collections.namedtuple('Stream', 'group rate quantum velocities jitter')
Figure = collections.namedtuple('Figure', 'part stream method lag quantity')


class EstimatorFigures:
    COLUMNS = ('part', 'group', 'rate_hz', 'quantum_rad', 'velocities', 'jitter_ms', 'method',
               'lag_ms', 'quantity', 'value')

    def __init__(self, path, part='offline'):
        """part: what has to be in it"""
        table = Table(path, self.COLUMNS)
        self._values = {}
        self.row_count = len(table.rows)
        for line in table.rows:
            self._take(table, line)
        if not self.streams(part):
            raise ReportError('%s: no rows of part %s' % (path, part))

    def _take(self, table, line):
        stream = Stream(table.name(line, 'group'), table.count(line, 'rate_hz'),
                        table.number(line, 'quantum_rad'), table.name(line, 'velocities'),
                        table.number(line, 'jitter_ms'))
        numbers = {}
        for column in ('lag_ms', 'value'):
            text = line[1][column]
            try:
                numbers[column] = float(text)
            except ValueError:
                numbers[column] = math.nan
            if math.isnan(numbers[column]):
                table.complain(line[0], column, text, 'a number')
        figure = Figure(table.name(line, 'part'), stream, table.name(line, 'method'),
                        numbers['lag_ms'], table.name(line, 'quantity'))
        self._values[figure] = numbers['value']

    def value(self, part, stream, method, quantity, lag=OFFLINE_LAG):
        """None where it was not measured."""
        return self._values.get(Figure(part, stream, method, lag, quantity))

    def streams(self, part, groups=None):
        """In the order of the file; groups: only those of these."""
        return list(dict.fromkeys(f.stream for f in self._values
                                  if f.part == part and (not groups or f.stream.group in groups)))

    def lags(self):
        return sorted({f.lag for f in self._values if f.part == 'node'})

    def groups(self, part):
        return list(dict.fromkeys(stream.group for stream in self.streams(part)))

    def of_part(self, part):
        """[(Figure, value)] in the order of the file."""
        return [(f, value) for f, value in self._values.items() if f.part == part]

    def offline_ratios(self, method, groups, quantity='error'):
        """{stream: error over that of the filter chosen with hindsight}"""
        return {stream: self.value('offline', stream, method, quantity)
                / self.value('offline', stream, FILTER, quantity)
                for stream in self.streams('offline', groups)}

    def node_ratios(self, lag, groups, quantity='error'):
        """{stream: error over that of the smoother chosen with hindsight}"""
        return {stream: self.value('node', stream, DEFAULT, quantity, lag)
                / self.value('node', stream, HINDSIGHT, quantity, lag)
                for stream in self.streams('node', groups)}

    def wrong_ratios(self, kind, lag):
        """{stream: error over that of positions only}"""
        return {stream: self.value('wrong_velocities', stream, DEFAULT, 'error', lag)
                / self.value('wrong_velocities', stream, 'positions_only', 'error', lag)
                for stream in self.streams('wrong_velocities') if stream.velocities == kind}

    def velocity_gains(self, lag):
        """{stream with velocities: node's error over that of the stream without}"""
        gains = {}
        for stream in self.streams('node', (GRID,)):
            if stream.velocities == 'none':
                continue
            without = self.value('node', stream._replace(velocities='none'), DEFAULT, 'error', lag)
            gains[stream] = self.value('node', stream, DEFAULT, 'error', lag) / without
        return gains

    def calibration(self, method, quantity):
        """{stream: share of errors within two deviations}"""
        return {f.stream: value for f, value in self.of_part('calibration')
                if f.method == method and f.quantity == quantity}


def median(ratios):
    return statistics.median(ratios.values())


def worst(ratios):
    """(ratio, stream)"""
    stream = max(ratios, key=ratios.get)
    return ratios[stream], stream


def beyond(ratios, bound):
    """[(stream, ratio)] above a bound, the worst first."""
    return sorted(((s, r) for s, r in ratios.items() if r > bound), key=lambda pair: -pair[1])


def share_calibrated(shares):
    """Of streams in which the share of errors within two deviations is as it should be."""
    good = sum(WITHIN[0] <= share <= WITHIN[1] for share in shares.values())
    return good / len(shares)
