"""Weighted least squares for parameters, in which bodies stay bodies that can be.

Efforts are k (d + sum of x c): with d as described, columns c of the parameters, changes x of these, and the
motors' gains k. All is kept as one quadratic form in x and k, so that the search for bodies costs
nothing that grows with the recording.
"""
import numpy as np
from scipy import linalg

from . import bodies
from .colour import Colour

ROUNDS = 4  # of weights and solutions
WIDE = 1e3  # a deviation without data, over the scale of a parameter
SIGNIFICANT = 3  # deviations: a value that far from the described one is told, however poorly
# Of terms that cannot be told from each other, those that say something about motions that were not
# recorded go first: a joint that turns one way only has an offset, not dry friction.
DROP_FIRST = ('rotor_inertia', 'coupled_coulomb', 'coupled_damping', 'coulomb', 'damping', 'offset')


class Block:
    """Ten parameters of a body, with what is thought of it before."""

    def __init__(self, first, described, before, weight):
        self.first = first  # index of its mass
        self.described = described  # which changes are added to
        self.before = before  # a body that can be
        self.weight = weight  # of the metric: 1 for a deviation of 100 %
        self.metric = weight * bodies.metric(before)

    @property
    def slice(self):
        return slice(self.first, self.first + 10)


class Solution:
    """Changes of all parameters, then gains; deviations; what was held and why."""

    def __init__(self, count, gains):
        self.x = np.zeros(count)
        self.gains = gains
        self.covariance = None
        self.prior_covariance = None
        self.held = {}  # index: reason
        self.at_bound = set()
        self.colour = None
        self.condition = np.nan
        self.normal = None

    def deviation(self, index):
        return float(np.sqrt(max(self.covariance[index, index], 0)))


class Solver:
    """Fits one set of parameters to pieces of recordings."""

    def __init__(self, parameters, pieces, scales, blocks=(), gain_efforts=(), rests=None):
        self.parameters = parameters
        self.pieces = pieces
        self.scales = np.asarray(scales, dtype=float)  # what counts as much of each parameter
        self.blocks = list(blocks)
        self.gain_efforts = list(gain_efforts)
        self.rests = dict(rests or {})  # index of a parameter: why it cannot be told
        self.count = len(parameters)
        self.inertial = np.zeros(self.count, dtype=bool)
        for block in self.blocks:
            self.inertial[block.slice] = True

    # --- rows

    def computed(self, piece, x, gains):
        return gains * (piece.described + np.tensordot(x, piece.columns, 1))

    def residuals(self, x, gains):
        return [piece.measured - self.computed(piece, x, gains) for piece in self.pieces]

    def normal_equations(self, weights, colour, x, gains):
        """Of the linear problem at x and gains, with the weights of each effort: its matrix, the right-hand
        side for (x, gains), and the variance of the latter under residuals of a colour."""
        columns, coloured = [], []
        for pieces in self._columns(x, gains):
            columns.append(np.concatenate([(piece * np.sqrt(weights)).ravel() for piece in pieces]))
            if colour is not None:
                coloured.append(colour.of_rows([piece * weights for piece in pieces]))
        matrix = np.array(columns)
        at = np.concatenate([x, gains[self.gain_efforts]])
        target = np.concatenate([(piece * np.sqrt(weights)).ravel() for piece in self.residuals(x, gains)])
        normal = matrix @ matrix.T
        coloured = np.array(coloured)
        return normal, matrix @ (target + at @ matrix), normal if colour is None else coloured @ coloured.T

    def _columns(self, x, gains):
        """For each unknown a list of pieces: how efforts change with it."""
        for k in range(self.count):
            yield [gains * piece.columns[k] for piece in self.pieces]
        for effort in self.gain_efforts:
            parts = []
            for piece in self.pieces:
                alone = np.zeros_like(piece.measured)
                alone[:, effort] = self.computed(piece, x, np.ones_like(gains))[:, effort]
                parts.append(alone)
            yield parts

    def _weights(self, residuals):
        variances = np.mean(np.concatenate(residuals) ** 2, axis=0)
        return 1 / (variances + 1e-30 + 1e-12 * variances.sum())

    # --- solutions

    def before(self):
        """The quadratic form of what is known of bodies before, and its right-hand side."""
        size = self.count + len(self.gain_efforts)
        form, right = np.zeros((size, size)), np.zeros(size)
        for block in self.blocks:
            form[block.slice, block.slice] = block.metric
            right[block.slice] = block.metric @ (block.before - block.described)
        wide = np.zeros(size)
        joint = ~self.inertial
        wide[:self.count][joint] = 1 / (WIDE * self.scales[joint]) ** 2
        return form + np.diag(wide), right

    def solve(self):
        width = self.pieces[0].measured.shape[1]
        rows = sum(len(piece.times) for piece in self.pieces)
        solution = Solution(self.count, np.ones(width))
        described = [piece.measured - piece.described for piece in self.pieces]
        weights, colour = self._weights([piece - piece.mean(0) for piece in described]), None
        for number in range(ROUNDS):
            # Gains make the problem a little nonlinear: the first round goes to its solution.
            for _ in range(6 if self.gain_efforts and number == 0 else 1):
                problem = self.normal_equations(weights, colour, solution.x, solution.gains)
                self._solve_once(solution, *problem)
            residuals = self.residuals(solution.x, solution.gains)
            left = self.count + len(self.gain_efforts) - len(solution.held)
            unknown = rows * width / max(rows * width - left, 1)  # what the fit has taken of the residuals
            weights = self._weights(residuals) / unknown
            colour = Colour([np.sqrt(unknown) * piece for piece in residuals])
        solution.colour, solution.weights = colour, weights
        self._finish(solution, *self.normal_equations(weights, colour, solution.x, solution.gains))
        return solution

    def _solve_once(self, solution, matrix, target, variance):
        form, right = self.before()
        whole, sides = matrix + form, target + right
        solution.held = dict(self.rests)
        solution.held.update(self._not_told(whole, sides, matrix, variance + form, solution.held))
        free = np.array([i for i in range(len(sides)) if i not in solution.held])
        at = np.zeros(len(sides))
        at[self.count:] = solution.gains[self.gain_efforts]
        solution.at_bound = set()
        lowest = {i: -parameter.described for i, parameter in enumerate(self.parameters)
                  if parameter.at_least_zero and i not in solution.held}
        while True:
            loose = np.array([i for i in free if i not in solution.at_bound])
            at[:self.count] = 0
            for i in solution.at_bound:
                at[i] = lowest[i]
            fixed = np.setdiff1d(np.arange(len(sides)), loose)
            reduced = sides[loose] - whole[np.ix_(loose, fixed)] @ at[fixed]
            at[loose] = self._search(whole[np.ix_(loose, loose)], reduced, loose)
            below = [i for i in lowest if i not in solution.at_bound and
                     at[i] < lowest[i] - 1e-12 * self.scales[i]]
            if not below:
                break
            solution.at_bound.update(below)
        solution.x = at[:self.count].copy()
        solution.gains = solution.gains.copy()
        solution.gains[self.gain_efforts] = at[self.count:]

    def _search(self, whole, sides, loose):
        """The least of a quadratic form where bodies are bodies: Gauss-Newton in log-Cholesky."""
        scale = 1 / np.sqrt(np.diag(whole))
        linear = scale * linalg.solve(scale[:, None] * whole * scale, scale * sides, assume_a='sym')
        if not self.blocks:
            return linear
        place = {index: row for row, index in enumerate(loose)}
        rows = [np.array([place[i] for i in range(block.first, block.first + 10)]) for block in self.blocks]
        at = linear.copy()
        coordinates = []
        for block, its in zip(self.blocks, rows):
            start = block.described + linear[its]
            if not bodies.is_possible(start) or linalg.eigvalsh(bodies.pseudo_inertia(start))[0] <= 0:
                start = bodies.nearest_possible(start, 0.3, 0.05 * max(block.before[0], 1e-9))
            coordinates.append(bodies.to_coordinates(start))
            at[its] = bodies.from_coordinates(coordinates[-1])[0] - block.described
        return self._descend(whole, sides, at, coordinates, rows)

    def _descend(self, whole, sides, at, coordinates, rows):
        size = len(sides)
        inertial = np.concatenate(rows)
        others = np.setdiff1d(np.arange(size), inertial)

        def cost(x):
            return 0.5 * x @ whole @ x - sides @ x

        damping, best = 1e-6, cost(at)
        for _ in range(200):
            change = np.zeros((size, size))  # d at / d unknown
            change[others, others] = 1
            for block_coordinates, its in zip(coordinates, rows):
                change[np.ix_(its, its)] = bodies.from_coordinates(block_coordinates)[1]
            gradient = change.T @ (sides - whole @ at)
            curvature = change.T @ whole @ change
            scale = np.sqrt(np.diag(curvature))
            scale[scale == 0] = 1
            step = None
            while damping < 1e9:
                normed = curvature / np.outer(scale, scale) + damping * np.eye(size)
                try:
                    step = linalg.solve(normed, gradient / scale, assume_a='pos') / scale
                except linalg.LinAlgError:  # by rounding: a body is close to one that cannot be
                    damping *= 10
                    continue
                new = [c + np.clip(step[its], -2, 2) for c, its in zip(coordinates, rows)]
                moved = at.copy()
                moved[others] += step[others]
                for block, c, its in zip(self.blocks, new, rows):
                    moved[its] = bodies.from_coordinates(c)[0] - block.described
                if np.isfinite(moved).all() and cost(moved) <= best:
                    break
                damping *= 10
                step = None
            if step is None:
                break
            gained, best = best - cost(moved), cost(moved)
            at, coordinates, damping = moved, new, max(damping / 10, 1e-12)
            if gained <= 1e-9 * (1 + 1e-9 * abs(best)):
                break
        return at

    # --- what can be told

    def _not_told(self, whole, sides, matrix, variance, held):
        """Joint terms that the rows do not tell, one after the other, each with the reason."""
        found = []
        left = [i for i in range(len(whole)) if i not in held]
        joint = [i for i in left if i < self.count and not self.inertial[i]]
        while joint:
            inverse = _inverse(whole[np.ix_(left, left)])
            spread = np.einsum('ij,jk,ki->i', inverse, variance[np.ix_(left, left)], inverse)
            place = {index: row for row, index in enumerate(left)}
            values = inverse @ sides[left]
            poor = [i for i in joint if spread[place[i]] > self.scales[i] ** 2 and
                    values[place[i]] ** 2 < SIGNIFICANT ** 2 * spread[place[i]]]
            if not poor:
                break
            poor.sort(key=lambda i: (DROP_FIRST.index(self.parameters[i].kind),
                                     -spread[place[i]] / self.scales[i] ** 2))
            worst = poor[0]
            found.append((worst, self._why(worst, matrix, [i for i in left if i != worst])))
            left.remove(worst)
            joint.remove(worst)
        return found

    def _why(self, index, matrix, others):
        own = matrix[index, index]
        if own <= 0:
            return 'no effort that is measured depends on it'
        others = [i for i in others if matrix[i, i] > 0]
        if others:
            parts = linalg.lstsq(matrix[np.ix_(others, others)], matrix[others, index])[0]
            left = own - matrix[index, others] @ parts
            if left < 0.02 * own:
                shares = np.abs(parts) * np.sqrt(np.diag(matrix)[others])
                most = others[int(np.argmax(shares))]
                return 'cannot be told from ' + self._name(most)
        return 'too little motion to tell it from noise'

    def _name(self, index):
        if index < self.count:
            return self.parameters[index].name
        return 'gain'

    def _finish(self, solution, matrix, _, variance):
        form, _ = self.before()
        size = len(matrix)
        free = np.array([i for i in range(size) if i not in solution.held])
        its = np.ix_(free, free)
        inverse = _inverse((matrix + form)[its])
        solution.covariance = np.zeros((size, size))
        solution.covariance[its] = inverse @ (variance + form)[its] @ inverse
        # What is held may be off by as much as counts as little, and takes others with it.
        for held in solution.held:
            moves = inverse @ matrix[free, held] * self.scales[held]
            solution.covariance[its] += np.outer(moves, moves)
        solution.prior_covariance = np.zeros((size, size))
        for block in self.blocks:
            solution.prior_covariance[block.slice, block.slice] = _inverse(block.metric)
        solution.normal = matrix


def _inverse(matrix):
    scale = 1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    normed = scale[:, None] * matrix * scale
    values, vectors = linalg.eigh((normed + normed.T) / 2)
    values = np.maximum(values, 1e-13 * values[-1])
    return scale[:, None] * (vectors / values @ vectors.T) * scale


def condition_of(normal, indices):
    """Of the rows for these parameters, each column divided by its length."""
    part = normal[np.ix_(indices, indices)]
    lengths = np.sqrt(np.diag(part))
    if len(indices) == 0 or lengths.min() <= 0:
        return np.inf
    values = linalg.eigvalsh(part / np.outer(lengths, lengths))
    return float(np.sqrt(values[-1] / max(values[0], 1e-300)))
