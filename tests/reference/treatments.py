"""What walls are to the fluid, by each treatment, as its documentation gives the equations."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from .edges import approach, edges, friction
from .kernels import Array
from .weights import (
    Around,
    extrapolated,
    improved_shepard,
    linear_least_squares,
    normal_derivative,
    normalised,
    quadratic_least_squares,
    sfdi,
    shepard,
    usable,
)

if TYPE_CHECKING:
    from .plain import Plain

METHODS: dict[str, Callable[[Around], Array]] = {
    "improved-shepard": improved_shepard,
    "shepard": shepard,
    "normalized": normalised,
    "mls-linear": linear_least_squares,
    "mls-quadratic": quadratic_least_squares,
    "sfdi": sfdi,
    "mdbc": extrapolated,
    "adami": normalised,
}


@dataclass
class Assigned:
    """Pressure (g,) and velocity (g, dim) of the ghosts, and the share with which they count.

    ``viscous``: another velocity for the viscosity; ``pairs``: pressure and velocities (n, g, ..) as each particle sees
    them; ``force``: accelerations (n, g, dim) that take the place of all sums; ``rate`` of the walls' densities. Images
    of the fluid have a ``position`` and a ``volume`` of their own, and are seen only by the fluid. Edges: forces per
    volume (n, g, dim) and divergences (n, g) of the ``surface``, and ``gamma`` (n,), by which all sums are divided.
    ``points`` (g, dim): to which the fluid was interpolated.
    """

    pressure: Array
    velocity: Array
    share: Array | float = 1.0
    viscous: Array | None = None
    pairs: tuple[Array, Array, Array] | None = None
    force: Array | None = None
    rate: Array | None = None
    position: Array | None = None
    volume: Array | None = None
    surface: tuple[Array, Array] | None = None
    gamma: Array | None = None
    points: Array | None = None


def lifted(s: "Plain", phi: Array, around: Around) -> Array:
    """sum Phi_j [p_j + b.(x_G - x_j)]."""
    higher = np.einsum("gk,gjk->gj", s.walls.b, around.lift[:, None] - around.offset)
    return np.einsum("gj,gj->g", phi, s.p + higher)


def fixed_ghosts(s: "Plain") -> Assigned:
    """Pressure and reflected velocity by the interpolator of the case."""
    walls, case, name = s.walls, s.case, s.case.interpolator.name
    no_slip, balanced = case.slip == "no", case.hydrostatic_lift == "balanced" or name == "adami"
    corrected = case.ghost_velocity == "corrected" and name not in ("adami", "mdbc")
    points = walls.ghost if name == "adami" else walls.mirror
    around = s.around(points)
    phi, fine = usable(METHODS[name](around), around)
    wet = around.inside.any(axis=1)
    rise = wet * np.einsum("gk,gk->g", walls.b, around.lift)
    pressure = lifted(s, phi, around) if balanced else phi @ s.p + rise
    if name == "mdbc":
        pressure = np.where(fine, phi @ s.p, pressure)
        around.lift = np.zeros_like(around.lift)
        phi = np.where(fine[:, None], usable(extrapolated(around), around)[0], phi)
    scale = np.ones(len(wet))
    if balanced and corrected:
        height = np.einsum("gk,gk->g", walls.foot - walls.mirror, walls.normal)
        height = np.maximum(height, 0.1 * walls.depth)
        distances = height[:, None] - np.einsum("gjk,gk->gj", around.offset, walls.normal)
        scale = np.where(wet, walls.depth / np.maximum(np.einsum("gj,gj->g", phi, distances), 0.5 * height), 1.0)
    relative = np.where(wet[:, None], phi @ s.u - walls.u, 0.0)
    half, viscous = 0.5 * (1.0 - scale)[:, None], None
    reflection = np.tile(-np.eye(s.dim), (len(wet), 1, 1)) if no_slip else walls.reflection
    if no_slip and case.wall_treatment.options.get("continuity") == "free-slip":
        reflection, viscous = walls.reflection, walls.u - scale[:, None] * relative
    velocity = walls.u + half * relative + (1.0 - half) * np.einsum("gkl,gl->gk", reflection, relative)
    if not balanced and corrected:
        velocity -= work(s, velocity, reflection)
    return Assigned(pressure, velocity, viscous=viscous, points=points)


def work(s: "Plain", velocity: Array, reflection: Array) -> Array:
    """The change of reversed velocities with which the ghosts do no work in a uniform pressure."""
    slope = s.kernel.gradient(s.walls.nearest(s.x[None] - s.walls.ghost[:, None])) * s.v[None, :, None]
    across = 0.5 * (slope - np.einsum("gkl,gjl->gjk", reflection, slope))
    a = across.sum(axis=1)
    motion = s.u[None] + velocity[:, None] - 2.0 * s.walls.u[:, None]
    square = np.sum(a**2, axis=1)
    works = np.sqrt(square) > 0.1 * np.linalg.norm(slope, axis=2).sum(axis=1)
    b = np.einsum("gjk,gjk->g", across, motion)
    return np.where(works, b / np.where(works, square, 1.0), 0.0)[:, None] * a


def adami_2012(s: "Plain") -> Assigned:
    """The kernel average at the ghost; the velocity of the wall, in the viscosity 2 u_w - u."""
    around = s.around(s.walls.ghost)
    phi = normalised(around)
    viscous = 2.0 * s.walls.u - phi @ s.u
    return Assigned(lifted(s, phi, around), s.walls.u, viscous=viscous, points=s.walls.ghost)


def fitted(s: "Plain", points: Array, method: Callable[[Around], Array]) -> Assigned:
    """Pressure by a method at points, lifted where it has no weights; the velocity of the wall."""
    around = s.around(points)
    phi, fine = usable(method(around), around)
    return Assigned(np.where(fine, phi @ s.p, lifted(s, phi, around)), s.walls.u, points=points)


def mdbc_2022(s: "Plain") -> Assigned:
    """Pressure extrapolated from the mirror point; the velocity of the wall."""
    return fitted(s, s.walls.mirror, extrapolated)


def mdbc_2025(s: "Plain") -> Assigned:
    """First-order pressure at the mirror point, lifted along n; the wall's velocity, in the viscosity 2 u_w - u."""
    walls, around = s.walls, s.around(s.walls.mirror)
    rise = np.einsum("gk,gk->g", walls.b, walls.normal) * np.einsum("gk,gk->g", around.lift, walls.normal)
    around.lift = np.zeros_like(around.lift)
    phi, _ = usable(extrapolated(around), around)
    wet = around.inside.any(axis=1)
    at_mirror = (phi if s.case.wall_treatment.options.get("velocity") == "corrected" else normalised(around)) @ s.u
    along = 2.0 * walls.u - at_mirror if s.case.slip == "no" else at_mirror
    viscous = along + np.einsum("gk,gk->g", walls.u - along, walls.normal)[:, None] * walls.normal
    return Assigned(np.where(wet, phi @ s.p + rise, 0.0), walls.u, wet.astype(float), viscous, points=walls.mirror)


def band_2018(s: "Plain") -> Assigned:
    """The linear fit at the ghost; the velocity of the wall."""
    return fitted(s, s.walls.ghost, linear_least_squares)


def hashemi_2012(s: "Plain") -> Assigned:
    """p_G = sum Phi_j p_j - (b.n) sum Phi_j (x_j - x_G).n; the velocity of the wall."""
    walls, around = s.walls, s.around(s.walls.ghost)
    phi, _ = usable(normal_derivative(around), around)
    s.condition = max(s.condition, around.condition)
    across = np.einsum("gj,gjk,gk->g", phi, around.offset, walls.normal)
    pressure = phi @ s.p - np.einsum("gk,gk->g", walls.b, walls.normal) * across
    return Assigned(pressure, walls.u, points=walls.ghost)


def pairwise(s: "Plain", pressure: Array, velocity: Array, viscous: Array) -> Assigned:
    """Ghosts of pressure 0 that each particle sees as it is given."""
    return Assigned(np.zeros(len(s.walls.u)), s.walls.u, pairs=(pressure, velocity, viscous))


def akinci_2012(s: "Plain") -> Assigned:
    """p_G = p_i, u_G = u_w."""
    velocity = np.broadcast_to(s.walls.u, s.x_gi.shape)
    return pairwise(s, np.broadcast_to(s.p[:, None], s.x_gi.shape[:2]), velocity, velocity)


def higher(s: "Plain") -> Array:
    """p_i + b.(x_G - x_i)."""
    return s.p[:, None] + np.einsum("igk,gk->ig", s.x_gi, s.walls.b)


def pair_mirror(s: "Plain") -> Assigned:
    """p_G = p_i + b.(x_G - x_i), u_G = 2 u_w - u_i."""
    velocity = 2.0 * s.walls.u - s.u[:, None]
    return pairwise(s, higher(s), velocity, velocity)


def riemann_2017(s: "Plain") -> Assigned:
    """The same with a dissipation rho0 c0 U min(3 U / c0, 1), U = 2 (u_i - u_w).n > 0."""
    velocity = 2.0 * s.walls.u - s.u[:, None]
    jump = np.maximum(2.0 * np.einsum("igk,gk->ig", s.u[:, None] - s.walls.u, s.walls.normal), 0.0)
    return pairwise(s, higher(s) + s.rho0 * s.c0 * jump * np.minimum(3.0 * jump / s.c0, 1.0), velocity, velocity)


def distance_ratio(s: "Plain") -> Assigned:
    """Fixed ghosts; in the viscosity u_w - d_G / d_i (u_i - u_w)."""
    found, options = fixed_ghosts(s), s.case.wall_treatment.options
    before = np.einsum("igk,gk->ig", s.x_gi, s.walls.normal) - s.walls.depth
    ratio = s.walls.depth / np.maximum(before, 0.25 * s.case.particle_spacing)
    ratio = np.minimum(ratio, options.get("cap") or np.inf)[:, :, None]
    viscous = s.walls.u - ratio * (s.u[:, None] - s.walls.u)
    velocity = viscous if options.get("continuity") == "ratio" else np.broadcast_to(found.velocity, viscous.shape)
    pressure = np.broadcast_to(s.bounded(found.pressure), viscous.shape[:2])
    return Assigned(found.pressure, found.velocity, pairs=(pressure, velocity, viscous), points=found.points)


def repelled(s: "Plain", size: Any) -> Assigned:
    """Accelerations ``size`` (x_i - x_G) / r^2."""
    force = -size[:, :, None] * s.x_gi / np.sum(s.x_gi**2, axis=2, keepdims=True)
    return Assigned(np.zeros(len(s.walls.u)), s.walls.u, share=0.0, force=force)


def lennard_jones(s: "Plain") -> Assigned:
    """D [(r0/r)^4 - (r0/r)^2], r < r0."""
    ratio = s.case.particle_spacing / np.linalg.norm(s.x_gi, axis=2)
    return repelled(s, np.where(ratio > 1.0, s.strength(5.0) * (ratio**4 - ratio**2), 0.0))


def monaghan_kajtar_2009(s: "Plain") -> Assigned:
    """K/3^(d-1) 1.77/32 (1 + 5q/2 + 2 q^2) (2 - q)^5, q < 2."""
    q = np.linalg.norm(s.x_gi, axis=2) / s.kernel.h
    psi = 1.77 / 32.0 * (1.0 + 2.5 * q + 2.0 * q**2) * np.maximum(2.0 - q, 0.0) ** 5
    return repelled(s, s.strength(1.0) / 3.0 ** (s.dim - 1) * psi)


def dynamic_2007(s: "Plain") -> Assigned:
    """drho_G/dt = -rho_G sum (u_j - u_w).grad W V_j + delta h c0 sum psi.grad W V_j, and does not fall below rho0."""
    walls, around, density = s.walls, s.around(s.walls.ghost), np.maximum(s.wall_density, s.rho0)
    closing = np.einsum("gjk,gjk->g", s.u[None] - walls.u[:, None], around.slopes)
    excess = s.rho - s.wall_density[:, None] - np.einsum("gk,gjk->gj", walls.b, around.offset) / s.c0**2
    psi = 2.0 * (excess / around.r**2)[:, :, None] * around.offset
    delta = s.case.wall_treatment.options.get("diffusion", 0.0)
    rate = -s.wall_density * closing + delta * s.kernel.h * s.c0 * np.einsum("gjk,gjk->g", psi, around.slopes)
    rate = np.where(s.wall_density > s.rho0, rate, np.maximum(rate, 0.0))
    return Assigned(s.c0**2 * (density - s.rho0), walls.u, s.rho0 / density, rate=rate)


def mirror_images(s: "Plain") -> Assigned:
    """Images of all particles in the faces of a box, also of images in its edges and corners."""
    walls, box = s.walls, s.walls.box
    assert box is not None
    images = []
    for sides in product(*([None, *faces] for faces in box)):
        axes = np.array([side is not None for side in sides])
        if axes.any():
            at = np.array([0.0 if side is None else side for side in sides])
            drawn = walls.in_frame(s.x)
            images.append(walls.out_of_frame(np.where(axes, 2.0 * at - drawn, drawn), np.where(axes, at, drawn), axes))
    x, u_w, b, reflection = (np.concatenate(part) for part in zip(*images, strict=True))
    copies = len(images)
    relative = np.tile(s.u, (copies, 1)) - u_w
    mirrored = -relative if s.case.slip == "no" else np.einsum("gkl,gl->gk", reflection, relative)
    pressure = np.tile(s.p, copies) + np.einsum("gk,gk->g", b, x - np.tile(s.x, (copies, 1)))
    return Assigned(pressure, u_w + mirrored, position=x, volume=np.tile(s.v, copies))


def edge_integrals(s: "Plain") -> Assigned:
    """2 p_i grad gamma_e - A_e b, grad gamma_e = -w0_e n, A_e = c_e 1 + (z_e w0_e n + w1_e t) (x) n."""
    e, normal, b = edges(s), s.walls.normal, s.walls.b
    across = (e.z * e.weight)[:, :, None] * normal + e.moment[:, :, None] * e.tangent
    lift = e.solid[:, :, None] * b + across * np.einsum("gk,gk->g", b, normal)[:, None]
    force = -2.0 * (s.p[:, None] * e.weight)[:, :, None] * normal - lift + friction(s, e)
    return Assigned(np.zeros(len(b)), s.walls.u, share=0.0, surface=(force, 2.0 * approach(s) * e.weight))


def usaw_2013(s: "Plain") -> Assigned:
    """(p_i + p_s) grad gamma_s, and all sums divided by gamma_i = 1 - sum c_s."""
    e, around = edges(s), s.around(s.walls.ghost)
    pressure = lifted(s, normalised(around), around)
    push = (s.p[:, None] + s.bounded(pressure)) * e.weight
    force = -push[:, :, None] * s.walls.normal + friction(s, e)
    gamma = np.maximum(1.0 - e.solid.sum(axis=1), 0.05)
    surface = force, approach(s) * e.weight
    return Assigned(pressure, s.walls.u, share=0.0, surface=surface, gamma=gamma)


TREATMENTS: dict[str, Callable[["Plain"], Assigned]] = {
    "fixed-ghosts": fixed_ghosts,
    "adami-2012": adami_2012,
    "mdbc-2022": mdbc_2022,
    "mdbc-2025": mdbc_2025,
    "band-2018": band_2018,
    "hashemi-2012": hashemi_2012,
    "akinci-2012": akinci_2012,
    "pair-mirror": pair_mirror,
    "riemann-2017": riemann_2017,
    "distance-ratio": distance_ratio,
    "dynamic-2007": dynamic_2007,
    "mirror-images": mirror_images,
    "lennard-jones": lennard_jones,
    "monaghan-kajtar-2009": monaghan_kajtar_2009,
    "edge-integrals": edge_integrals,
    "usaw-2013": usaw_2013,
}
IN_THE_PLANE = ("edge-integrals", "usaw-2013")
"""treatments that exist in two dimensions alone"""
RUBS_WITHOUT_FRICTION = ("fixed-ghosts", "mirror-images", "mdbc-2025", "dynamic-2007")
"""treatments whose walls have a viscosity with free slip, too"""
