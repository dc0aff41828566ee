"""Residuals of efforts are coloured: without that, deviations of parameters would be far too small.

An autoregression for each effort, and the covariance of the efforts in what is left, say how residuals
follow each other. Parameters are fitted without it, with efforts weighed by their variance alone: where the
model lacks something, weights of a coloured noise would fit its changes rather than its size. Deviations
are those of that fit under residuals of that colour.
"""
import numpy as np
from scipy import linalg, signal

MOST = 12  # coefficients of an autoregression
ROWS_FOR_COVARIANCE = 12  # rows for each effort, from which on covariances of efforts count


class Colour:
    """Found from residuals: a list of pieces, each rows x efforts."""

    def __init__(self, residuals):
        rows = sum(len(piece) for piece in residuals)
        self._width = residuals[0].shape[1]
        most = int(max(0, min(MOST, rows // 10, min(len(piece) for piece in residuals) - 2)))
        covariances = sum(_autocovariances(piece, most) for piece in residuals) / rows
        self.order = self._best_order(covariances, rows)
        self._filters = [np.concatenate([[1], -_autoregression(covariances[:, i], self.order)[0]])
                         for i in range(self._width)]
        left = self.white_pieces(residuals)
        covariance = left.T @ left / max(len(left), 1)
        tiny = 1e-30 + 1e-12 * np.trace(covariance)
        if len(left) < ROWS_FOR_COVARIANCE * self._width:
            covariance = np.diag(np.diag(covariance))
        self._factor = linalg.cholesky(covariance + tiny * np.eye(self._width), lower=True)

    def _best_order(self, covariances, rows):
        """By Schwarz's criterion, over all efforts."""
        costs = []
        for order in range(len(covariances)):
            left = [_autoregression(covariances[:, i], order)[1] for i in range(self._width)]
            costs.append(rows * np.sum(np.log(np.maximum(left, 1e-300))) + self._width * order * np.log(rows))
        return int(np.argmin(costs))

    def white_pieces(self, pieces):
        """What the autoregressions leave of pieces: all rows x efforts."""
        result = []
        for piece in pieces:
            filtered = [signal.lfilter(its, 1, piece[:, i])[self.order:] for i, its in enumerate(self._filters)]
            result.append(np.stack(filtered, 1))
        return np.concatenate(result)

    def of_rows(self, pieces):
        """Rows whose products with themselves are the variance of `pieces` times residuals: flat."""
        result = []
        for piece in pieces:
            back = [signal.lfilter([1], its, piece[::-1, i])[::-1] for i, its in enumerate(self._filters)]
            result.append((np.stack(back, 1) @ self._factor).ravel())
        return np.concatenate(result)


def _autocovariances(piece, most):
    """Sums of products at lags 0.. most: lags x efforts. Those of shorter lags have more terms, so that an
    autoregression of them is stable."""
    return np.array([np.sum(piece[lag:] * piece[:len(piece) - lag], axis=0) for lag in range(most + 1)])


def _autoregression(covariances, order):
    """Coefficients by Yule and Walker, and the variance that they leave."""
    variance = covariances[0]
    if order == 0 or variance <= 0:
        return np.zeros(order), variance
    column = covariances[:order].copy()
    column[0] *= 1 + 1e-9  # residuals that are nothing but rounding stay tame
    coefficients = linalg.solve_toeplitz(column, covariances[1:order + 1])
    return coefficients, max(variance - coefficients @ covariances[1:order + 1], 1e-12 * variance)


def autocorrelation(pieces, lags):
    """Of pieces, rows x efforts: lags x efforts, one at lag 0."""
    result = np.zeros((lags + 1, pieces[0].shape[1]))
    for piece in pieces:
        for lag in range(min(lags, len(piece) - 1) + 1):
            result[lag] += np.sum(piece[lag:] * piece[:len(piece) - lag], axis=0)
    return result / np.maximum(result[0], 1e-300)
