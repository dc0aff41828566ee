"""The CSV of estimator_error, read and checked, and what can be concluded from it."""
import collections
import math

from report_data import ReportError, Table

LEAST_SQUARES = 'least_squares'
DEFAULT = 'default'
DIFFERENCES = 'differences'
ZERO = 'zero_acceleration'
MOTION = 'motion_itself'
METHODS = (LEAST_SQUARES, DEFAULT, DIFFERENCES, ZERO, MOTION)
EXACT_ENCODER = 'exact'
USUAL_MOTION = 'brisk'  # the one that comes with all velocities and stamps
VARIED_ENCODER = 'optical_20bit_joint'  # the real one that does
VELOCITIES = ('none', 'differences', 'exact')
STAMPS = ('true', 'uneven', 'wrong')
EFFORT = 'effort_rms_share'
EFFORT_NOW = 'effort_now_rms_share'
ERRORS = ('qd_rms_rad_s', 'qd_max_rad_s', 'qdd_rms_rad_s2', 'qdd_max_rad_s2', 'effort_rms_Nm',
          'effort_max_Nm', EFFORT, 'effort_max_share', EFFORT_NOW)
# Of the range of an effort: no smaller error matters, as no model of an arm is that good.
NEGLIGIBLE = 1e-3

Stream = collections.namedtuple('Stream', 'rate motion encoder velocity stamps')
Setting = collections.namedtuple('Setting', 'window order lag')
Row = collections.namedtuple('Row', ('stream', 'method', 'setting') + ERRORS)
Encoder = collections.namedtuple('Encoder', 'counts gear noise')
# How a setting does on many streams: error over the least error of each stream, and the error
# itself, both as geometric means; the largest error.
Merit = collections.namedtuple('Merit', 'setting times_best typical largest')


def delay(row):
    """ms"""
    return 1000.0 * row.setting.lag / row.stream.rate


def length(setting, rate):
    """Of the window, ms."""
    return 1000.0 * (setting.window - 1) / rate


def middle(setting):
    return setting.lag == (setting.window - 1) // 2


class EstimatorErrors:
    COLUMNS = ('rate_hz', 'motion', 'highest_frequency_hz', 'encoder', 'counts_per_turn',
               'gear_ratio', 'noise_rms_counts', 'velocity', 'stamps', 'method', 'window', 'order',
               'lag') + ERRORS

    def __init__(self, path):
        table = Table(path, self.COLUMNS)
        self.motions = {}  # name: highest frequency, Hz
        self.encoders = {}  # name: Encoder
        self._grid = {}  # stream: {setting: row}
        self._other = {}  # stream, method: row
        for line in table.rows:
            row = self._read(table, line)
            if row.method == LEAST_SQUARES:
                self._grid.setdefault(row.stream, {})[row.setting] = row
            else:
                self._other[row.stream, row.method] = row
        self.streams = list(self._grid)
        self.rates = sorted({stream.rate for stream, _ in self._other})
        self.row_count = len(table.rows)
        self._check(path)
        self.default = self._other[self.streams[0], DEFAULT].setting

    def _read(self, table, line):
        motion = table.name(line, 'motion')
        encoder = table.name(line, 'encoder')
        stream = Stream(table.count(line, 'rate_hz'), motion, encoder,
                        table.name(line, 'velocity', VELOCITIES),
                        table.name(line, 'stamps', STAMPS))
        if stream.rate == 0:
            table.complain(line[0], 'rate_hz', '0', 'a positive number')
        self.motions[motion] = table.number(line, 'highest_frequency_hz', positive=True)
        self.encoders[encoder] = Encoder(table.count(line, 'counts_per_turn'),
                                         table.number(line, 'gear_ratio', positive=True),
                                         table.number(line, 'noise_rms_counts'))
        setting = Setting(*(table.count(line, name) for name in Setting._fields))
        return Row(stream, table.name(line, 'method', METHODS), setting,
                   *(table.number(line, name) for name in ERRORS))

    def _check(self, path):
        """That the rows are there on which the page is built."""
        for motion in self.motions:
            if not self.size(motion):
                raise ReportError("%s: no row of method '%s' for %s motion" % (
                    path, MOTION, motion))
        wanted = {(stream, method) for stream in self.streams for method in (DEFAULT, ZERO)}
        for rate in self.rates:
            for encoder in list(self.encoders) + [VARIED_ENCODER]:
                stream = Stream(rate, USUAL_MOTION, encoder, 'none', 'true')
                wanted |= {(stream, LEAST_SQUARES), (stream, DIFFERENCES)}
            varied = Stream(rate, USUAL_MOTION, VARIED_ENCODER, 'none', 'true')
            wanted |= {(varied._replace(velocity=v), LEAST_SQUARES) for v in VELOCITIES}
            wanted |= {(varied._replace(stamps=s), LEAST_SQUARES) for s in STAMPS}
        for stream, method in sorted(wanted):
            if stream not in self._grid if method == LEAST_SQUARES else \
                    (stream, method) not in self._other:
                raise ReportError("%s: no row of method '%s' for %d Hz, %s motion, encoder %s, "
                                  'velocities %s, stamps %s' % ((path, method) + stream))

    def find(self, stream, method):
        """Row, or None."""
        return self._other.get((stream, method))

    def grid(self, stream):
        """{setting: row}; empty for a stream that was not simulated."""
        return self._grid.get(stream, {})

    def best(self, stream, longest_delay=math.inf, error=EFFORT):
        """Row with the least error."""
        return min((row for row in self._grid[stream].values() if delay(row) <= longest_delay),
                   key=lambda row: getattr(row, error))

    def size(self, motion):
        """Row with the motion itself in place of errors, or None."""
        found = [row for (stream, method), row in self._other.items()
                 if method == MOTION and stream.motion == motion]
        return max(found, key=lambda row: row.stream.rate) if found else None

    def realistic(self, rate=None):
        """Streams that an encoder could have sent, with true or wrong stamps."""
        return [s for s in self.streams if (rate is None or s.rate == rate)
                and s.encoder != EXACT_ENCODER and s.velocity != 'exact' and s.stamps != 'uneven']

    def merits(self, streams, longest_lag=math.inf, error=EFFORT):
        """How the settings with no more lag do on the streams, the best first."""
        common = set.intersection(*(set(self._grid[s]) for s in streams)) | {self.default}
        allowed = [c for c in common if c.lag <= longest_lag]
        errors = {c: [self._error(s, c, error) for s in streams] for c in allowed}
        least = [min(errors[c][i] for c in allowed) for i in range(len(streams))]
        return sorted((Merit(c, geometric_mean(_ratios(errors[c], least)),
                             geometric_mean(what_matters(e) for e in errors[c]), max(errors[c]))
                       for c in allowed), key=lambda m: (m.times_best, m.setting))

    def _error(self, stream, setting, error):
        row = self._other[stream, DEFAULT] if setting == self.default \
            else self._grid[stream][setting]
        return getattr(row, error)

    def default_merit(self, merits):
        return next(m for m in merits if m.setting == self.default)

    def worse_than_zero(self):
        """Rows of the default that err more than accelerations taken as zero do."""
        return [row for row in (self._other[s, DEFAULT] for s in self.realistic())
                if row.effort_rms_share > self._other[row.stream, ZERO].effort_rms_share]


def what_matters(share):
    return max(share, NEGLIGIBLE)


def _ratios(errors, others):
    return (what_matters(e) / what_matters(o) for e, o in zip(errors, others))


def geometric_mean(values):
    values = list(values)
    return math.exp(sum(math.log(value) for value in values) / len(values))


def step(encoder):
    """One count at the joint, rad."""
    return 2 * math.pi / (encoder.counts * encoder.gear) if encoder.counts else 0.0


def reading_noise(encoder):
    """Standard deviation of a reading at the joint, rad: rounding and noise."""
    return step(encoder) * math.sqrt(1.0 / 12 + encoder.noise ** 2)


def noise_formula(encoder, window, rate):
    """RMS error (rad/s^2) that independent reading errors leave in the acceleration in the middle
    of a window, by the formula of Savitzky and Golay for polynomials of order 2 or 3."""
    n = float(window)
    gain = math.sqrt(720 / (n * (n ** 2 - 1) * (n ** 2 - 4)))
    return reading_noise(encoder) * gain * rate ** 2
