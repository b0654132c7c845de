"""Boundary: the ghosts of all walls at the present time."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from sphframe.arrays import Array, BoolArray
from sphframe.boundary.corners import Corners, Shares
from sphframe.boundary.images import Images
from sphframe.boundary.movement import move_ghosts
from sphframe.boundary.sides import WallSides
from sphframe.boundary.solid_contact import SolidContacts
from sphframe.boundary.wall_arrays import WallArrays
from sphframe.geometry import Shape, Wall, ghosts_of, rotation_matrix, row_of, sides_of, wall_groups, within
from sphframe.interfaces import EvaluationPoint, Motion, RigidBody, Status
from sphframe.neighbours import Sight
from sphframe.particles import Periods

_STATE = (
    "position", "mirror", "foot", "normal", "reflection", "velocity", "acceleration", "driving", "statuses",
    "wall_state",
)  # fmt: skip


class Boundary:
    """Fixed ghost particles of ``walls``, carried by ``bodies``; ``fluid`` at the start tells which sides are wet.

    They are in layers that fill the ``support``, or ``row_spacing`` (m) apart on the walls; ghosts that no fluid
    before the walls can reach are left out, unless ghosts ``fade``, to whose filling they belong.

    Attributes
    ----------
    position, mirror
        (g, dim) ghosts and mirror points at present, m.
    foot
        (g, dim) the wall's point next to each ghost, m; ``normal`` (g, dim) unit vector from there to the ghost.
    depth
        (g,) of each ghost behind its foot, m; ``height`` (g,) of its evaluation point above the wall, at least a
        tenth of it, m.
    points
        (g, dim) where the method evaluates the fluid; ``lifts`` (g, dim) from there to the ghosts.
    reflection
        (g, dim, dim) maps the fluid's velocity relative to the wall to that of the ghost.
    velocity, acceleration
        (g, dim) of the wall at each ghost, zero (dim,) without bodies; ``driving`` (g, dim): rho0 (f - a_wall), N/m^3.
    volume
        (g,) of each ghost, m^dim.
    groups
        the walls of each body, ``group_body`` its index, -1 at rest.
    wall
        (g,) index of each ghost's wall; ``body`` (g,) index of its body, -1 at rest.
    wall_body
        (walls,) index of each wall's body, -1 at rest; ``centres`` (bodies, dim) as drawn, m.
    statuses
        (g,) :class:`Status` of the last filling.
    wall_state
        (g,) what the treatment advances; ``full`` (g,) filling of the evaluation point within the fluid.
    arrays
        what compiled loops read of the ghosts; ``images`` of the fluid, for treatments with images.
    solid_contacts
        puts particles back on walls of triangles.
    sides
        the sides of walls, where a wall is thin; else None.
    periods
        in which the ghosts repeat themselves.
    """

    _force: Array | None = None
    """the driving force with which the ghosts were last moved"""

    def __init__(
        self,
        walls: Sequence[Wall],
        bodies: Mapping[str, RigidBody],
        evaluation_point: EvaluationPoint,
        *,
        fluid: Sequence[Shape],
        spacing: float,
        support: float,
        no_slip: bool,
        fade: bool = False,
        row_spacing: float | None = None,
        periods: Periods | None = None,
    ) -> None:
        groups = wall_groups(tuple(walls), fluid, spacing, periods)
        self.groups = [group for _, group in groups]
        layers = math.ceil(support / spacing - 1e-9)
        sides = sides_of(self.groups, spacing, layers)
        if row_spacing is None:
            drawn = ghosts_of(self.groups, spacing, layers)
            if not fade:
                drawn, sides = within(support, drawn, sides)
        else:
            drawn = row_of(self.groups, row_spacing, spacing)
        self.dim = drawn.position.shape[1]
        self.periods = Periods.none(self.dim) if periods is None else periods
        self.bodies = dict(bodies)
        names = list(self.bodies)
        self._drawn, self.wall, self.volume = drawn, drawn.wall, drawn.volume
        self.group_body = np.array([-1 if body is None else names.index(body) for body, _ in groups], np.int64)
        self.wall_body = np.array([-1 if wall.body is None else names.index(wall.body) for wall in walls], np.int64)
        self.body = self.wall_body[drawn.wall]
        self.centres = np.zeros((len(names), self.dim))
        for k, body in enumerate(self.bodies.values()):
            self.centres[k, : len(body.centre)] = body.centre
        scales = spacing, layers * spacing
        self.sides = None if sides is None else WallSides(sides[0], self.group_body[sides[1]], self.centres, *scales)
        self.solid_contacts = SolidContacts(self.groups, self.group_body, self.centres, self.periods)
        self._corners = Corners(self.groups, drawn, self.body, self.wall_body, self.centres, 1.5 * support)
        self._drawn_reflection = np.tile(-np.eye(self.dim), (len(self.wall), 1, 1)) if no_slip else drawn.reflection
        own: Callable[[Array], Array] = np.copy if self.bodies else np.asarray
        self.position, self.mirror, self.foot = own(drawn.position), own(drawn.mirror), own(drawn.foot)
        self.normal, self.reflection = own(drawn.normal), own(self._drawn_reflection)
        self._evaluation_point = evaluation_point
        self.points = self.position if evaluation_point.at_ghost else self.mirror
        self.lifts = self.position - self.points
        self.depth = np.einsum("gi,gi->g", self.position - self.foot, self.normal)
        height = np.einsum("gi,gi->g", self.foot - self.points, self.normal)
        self.height = np.maximum(height, 0.1 * self.depth)
        self.velocity, self.driving = np.zeros((2, *self.position.shape))
        self.acceleration = np.zeros_like(self.position) if self.bodies else np.zeros(self.dim)
        for k, wall in enumerate(walls):
            self.velocity[self.wall == k] = wall.surface_velocity or (0.0,) * self.dim
        self.statuses = np.full(self.count, int(Status.DRY), np.int64)
        self.wall_state, self.full = np.zeros(self.count), np.ones(self.count)
        self.images = Images.of(0, self.dim)
        self.arrays = WallArrays(
            self.normal, self.depth, self.height, self.reflection, self.velocity, self.driving, self.volume, self.full,
            np.zeros_like(self.position), self.wall_state, self.position, self.wall,
        )  # fmt: skip

    @property
    def count(self) -> int:
        """Number of ghosts."""
        return len(self.wall)

    @property
    def lift_of_weights(self) -> Array | None:
        """The argument ``lift`` of the weights (g, dim): the lift or the normal; None where they take none."""
        if not self._evaluation_point.takes_lift:
            return None
        return self.normal if self._evaluation_point.at_ghost else self.lifts

    @property
    def sight(self) -> Sight | None:
        """What hides particles and ghosts; None where no wall is thin."""
        return None if self.sides is None else self.sides.sight

    @property
    def passable(self) -> BoolArray:
        """Whether each ghost (g,) lies beyond the end of a thin wall; one entry where no wall is thin."""
        return np.zeros(1, dtype=np.bool_) if self.sides is None else self.sides.passable

    @property
    def speed(self) -> float:
        """Largest speed with which a ghost moves, m/s."""
        moving = self.velocity[self.body >= 0] if self.bodies else self.velocity[:0]
        return float(np.sqrt(np.square(moving).sum(axis=1).max(initial=0.0)))

    def move(
        self,
        motions: Sequence[Motion],
        rows: Array,
        driving_force: Array,
        density: float,
        gradient: Array | None = None,
    ) -> bool:
        """Put ghosts (their ``rows``) and mirror points where ``motions`` carries them; set the driving forces.

        ``driving_force`` (dim,) is rho0 f at the origin, N/m^3, and ``gradient`` (dim, dim) that of f, 1/s^2, None for
        a uniform force; ``density`` is rho0. Ghosts at rest are left as they are if it is the same array as before.
        Returns whether anything has changed.
        """
        if not len(motions) and self._force is driving_force:
            return False
        self._force = driving_force
        if len(motions):
            position = np.array([motion.position for motion in motions])
            rotations = np.array([rotation_matrix(turned[3:]) for turned in position if self.dim == 3])
            velocity = np.array([motion.velocity for motion in motions])
            acceleration = np.array([motion.acceleration for motion in motions])
            move_ghosts(
                self._drawn, self._drawn_reflection, self.body, self.centres,
                position, velocity, acceleration, rotations.reshape(-1, 3, 3),
                self.position, self.mirror, self.foot, self.normal, self.reflection, self.velocity, self.acceleration,
            )  # fmt: skip
            if self.sides is not None:
                self.sides.move(motions)
                self.sides.reflect(self.body, self.mirror, self.reflection)
            if self.points is not self.position:
                np.subtract(self.position, self.points, out=self.lifts)
        np.multiply(self.acceleration, -density, out=self.driving)
        self.driving += driving_force
        if gradient is not None:
            self.driving += density * self.foot @ gradient.T
        rows[:, : self.dim] = self.position
        if self.periods:  # no pressure grows along a direction that repeats itself
            self.driving[:, self.periods.repeats] = 0.0
            rows[:, : self.dim] = self.periods.wrapped(self.position)
        return True

    def references(self, motions: Sequence[Motion]) -> Array:
        """Return the points (walls, dim) to which moments refer: the centre of the wall's body, or the origin, m."""
        centres = np.zeros((len(self.wall_body), self.dim))
        for wall, body in enumerate(self.wall_body):
            if body >= 0:
                centres[wall] = self.centres[body] + motions[body].position[: self.dim]
        return centres

    def corner_shares(self, motions: Sequence[Motion]) -> Shares:
        """Return the second walls that take part of the forces on ghosts."""
        shares = self._corners.shares(self.position, motions)
        return shares if self.sides is None else self.sides.share(shares, self.normal)

    def state(self) -> dict[str, Array]:
        """Return copies of all arrays that change during a run, by name."""
        state = {name: getattr(self, name).copy() for name in _STATE}
        return state if self.sides is None else {**state, "sides": self.sides.sight.ends.copy()}

    def restore(self, state: Mapping[str, Array]) -> None:
        """Continue from what :meth:`state` returned."""
        for name in _STATE:
            getattr(self, name)[:] = state[name]
        if self.sides is not None:
            self.sides.sight.ends[:] = state["sides"]
        np.subtract(self.position, self.points, out=self.lifts)
