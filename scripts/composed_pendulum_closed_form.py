"""The composed pendulum of Stroe and Staicu (2010), section 5, in closed form."""
import math

import numpy as np

GRAVITY = 9.81  # m/s^2, along x0
L1, L2 = 0.50, 0.75  # m
M1, M2 = 0.25, 1.0  # kg
AMPLITUDES = (math.pi / 12, math.pi / 6)  # rad

# Name, unit and title of each result, in the order of closed_form().
COLUMNS = (
    ('m10_z', 'N m', 'Active torque of the first rod'),
    ('m21_z', 'N m', 'Active torque of the second rod'),
    ('f10_x', 'N', 'Vertical joint force of the first rod'),
    ('f10_y', 'N', 'Horizontal joint force of the first rod'),
    ('f21_x', 'N', 'Vertical joint force of the second rod'),
    ('f21_y', 'N', 'Horizontal joint force of the second rod'),
)


def motion(t):
    """The angles by (5.11) and their first two derivatives, arrays of 2 x len(t)."""
    rate = math.pi / 6
    amplitudes = np.array(AMPLITUDES)[:, np.newaxis]
    return (amplitudes * (1 - np.cos(rate * t)),
            amplitudes * rate * np.sin(rate * t),
            amplitudes * rate ** 2 * np.cos(rate * t))


def closed_form(t):
    """The six results at the times t (s) by (5.7), (5.8) and similar equations, one row each."""
    (q1, q2), (v1, v2), (a1, a2) = motion(t)
    q, v, a = q1 + q2, v1 + v2, a1 + a2  # motion of the second rod in the fixed frame

    m10_z = ((M1 / 3 + M2) * L1 ** 2 * a1 + M2 * L2 ** 2 / 3 * a
             + M2 * L1 * L2 / 2 * ((2 * a1 + a2) * np.cos(q2) - v2 * (2 * v1 + v2) * np.sin(q2))
             + (M1 / 2 + M2) * GRAVITY * L1 * np.sin(q1) + M2 * GRAVITY * L2 / 2 * np.sin(q))
    m21_z = (M2 * L2 ** 2 / 3 * a
             + M2 * L1 * L2 / 2 * (a1 * np.cos(q2) + v1 ** 2 * np.sin(q2))
             + M2 * GRAVITY * L2 / 2 * np.sin(q))

    # Forces are mass times acceleration of the centres of mass, less gravity.
    along_1, across_1 = a1 * np.sin(q1) + v1 ** 2 * np.cos(q1), a1 * np.cos(q1) - v1 ** 2 * np.sin(q1)
    along_2, across_2 = a * np.sin(q) + v ** 2 * np.cos(q), a * np.cos(q) - v ** 2 * np.sin(q)
    f21_x = -M2 * (GRAVITY + L1 * along_1 + L2 / 2 * along_2)
    f21_y = M2 * (L1 * across_1 + L2 / 2 * across_2)
    f10_x = f21_x - M1 * (GRAVITY + L1 / 2 * along_1)
    f10_y = f21_y + M1 * L1 / 2 * across_1
    return np.array([m10_z, m21_z, f10_x, f10_y, f21_x, f21_y])
