from types import SimpleNamespace

import numpy as np
import pytest
from sphframe_edge_integrals import EdgeIntegrals

from sphframe import Edge, FluidSide, InputError, WallContext, WallSide, create
from sphframe.cases.custom import Custom
from sphframe.kernels import compiled_kernel
from sphframe.simulation.simulation import Simulation
from sphframe.testing import parametrize_with_checks, wall_residuals
from sphframe.testing.wall_integrals import wall_integrals

H, DX = 0.13, 0.1
CONSTANTS = SimpleNamespace(smoothing_length=H, spacing=DX, viscosity=4.0, friction=1.0)
TRIANGLE = np.array([[0.0, 0.0], [2.0, 0.3], [0.4, 1.5]])


@parametrize_with_checks([EdgeIntegrals()])
def test_has_its_traits(treatment, check):
    check(treatment)


def sums(point, fluid, force=(0.0, 0.0), wall_velocity=(0.0, 0.0), *, no_slip=False):
    """Sum over the pieces of a triangular vessel around ``point``."""
    context = WallContext(compiled_kernel(create("kernels", "wendland-c2"), 2), 2, None, no_slip=no_slip)
    integrals = context.kernel.edge_integrals
    surface = EdgeIntegrals().parts(context).surface
    total = np.zeros(3)
    for a, b in zip(TRIANGLE, np.roll(TRIANGLE, -1, axis=0), strict=True):
        count = int(np.ceil(np.hypot(*(b - a)) / DX))
        piece = (b - a) / count
        length = np.hypot(*piece)
        normal = np.array([piece[1], -piece[0]]) / length
        for k in range(count):
            x, y = a + (k + 0.5) * piece - point
            z, s = x * normal[0] + y * normal[1], y * normal[0] - x * normal[1]
            start, end = s - 0.5 * length, s + 0.5 * length
            c, w0, w1 = context.kernel.normalisation * np.array(integrals(z / H, start / H, end / H))
            wall = WallSide(
                **{**dict.fromkeys(WallSide._fields, 0.0), "nx": normal[0], "ny": normal[1], "bx": force[0],
                   "by": force[1], "wall_u": wall_velocity[0], "wall_v": wall_velocity[1]}
            )  # fmt: skip
            total += surface(fluid, wall, Edge(z, start, end, c, w0 / H, w1), CONSTANTS)
    return total


@pytest.mark.parametrize("point", [(0.15, 0.1), (1.9, 0.3), (0.6, 0.13), (0.5, 1.3)])
def test_the_sum_over_the_pieces_is_the_integral_over_the_solid(point):
    gamma, gradient, moment = wall_integrals(
        create("kernels", "wendland-c2"), H, np.array([point]), TRIANGLE, np.roll(TRIANGLE, -1, axis=0)
    )
    assert gamma[0] < 1.0
    p, b, u, u_wall = 700.0, np.array([300.0, -9810.0]), np.array([0.3, -0.2]), np.array([0.1, 0.4])
    found = sums(point, FluidSide(p, 1000.0, *u, 0.0), b, u_wall)
    assert found[:2] == pytest.approx(2.0 * p * gradient[0] - moment[0] @ b, rel=1e-11)
    assert found[2] == pytest.approx(-2.0 * (u_wall - u) @ gradient[0], rel=1e-11)


def test_the_force_of_the_filled_solid_is_its_integral():
    # -int over the solid of (p_i + p) grad_i W dx' by brute force, with p = p_i + b.(x' - x_i)
    n, point, p, b = 3000, np.array([0.6, 0.13]), 700.0, np.array([300.0, -9810.0])
    x = point[0] - 2 * H + 4 * H * (np.arange(n) + 0.5) / n
    y = point[1] - 2 * H + 4 * H * (np.arange(n) + 0.5) / n
    x, y = np.meshgrid(x, y)
    edges = zip(TRIANGLE, np.roll(TRIANGLE, -1, axis=0), strict=True)
    solid = np.zeros(x.shape, bool)
    for start, end in edges:
        solid |= (end[0] - start[0]) * (y - start[1]) - (end[1] - start[1]) * (x - start[0]) < 0.0
    dx, dy = x - point[0], y - point[1]
    q = np.hypot(dx, dy) / H
    slope = np.where(q < 2.0, -5.0 * (1.0 - q / 2.0) ** 3, 0.0) * 7.0 / (4.0 * np.pi * H**4)
    pressure = np.where(solid, (2.0 * p + b[0] * dx + b[1] * dy) * slope, 0.0) * (4 * H / n) ** 2
    expected = np.array([(pressure * dx).sum(), (pressure * dy).sum()])  # grad_i W = -slope (x' - x_i)
    assert sums(point, FluidSide(p, 1000.0, 0.0, 0.0, 0.0), b)[:2] == pytest.approx(expected, rel=2e-3)


def test_friction_acts_along_the_wall_alone():
    at_rest, moving = FluidSide(0.0, 1000.0, 0.0, 0.0, 0.0), FluidSide(0.0, 1000.0, 0.2, 0.03, 0.0)  # along the base
    point = np.array([1.0, 0.15 + 0.05])
    assert sums(point, moving)[:2] == pytest.approx(np.zeros(2), abs=1e-12)
    along = sums(point, moving, no_slip=True)[:2] - sums(point, at_rest, no_slip=True)[:2]
    direction = np.array([2.0, 0.3]) / np.hypot(2.0, 0.3)
    gradient = wall_integrals(
        create("kernels", "wendland-c2"), H, point[None], TRIANGLE, np.roll(TRIANGLE, -1, axis=0)
    ).gradient[0]
    z = 0.05 * direction[0]
    assert along == pytest.approx(-2.0 * np.hypot(*gradient) * np.hypot(0.2, 0.03) / z * direction, rel=1e-9)


def test_errors_at_a_straight_wall():
    assert wall_residuals(EdgeIntegrals()).uniform == pytest.approx((-0.0139, 0.0107), abs=2e-4)
    assert wall_residuals(EdgeIntegrals(), "wendland-c2", 2.0).uniform == pytest.approx((-0.0087, 0.0042), abs=2e-4)


def test_there_is_no_treatment_of_edges_in_three_dimensions():
    box = {"shape": "box", "lower": (0.0, 0.0, 0.0), "upper": (1.0, 1.0, 1.0)}
    with pytest.raises(InputError, match="2 dimensions, but the case has 3"):
        Simulation(
            Custom(dimension=3, particle_spacing=0.1, walls=[box], fluid=[box], wall_treatment="edge-integrals",
                   until=1.0, frame_interval=1.0, probe_interval=1.0)
        )  # fmt: skip
