"""Neighbour lists against brute force."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe.neighbours import NeighbourLists
from sphframe.neighbours.approach import relative_displacement
from sphframe.particles import Columns


@settings(max_examples=40, deadline=None)
@given(
    dim=st.sampled_from([2, 3]),
    seed=st.integers(0, 2**31),
    fluid=st.integers(1, 120),
    ghosts=st.integers(0, 60),
    scale=st.sampled_from([1e-6, 1.0, 1e3]),
    stretch=st.floats(0.05, 20.0),
    cluster=st.sampled_from([1, 2, 4, 7]),
)
def test_lists_hold_the_pairs_within_the_radius(dim, seed, fluid, ghosts, scale, stretch, cluster):
    random = np.random.default_rng(seed)
    columns = Columns(dim)
    rows = columns.empty(fluid + ghosts)
    rows[:, columns.position] = random.uniform(-1.0, 1.0, (fluid + ghosts, dim)) * [stretch, *[1.0] * (dim - 1)] * scale
    points = random.uniform(-1.5, 1.5, (ghosts, dim)) * scale
    lists = NeighbourLists(dim, fluid, ghosts, support=0.4 * scale, skin=0.05 * scale, cluster=cluster)
    order = lists.sort(rows)
    assert sorted(order) == list(range(fluid))
    rows[:fluid] = rows[:fluid][order]
    lists.build(rows, points)
    position = rows[:, columns.position]
    for c in range(-(-fluid // cluster)):
        members = position[c * cluster : min((c + 1) * cluster, fluid)]
        near = (np.linalg.norm(position[:, None] - members, axis=2) < lists.radius).any(axis=1)
        outside = np.maximum(np.maximum(members.min(axis=0) - position, position - members.max(axis=0)), 0.0)
        near_the_box = np.linalg.norm(outside, axis=1) < lists.radius * (1.0 + 1e-12)
        if len(members) == 1:
            near[c * cluster] = near_the_box[c * cluster] = False
        first, second = int(lists.fluid_counts[c]), int(lists.ghost_counts[c])
        found = lists.fluid[c, : first + second].astype(int)
        assert (found[:first] < fluid).all()
        assert (found[first:] >= fluid).all()
        assert len(set(found)) == len(found)
        assert set(np.flatnonzero(near)) <= set(found) <= set(np.flatnonzero(near_the_box))
    for k in range(ghosts):
        near = np.linalg.norm(position[:fluid] - points[k], axis=1) < lists.radius
        found = lists.points[k, : lists.point_counts[k]].astype(int)
        assert sorted(found) == list(np.flatnonzero(near))


def test_clusters_are_compact():
    """Particles that follow each other fill squares, so that their lists are little longer than one particle's."""
    x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    rows = Columns(2).empty(3600)
    rows[:, :2] = np.random.default_rng(3).permutation(np.stack([x.ravel(), y.ravel()], axis=1))
    lists = NeighbourLists(2, 3600, 0, support=3.9, skin=0.39, cluster=8, width=np.sqrt(8.0))
    rows = rows[lists.sort(rows)]
    lists.build(rows, np.empty((0, 2)))
    extent = np.ptp(rows[:, :2].reshape(-1, 8, 2), axis=1)
    assert np.median(extent.max(axis=1)) <= 3.0
    assert lists.fluid_counts.mean() < 2.0 * np.pi * lists.radius**2


def test_sorting_is_stable():
    columns = Columns(2)
    rows = columns.empty(5)
    lists = NeighbourLists(2, 5, 0, support=1.0, skin=0.1)
    assert list(lists.sort(rows)) == [0, 1, 2, 3, 4]


@settings(max_examples=100, deadline=None)
@given(
    dim=st.sampled_from([2, 3]),
    seed=st.integers(0, 2**31),
    fluid=st.integers(2, 300) | st.integers(2, 6),
    stream=st.floats(0.0, 0.2),
    shear=st.floats(0.0, 0.1),
    noise=st.floats(0.0, 0.1),
)
def test_lists_that_last_are_complete(dim, seed, fluid, stream, shear, noise):
    """However the fluid has moved: while lists are said to last, whatever is within the support is on them."""
    random = np.random.default_rng(seed)
    columns, ghosts, support, skin, ahead = Columns(dim), 60, 0.4, 0.2, 0.01
    rows = columns.empty(fluid + ghosts)
    rows[:, columns.position] = random.uniform(-1.0, 1.0, (fluid + ghosts, dim))
    points = random.uniform(-1.2, 1.2, (ghosts, dim))
    lists = NeighbourLists(dim, fluid, ghosts, support=support, skin=skin)
    rows[:fluid] = rows[:fluid][lists.sort(rows)]
    lists.build(rows, points)
    reference = rows[:fluid, columns.position].copy()
    moved = shear * np.sign(reference @ random.normal(size=dim))[:, None] * random.normal(size=dim)
    moved[:, 0] += stream
    moved += random.uniform(-noise, noise, moved.shape) / np.sqrt(dim)
    rows[:fluid, columns.position] += moved
    furthest = float(np.linalg.norm(moved, axis=1).max())
    near = np.linalg.norm(reference[:, None] - reference, axis=2) < support + 2.0 * skin
    apart = np.linalg.norm(moved[:, None] - moved, axis=2)
    if furthest + ahead > skin or (2.0 * (furthest + ahead) > skin and apart[near].max() + 2.0 * ahead > skin):
        assert not lists.last(rows, reference, furthest, 0.0, ahead)
    if not lists.last(rows, reference, furthest, 0.0, ahead):
        return
    rows[:fluid, columns.position] += random.uniform(-ahead, ahead, moved.shape) / np.sqrt(dim)
    position = rows[:, columns.position]
    for i in range(fluid):
        met = np.flatnonzero(np.linalg.norm(position - position[i], axis=1) < support)
        listed = lists.fluid[i, : lists.fluid_counts[i] + lists.ghost_counts[i]].astype(int)
        assert set(met) - {i} <= set(listed)
    for k in range(ghosts):
        met = np.flatnonzero(np.linalg.norm(position[:fluid] - points[k], axis=1) < support)
        assert set(met) <= set(lists.points[k, : lists.point_counts[k]].astype(int))


@settings(max_examples=60, deadline=None)
@given(dim=st.sampled_from([2, 3]), seed=st.integers(0, 2**31), count=st.integers(2, 12))
def test_no_two_neighbours_part_further_than_the_bound(dim, seed, count):
    random = np.random.default_rng(seed)
    reference = random.uniform(0.0, 1.0, (count, dim))
    rows = reference + random.normal(size=(count, dim))
    edge = 0.4
    shape = np.array([4 + 1] * dim + [1] * (3 - dim))
    boxes = np.empty((2, int(shape.prod()), 6))
    bound = relative_displacement(rows, reference, dim, np.zeros(dim), edge, shape, boxes)
    near = np.linalg.norm(reference[:, None] - reference, axis=2) < edge
    parted = np.linalg.norm((rows - reference)[:, None] - (rows - reference), axis=2)
    assert parted[near].max() <= bound * (1.0 + 1e-12)
    assert bound <= np.linalg.norm(np.ptp(rows - reference, axis=0)) * (1.0 + 1e-12)
    one_part = np.empty((1, int(shape.prod()), 6))
    assert relative_displacement(rows, reference, dim, np.zeros(dim), edge, shape, one_part) == bound


def test_a_stream_wears_lists_out_at_the_walls_only():
    """Fluid that moves as one body keeps its lists twice as long as fluid whose particles part."""
    random = np.random.default_rng(5)
    rows = Columns(2).empty(500)
    rows[:, :2] = random.uniform(-1.0, 1.0, (500, 2))
    lists = NeighbourLists(2, 500, 0, support=0.4, skin=0.1)
    rows = rows[lists.sort(rows)]
    lists.build(rows, np.empty((0, 2)))
    reference = rows[:, :2].copy()
    rows[:, 0] += 0.09
    assert lists.last(rows, reference, 0.09, walls=0.0, ahead=0.005)
    assert not lists.last(rows, reference, 0.09, walls=0.0, ahead=0.02)
    assert not lists.last(rows, reference, 0.09, walls=0.02, ahead=0.005)
    rows[0, 0] -= 0.18
    assert not lists.last(rows, reference, 0.09, walls=0.0, ahead=0.005)
