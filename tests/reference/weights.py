"""Weights Phi_j (g, n) of the fluid for points, by each method; a row is NaN where the method has none."""

from dataclasses import dataclass

import numpy as np

from .kernels import Array, Gaussian


@dataclass
class Around:
    """The fluid around points r: ``offset`` x_j - r (g, n, dim); a ``normal`` and a ``lift`` x_G - r of each point."""

    kernel: Gaussian
    offset: Array
    volumes: Array
    normal: Array
    lift: Array
    condition: float = 1.0
    """the largest of the matrices of weights that are not limited"""

    def __post_init__(self) -> None:
        self.r = np.linalg.norm(self.offset, axis=2)
        self.inside = self.r < self.kernel.support
        self.values = self.kernel.value(self.r)
        self.parts = self.values * self.volumes
        self.slopes = self.kernel.gradient(self.offset) * self.volumes[None, :, None]
        self.enough = self.inside.sum(axis=1) > self.offset.shape[2]


def usable(phi: Array, around: Around) -> tuple[Array, Array]:
    """Return the weights, the kernel average where there are none, and where there are."""
    fine = np.isfinite(phi).all(axis=1) & around.inside.any(axis=1)
    return np.where(fine[:, None], phi, normalised(around)), fine


def shared(weights: Array) -> Array:
    """Divide each row by its sum; a row of zeros remains."""
    total = weights.sum(axis=1, keepdims=True)
    return weights / np.where(total > 0.0, total, 1.0)


def limited(phi: Array, most: float) -> Array:
    """Let there be none where sum |Phi_j| is above ``most``."""
    return np.where(np.abs(phi).sum(axis=1, keepdims=True) <= most, phi, np.nan)


def improved_shepard(around: Around) -> Array:
    """phi^4 / sum phi^4 with phi = exp[-s^2 / (1 - s^2)] / s, s = r/R, by logarithms."""
    s = np.where(around.inside, around.r / around.kernel.support, 0.5)
    powers = np.where(around.inside, 4.0 * (-(s**2) / (1.0 - s**2) - np.log(s)), -np.inf)
    highest = np.where(around.inside.any(axis=1), powers.max(axis=1, initial=-np.inf), 0.0)
    return shared(np.exp(powers - highest[:, None]))


def shepard(around: Around) -> Array:
    """r^-2 / sum r^-2."""
    return shared(np.where(around.inside, 1.0 / np.where(around.inside, around.r, 1.0) ** 2, 0.0))


def normalised(around: Around) -> Array:
    """W V / sum W V."""
    return shared(around.parts)


def least_squares(around: Around, basis: Array) -> Array:
    """e_1 M^-1 b_j W_j V_j, M = sum b_j b_j W_j V_j, by the factors Q R of sqrt(W_j V_j) b_j.

    There are none where the other terms of the basis reproduce the constant but for 1 % of its square, 1/(M^-1)_11.
    """
    phi, terms = np.full(around.r.shape, np.nan), basis.shape[2]
    for k in np.flatnonzero(around.inside.sum(axis=1) >= terms):
        root = np.sqrt(around.parts[k])
        q, r = np.linalg.qr(root[:, None] * basis[k])
        if np.linalg.cond(r) < 1e6:
            first = np.linalg.solve(r.T, np.eye(terms)[0])
            phi[k] = root * (q @ first) if 0.01 * (first @ first) * (root @ root) < 1.0 else np.nan
    return limited(phi, 3.0)


def linear(around: Around) -> Array:
    """1, x, y, z over h."""
    scaled = around.offset / around.kernel.h
    return np.concatenate([np.ones((*around.r.shape, 1)), scaled], axis=2)


def linear_least_squares(around: Around) -> Array:
    """The linear fit."""
    return least_squares(around, linear(around))


def quadratic_least_squares(around: Around) -> Array:
    """The fit with all products of two coordinates."""
    one, (first, second) = linear(around), np.triu_indices(around.offset.shape[2])
    return least_squares(around, np.concatenate([one, one[..., 1 + first] * one[..., 1 + second]], axis=2))


def sfdi(around: Around) -> Array:
    """W_j / sum W - B_j, and with the sum of all B for the nearest i; B_j = W_ji r_ji / r_ji^2 . N^-1 R_0."""
    phi = shared(around.values)
    for k in range(len(phi)):
        x = around.offset[k] - around.offset[k, (i := around.r[k].argmin())]
        r2 = np.sum(x**2, axis=1)
        slope = (around.inside[k] * around.kernel.value(np.sqrt(r2)) / np.where(r2 > 0.0, r2, 1.0))[:, None] * x
        if not around.enough[k] or np.linalg.cond(slope.T @ x) > 1e12:
            phi[k] = np.nan
            continue
        b = slope @ np.linalg.solve(slope.T @ x, phi[k] @ around.offset[k])
        phi[k] -= b
        phi[k, i] += b.sum()
    return limited(phi, 3.0)


def extrapolated(around: Around) -> Array:
    """V_j (y_0 W_j + y.grad W_j), A^T [y_0, y] = [1, lift], A = sum V_j [W_j, grad W_j] [1, x_j - r]."""
    phi = np.full(around.r.shape, np.nan)
    rows = np.concatenate([around.parts[..., None], around.slopes], axis=2)
    columns = np.concatenate([np.ones((*around.r.shape, 1)), around.offset], axis=2)
    for k in np.flatnonzero(around.enough):
        matrix = rows[k].T @ columns[k]
        phi[k] = rows[k] @ np.linalg.solve(matrix.T, np.append(1.0, around.lift[k]))
    return limited(phi, 10.0)


def normal_derivative(around: Around) -> Array:
    """omega_j / sum omega, omega_j = V_j n.L grad W_j, L = [sum V_j (x_j - r) grad W_j]^-1."""
    phi = np.full(around.r.shape, np.nan)
    for k in np.flatnonzero(around.inside.sum(axis=1) >= around.offset.shape[2]):
        matrix = around.offset[k].T @ around.slopes[k]
        around.condition = max(around.condition, float(np.linalg.cond(matrix)))
        omega = around.slopes[k] @ np.linalg.solve(matrix, around.normal[k])
        phi[k] = omega / omega.sum()
    return phi
