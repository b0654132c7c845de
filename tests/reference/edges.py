"""Integrals of the kernel over the edges of walls in the plane, by quadrature, and the treatments that use them."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .kernels import NORMALISATION, Array, Gaussian
from .walls import cross

if TYPE_CHECKING:
    from .plain import Plain

NODES, WEIGHTS = np.polynomial.legendre.leggauss(120)


class Edges(NamedTuple):
    """As each particle sees each edge, (n, g): distance ``z`` before its line, and the integrals over it.

    ``solid``: of the kernel over what lies behind the edge; ``weight``, ``moment``: int W ds and int W s ds, along the
    ``tangent`` (g, dim).
    """

    tangent: Array
    z: Array
    solid: Array
    weight: Array
    moment: Array


def beyond(kernel: Gaussian, r: Array) -> Array:
    """The integral of W r dr from ``r`` to the end of the support."""
    r, end, floor = np.minimum(r, kernel.support), kernel.support, np.exp(-9.0)
    gaussian = 0.5 * kernel.h**2 * (np.exp(-((r / kernel.h) ** 2)) - floor)
    return NORMALISATION[2] / kernel.h**2 * (gaussian - 0.5 * floor * (end**2 - r**2))


def edges(s: "Plain") -> Edges:
    """The integrals over the part of each edge within the support, with s = z sinh t in the one over the solid."""
    kernel, normal, half = s.kernel, s.walls.normal, 0.5 * s.walls.drawn.volume / s.case.particle_spacing
    tangent = cross(np.ones(1), normal)
    z = np.einsum("igk,gk->ig", s.x_gi, normal)
    middle = np.einsum("igk,gk->ig", s.x_gi, tangent)
    reach = np.sqrt(np.maximum(kernel.support**2 - z**2, 0.0))
    start, end = np.clip(middle - half, -reach, reach), np.clip(middle + half, -reach, reach)

    def quadrature(begin: Array, stop: Array) -> tuple[Array, Array]:
        scale = 0.5 * (stop - begin)
        return 0.5 * (begin + stop)[..., None] + scale[..., None] * NODES, scale[..., None] * WEIGHTS

    along, ds = quadrature(start, end)
    part = kernel.value(np.hypot(z[..., None], along)) * ds
    size = np.abs(z)
    t, dt = quadrature(np.arcsinh(start / size), np.arcsinh(end / size))
    solid = np.sign(z) * np.sum(beyond(kernel, size[..., None] * np.cosh(t)) / np.cosh(t) * dt, axis=2)
    return Edges(tangent, z, solid, part.sum(axis=2), np.sum(part * along, axis=2))


def friction(s: "Plain", e: Edges) -> Array:
    """2 mu |grad gamma_e| (u_w - u_i)_t / z_e with no slip, (n, g, dim), z_e at least a tenth of a spacing."""
    mu = s.case.artificial_viscosity * s.kernel.h * s.c0 * s.rho0 / 8.0 + s.rho0 * s.case.kinematic_viscosity
    relative = s.walls.u - s.u[:, None]
    along = relative - np.einsum("igk,gk->ig", relative, s.walls.normal)[:, :, None] * s.walls.normal
    size = 2.0 * mu * (s.case.slip == "no") * e.weight / np.maximum(e.z, 0.1 * s.case.particle_spacing)
    return size[:, :, None] * along


def approach(s: "Plain") -> Array:
    """(u_w - u_i).n, (n, g)."""
    return np.einsum("igk,gk->ig", s.walls.u - s.u[:, None], s.walls.normal)
