"""Which inertial parameters efforts depend on at all: the base parameters of a robot."""
import numpy as np
from scipy import linalg

# What is left of a column, relative to it, that the columns before it explain: the regressor has a
# relative error of some 1e-15 and its condition on random states is below 1e5.
LEFT = 1e-8
COEFFICIENT = 1e-7  # relative to what would make both columns alike; less is rounding


class BaseParameters:
    """Goes through columns in their order and keeps what the columns before do not explain. Units play
    no part, as every column is judged against its own length."""

    def __init__(self, columns):
        """columns: what random states make of each parameter, parameters x numbers."""
        lengths = linalg.norm(columns, axis=1)
        largest = lengths.max() if len(lengths) else 0
        self.kept, self.unseen, self.sums = [], [], {}
        directions = np.zeros((0, columns.shape[1]))
        for i, column in enumerate(columns):
            if lengths[i] <= 1e-12 * largest:
                self.unseen.append(i)
                continue
            left = column / lengths[i]
            for _ in range(2):  # the second time takes out what rounding left
                left = left - directions.T @ (directions @ left)
            if linalg.norm(left) > LEFT:
                self.kept.append(i)
                directions = np.vstack([directions, left / linalg.norm(left)])
        self._add_sums(columns, lengths)

    def _add_sums(self, columns, lengths):
        """Of each parameter that is not kept: what one of it counts as in those that are."""
        basis = columns[self.kept] / lengths[self.kept, None]
        for i in range(len(columns)):
            if i in self.kept or i in self.unseen:
                continue
            parts = linalg.lstsq(basis.T, columns[i] / lengths[i])[0]
            self.sums[i] = {kept: part * lengths[i] / lengths[kept]
                            for kept, part in zip(self.kept, parts) if abs(part) > COEFFICIENT}

    def matrix(self, count):
        """Base parameters as sums of all parameters: kept x count."""
        result = np.zeros((len(self.kept), count))
        for row, kept in enumerate(self.kept):
            result[row, kept] = 1
            for other, parts in self.sums.items():
                result[row, other] = parts.get(kept, 0)
        return result

    def text(self, row, names):
        """A base parameter by the names of all parameters."""
        kept = self.kept[row]
        text = names[kept]
        for other, parts in self.sums.items():
            if kept in parts:
                factor = parts[kept]
                sign = ' + ' if factor > 0 else ' - '
                size = '' if abs(abs(factor) - 1) < 1e-6 else '%.4g ' % abs(factor)
                text += sign + size + names[other]
        return text
