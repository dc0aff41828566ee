"""The same filter on both sides of the regression: an even grid, a low pass without phase, fewer rows."""
import numpy as np
from scipy import signal

LONGEST_GAP = 0.25  # s: nothing is filtered across longer gaps, unless they are usual
ORDER = 4
ROWS_PER_CUTOFF = 2.5  # rate of the rows that are kept over the cut-off
CUT_OFF = 1  # periods of the cut-off that are left out at each end


def usual_step(times):
    return float(np.median(np.diff(times)))


def chosen_cutoff(times, velocities):
    """Five times the frequency below which 99 % of every moving joint's power of velocity lies; at least
    what gives 50 rows of the recording; at most a fifth of the rate."""
    step = usual_step(times)
    even = np.arange(times[0], times[-1], step)
    highest = 0
    moves = np.ptp(velocities, axis=0)
    for i in range(velocities.shape[1]):
        if moves[i] < 0.02 * moves.max():
            continue
        values = np.interp(even, times, velocities[:, i])
        frequencies, power = signal.periodogram(values, 1 / step, window='hann', detrend='constant')
        share = np.cumsum(power) / max(power.sum(), np.finfo(float).tiny)
        highest = max(highest, frequencies[min(np.searchsorted(share, 0.99), len(share) - 1)])
    least = 50 / ROWS_PER_CUTOFF / max(even[-1] - even[0], step)
    return float(min(max(5 * highest, least, 1), 0.2 / step))


class Filter:
    """Brings series at uneven times to an even grid, filters them and keeps as many rows as the filter
    leaves independent."""

    def __init__(self, times, cutoff):
        self.step = usual_step(times)
        rate = 1 / self.step
        self.every = max(1, int(rate / (ROWS_PER_CUTOFF * cutoff) + 1e-6))
        self.sos = signal.butter(ORDER, cutoff, fs=rate, output='sos') if cutoff < 0.45 * rate else None
        self._edge = int(round(CUT_OFF * rate / cutoff)) if self.sos is not None else 0

    @property
    def period(self):
        return self.step * self.every

    def grid(self, times):
        return times[0] + self.step * np.arange(int((times[-1] - times[0]) / self.step + 1e-6) + 1)

    def rows(self, times):
        """The times of the rows that are kept, of a piece without gaps."""
        return self._kept(self.grid(times))

    def _kept(self, series):
        edge = min(self._edge, len(series) // 4)
        return series[edge:len(series) - edge:self.every]

    def __call__(self, times, series):
        """A series, rows x anything, at rows()."""
        grid = self.grid(times)
        even = np.empty((len(grid), series.shape[1]))
        for i in range(series.shape[1]):
            even[:, i] = np.interp(grid, times, series[:, i])
        if self.sos is not None and len(grid) > 30:
            even = signal.sosfiltfilt(self.sos, even, axis=0)
        return self._kept(even)


def pieces(times, good):
    """Slices of rows that are all good and have no gap between them."""
    gap = max(LONGEST_GAP, 5 * usual_step(times))
    result = []
    start = None
    for i in range(len(times)):
        if start is not None and (not good[i] or times[i] - times[i - 1] > gap):
            result.append(slice(start, i))
            start = None
        if good[i] and start is None:
            start = i
    if start is not None:
        result.append(slice(start, len(times)))
    return result
