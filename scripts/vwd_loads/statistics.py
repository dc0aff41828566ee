"""Peaks, means and percentiles over time."""
import math

import numpy as np

PERCENTILES = (1, 5, 50, 95, 99)


def weighted_mean(values, weights):
    return float(np.sum(weights * values) / np.sum(weights))


def weighted_rms(values, weights):
    largest = float(np.max(np.abs(values), initial=0.0))
    if largest == 0:
        return 0.0
    return largest * math.sqrt(weighted_mean((values / largest) ** 2, weights))


def weighted_percentiles(values, weights, percentiles=PERCENTILES):
    """For each percentile the least value that is not exceeded in that part of the time."""
    order = np.argsort(values, kind='stable')
    part = np.cumsum(weights[order])
    # Rounding of the sum must not pass over a value that is reached exactly.
    wanted = np.array(percentiles) / 100 * part[-1] * (1 - 1e-12)
    index = np.minimum(np.searchsorted(part, wanted), len(values) - 1)
    return [float(value) for value in values[order][index]]


def peak_row(values):
    """The row of the largest magnitude, None where no value exists."""
    magnitudes = np.abs(values)
    if np.all(np.isnan(magnitudes)):
        return None
    return int(np.nanargmax(magnitudes))
