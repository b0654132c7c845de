"""The corrected series against an independent solution of the same boundary value problem."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from sphframe.cases.dam_break_series import WaterColumn

RHO0, GRAVITY = 1000.0, 9.81


def column(height: float, length: float, **options: int) -> WaterColumn:
    return WaterColumn(height, length, RHO0, GRAVITY, 20.0 * float(np.sqrt(GRAVITY * height)), **options)


def finite_differences(height: float, length: float, sound_speed: float, cells: int) -> tuple[np.ndarray, ...]:
    """Solve laplace p = 0, p_x = 0 at x = 0, p_y = -(rho0 + p/c0^2) g at y = 0, p = 0 at x = L and y = H.

    Five-point differences on nodes, second order; ghost nodes at the two Neumann sides.
    """
    step = height / cells
    nx, ny = round(length / step), cells
    number = np.arange(nx * ny).reshape(nx, ny)  # the nodes of the sides x = L and y = H are known to be zero
    rows, columns, values = [], [], []
    right_side = np.zeros(nx * ny)

    def add(row: int, column: int, value: float) -> None:
        rows.append(row)
        columns.append(column)
        values.append(value)

    for i in range(nx):
        for j in range(ny):
            row = number[i, j]
            add(row, row, -4.0)
            for k, m in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
                if k == nx or m == ny:
                    continue
                if k == -1:
                    add(row, number[1, j], 1.0)
                elif m == -1:  # p_-1 = p_1 + 2 step (rho0 + p_0/c0^2) g
                    add(row, number[i, 1], 1.0)
                    add(row, row, 2.0 * step * GRAVITY / sound_speed**2)
                    right_side[row] -= 2.0 * step * RHO0 * GRAVITY
                else:
                    add(row, number[k, m], 1.0)
    matrix = coo_array((values, (rows, columns))).tocsr()
    x, y = np.meshgrid(np.arange(nx) * step, np.arange(ny) * step, indexing="ij")
    return x, y, spsolve(matrix, right_side).reshape(nx, ny)


@pytest.mark.parametrize(("height", "length"), [(0.6, 1.2), (0.6, 0.6), pytest.param(0.3, 1.2, marks=pytest.mark.long)])
def test_series_solves_the_laplace_equation(height: float, length: float) -> None:
    given = column(height, length)
    x, y, pressure = finite_differences(height, length, given.sound_speed, cells=150)
    difference = given.pressure(x, y) - pressure
    largest = np.abs(difference).max() / (RHO0 * GRAVITY * height)
    assert largest < 1e-3, f"largest difference over all nodes is {largest:.2e} of rho g H"
    # what differs is the finite differences beside the corner (L, 0), where the condition at the side jumps: it halves
    # with the step
    x, y, pressure = finite_differences(height, length, given.sound_speed, cells=75)
    coarse = np.abs(given.pressure(x, y) - pressure).max() / (RHO0 * GRAVITY * height)
    assert coarse / largest == pytest.approx(2.0, rel=0.05)


def test_density_is_that_of_the_linear_equation_of_state() -> None:
    x, y = np.meshgrid(np.linspace(0.0, 1.2, 25), np.linspace(0.0, 0.6, 13))
    given = column(0.6, 1.2)
    density = given.density(x, y)
    assert given.pressure(x, y) == pytest.approx(given.sound_speed**2 * (density - RHO0))


@pytest.mark.parametrize(
    ("x", "y", "expected"), [(0.0, 0.0, 0.93213), (0.0, 0.3, 0.45155), (0.6, 0.0, 0.8254)], ids=str
)
def test_reference_values(x: float, y: float, expected: float) -> None:
    pressure = column(0.6, 1.2).pressure(np.array([x]), np.array([y]))
    assert pressure[0] / (RHO0 * GRAVITY * 0.6) == pytest.approx(expected, abs=2e-5)


def test_force_on_the_left_wall() -> None:
    y = np.linspace(0.0, 0.6, 2001)
    pressure = column(0.6, 1.2).pressure(np.zeros_like(y), y)
    assert np.trapezoid(pressure, y) / (0.5 * RHO0 * GRAVITY * 0.6**2) == pytest.approx(0.913, abs=5e-4)


def test_many_terms_do_not_overflow() -> None:
    pressure = column(0.6, 1.2, terms=5000).pressure(np.array([0.1]), np.array([0.0]))
    assert np.all(np.isfinite(pressure))


def test_truncation_error_is_as_stated() -> None:
    x, y = np.meshgrid(np.linspace(0.0, 1.2, 25), np.linspace(0.0, 0.6, 13))
    by_default = column(0.6, 1.2).pressure(x, y)
    converged = column(0.6, 1.2, terms=8192).pressure(x, y)
    assert np.abs(by_default - converged).max() / (RHO0 * GRAVITY * 0.6) < 2e-5


def test_free_sides_have_no_pressure() -> None:
    s = np.linspace(0.0, 1.0, 21)
    given = column(0.6, 1.2)
    top = given.pressure(1.2 * s, np.full(21, 0.6))
    right = given.pressure(np.full(21, 1.2), 0.6 * s)
    assert np.abs(top).max() < 1e-6
    assert np.abs(right).max() < 1e-6
