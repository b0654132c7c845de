"""Interfaces: how a wall acts on the fluid: what its particles are assigned, and what the fluid sees of them.

A treatment gives some of the functions of :class:`WallParts`; each is compiled into the loop where it belongs, and a
loop without it stays as it is. In all of them x_G is a wall particle behind the wall, n the wall's normal out of the
fluid, u_w and a_w velocity and acceleration of the wall's nearest point, and b = rho0 (f - a_w) the force per volume
that the pressure balances at the wall, dp/dn = b.n.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

from sphframe.arrays import Array
from sphframe.interfaces.boundary_interpolator import BoundaryInterpolator
from sphframe.interfaces.equation_of_state import StateFunction
from sphframe.interfaces.kernel import CompiledKernel
from sphframe.interfaces.order import NOTHING, Orders


class WallGeometry(StrEnum):
    """Where the particles of a wall are."""

    LAYERS = "layers"
    """in layers at (k + 1/2) dx behind the wall, which fill the support of the kernel"""
    ROW = "row"
    """in one row on the wall"""
    IMAGES = "images"
    """mirror images of the fluid particles; ``assign`` gives each what it makes of the one particle"""


class Interpolated(NamedTuple):
    """What the interpolation found for a wall particle at its evaluation point r, with the weights Phi_j.

    ``status`` of the method, see :class:`sphframe.Status`; ``neighbours``: their number, 0 where the point is dry;
    ``total``: sum_j Phi_j; ``pressure``: sum_j Phi_j p_j, Pa, at the ghost itself if ``extrapolated``; ``offset``
    (dim,): sum_j Phi_j (x_j - r), m; ``velocity`` (dim,): sum_j Phi_j u_j, m/s, with the weights of the method for
    velocities if there is one.
    """

    status: int
    neighbours: int
    total: float
    pressure: float
    extrapolated: bool
    offset: Array
    velocity: Array


class WallPoint(NamedTuple):
    """A wall particle as ``assign`` and ``rate`` see it.

    Attributes
    ----------
    normal
        (dim,) n.
    distance
        behind the wall, m.
    height
        of the evaluation point above the wall, m.
    lift
        (dim,) from the evaluation point to the particle, m.
    reflection
        (dim, dim) S, maps the fluid's velocity relative to the wall to that of the ghost; -1 for no slip, and for
        mirror images and treatments with ``own_viscous_velocity`` that of free slip in any case.
    velocity
        (dim,) u_w, m/s.
    force
        (dim,) b, N/m^3.
    state
        what ``rate`` advances, such as a density; 0 without it.
    position
        (dim,) of the particle at present, m.
    number
        of its wall among those of the case, from 0, in their order.
    """

    normal: Array
    distance: float
    height: float
    lift: Array
    reflection: Array
    velocity: Array
    force: Array
    state: float
    position: Array
    number: int


class Neighbours(NamedTuple):
    """The n fluid particles around a wall particle x_G, as ``rate`` sees them.

    ``offsets`` (n, dim): x_j - x_G, m; ``distances`` (n,), m; ``slopes`` (n,): W'(r)/r, m^-(dim+2), so that
    grad_G W_Gj = -slope offset; ``volumes``, ``pressures``, ``densities`` (n,); ``velocities`` (n, dim), m/s.
    """

    offsets: Array
    distances: Array
    slopes: Array
    volumes: Array
    pressures: Array
    densities: Array
    velocities: Array


class FluidSide(NamedTuple):
    """The fluid particle of a pair: p, rho and the velocity; ``w`` is 0 in 2-D."""

    pressure: float
    density: float
    u: float
    v: float
    w: float


class WallSide(NamedTuple):
    """The wall particle of a pair; last components of vectors are 0 in 2-D.

    ``pressure`` and velocities as assigned: ``u, v, w`` for the continuity, ``viscous_u ..`` for the viscosity;
    normal ``nx ..``; ``distance`` from the wall, m; ``wall_u ..``: u_w, m/s; ``bx ..``: b, N/m^3.
    """

    pressure: float
    u: float
    v: float
    w: float
    viscous_u: float
    viscous_v: float
    viscous_w: float
    nx: float
    ny: float
    nz: float
    distance: float
    wall_u: float
    wall_v: float
    wall_w: float
    bx: float
    by: float
    bz: float


class Separation(NamedTuple):
    """x_G - x_i of a pair, m, and its square r2, m^2; ``z`` is 0 in 2-D."""

    x: float
    y: float
    z: float
    r2: float


class Edge(NamedTuple):
    """An edge of a wall with the integrals of the kernel over it, as a fluid particle sees it, in two dimensions.

    ``z``: distance of the particle before the line of the edge, m, negative behind it; ``start``, ``end``: of the edge,
    m, along t = (-n_y, n_x) from the particle's foot; ``solid``: part of the kernel that the solid behind the edge
    takes; ``weight`` = int W ds, 1/m, so that the gradient of gamma = 1 - sum solid is -sum n weight; ``moment`` =
    int W s ds.
    """

    z: float
    start: float
    end: float
    solid: float
    weight: float
    moment: float


class Seen(NamedTuple):
    """What a fluid particle i sees of a wall particle G.

    ``pressure_sum``: p_i + p_G, Pa; velocity of G for the continuity (``u, v, w``) and for the viscosity.
    """

    pressure_sum: float
    u: float
    v: float
    w: float
    viscous_u: float
    viscous_v: float
    viscous_w: float


AssignFunction = Callable[[Interpolated, WallPoint, Any, Array, Array], tuple[float, float]]
SeenFunction = Callable[[FluidSide, WallSide, Separation, Any], Seen]
ForceFunction = Callable[[WallSide, Separation, Any], tuple[float, float, float]]
SurfaceFunction = Callable[[FluidSide, WallSide, Edge, Any], tuple[float, float, float]]
RateFunction = Callable[[Neighbours, WallPoint, Any], float]


@dataclass(frozen=True, kw_only=True)
class WallParts:
    """The functions of a treatment, all optional. They are compiled by sphframe, and must not allocate or raise.

    ``constants`` is a :class:`sphframe.physics.LoopParameters`: h, R, rho0, c0, spacing, depth and more.

    Attributes
    ----------
    assign
        ``assign(fluid, wall, constants, velocity, viscous_velocity) -> (pressure, share)``, once per wall particle
        and evaluation. It writes the velocities (dim,) for the continuity and for the viscosity, and returns p_G and
        the share of the volume with which the particle counts, 0 to 1. Without it, u_G = u_w and p_G = 0.
    seen
        ``seen(fluid, wall, separation, constants) -> Seen``, per pair of a fluid and a wall particle. The loop is
        vectorised: choices instead of branches, + - * /, min, max, abs, sqrt, divisions guarded by max(., tiny); it
        must be finite for any finite input. Without it, a pair sees what is assigned.
    force
        ``force(wall, separation, constants) -> (ax, ay, az)``, acceleration of a fluid particle per pair, m/s^2;
        0 beyond the cut-off. It takes the place of the sums over wall particles in continuity and momentum.
    surface
        ``surface(fluid, wall, edge, constants) -> (fx, fy, divergence)``, per fluid particle and edge, in two
        dimensions: force per volume, Pa/m, and part of the divergence of the velocity, 1/s. The edges are the pieces of
        a row on the wall. They take the place of the sums over wall particles.
    divides_by_gamma
        whether the sums over fluid and edges are divided by gamma.
    rate
        ``rate(neighbours, wall, constants) -> d(state)/dt``, once per wall particle and evaluation. The state is a
        density; it starts in hydrostatic equilibrium, is advanced by the integrator, and is part of checkpoints.
    uses_velocity
        whether ``assign`` uses the fluid's velocity. Without it, a method that extrapolates gives only the
        pressure, where it succeeds.
    own_viscous_velocity
        whether ``assign`` writes a velocity for the viscosity; else it is that for the continuity.
    friction
        whether the viscosity between fluid and wall particles acts; with free slip, most treatments leave it out.
    conjugate
        whether the velocities are then corrected as in :mod:`sphframe.boundary.conjugate`.
    """

    assign: AssignFunction | None = None
    seen: SeenFunction | None = None
    force: ForceFunction | None = None
    surface: SurfaceFunction | None = None
    divides_by_gamma: bool = False
    rate: RateFunction | None = None
    uses_velocity: bool = True
    own_viscous_velocity: bool = False
    friction: bool = True
    conjugate: bool = False


@dataclass(frozen=True)
class WallContext:
    """What a treatment can choose its functions by.

    Attributes
    ----------
    kernel, dim
        compiled kernel, and 2 or 3.
    interpolator, velocity_interpolator
        what the methods of these names of :class:`WallTreatment` returned.
    no_slip
        whether the case asks for no slip.
    balanced_lift, corrected_velocity
        the case's ``hydrostatic_lift`` and ``ghost_velocity``.
    pressure
        the case's equation of state, p(rho, rho0, c0), for the states that ``rate`` advances.
    """

    kernel: CompiledKernel
    dim: int
    interpolator: BoundaryInterpolator | None
    no_slip: bool = False
    balanced_lift: bool = True
    corrected_velocity: bool = True
    velocity_interpolator: BoundaryInterpolator | None = None
    pressure: StateFunction | None = None


@dataclass(frozen=True, kw_only=True)
class WallTraits:
    """What a treatment promises at a straight wall on a full lattice; each is tested.

    Attributes
    ----------
    exact_constant
        under uniform pressure, with the fluid's velocity that of the wall, forces and rates vanish.
    exact_hydrostatic
        in a hydrostatic field, acceleration f included, the force is that of the fluid's own lattice.
    exact_shear
        with no slip, the viscous force vanishes in a linear shear flow along the wall.
    exact_normal
        a velocity that grows linearly from the wall has the divergence of the fluid's own lattice.
    momentum
        fluid and walls together conserve momentum. False where sums are divided by gamma.
    conjugate
        without viscosity, diffusion and gravity a wall at rest does no work.
    dimensions
        numbers of dimensions in which it works.
    order
        orders of convergence near walls, also curved ones, with options of the case at their defaults.
    """

    exact_constant: bool = False
    exact_hydrostatic: bool = False
    exact_shear: bool = False
    exact_normal: bool = False
    momentum: bool = True
    conjugate: bool = False
    dimensions: tuple[int, ...] = (2, 3)
    order: Orders = NOTHING


class WallTreatment(ABC):
    """How walls act on the fluid. Options are the fields of a frozen dataclass.

    An author declares :attr:`traits` and returns compiled functions from :meth:`parts`::

        @dataclass(frozen=True)
        class Mirrored(WallTreatment):
            traits = WallTraits(exact_constant=True)

            def parts(self, context):
                def seen(fluid, wall, separation, constants):
                    u, v, w = wall.wall_u, wall.wall_v, wall.wall_w
                    return Seen(2.0 * fluid.pressure, u, v, w, u, v, w)
                return WallParts(seen=seen)
    """

    geometry: WallGeometry = WallGeometry.LAYERS
    """where the wall particles are"""
    row_spacing: float = 1.0
    """distance between the particles of a row, in particle spacings"""

    @property
    @abstractmethod
    def traits(self) -> WallTraits:
        """Properties that the treatment guarantees. A plain class attribute is sufficient."""

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator | None:
        """Return the method that interpolates to the wall particles: ``chosen`` by the case, another one, or none."""
        return None

    def velocity_interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator | None:
        """Return another method for velocities, at the same evaluation point; None: the same as for the pressure."""
        return None

    @abstractmethod
    def parts(self, context: WallContext) -> WallParts:
        """Return the functions of the treatment."""
