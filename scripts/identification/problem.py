"""Rows of the regression: measured efforts, those of the description, and columns of parameters."""
import numpy as np

from .filtering import Filter, pieces
from .refusal import Refusal

SHORTEST = 0.3  # s
ROWS_FOR_EACH = 3  # rows of an effort for each unknown that it depends on, on average


class Piece:
    """Filtered rows without a gap: all arrays are rows x efforts, columns parameters x rows x efforts."""

    def __init__(self, times, measured, described, columns):
        self.times = times
        self.measured = measured
        self.described = described
        self.columns = columns


def friction_shape(speed, full_from):
    """Dry friction over its amplitude, as the scene has it."""
    s = np.clip(speed / full_from, -1, 1)
    return s * (3 - s * s) / 2


class Coupling:
    """Friction of two joints by the sum, or the difference, of their speeds."""

    def __init__(self, first, second, sign):
        self.first, self.second, self.sign = first, second, sign

    @property
    def name(self):
        return self.first + ('+' if self.sign > 0 else '-') + self.second

    def columns(self, regressor, full_from):
        """Viscous and dry, each rows x efforts."""
        i, j = (regressor.coordinates.index(name) for name in (self.first, self.second))
        speed = regressor.velocities[:, i] + self.sign * regressor.velocities[:, j]
        result = []
        for friction in (speed, friction_shape(speed, full_from)):
            column = np.zeros_like(regressor.described)
            column[:, regressor.efforts.index(self.first)] = friction
            column[:, regressor.efforts.index(self.second)] = self.sign * friction
            result.append(column)
        return result


class Parameter:
    """An unknown: what it is of, and what is known of it before."""

    def __init__(self, kind, of, described, source, joint=None):
        self.kind, self.of, self.described = kind, of, described
        self.joint = joint or of  # whose effort and speed it goes by, if it is one of a joint
        self.source = source  # its column: an index into the regressor, or a function of a regressor

    @property
    def name(self):
        return '%s of %s' % (self.kind, self.of)

    @property
    def at_least_zero(self):
        return self.kind in ('damping', 'coulomb', 'rotor_inertia', 'coupled_damping', 'coupled_coulomb')


def filtered_pieces(regressor, measured, keep, efforts, parameters, cutoff, loaded=True, progress=None):
    """Pieces of the rows `keep` of a recording; `efforts` are indices of those that are used.

    Parameters of a payload do not act where the recording is one without it (`loaded` is false)."""
    times = regressor.times
    good = keep & np.isfinite(measured[:, efforts]).all(1) & np.isfinite(regressor.described[:, efforts]).all(1)
    for parameter in parameters:  # some have no value in singular positions of loops
        if loaded or not parameter.kind.startswith('payload_'):
            good &= np.isfinite(_column(parameter, regressor, efforts)).all(1)
    low_pass = Filter(times, cutoff)
    slices = [part for part in pieces(times, good) if times[part.stop - 1] - times[part.start] > SHORTEST / 2]
    result = [Piece(low_pass.rows(times[part]), low_pass(times[part], measured[part][:, efforts]),
                    low_pass(times[part], regressor.described[part][:, efforts]), None) for part in slices]
    for piece in result:
        piece.columns = np.zeros((len(parameters), len(piece.times), len(efforts)))
    for k, parameter in enumerate(parameters):
        if progress:
            progress.update(k + 1, len(parameters))
        if not loaded and parameter.kind.startswith('payload_'):
            continue
        column = _column(parameter, regressor, efforts)
        for part, piece in zip(slices, result):
            piece.columns[k] = low_pass(times[part], column[part])
    return [piece for piece in result if len(piece.times) > 2]


def _column(parameter, regressor, efforts):
    source = parameter.source
    column = regressor.columns[source] if isinstance(source, int) else source(regressor)
    return np.asarray(column)[:, efforts]


def check_length(found, parameters, efforts, cutoff):
    """Refuses what is too short to tell anything."""
    rows = sum(len(piece.times) for piece in found)
    span = sum(piece.times[-1] - piece.times[0] for piece in found)
    needed = ROWS_FOR_EACH * max(1, -(-len(parameters) // max(len(efforts), 1)))
    if rows < needed or span < SHORTEST:
        raise Refusal('the recording is too short to fit: %.3g s have %d independent rows below %.3g Hz, and '
                      '%d parameters need %d' % (span, rows, cutoff, len(parameters), needed))
