"""Power spectral density of a series that has gaps and whose stamps may be uneven."""
import numpy as np

EVEN = 0.02  # stamps are even when their spacings vary by less than this part of them
FEWEST = 32  # samples in a segment
MOST = 1 << 14
SEGMENTS = 8  # of the longest piece, about; they overlap by half


class Clock:
    """How series of one table are brought to even steps."""

    def __init__(self, times, gap):
        spacings = np.diff(times)
        spacings = spacings[spacings <= gap]
        self.step = float(np.median(spacings)) if len(spacings) > 0 else 0.0
        spread = float(np.std(spacings)) if len(spacings) > 0 else 0.0
        self.spread = spread / self.step if self.step > 0 else 0.0
        self.even = self.spread < EVEN
        if self.even and self.step > 0:
            self.step = float(np.mean(spacings))

    @property
    def rate(self):
        return 1 / self.step if self.step > 0 else 0.0

    def sampled(self, times, values):
        """A piece in even steps: as it is, or by straight lines between its samples."""
        if self.even:
            return values
        count = int((times[-1] - times[0]) / self.step * (1 + 1e-9)) + 1
        return np.interp(times[0] + self.step * np.arange(count), times, values)


class Spectrum:
    """Densities over frequencies, and which part of the time they are of."""

    def __init__(self, frequencies, density, used):
        self.frequencies = frequencies  # Hz
        self.density = density  # unit^2/Hz, one-sided: its integral is the variance
        self.used = used  # part of the time in pieces long enough


def density_of(series, times, pieces, clock):
    """The sum of the densities of several series, such as the components of a force, whose pieces are
    the same. None where no piece is long enough, or the clock has no step."""
    from scipy import signal  # takes long to load, and not every report has spectra
    lengths = [piece.stop - piece.start for piece in pieces]
    longest = max(lengths, default=0)
    if clock.step <= 0 or longest < FEWEST:
        return None
    segment = int(min(MOST, max(FEWEST, 2 * longest // (SEGMENTS + 1))))
    frequencies, total, weight, used = None, 0.0, 0, 0
    for piece, length in zip(pieces, lengths):
        if length < segment:
            continue
        parts = [clock.sampled(times[piece], values[piece]) for values in series]
        if len(parts[0]) < segment:
            continue
        segments = 1 + (len(parts[0]) - segment) // (segment - segment // 2)
        for part in parts:
            frequencies, density = signal.welch(part, fs=clock.rate, window='hann', nperseg=segment,
                                                noverlap=segment // 2, detrend='constant')
            total = total + segments * density
        weight += segments
        used += length
    if weight == 0:
        return None
    return Spectrum(frequencies[1:], (total / weight)[1:], used / max(1, len(times)))
