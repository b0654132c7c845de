"""Boundary: the ghosts of all walls at the present time, and how they are filled from the fluid."""

from collections.abc import Mapping, Sequence

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.boundary.conjugate import make_conjugate
from sphframe.boundary.corners import Corners
from sphframe.boundary.ghosts import fill_ghosts
from sphframe.boundary.movement import move_ghosts
from sphframe.compiled import compile_part, specialise
from sphframe.geometry import BoxWall, PolygonWall, wall_ghosts
from sphframe.interfaces import (
    BoundaryInterpolator,
    CompiledKernel,
    EquationOfState,
    EvaluationPoint,
    Motion,
    RigidBody,
    Status,
)
from sphframe.neighbours import NeighbourLists

__all__ = ["Boundary"]

Array = NDArray[np.float64]

_STATE = (
    "position", "mirror", "reflection", "velocity", "acceleration", "driving", "statuses",
    "_remembered", "_remembered_points",
)  # fmt: skip


class Boundary:
    """Fixed ghost particles of ``walls``, carried by ``bodies``.

    Attributes
    ----------
    position, mirror: (g, dim) ghosts and mirror points at present, m.
    points: (g, dim) where the method evaluates the fluid; ``lifts`` (g, dim) from there to the ghosts.
    wall: (g,) index of each ghost's wall; ``body`` (g,) index of its body, -1 at rest.
    statuses: (g,) :class:`Status` of the last filling.
    displacement: the furthest that a ghost or an evaluation point has moved since :meth:`remember`, m.
    """

    def __init__(
        self,
        walls: Sequence[PolygonWall | BoxWall],
        bodies: Mapping[str, RigidBody],
        interpolator: BoundaryInterpolator,
        kernel: CompiledKernel,
        equation_of_state: EquationOfState,
        *,
        spacing: float,
        support: float,
        no_slip: bool,
        balanced: bool,
        corrected: bool,
    ) -> None:
        drawn = wall_ghosts(tuple(walls), spacing, int(np.ceil(support / spacing - 1e-9)))
        self.dim = drawn.position.shape[1]
        self.wall = drawn.wall
        self.bodies = dict(bodies)
        names = list(self.bodies)
        wall_body = np.array([-1 if wall.body is None else names.index(wall.body) for wall in walls], np.int64)
        self.wall_body = wall_body
        self.body = wall_body[drawn.wall]
        self.centres = np.zeros((len(names), self.dim))
        for k, body in enumerate(self.bodies.values()):
            self.centres[k, : len(body.centre)] = body.centre
        self._corners = Corners(walls, wall_body, self.centres, 1.5 * support)
        self.drawn = drawn
        self.reflection_drawn = np.tile(-np.eye(self.dim), (len(drawn.wall), 1, 1)) if no_slip else drawn.reflection
        self.position = drawn.position.copy()
        self.mirror = drawn.mirror.copy()
        self.reflection = self.reflection_drawn.copy()
        at_ghost = interpolator.traits.evaluation_point is EvaluationPoint.GHOST
        self.points = self.position if at_ghost else self.mirror
        self.lifts = self.position - self.points
        self.velocity = np.zeros_like(self.position)
        self.acceleration = np.zeros_like(self.position)
        self.driving = np.zeros_like(self.position)
        self.statuses = np.full(len(self.wall), int(Status.DRY), np.int64)
        self.displacement = 0.0
        self._remembered = self.position.copy()
        self._remembered_points = self.points.copy()
        self._fill = specialise(
            fill_ghosts,
            {
                "DIM": self.dim,
                "SUPPORT": kernel.support,
                "BALANCED": balanced or at_ghost,
                "SCALED": balanced and corrected,
                "EXTRAPOLATED": interpolator.traits.evaluation_point is EvaluationPoint.EXTRAPOLATED,
                "VALUE": kernel.value,
                "WEIGHTS": interpolator.point_weights(kernel, self.dim),
                "FALLBACK": interpolator.fallback_weights(kernel, self.dim),
                "DENSITY": compile_part(equation_of_state.density_function()),
            },
        )
        self._make_conjugate = None
        if corrected and not balanced and interpolator.traits.evaluation_point is EvaluationPoint.MIRROR:
            parts = {"DIM": self.dim, "SUPPORT": kernel.support, "GRADIENT": kernel.gradient_of_square}
            self._make_conjugate = specialise(make_conjugate, parts)
        self._scratch_for(8)

    @property
    def count(self) -> int:
        """Number of ghosts."""
        return len(self.wall)

    def _scratch_for(self, capacity: int) -> None:
        chunks = 8 * int(numba.config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]
        self._offsets = np.zeros((chunks, capacity, self.dim))
        self._columns = np.zeros((chunks, 4, capacity))
        self._members = np.zeros((chunks, capacity), np.uint32)
        self._lift = np.zeros((chunks, self.dim))

    def move(self, motions: Sequence[Motion], rows: Array, driving_force: Array, density: float) -> None:
        """Put ghosts (their ``rows``) and mirror points where ``motions`` carries them; set the driving forces.

        ``driving_force`` (dim,) is rho0 f, N/m^3; ``density`` is rho0.
        """
        if len(motions):
            position = np.array([motion.position for motion in motions])
            velocity = np.array([motion.velocity for motion in motions])
            acceleration = np.array([motion.acceleration for motion in motions])
            moved = move_ghosts(
                self.drawn.position, self.drawn.mirror, self.reflection_drawn, self.body, self.centres,
                position, velocity, acceleration, self._remembered, self.points, self._remembered_points,
                self.position, self.mirror, self.reflection, self.velocity, self.acceleration,
            )  # fmt: skip
            self.displacement = float(moved)
            if self.points is not self.position:
                np.subtract(self.position, self.points, out=self.lifts)
        np.multiply(self.acceleration, -density, out=self.driving)
        self.driving += driving_force
        rows[:, : self.dim] = self.position

    @property
    def speed(self) -> float:
        """Largest speed of a wall, m/s."""
        return float(np.sqrt(np.square(self.velocity).sum(axis=1).max(initial=0.0))) if self.bodies else 0.0

    def corner_shares(self, motions: Sequence[Motion]) -> tuple[NDArray[np.int64], Array]:
        """Other wall (g,) that answers for part of each ghost's force, or -1, and its normal (g, dim)."""
        return self._corners.shares(self.position, self.wall, motions)

    def remember(self) -> None:
        """Measure :attr:`displacement` from here on."""
        self._remembered[:] = self.position
        self._remembered_points[:] = self.points
        self.displacement = 0.0

    @property
    def remembered(self) -> tuple[Array, Array]:
        """Ghosts and evaluation points (g, dim) at the last :meth:`remember`, m."""
        return self._remembered, self._remembered_points

    def state(self) -> dict[str, Array]:
        """Return copies of all arrays that change during a run, by name."""
        return {name: getattr(self, name).copy() for name in _STATE} | {"displacement": np.array(self.displacement)}

    def restore(self, state: Mapping[str, Array]) -> None:
        """Continue from what :meth:`state` returned."""
        for name in _STATE:
            getattr(self, name)[:] = state[name]
        np.subtract(self.position, self.points, out=self.lifts)
        self.displacement = float(state["displacement"])

    def fill(
        self,
        rows: Array,
        lists: NeighbourLists,
        *,
        kernel_scale: float,
        reference_density: float,
        sound_speed: float,
    ) -> None:
        """Interpolate the fluid to the evaluation points and assign the ghosts' velocity, pressure and density."""
        if lists.points.shape[1] > self._members.shape[1]:
            self._scratch_for(lists.points.shape[1])
        self._fill(
            rows, lists.fluid_count, lists.points, lists.point_counts, self.points, self.lifts, self.reflection,
            self.velocity, self.driving, lists.support, kernel_scale, reference_density, sound_speed,
            self._offsets, self._columns, self._members, self._lift, self.statuses,
        )  # fmt: skip
        if self._make_conjugate:
            self._make_conjugate(
                rows, lists.fluid_count, lists.points, lists.point_counts, self.reflection, self.velocity, lists.support
            )
