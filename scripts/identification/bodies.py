"""Inertial parameters of a body: mass, first moments and moments of inertia about its link's origin.

A body that can be has a pseudo-inertia that is positive definite,

    J = [[S, h], [h^T, m]],  S = tr(I)/2 1 - I,

with its second moments S. Written as J = L L^T, with the logarithms of the diagonal of L as coordinates,
every step of a search is such a body.
"""
import numpy as np
from scipy import linalg

KINDS = ('mass', 'first_moment_x', 'first_moment_y', 'first_moment_z', 'inertia_xx', 'inertia_xy',
         'inertia_xz', 'inertia_yy', 'inertia_yz', 'inertia_zz')
LOWER = [(i, j) for i in range(4) for j in range(i + 1)]


def inertia_matrix(parameters):
    xx, xy, xz, yy, yz, zz = parameters[4:]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def pseudo_inertia(parameters):
    inertia = inertia_matrix(parameters)
    result = np.empty((4, 4))
    result[:3, :3] = np.trace(inertia) / 2 * np.eye(3) - inertia
    result[:3, 3] = result[3, :3] = parameters[1:4]
    result[3, 3] = parameters[0]
    return result


def parameters_of(pseudo):
    second = pseudo[:3, :3]
    inertia = np.trace(second) * np.eye(3) - second
    return np.concatenate([[pseudo[3, 3]], pseudo[:3, 3],
                           inertia[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]])


# d J / d parameter, of each of the ten.
BASIS = np.array([pseudo_inertia(unit) for unit in np.eye(10)])


def is_possible(parameters):
    """Whether a body can have them, up to rounding."""
    eigenvalues = linalg.eigvalsh(pseudo_inertia(parameters))
    return bool(eigenvalues[0] >= -1e-9 * max(eigenvalues[-1], 1e-300))


def body(mass, centre, moments):
    """Parameters of a mass at a centre with these second moments about it along the axes of the link."""
    centre = np.asarray(centre, dtype=float)
    pseudo = np.empty((4, 4))
    pseudo[:3, :3] = mass * np.outer(centre, centre) + np.diag(np.broadcast_to(moments, 3))
    pseudo[:3, 3] = pseudo[3, :3] = mass * centre
    pseudo[3, 3] = mass
    return parameters_of(pseudo)


def nearest_possible(parameters, size, least_mass):
    """A body that can be, close to parameters that may belong to none: at least `least_mass`, and as
    large as a ball of a tenth of `size`."""
    mass = max(parameters[0], least_mass)
    centre = parameters[1:4] / mass if parameters[0] >= least_mass else np.zeros(3)
    about = pseudo_inertia(parameters)[:3, :3] - parameters[0] * np.outer(centre, centre)
    if parameters[0] < least_mass:
        about = np.zeros((3, 3))
    values, vectors = linalg.eigh(about)
    values = np.maximum(values, mass * (0.02 * size) ** 2)
    pseudo = np.empty((4, 4))
    pseudo[:3, :3] = vectors @ np.diag(values) @ vectors.T + mass * np.outer(centre, centre)
    pseudo[:3, 3] = pseudo[3, :3] = mass * centre
    pseudo[3, 3] = mass
    return parameters_of(pseudo)


def to_coordinates(parameters):
    """The ten numbers of log-Cholesky: logarithms on the diagonal of L."""
    factor = linalg.cholesky(pseudo_inertia(parameters), lower=True)
    return np.array([np.log(factor[i, j]) if i == j else factor[i, j] for i, j in LOWER])


def from_coordinates(coordinates):
    """The parameters, and their derivatives by the coordinates."""
    factor = np.zeros((4, 4))
    for value, (i, j) in zip(coordinates, LOWER):
        factor[i, j] = np.exp(value) if i == j else value
    jacobian = np.empty((10, 10))
    for k, (i, j) in enumerate(LOWER):
        change = np.zeros((4, 4))
        change[i, j] = factor[i, j] if i == j else 1
        half = change @ factor.T
        jacobian[:, k] = parameters_of(half + half.T)
    return parameters_of(factor @ factor.T), jacobian


def metric(parameters):
    """The quadratic form in which a change of the parameters counts relative to the body itself: the sum
    of squares of L^-1 dJ L^-T. It does not depend on axes, origin or units."""
    inverse = linalg.inv(linalg.cholesky(pseudo_inertia(parameters), lower=True))
    rows = np.array([(inverse @ basis @ inverse.T).ravel() for basis in BASIS])
    return rows @ rows.T


def described(parameters):
    """Mass, centre of mass and inertia about it, of parameters with a mass."""
    mass = parameters[0]
    centre = parameters[1:4] / mass
    inertia = inertia_matrix(parameters) - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    return mass, centre, inertia


def described_jacobian(parameters):
    """Derivatives of mass, centre and the six moments about the centre by the parameters."""
    mass, centre = parameters[0], parameters[1:4] / parameters[0]
    jacobian = np.zeros((10, 10))
    jacobian[0, 0] = 1
    jacobian[1:4, 0] = -centre / mass
    jacobian[1:4, 1:4] = np.eye(3) / mass
    jacobian[4:, 4:] = np.eye(6)
    # I_C = I - (h.h 1 - h h^T) / m
    pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
    for row, (i, j) in enumerate(pairs):
        same = 1 if i == j else 0
        jacobian[4 + row, 0] = same * (centre @ centre) - centre[i] * centre[j]
        for k in range(3):
            product = (1 if k == i else 0) * centre[j] + (1 if k == j else 0) * centre[i]
            jacobian[4 + row, 1 + k] = -(2 * same * centre[k] - product)
    return jacobian
