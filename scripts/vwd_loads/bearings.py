"""What a bearing carries: forces along and across its axis, and the equivalent load (ISO 281)."""
import numpy as np

BALL = 3.0
ROLLER = 10.0 / 3.0


def along(vectors, axis):
    """Signed components of vectors, an array of rows, along a unit vector."""
    return vectors @ axis


def across(vectors, axis):
    """Magnitudes of what is normal to a unit vector."""
    return np.linalg.norm(vectors - np.outer(vectors @ axis, axis), axis=1)


def _integral(values, times):
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(times)))


def travel_integrals(loads, speeds, times, pieces, exponent):
    """The integrals of load^exponent |speed| dt and of |speed| dt over pieces, by the trapezoidal rule.
    The integral of loads is of loads over the largest, which is the third number."""
    worn, travel = 0.0, 0.0
    rows = [np.arange(piece.start, piece.stop) for piece in pieces]
    largest = max((float(np.max(np.abs(loads[part]))) for part in rows), default=0.0)
    scale = largest if largest > 0 else 1.0
    for part in rows:
        speed = np.abs(speeds[part])
        worn += _integral((np.abs(loads[part]) / scale) ** exponent * speed, times[part])
        travel += _integral(speed, times[part])
    return worn, travel, scale


def equivalent_load(loads, speeds, times, pieces, exponent):
    """P = (int |F|^p |qd| dt / int |qd| dt)^(1/p); None for what does not turn."""
    worn, travel, scale = travel_integrals(loads, speeds, times, pieces, exponent)
    return scale * (worn / travel) ** (1 / exponent) if travel > 0 else None
