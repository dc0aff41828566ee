"""Cycles of a load by the rainflow count of ASTM E1049-85, section 5.4.4."""
import numpy as np


def reversals(values):
    """The values at which a series turns, with its first and last one."""
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return values
    values = values[np.concatenate(([True], np.diff(values) != 0))]  # plateaus are one point
    if len(values) < 3:
        return values
    steps = np.diff(values) > 0
    turns = np.flatnonzero(steps[1:] != steps[:-1]) + 1
    return values[np.concatenate(([0], turns, [len(values) - 1]))]


def count_cycles(values):
    """Ranges of a series and how often each is counted: 1 for a cycle, 0.5 for half of one."""
    ranges, counts = [], []
    points = []  # peaks and valleys that are not discarded yet; the first is the starting point
    for point in reversals(values).tolist():
        points.append(point)
        while len(points) >= 3:
            latest = abs(points[-1] - points[-2])
            before = abs(points[-2] - points[-3])
            if latest < before:
                break
            ranges.append(before)
            if len(points) == 3:  # with the starting point: half a cycle, and the next one starts
                counts.append(0.5)
                del points[0]
            else:
                counts.append(1.0)
                del points[-3:-1]
    for first, second in zip(points, points[1:]):
        ranges.append(abs(second - first))
        counts.append(0.5)
    return np.array(ranges), np.array(counts)


def count_pieces(values, pieces):
    """The cycles of a series in pieces; none reaches across a gap."""
    counted = [count_cycles(values[piece]) for piece in pieces]
    if not counted:
        return np.array([]), np.array([])
    return (np.concatenate([ranges for ranges, _ in counted]),
            np.concatenate([counts for _, counts in counted]))


def range_applied_once(ranges, counts, exponent):
    """The range that does the damage of all cycles in one: (sum n range^m)^(1/m)."""
    largest = float(np.max(ranges, initial=0.0))
    if largest == 0:
        return 0.0
    return largest * float(np.sum(counts * (ranges / largest) ** exponent)) ** (1 / exponent)


def equivalent_range(ranges, counts, exponent):
    """The range that does the damage of all cycles in as many of its own."""
    total = float(np.sum(counts))
    return range_applied_once(ranges, counts, exponent) / total ** (1 / exponent) if total > 0 else 0.0
