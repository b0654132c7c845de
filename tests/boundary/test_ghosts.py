"""Ghosts: exact fields, slip conditions, wall acceleration and statuses, in the compiled loop of the solver."""

import numpy as np
import pytest

from sphframe.boundary.boundary import Boundary
from sphframe.boundary.filling import Filling
from sphframe.boundary.fixed_ghosts import FixedGhosts
from sphframe.equations_of_state.linear import Linear
from sphframe.geometry import BoxRegion, BoxWall, Polygon, PolygonWall, fill
from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint, Motion, RigidBody, Status, Traits, WallContext
from sphframe.interfaces.traits import TOO_FEW
from sphframe.kernels import compiled_kernel
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import LoopParameters
from sphframe.registry import create
from sphframe.simulation.components import loop_parts

METHODS = ["improved-shepard", "shepard", "normalized", "sfdi", "mls-linear", "mls-quadratic", "mdbc", "adami"]
LINEAR_EXACT = ["sfdi", "mls-linear", "mls-quadratic"]
IN_SPACE = ["improved-shepard", "mdbc"]
"""the default, and a method that extrapolates"""
DENSITY, GRAVITY, SPEED = 1000.0, 9.81, 50.0
SPACING = 0.1


class Still(RigidBody):
    """A body at its initial position that has a velocity and an acceleration."""

    def __init__(self, acceleration=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0)):
        self.acceleration, self.velocity = np.array(acceleration, float), np.array(velocity, float)

    def motion(self, time, position, velocity, load):
        return Motion(np.zeros(3), self.velocity, self.acceleration)


class Basin:
    """A box of fluid with every side walled but the top, particles jittered."""

    def __init__(
        self, method, dim=2, *, lift="balanced", slip="free", body=None, jitter=0.2, corrected=True, wall=None
    ):
        shape = RenormalisedGaussian()
        self.kernel = compiled_kernel(shape, dim)
        self.dim, self.h = dim, 1.3 * SPACING
        side = 1.2 if dim == 2 else 0.8
        region = BoxRegion(lower=(0.0,) * dim, upper=(side,) * dim)
        if wall is None:
            open_faces = ("+y" if dim == 2 else "+z",)
            wall = BoxWall(lower=region.lower, upper=region.upper, open_faces=open_faces, body=body and "body")
        else:
            region = Polygon(points=wall.points)
        interpolator = create("interpolators", method) if isinstance(method, str) else method
        self.boundary = Boundary(
            (wall,),
            {"body": body} if body else {},
            interpolator.traits.evaluation_point,
            fluid=[region],
            spacing=SPACING,
            support=self.kernel.support * self.h,
            no_slip=slip == "no",
        )
        parts = loop_parts(self.kernel, Linear(), dim)
        context = WallContext(
            self.kernel, dim, interpolator, no_slip=slip == "no", balanced_lift=lift == "balanced",
            corrected_velocity=corrected,
        )  # fmt: skip
        self.filling = Filling(interpolator, self.kernel, parts, FixedGhosts().parts(context))
        position = fill(region, SPACING).position.copy()
        position += np.random.default_rng(0).uniform(-jitter, jitter, position.shape) * SPACING
        self.n = len(position)
        c = self.columns = Columns.of(dim)
        self.rows = c.zeros(self.n + self.boundary.count)
        self.rows[: self.n, c.position] = position
        self.rows[: self.n, c.volume] = SPACING**dim
        self.rows[: self.n, c.density] = DENSITY
        force = np.zeros(dim)
        force[-1] = -DENSITY * GRAVITY
        motions = [Motion(*np.pad(body.motion(0.0, None, None, None), ((0, 0), (0, 3 * dim - 6))))] if body else []
        self.boundary.move(motions, self.rows[self.n :], force, DENSITY)
        self.lists = NeighbourLists(dim, self.n, self.boundary.count, self.kernel.support * self.h, 0.0)
        self.rows[: self.n] = self.rows[: self.n][self.lists.sort(self.rows)]
        self.lists.build(self.rows, self.boundary.points)

    def fill(self):
        parameters = LoopParameters.of(
            self.kernel, self.dim, smoothing_length=self.h, reference_density=DENSITY, sound_speed=SPEED
        )
        self.filling(self.rows, self.lists, self.boundary, parameters)
        ghosts, c = self.rows[self.n :], self.columns
        wet = self.boundary.statuses != Status.DRY
        return wet, ghosts[:, c.position], ghosts[:, c.velocity], ghosts[:, c.pressure], ghosts[:, c.density]


@pytest.mark.parametrize(
    ("method", "dim"),
    [
        *((method, 2) for method in METHODS),
        *((method, 3) for method in IN_SPACE),
        *(pytest.param(method, 3, marks=pytest.mark.long) for method in METHODS if method not in IN_SPACE),
    ],
)
def test_balanced_lift_is_exact_on_a_hydrostatic_field(method, dim):
    basin = Basin(method, dim)
    c = basin.columns
    fluid = basin.rows[: basin.n]
    fluid[:, c.pressure] = 5e4 - DENSITY * GRAVITY * fluid[:, dim - 1]
    wet, position, _, pressure, density = basin.fill()
    assert wet.any()
    expected = 5e4 - DENSITY * GRAVITY * position[:, -1]
    np.testing.assert_allclose(pressure[wet], expected[wet], rtol=1e-9)
    np.testing.assert_allclose(density[wet], DENSITY + pressure[wet] / SPEED**2, rtol=1e-13)


@pytest.mark.parametrize("method", LINEAR_EXACT)
def test_mirror_lift_is_exact_for_methods_that_reproduce_linear_fields(method):
    basin = Basin(method, lift="mirror")
    c = basin.columns
    fluid = basin.rows[: basin.n]
    fluid[:, c.pressure] = 5e4 - DENSITY * GRAVITY * fluid[:, 1]
    _, position, _, pressure, _ = basin.fill()
    ok = basin.boundary.statuses == Status.OK
    np.testing.assert_allclose(pressure[ok], 5e4 - DENSITY * GRAVITY * position[ok, 1], rtol=1e-9)


@pytest.mark.parametrize("lift", ["balanced", "mirror"])
def test_wall_acceleration_enters_the_pressure(lift):
    body = Still(acceleration=(3.0, 0.0, 0.0))
    basin = Basin("mls-linear", body=body, lift=lift)
    c = basin.columns
    fluid = basin.rows[: basin.n]
    fluid[:, c.pressure] = 5e4 - DENSITY * (GRAVITY * fluid[:, 1] + 3.0 * fluid[:, 0])
    _, position, _, pressure, _ = basin.fill()
    ok = basin.boundary.statuses == Status.OK
    expected = 5e4 - DENSITY * (GRAVITY * position[:, 1] + 3.0 * position[:, 0])
    np.testing.assert_allclose(pressure[ok], expected[ok], rtol=1e-9)


@pytest.mark.parametrize("method", [m for m in METHODS if m != "adami"])
@pytest.mark.parametrize("slip", ["free", "no"])
def test_velocities_beside_one_face(method, slip):
    """Normal velocity linear in the distance and, for no slip, the tangential one too, are continued exactly."""
    body = Still(velocity=(0.5, -0.25, 0.0))
    basin = Basin(method, slip=slip, body=body)
    c = basin.columns
    fluid = basin.rows[: basin.n]
    depth = fluid[:, 1]
    fluid[:, c.velocity] = [0.5, -0.25]
    fluid[:, c.velocity.start + 1] += 2.0 * depth
    fluid[:, c.velocity.start] += 3.0 * depth if slip == "no" else 3.0
    wet, position, velocity, _, _ = basin.fill()
    below = wet & (position[:, 1] < 0.0) & (np.abs(position[:, 0] - 0.6) < 0.15)
    np.testing.assert_allclose(velocity[below, 1], -0.25 + 2.0 * position[below, 1], rtol=1e-9, atol=1e-9)
    tangential = 0.5 + (3.0 * position[below, 1] if slip == "no" else 3.0)
    np.testing.assert_allclose(velocity[below, 0], tangential, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("method", ["improved-shepard", "normalized", "mls-linear"])
def test_velocities_in_an_acute_corner(method):
    """A velocity that grows linearly from the bed is continued below it, although the mirror points are moved."""
    basin = Basin(method, body=Still(), wall=PolygonWall(points=((1.2, 0), (0, 0), (1.2, 0.7)), body="body"))
    c = basin.columns
    fluid = basin.rows[: basin.n]
    fluid[:, c.velocity] = np.column_stack([np.full(basin.n, 3.0), 2.0 * fluid[:, 1]])
    wet, position, velocity, _, _ = basin.fill()
    moved = np.linalg.norm(position + basin.boundary.mirror - 2.0 * basin.boundary.foot, axis=1) > 1e-6
    below = wet & (position[:, 1] < 0.0) & (position[:, 0] > 0.0) & (position[:, 0] < 1.0)
    assert (below & moved).sum() > 2
    np.testing.assert_allclose(velocity[below, 1], 2.0 * position[below, 1], rtol=1e-9)
    np.testing.assert_allclose(velocity[below, 0], 3.0, rtol=1e-9)


@pytest.mark.parametrize(
    ("method", "dim"),
    [
        *((method, 2) for method in ("improved-shepard", "normalized", "mls-linear")),
        ("improved-shepard", 3),
        *(pytest.param(method, 3, marks=pytest.mark.long) for method in ("normalized", "mls-linear")),
    ],
)
@pytest.mark.parametrize("slip", ["free", "no"])
def test_with_the_mirror_lift_a_wall_under_uniform_pressure_does_no_work(method, slip, dim):
    """sum_j V_j (P grad W_jG).(u_j + u_G - 2 u_wall) = 0 of every ghost, with P on the reversed components."""
    basin = Basin(method, dim, lift="mirror", slip=slip, body=Still(velocity=(0.5, -0.25, 0.125)))
    c = basin.columns
    fluid = basin.rows[: basin.n]
    fluid[:, c.velocity] = np.random.default_rng(1).normal(size=(basin.n, dim))
    _, position, velocity, _, _ = basin.fill()
    offset = fluid[:, c.position] - position[:, None]  # in 2-D the wall also rotates
    q = np.linalg.norm(offset, axis=2) / basin.h
    slope = np.exp(-(q**2)) * (q < basin.kernel.support) * SPACING**dim
    reversed_part = 0.5 * (np.eye(dim) - basin.boundary.reflection)
    side = np.einsum("gj,gde,gje->gjd", slope, reversed_part, offset)
    power = (side * (fluid[:, c.velocity] + (velocity - 2.0 * basin.boundary.velocity)[:, None])).sum(axis=(1, 2))
    reached = slope.any(axis=1)
    assert reached.sum() > 0.5 * len(reached)
    np.testing.assert_allclose(power, 0.0, atol=1e-12 * np.abs(side).sum(axis=(1, 2)).max())


@pytest.mark.parametrize("method", ["improved-shepard", "normalized", "mls-linear"])
def test_with_the_mirror_lift_a_uniform_flow_is_mirrored(method):
    basin = Basin(method, lift="mirror")
    c = basin.columns
    basin.rows[: basin.n, c.velocity] = [3.0, -2.0]
    _, position, velocity, _, _ = basin.fill()
    below = (position[:, 1] < 0.0) & (np.abs(position[:, 0] - 0.6) < 0.15)
    np.testing.assert_allclose(velocity[below], np.broadcast_to([3.0, 2.0], velocity[below].shape), rtol=1e-9)


def test_negative_pressures_are_clipped_to_zero():
    basin = Basin("normalized")
    basin.rows[: basin.n, basin.columns.pressure] = -1e5
    _, _, _, pressure, _ = basin.fill()
    assert (pressure == 0.0).all()


def test_dry_ghosts_have_no_pressure_and_the_velocity_of_the_wall():
    basin = Basin("improved-shepard", body=Still(velocity=(0.5, 0.0, 0.0)))
    c = basin.columns
    basin.rows[: basin.n, c.position] += [0.0, 100.0]
    basin.rows[: basin.n] = basin.rows[: basin.n][basin.lists.sort(basin.rows)]
    basin.lists.build(basin.rows, basin.boundary.points)
    wet, _, velocity, pressure, density = basin.fill()
    assert not wet.any()
    np.testing.assert_array_equal(velocity, np.broadcast_to([0.5, 0.0], velocity.shape))
    assert (pressure == 0.0).all()
    assert (density == DENSITY).all()


class Refuses(BoundaryInterpolator):
    """Weights that want more points than there ever are, so that the fallback takes their place."""

    traits = Traits()

    def point_weights(self, kernel, dim):
        def weights(offsets, distances, kernel_values, volumes, support, lift, out):
            return TOO_FEW

        return weights


class RefusesWithoutKernel(Refuses):
    """The same weights, for which the loop computes no values of the kernel."""

    traits = Traits(kernel_independent=True)


def test_the_fallback_knows_the_kernel_though_the_method_needs_none():
    found = []
    for method in (Refuses(), RefusesWithoutKernel()):
        basin = Basin(method)
        basin.rows[: basin.n, basin.columns.pressure] = np.random.default_rng(1).uniform(1e3, 2e3, basin.n)
        found.append(basin.fill())
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)
    assert found[0][0].any()


@pytest.mark.parametrize("shift", [0.0, 0.4])
def test_a_paddle_takes_its_part_of_the_bed_below_it_wherever_it_is(shift):
    """The ghosts of the bed just behind the foot of the paddle belong to it, too, where its body has carried it."""
    walls = [
        PolygonWall(name="paddle", points=[(0.0, 0.6), (0.0, 0.0)], body="paddle", one_sided=True),
        PolygonWall(name="tank", points=[(-1.0, 0.0), (1.2, 0.0), (1.2, 0.6)]),
    ]
    water = BoxRegion(lower=(0.0, 0.0), upper=(1.2, 0.5))
    boundary = Boundary(
        walls, {"paddle": Still()}, EvaluationPoint.MIRROR, fluid=[water], spacing=SPACING, support=0.3, no_slip=False
    )
    place = Motion(np.array([shift, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    boundary.move([place], np.zeros((boundary.count, 9)), np.zeros(2), DENSITY)
    shares = boundary.corner_shares([place])
    below = (boundary.wall == 1) & (boundary.position[:, 1] < 0.0)
    near = below & (boundary.position[:, 0] < shift) & (boundary.position[:, 0] > shift - 0.3)
    assert near.sum() >= 6
    assert np.all(shares.wall[near] == 0)
    np.testing.assert_allclose(shares.normal[near], [[-1.0, 0.0]] * near.sum(), atol=1e-12)
    assert np.all(shares.wall[below & (boundary.position[:, 0] > shift) & (boundary.position[:, 0] < 1.1)] == -1)
