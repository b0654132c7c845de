"""Neighbour lists against brute force."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe.neighbours import NeighbourLists
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
