"""What was found, in numbers: values with deviations, what the motion did not tell, and how well it fits."""
import numpy as np
from scipy import stats

from . import bodies
from .colour import autocorrelation
from .refusal import Refusal

TERMS = ('damping', 'coulomb', 'rotor_inertia', 'offset')
LAGS = 20
GAIN_TOLD = 0.1  # a relative deviation, from which on a gain is not told
NOT_TOLD = 0.5  # a deviation over what was thought before, from which on the recording has told nothing


class Row:
    """A line of the table of parameters."""

    def __init__(self, what, of, unit, described, value, deviation, status):
        self.what, self.of, self.unit = what, of, unit
        self.described, self.value, self.deviation, self.status = described, value, deviation, status

    @property
    def excited(self):
        return not self.status.startswith('not excited')


def vaf(measured, computed):
    """Variance accounted for: 1 - var(measured - computed) / var(measured)."""
    variance = np.var(measured)
    return 1 - np.var(measured - computed) / variance if variance > 0 else np.nan


class Judged:
    """How well efforts before and after are those that were measured, in some rows."""

    def __init__(self, label, names, measured, before, after):
        self.label, self.rows = label, []
        for i, name in enumerate(names):
            good = np.isfinite(measured[:, i]) & np.isfinite(after[:, i])
            if good.sum() < 2:
                continue
            m, b, a = measured[good, i], before[good, i], after[good, i]
            rms = np.sqrt(np.mean((m - b) ** 2)), np.sqrt(np.mean((m - a) ** 2))
            self.rows.append((name, np.sqrt(np.mean(m ** 2)), vaf(m, b), vaf(m, a)) + rms)


class Outcome:
    def __init__(self, arguments, regressor, parameters, efforts, cutoff):
        self.arguments, self.regressor = arguments, regressor
        self.parameters, self.efforts, self.cutoff = parameters, efforts, cutoff
        self.solution = self.base = self.scene = self.urdf = self.shown = None
        self.blocks, self.inertial, self.judged = [], [], []
        self.condition = self.span = np.nan
        self.without_gain = []  # efforts that are left out, as their gain is not told

    @property
    def names(self):
        return [self.regressor.efforts[i] for i in self.efforts]

    def leave_out_unknown_gains(self, pieces):
        """Takes efforts out of pieces whose gain has a large deviation. Returns whether there are any."""
        count = len(self.parameters)
        gains = self.solution.gains
        deviations = [self.solution.deviation(count + i) for i in range(len(self.efforts))]
        told = [i for i, deviation in enumerate(deviations) if deviation < GAIN_TOLD * abs(gains[i])]
        if len(told) == len(self.efforts):
            return False
        if not told:
            raise Refusal('--fit gain: no gain is told: what masses make of the efforts is too small beside '
                          'friction and noise')
        self.without_gain += [name for i, name in enumerate(self.names) if i not in told]
        self.efforts = [self.efforts[i] for i in told]
        for piece in pieces:
            piece.measured, piece.described = piece.measured[:, told], piece.described[:, told]
            piece.columns = piece.columns[:, :, told]
        return True

    # --- values

    def value(self, index):
        return self.parameters[index].described + self.solution.x[index]

    def body(self, kind, of):
        first = next(k for k, p in enumerate(self.parameters) if p.kind == kind and p.of == of)
        return np.array([self.value(k) for k in range(first, first + 10)])

    def terms(self):
        """What goes into `joints:` of the scene."""
        return [(p.of, p.kind, max(self.value(k), 0) if p.at_least_zero else self.value(k))
                for k, p in enumerate(self.parameters) if p.kind in TERMS and k not in self.solution.held]

    def unit_of(self, kind, of):
        slides = self.regressor.units.get(of) == 'm'
        units = {'damping': ('N m s/rad', 'N s/m'), 'coulomb': ('N m', 'N'), 'offset': ('N m', 'N'),
                 'rotor_inertia': ('kg m^2', 'kg'), 'mass': ('kg',) * 2}
        kind = kind.replace('coupled_', '')
        if kind in units:
            return units[kind][slides]
        return 'kg m' if kind.startswith('first') else 'kg m^2'

    def rows(self):
        result = []
        for k, p in enumerate(self.parameters):
            if p.kind in TERMS or p.kind.startswith('coupled_'):
                result.append(self._term_row(k, p))
        for block in self.blocks:
            if self.parameters[block.first].kind == 'payload_mass':
                result += self._payload_rows(block)
        if self.base is not None:
            result += self._base_rows()
        result += self._gain_rows()
        return result

    def _term_row(self, k, p):
        held = self.solution.held.get(k)
        status = 'excited'
        if held:
            status = 'not excited: ' + held
        elif self._only_in_sums(k):
            status = 'not excited: told in sums with inertia only, see below'
        elif k in self.solution.at_bound:
            status = 'at its bound, 0'
        deviation = np.nan if held else self.solution.deviation(k)
        return Row(p.kind, p.of, self.unit_of(p.kind, p.of), p.described, self.value(k), deviation, status)

    def _only_in_sums(self, k):
        """Whether no motion tells a rotor from the inertia of a link."""
        return self.base is not None and k in self.inertial and self.inertial.index(k) in self.base.sums

    def _payload_rows(self, block):
        found = block.described + self.solution.x[block.slice]
        change = bodies.described_jacobian(found)
        after = np.diag(change @ self.solution.covariance[block.slice, block.slice] @ change.T)
        before = np.diag(change @ self.solution.prior_covariance[block.slice, block.slice] @ change.T)
        mass, centre, inertia = bodies.described(found)
        values = [mass] + list(centre) + list(inertia[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]])
        whats = ['mass', 'centre x', 'centre y', 'centre z', 'ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz']
        units = ['kg'] + ['m'] * 3 + ['kg m^2'] * 6
        of = 'payload of ' + self.parameters[block.first].of
        return [Row(what, of, unit, np.nan, value, np.sqrt(own), self._told(own, other))
                for what, unit, value, own, other in zip(whats, units, values, after, before)]

    @staticmethod
    def _told(after, before):
        if before > 0 and np.sqrt(after / before) > NOT_TOLD:
            return 'not excited: the recording tells less than was assumed'
        return 'excited'

    def _base_rows(self):
        matrix = self.base.matrix(len(self.inertial))
        its = self.inertial
        after = self.solution.covariance[np.ix_(its, its)]
        before = self.solution.prior_covariance[np.ix_(its, its)]
        names = [self.parameters[k].name for k in its]
        described = np.array([self.parameters[k].described for k in its])
        rows = []
        for i, sums in enumerate(matrix):
            p = self.parameters[its[self.base.kept[i]]]
            if p.kind in TERMS and not np.any(np.delete(sums, self.base.kept[i])):
                continue  # a rotor that stands alone has a row of its own
            value = sums @ (described + self.solution.x[its])
            own, other = sums @ after @ sums, sums @ before @ sums
            rows.append(Row(self.base.text(i, names), '', self.unit_of(p.kind, p.of), sums @ described, value,
                            np.sqrt(own), self._told(own, other)))
        return rows

    def _gain_rows(self):
        count = len(self.parameters)
        rows = []
        if self.has_gains:
            for i, name in enumerate(self.names):
                k = self.solution.gains[i]
                rows.append(Row('gain', name, 'effort per measured unit', 1.0, 1 / k,
                                self.solution.deviation(count + i) / k ** 2, 'excited'))
        return rows + [Row('gain', name, 'effort per measured unit', np.nan, np.nan, np.nan,
                           'not excited: what masses make of the effort is too small')
                       for name in self.without_gain]

    @property
    def has_gains(self):
        return len(self.solution.covariance) > len(self.parameters)

    def unseen(self):
        """Inertial parameters that no motion shows."""
        if self.base is None:
            return []
        return [self.parameters[self.inertial[i]].name for i in self.base.unseen]

    # --- how well it fits

    def _coupled(self, regressor):
        result = np.zeros_like(regressor.described)
        for k, p in enumerate(self.parameters):
            if p.kind.startswith('coupled_'):
                result += self.value(k) * p.source(regressor)
        return result

    def _in_measured_units(self, efforts):
        gains = np.ones(efforts.shape[1])
        gains[self.efforts] = self.solution.gains
        return gains * efforts

    def before(self, regressor):
        """Efforts as described, in units of the measured ones: gains that were found count in them, too."""
        return self._in_measured_units(regressor.described)

    def after(self, regressor):
        """Efforts by what was found, in units of the measured ones."""
        return self._in_measured_units(regressor.described + self._coupled(regressor))

    def add_judged(self, label, recording, after, keep):
        its = self.efforts
        self.judged.append(Judged(label, self.names, recording.measured[keep][:, its],
                                  self.before(recording.regressor)[keep][:, its], self.after(after)[keep][:, its]))

    def colours(self):
        """Autocorrelations of what is left, before and after the autoregression, and how many rows they are of."""
        left = self.residual_pieces
        white = self.solution.colour.white_pieces(left)
        return autocorrelation(left, LAGS), autocorrelation([white], LAGS), len(white)

    def whiteness(self):
        """Probability, by Ljung and Box, that white rows have such correlations, for each effort."""
        _, white, rows = self.colours()
        lags = np.arange(1, min(LAGS, rows - 1) + 1)
        statistic = rows * (rows + 2) * np.sum(white[lags] ** 2 / (rows - lags)[:, None], axis=0)
        return stats.chi2.sf(statistic, max(len(lags) - self.solution.colour.order, 1))

    def scene_comments(self):
        lines = ['What identify.py found in %s, %.4g s of it fitted.' % (
            ' '.join(self.arguments.motion), self.span)]
        for row in self.rows():
            where = ' of ' + row.of if row.of else ''
            if not row.excited:
                lines.append('%s%s: %s' % (row.what, where, row.status))
            elif row.what.startswith('coupled') or row.what == 'gain':
                lines.append('%s%s: %.6g +- %.2g %s; a scene has no key for it' % (
                    row.what, where, row.value, row.deviation, row.unit))
        return lines
