"""Rows in one go, and the time that each row stands for."""
import numpy as np

SLOW = 5  # spacings longer than so many usual ones are gaps, and than the longest that is none


def gap_length(times, max_gap):
    """Spacings of rows beyond this are gaps, across which nothing is assumed; s."""
    if len(times) < 2:
        return max_gap
    return max(max_gap, SLOW * float(np.median(np.diff(times))))


def pieces_of(times, exists, gap):
    """Slices of rows in one go: values exist, and no spacing is longer than `gap`."""
    if len(times) == 0:
        return []
    exists = np.asarray(exists, dtype=bool)
    breaks = np.ones(len(times) + 1, dtype=bool)  # before row i
    breaks[1:-1] = (np.diff(times) > gap) | ~exists[1:] | ~exists[:-1]
    bounds = np.flatnonzero(breaks)
    return [slice(a, b) for a, b in zip(bounds[:-1], bounds[1:]) if exists[a]]


def weights_of(times, pieces):
    """The time that each row stands for, s: half of the way to its neighbours in its piece. Rows of no
    piece have none. Where all pieces are single rows, each row counts alike."""
    weights = np.zeros(len(times))
    for piece in pieces:
        half = 0.5 * np.diff(times[piece])
        weights[piece][:-1] += half
        weights[piece][1:] += half
    if not weights.any():
        for piece in pieces:
            weights[piece] = 1.0
    return weights
