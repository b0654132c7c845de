"""Neighbour lists against brute force."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe.neighbours import LargestMotion, NeighbourLists
from sphframe.neighbours.approach import relative_displacement
from sphframe.particles import Columns, Periods


def near_point(lists, ghost):
    """Return the fluid listed near the evaluation point of a ghost; none if the ghost is not near the fluid."""
    (place,) = np.nonzero(lists.near == ghost)
    return lists.points[place[0], : lists.point_counts[place[0]]].astype(int) if len(place) else np.zeros(0, int)


@settings(max_examples=40, deadline=None)
@given(
    dim=st.sampled_from([2, 3]),
    seed=st.integers(0, 2**31),
    fluid=st.integers(1, 120),
    ghosts=st.integers(0, 60),
    scale=st.sampled_from([1e-6, 1.0, 1e3]),
    stretch=st.floats(0.05, 20.0),
    cluster=st.sampled_from([1, 2, 4, 7]),
    half_edge=st.sampled_from([0.0, 0.1]),
)
def test_lists_hold_the_pairs_within_the_radius(dim, seed, fluid, ghosts, scale, stretch, cluster, half_edge):
    random = np.random.default_rng(seed)
    columns = Columns.of(dim)
    rows = columns.zeros(fluid + ghosts)
    rows[:, columns.position] = random.uniform(-1.0, 1.0, (fluid + ghosts, dim)) * [stretch, *[1.0] * (dim - 1)] * scale
    points = random.uniform(-1.5, 1.5, (ghosts, dim)) * scale
    lists = NeighbourLists(
        dim, fluid, ghosts, support=0.4 * scale, skin=0.05 * scale, cluster=cluster, half_edge=half_edge * scale
    )
    radius = np.full(fluid + ghosts, lists.radius)
    radius[fluid:] += half_edge * scale
    order = lists.sort(rows)
    assert sorted(order) == list(range(fluid))
    rows[:fluid] = rows[:fluid][order]
    lists.build(rows, points)
    position = rows[:, columns.position]
    for c in range(-(-fluid // cluster)):
        members = position[c * cluster : min((c + 1) * cluster, fluid)]
        apart = np.linalg.norm(position[:, None] - members, axis=2)
        near = (apart < radius[:, None]).any(axis=1)
        outside = np.maximum(np.maximum(members.min(axis=0) - position, position - members.max(axis=0)), 0.0)
        near_the_box = np.linalg.norm(outside, axis=1) < radius * (1.0 + 1e-12)
        if cluster == 1:
            near[c * cluster] = near_the_box[c * cluster] = False
        first, second = int(lists.fluid_counts[c]), int(lists.ghost_counts[c])
        found = lists.fluid[c, : first + second].astype(int)
        assert (found[:first] < fluid).all()
        assert (found[first:] >= fluid).all()
        assert len(set(found)) == len(found)
        assert set(np.flatnonzero(near)) <= set(found) <= set(np.flatnonzero(near_the_box))
    for k in range(ghosts):
        near = np.linalg.norm(position[:fluid] - points[k], axis=1) < lists.radius
        found = near_point(lists, k)
        assert sorted(found) == list(np.flatnonzero(near))
    listed = [
        lists.fluid[c, a : a + b] for c, (a, b) in enumerate(zip(lists.fluid_counts, lists.ghost_counts, strict=True))
    ]
    assert set(np.concatenate(listed).astype(int) - fluid) <= set(lists.near)


def test_ghosts_that_are_left_are_told_once():
    rows, points = Columns.of(2).zeros(3), np.array([[0.0, -0.1], [2.0, -0.1]])
    rows[1:, :2] = points
    lists = NeighbourLists(2, 1, 2, support=0.4, skin=0.1)
    for place, near, left in ((0.0, [0], [1]), (2.0, [1], [0]), (2.0, [1], [])):  # at first no ghost has been filled
        rows[0, 0] = place
        lists.sort(rows)
        lists.build(rows, points)
        assert (lists.near.tolist(), lists.left.tolist()) == (near, left)


def test_clusters_are_compact():
    """Consecutive particles fill squares, so their lists are little longer than that of one particle."""
    x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    rows = Columns.of(2).zeros(3600)
    rows[:, :2] = np.random.default_rng(3).permutation(np.stack([x.ravel(), y.ravel()], axis=1))
    lists = NeighbourLists(2, 3600, 0, support=3.9, skin=0.39, cluster=8, width=np.sqrt(8.0))
    rows = rows[lists.sort(rows)]
    lists.build(rows, np.empty((0, 2)))
    extent = np.ptp(rows[:, :2].reshape(-1, 8, 2), axis=1)
    assert np.median(extent.max(axis=1)) <= 3.0
    assert lists.fluid_counts.mean() < 2.0 * np.pi * lists.radius**2


def test_sorting_is_stable():
    columns = Columns.of(2)
    rows = columns.zeros(5)
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
def test_valid_lists_are_complete(dim, seed, fluid, stream, shear, noise):
    """However the fluid has moved: while lists are valid, they hold whatever is within the support."""
    random = np.random.default_rng(seed)
    columns, ghosts, support, skin, ahead = Columns.of(dim), 60, 0.4, 0.2, 0.01
    rows = columns.zeros(fluid + ghosts)
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
    rows[:fluid, columns.velocity] = random.uniform(-1.0, 1.0, (fluid, dim)) / np.sqrt(dim)
    motion = lists.largest_motion(rows)
    furthest = float(np.linalg.norm(moved, axis=1).max())
    assert motion.displacement == pytest.approx(furthest)
    assert motion.speed == pytest.approx(np.linalg.norm(rows[:fluid, columns.velocity], axis=1).max())
    near = np.linalg.norm(reference[:, None] - reference, axis=2) < support + 2.0 * skin
    apart = np.linalg.norm(moved[:, None] - moved, axis=2)
    valid = lists.remain_valid(rows, points, motion, wall_speed=0.0, interval=ahead / motion.speed)
    if furthest + ahead > skin or (2.0 * (furthest + ahead) > skin and apart[near].max() + 2.0 * ahead > skin):
        assert not valid
    if not valid:
        return
    rows[:fluid, columns.position] += random.uniform(-ahead, ahead, moved.shape) / np.sqrt(dim)
    position = rows[:, columns.position]
    for i in range(fluid):
        met = np.flatnonzero(np.linalg.norm(position - position[i], axis=1) < support)
        listed = lists.fluid[i, : lists.fluid_counts[i] + lists.ghost_counts[i]].astype(int)
        assert set(met) - {i} <= set(listed)
    for k in range(ghosts):
        met = np.flatnonzero(np.linalg.norm(position[:fluid] - points[k], axis=1) < support)
        assert set(met) <= set(near_point(lists, k))


@settings(max_examples=60, deadline=None)
@given(dim=st.sampled_from([2, 3]), seed=st.integers(0, 2**31), count=st.integers(2, 12))
def test_neighbours_move_apart_by_less_than_the_bound(dim, seed, count):
    random = np.random.default_rng(seed)
    reference = random.uniform(0.0, 1.0, (count, dim))
    rows = reference + random.normal(size=(count, dim))
    edge = 0.4
    shape = np.array([4 + 1] * dim + [1] * (3 - dim))
    boxes = np.empty((2, int(shape.prod()), 6))
    bound = relative_displacement(rows, reference, dim, np.zeros(dim), edge, shape, boxes)
    near = np.linalg.norm(reference[:, None] - reference, axis=2) < edge
    apart = np.linalg.norm((rows - reference)[:, None] - (rows - reference), axis=2)
    assert apart[near].max() <= bound * (1.0 + 1e-12)
    assert bound <= np.linalg.norm(np.ptp(rows - reference, axis=0)) * (1.0 + 1e-12)
    one_part = np.empty((1, int(shape.prod()), 6))
    assert relative_displacement(rows, reference, dim, np.zeros(dim), edge, shape, one_part) == bound


def test_a_uniform_stream_invalidates_lists_at_walls_only():
    """Fluid that moves as one body keeps its lists twice as long as fluid whose particles move apart."""
    random = np.random.default_rng(5)
    rows = Columns.of(2).zeros(500)
    rows[:, :2] = random.uniform(-1.0, 1.0, (500, 2))
    lists, points = NeighbourLists(2, 500, 0, support=0.4, skin=0.1), np.empty((0, 2))
    rows = rows[lists.sort(rows)]
    lists.build(rows, points)
    rows[:, 0] += 0.09
    motion = LargestMotion(speed=1.0, displacement=0.09)
    assert lists.remain_valid(rows, points, motion, wall_speed=0.0, interval=0.005)
    assert not lists.remain_valid(rows, points, motion, wall_speed=0.0, interval=0.02)
    assert not lists.remain_valid(rows, points, motion, wall_speed=4.0, interval=0.005)
    rows[0, 0] -= 0.18
    assert not lists.remain_valid(rows, points, motion, wall_speed=0.0, interval=0.005)


def test_walls_that_have_moved_invalidate_lists():
    """The displacement of ghosts, and of evaluation points, counts as that of the fluid does."""
    rows, points = Columns.of(2).zeros(3), np.array([[0.0, 0.3]])
    rows[:, :2] = [[0.0, 0.1], [0.1, 0.1], [0.0, -0.1]]
    lists = NeighbourLists(2, 2, 1, support=0.4, skin=0.1)
    rows[:2] = rows[:2][lists.sort(rows)]
    lists.build(rows, points)
    at_rest = lists.largest_motion(rows)
    assert at_rest == (0.0, 0.0)
    assert lists.remain_valid(rows, points, at_rest, wall_speed=0.0, interval=1.0)
    assert not lists.remain_valid(rows, np.add(points, [0.0, 0.11]), at_rest, wall_speed=0.0, interval=1.0)
    rows[2, 0] += 0.09
    assert lists.remain_valid(rows, points, at_rest, wall_speed=0.0, interval=1.0)
    rows[2, 0] += 0.02
    assert not lists.remain_valid(rows, points, at_rest, wall_speed=0.0, interval=1.0)


@pytest.mark.parametrize(("stride", "skin"), [(0.0, 0.02), (0.001, 0.02), (0.005, 0.05), (1.0, 0.1)])
def test_the_skin_is_that_of_ten_steps_within_its_bounds(stride, skin):
    lists = NeighbourLists(2, 70, 20, support=0.4, skin=0.1)
    lists.adapt_skin(stride)
    assert lists.skin == pytest.approx(skin)
    assert lists.radius == pytest.approx(0.4 + skin)
    assert lists.resized(60).skin == 0.1


def test_restored_lists_are_those_that_were_saved():
    random = np.random.default_rng(7)
    rows, points = Columns.of(2).zeros(90), random.uniform(-1.0, 1.0, (20, 2))
    rows[:, :2] = random.uniform(-1.0, 1.0, (90, 2))
    lists = NeighbourLists(2, 70, 20, support=0.4, skin=0.1, cluster=8)
    lists.adapt_skin(0.005)
    rows[:70] = rows[:70][lists.sort(rows)]
    lists.build(rows, points)
    saved = lists.state()
    other = lists.resized(70)
    other.restore(saved, np.zeros_like(rows))
    assert other.skin == lists.skin == 0.05
    for name in ("fluid_counts", "ghost_counts", "point_counts"):
        np.testing.assert_array_equal(getattr(other, name), getattr(lists, name))
    for c, count in enumerate(lists.fluid_counts + lists.ghost_counts):
        np.testing.assert_array_equal(other.fluid[c, :count], lists.fluid[c, :count])


@settings(max_examples=40, deadline=None)
@given(
    dim=st.sampled_from([2, 3]),
    seed=st.integers(0, 2**31),
    axes=st.sets(st.sampled_from("xyz"), min_size=1),
    fluid=st.integers(1, 120),
    cluster=st.sampled_from([1, 4, 7]),
    length=st.floats(1.0, 4.0),
    half_edge=st.sampled_from([0.0, 0.1]),
)
def test_periodic_lists_hold_each_neighbour_once(dim, seed, axes, fluid, cluster, length, half_edge):
    random, ghosts = np.random.default_rng(seed), 40
    periods = Periods.of(sorted(axes), ((-0.5,) * dim, (length - 0.5,) * dim))
    repeats = np.where(periods.repeats, length, np.inf)
    columns = Columns.of(dim)
    rows = columns.zeros(fluid + ghosts)
    rows[:, columns.position] = random.uniform(-0.5, length - 0.5, (fluid + ghosts, dim))
    points = random.uniform(-length, 2.0 * length, (ghosts, dim))
    lists = NeighbourLists(dim, fluid, ghosts, 0.4, 0.05, cluster, periods=periods, half_edge=half_edge)
    radius = np.full(fluid + ghosts, lists.radius)
    radius[fluid:] += half_edge
    rows[:fluid] = rows[:fluid][lists.sort(rows)]
    lists.build(rows, points)
    position = rows[:, columns.position]

    def distance(points):
        offset = position - points
        offset[:, periods.repeats] -= length * np.rint(offset[:, periods.repeats] / repeats[periods.repeats])
        return np.linalg.norm(offset, axis=1)

    for c in range(-(-fluid // cluster)):
        members = range(c * cluster, min((c + 1) * cluster, fluid))
        near = np.any([distance(position[i]) < radius for i in members], axis=0)
        near[members[0]] &= len(members) > 1
        found = lists.fluid[c, : lists.fluid_counts[c] + lists.ghost_counts[c]].astype(int)
        assert len(set(found)) == len(found)
        assert set(np.flatnonzero(near)) <= set(found)
    for k in range(ghosts):
        found = near_point(lists, k)
        assert sorted(found) == list(np.flatnonzero(distance(points[k])[:fluid] < lists.radius))
