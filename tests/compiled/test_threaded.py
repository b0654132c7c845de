"""Loops without parts are compiled for the threads that they run on, and compute what NumPy computes."""

import importlib

import numba
import numpy as np
import pytest

from sphframe.compiled import threaded
from sphframe.neighbours import NeighbourLists
from sphframe.neighbours.approach import relative_displacement
from sphframe.neighbours.cells import grid_around, sort_by_cell
from sphframe.neighbours.motion import largest_motion
from sphframe.particles import Columns
from sphframe.simulation.row_checks import check_fluid
from sphframe.simulation.updates import add_columns, advance_state


def doubled(values):
    for i in numba.prange(values.shape[0]):
        values[i] *= 2.0


@pytest.mark.parametrize("threads", [1, numba.config.NUMBA_NUM_THREADS])
def test_a_loop_gives_the_same_on_any_number_of_threads(threads):
    numba.set_num_threads(threads)
    values = np.arange(1000.0)
    threaded(doubled)(values)
    np.testing.assert_array_equal(values, 2.0 * np.arange(1000.0))


def test_a_loop_is_compiled_for_threads_only_where_there_are_several_and_rows_enough(monkeypatch):
    asked = []
    module = importlib.import_module(threaded.__module__)
    monkeypatch.setattr(module, "specialise", lambda loop, parts, parallel: asked.append(parallel) or loop)
    loop, several = threaded(doubled, least=4), numba.config.NUMBA_NUM_THREADS
    for threads in (1, several):
        numba.set_num_threads(threads)
        for length in (3, 4, 3, 4):
            loop(np.zeros(length))
    assert asked == [False, True][: len({1, several})]


@pytest.fixture(params=[1, numba.config.NUMBA_NUM_THREADS], ids=["one", "most"])
def rows(request):
    """Random rows, enough for several threads: x, y, u, v and density."""
    numba.set_num_threads(request.param)
    return np.random.default_rng(3).uniform(size=(20_003, 5))


def test_long_updates_are_those_of_numpy(rows):
    start, rates = rows.copy(), rows[::-1].copy()
    advance_state(rows, start, rates, 0.1)
    np.testing.assert_array_equal(rows, start + 0.1 * rates)
    add_columns(rows, rates, 20_001, 2, 4, -2, 0.5)
    expected = start + 0.1 * rates
    expected[:20_001, 2:4] += 0.5 * rates[:20_001, :2]
    np.testing.assert_array_equal(rows, expected)


def test_the_largest_motion_of_many_rows_is_that_of_numpy(rows):
    reference = rows[::-1, :2].copy()
    found = largest_motion(rows, reference, 2)
    largest = (np.linalg.norm(of, axis=1).max() for of in (rows[:, 2:4], rows[:, :2] - reference))
    np.testing.assert_allclose(found, list(largest), rtol=1e-15)


def test_many_rows_are_sorted_as_numpy_sorts_them(rows):
    n, grid = len(rows), grid_around(np.zeros(2), np.ones(2), 0.1, 0.0)
    cells, order, starts = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(grid.size + 1, np.int64)
    sort_by_cell(rows, 2, grid, cells, np.zeros((7, grid.size), np.int64), starts, order)
    across, along = ((rows[:, k] - grid.origin[k + 1]) // grid.cell[k + 1] for k in (0, 1))
    backwards = grid.shape[2] - 1 - along
    np.testing.assert_array_equal(order, np.lexsort([np.where(across % 2, backwards, along), across]))
    np.testing.assert_array_equal(np.diff(starts), np.bincount(cells, minlength=grid.size))


def test_the_first_of_many_rows_that_are_wrong_are_found(rows):
    columns = Columns.of(2)
    rows = np.hstack([rows, np.zeros((len(rows), len(columns.zeros(1)[0]) - rows.shape[1]))])
    rows[:, columns.density] = 1000.0
    rows[[9_000, 15_000], columns.u] = np.nan
    rows[[8_000, 19_000], 0] = 2.0
    rows[[7_000, 10_001, 17_000], columns.density] = 500.0
    found = check_fluid(rows, len(rows), columns, np.zeros(2), np.ones(2), 900.0, 1100.0)
    assert found == (9_000, 8_000, 7_000, 3)


def test_the_bound_on_the_displacement_of_many_rows_does_not_depend_on_threads(rows):
    reference, shape = rows[:, :2] + 0.01 * rows[::-1, 2:4], np.array([12, 12, 1])
    several = numba.get_num_threads()
    bounds = []
    for threads in (1, several):
        numba.set_num_threads(threads)
        boxes = np.empty((7, 150, 6))  # more than the 144 cubes
        bounds.append(relative_displacement(rows, reference, 2, np.zeros(2), 0.11, shape, boxes))
    assert bounds[0] == bounds[1]
    assert 0.005 < bounds[0] < 0.015


def test_the_same_of_many_ghosts_are_near_the_fluid_on_any_number_of_threads(rows):
    several = numba.get_num_threads()
    packed = Columns.of(2).zeros(len(rows) + 50)
    packed[:50, :2], packed[50:, :2] = rows[:50, :2], rows[:, :2]
    near = []
    for threads in (1, several):
        numba.set_num_threads(threads)
        lists = NeighbourLists(2, 50, len(rows), support=0.03, skin=0.005)
        ordered = np.vstack([packed[:50][lists.sort(packed)], packed[50:]])
        lists.build(ordered, packed[50:, :2].copy())
        near.append(lists.near)
    np.testing.assert_array_equal(*near)
    distance = np.linalg.norm(packed[50:, None, :2] - packed[:50, :2], axis=2).min(axis=1)
    assert np.isin(np.flatnonzero(distance < 0.03), near[0]).all()
    assert len(near[0]) < 0.8 * len(rows)
