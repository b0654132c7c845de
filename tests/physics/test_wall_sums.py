"""Sums over wall particles as a treatment lets the fluid see them, compared with plain NumPy; reaction and action."""

import numpy as np
import pytest

from sphframe.boundary.corners import Shares
from sphframe.boundary.images import Images
from sphframe.compiled import specialise
from sphframe.interfaces import FluidSide, Seen, WallParts, WallSide
from sphframe.particles import Columns
from sphframe.physics import make_seen, make_surface, wall_reaction, wall_sums

from .cloud import make_cloud

VISCOSITY, FRICTION = 50.0, 30.0


def odd_seen(fluid, wall, separation, constants):
    """What a pair sees, with every argument in use."""
    across = separation.x * wall.nx + separation.y * wall.ny + separation.z * wall.nz
    lift = wall.bx * separation.x + wall.by * separation.y + wall.bz * separation.z
    pressure_sum = 2.0 * fluid.pressure - 0.5 * wall.pressure + lift + 1e3 * across / wall.distance
    ratio = wall.distance / max(abs(across), constants.smoothing_length)
    return Seen(
        pressure_sum,
        2.0 * wall.wall_u - fluid.u, wall.v + fluid.density * 1e-3, wall.w - wall.wall_w,
        wall.viscous_u - ratio * fluid.u, wall.viscous_v, wall.wall_v + wall.viscous_w,
    )  # fmt: skip


def odd_force(wall, separation, constants):
    """An acceleration with every argument in use."""
    size = max(constants.smoothing_length**2 - separation.r2, 0.0) * (1.0 + wall.distance)
    return size * separation.x + wall.nx * size, size * separation.y * wall.bx, size * separation.z - wall.wall_u * size


def slow(cloud, walls, parts, attracts):
    """Density rates and accelerations by the ghosts, (n,) and (n, dim)."""
    c, n, dim = Columns.of(cloud.dim), cloud.fluid_count, cloud.dim
    density_rate, acceleration = np.zeros(n), np.zeros((n, dim))
    for i in range(n):
        fluid = cloud.rows[i]
        for g in range(len(cloud.rows) - n):
            ghost = cloud.rows[n + g]
            x = ghost[c.position] - fluid[c.position]
            r2 = x @ x
            if r2 >= (cloud.kernel.support * cloud.h) ** 2:
                continue
            u_g, viscous = ghost[c.velocity], ghost[c.velocity]
            pressure_sum = fluid[c.pressure] + ghost[c.pressure]
            if parts.own_viscous_velocity:
                viscous = walls.viscous_velocity[g]
            if parts.seen is not None:
                found = called(odd_seen, cloud, walls, fluid, ghost, g, x)
                pressure_sum, u_g, viscous = found[0], np.array(found[1 : 1 + dim]), np.array(found[4 : 4 + dim])
            acts = attracts or min(fluid[c.pressure], pressure_sum) > 0.0
            if not acts:
                pressure_sum = 0.0
                u_g = fluid[c.velocity] if (u_g - fluid[c.velocity]) @ x > 0.0 else u_g
            if not (acts and parts.friction):
                viscous = fluid[c.velocity]
            grad = cloud.grad_kernel(x[None])[0] * ghost[c.volume]
            density_rate[i] -= fluid[c.density] * (u_g - fluid[c.velocity]) @ grad
            pi = (viscous - fluid[c.velocity]) @ x / r2
            acceleration[i] += (VISCOSITY * pi - pressure_sum) * grad / fluid[c.density]
    return density_rate, acceleration


def called(function, cloud, walls, fluid, ghost, g, x):
    """Call a function of a pair with plain tuples."""
    from sphframe.interfaces import FluidSide, Separation, WallSide

    c = Columns.of(cloud.dim)

    def three(vector):
        return (*vector, 0.0)[:3]

    wall = WallSide(
        ghost[c.pressure], *three(ghost[c.velocity]), *three(walls.viscous_velocity[g]), *three(walls.normal[g]),
        walls.distance[g], *three(walls.velocity[g]), *three(walls.force[g]),
    )  # fmt: skip
    side = FluidSide(fluid[c.pressure], fluid[c.density], *three(fluid[c.velocity]))
    return function(side, wall, Separation(*three(x), x @ x), cloud.parameters())


def rates_of(cloud, walls, parts, attracts, continuity):
    bound = {**cloud.parts(), "CONTINUITY": continuity, "FORCES": parts.force is not None}
    bound["SEEN"] = make_seen(parts, attracts=attracts)
    bound["FORCE"] = parts.force or odd_force
    rates = np.zeros((cloud.fluid_count, 2 * cloud.dim + 1))
    parameters = cloud.parameters(viscosity=VISCOSITY, friction=FRICTION)
    specialise(wall_sums, bound)(
        cloud.rows, cloud.lists, cloud.fluid_counts, cloud.ghost_counts, cloud.shares, walls, Images.of(0, cloud.dim),
        parameters, rates,
    )  # fmt: skip
    return rates


@pytest.mark.parametrize(
    ("dim", "parts", "attracts"),
    [
        (2, WallParts(seen=odd_seen), True),
        (3, WallParts(seen=odd_seen, friction=False), False),
        (2, WallParts(own_viscous_velocity=True), True),
    ],
    ids=["seen", "frictionless", "assigned"],
)
def test_sums_are_those_of_plain_numpy(dim, parts, attracts):
    cloud = make_cloud(dim, 4, cells=8 if dim == 2 else 4)
    walls = cloud.walls()
    density_rate, acceleration = slow(cloud, walls, parts, attracts)
    assert np.abs(acceleration).max() > 0.0
    found = rates_of(cloud, walls, parts, attracts, True)
    np.testing.assert_allclose(found[:, -1], density_rate, rtol=1e-9, atol=1e-9 * np.abs(density_rate).max())
    found = rates_of(cloud, walls, parts, attracts, False)[:, dim : 2 * dim]
    np.testing.assert_allclose(found, acceleration, rtol=1e-9, atol=1e-9 * np.abs(acceleration).max())


@pytest.mark.parametrize(
    ("dim", "parts"), [(2, WallParts(seen=odd_seen)), (3, WallParts(force=odd_force))], ids=["seen", "force"]
)
def test_walls_bear_minus_what_they_exert(dim, parts):
    cloud = make_cloud(dim, 5, cells=8 if dim == 2 else 4)
    cloud.morris = True
    walls, c = cloud.walls(), Columns.of(dim)
    acceleration = rates_of(cloud, walls, parts, True, False)[:, dim : 2 * dim]
    forces = cloud.rows[: cloud.fluid_count, c.mass, None] * acceleration
    ghosts = len(cloud.rows) - cloud.fluid_count
    nothing = np.zeros((ghosts, dim))
    partial = np.zeros((7, 2, 3 if dim == 2 else 6))
    bound = {**cloud.parts(), "AS_ASSIGNED": False, "FORCES": parts.force is not None}
    bound |= {"SEEN": make_seen(parts, attracts=True), "FORCE": parts.force or odd_force}
    specialise(wall_reaction, bound)(
        cloud.rows, cloud.fluid_count, cloud.lists, cloud.fluid_counts, cloud.ghost_counts, cloud.shares,
        (np.arange(ghosts) % 2).astype(np.int64), Shares(np.full(ghosts, -1), nothing, nothing), np.zeros((2, dim)),
        walls, Images.of(0, dim), cloud.parameters(viscosity=VISCOSITY, friction=FRICTION), partial,
    )  # fmt: skip
    loads = partial.sum(axis=0)
    np.testing.assert_allclose(loads[:, :dim].sum(axis=0), -forces.sum(axis=0), rtol=1e-10)
    if dim == 2:
        position = cloud.rows[: cloud.fluid_count, :2]
        moment = -np.sum(position[:, 0] * forces[:, 1] - position[:, 1] * forces[:, 0])
        np.testing.assert_allclose(loads[:, 2].sum(), moment, rtol=1e-10)


def test_an_edge_without_tension_pushes_but_does_not_pull():
    """With the normal (0, -1) a force upwards pushes. Where an edge would pull, or push fluid that is not under
    pressure itself, a gap may open without any rate."""

    def surface(fluid, wall, edge, constants):
        return 3.0, wall.pressure, fluid.density

    for attracts, pressure, push, opening, expected in (
        (True, -1.0, -2.0, 0.5, (3.0, -2.0, 0.5)),
        (False, 1.0, 2.0, 0.5, (3.0, 2.0, 0.5)),
        (False, 1.0, -2.0, 0.5, (0.0, 0.0, 0.0)),
        (False, 1.0, -2.0, -0.5, (0.0, 0.0, -0.5)),
        (False, -1.0, 2.0, 0.5, (0.0, 0.0, 0.0)),
    ):
        wall = WallSide(**{**dict.fromkeys(WallSide._fields, 0.0), "ny": -1.0, "pressure": push})
        fluid = FluidSide(pressure, opening, 0.0, 0.0, 0.0)
        assert make_surface(surface, attracts=attracts)(fluid, wall, None, None) == expected
