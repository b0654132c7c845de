"""What particles see past bent lines, wherever they are, against shapely."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe.neighbours import NeighbourLists, Sight
from sphframe.particles import Columns

SPACING, SUPPORT, LANES = 1.0, 3.9, 8


def sides_of_a_line(points):
    """Both sides of a line without thickness, whose ends are ends of a wall."""
    count = len(points) - 1
    forth = np.hstack([points[:-1], points[1:]])
    smooth = np.zeros((2 * count, 2))
    smooth[0, 0] = smooth[count - 1, 1] = smooth[count, 1] = smooth[-1, 0] = SPACING
    ends = np.vstack([forth, np.roll(forth, 2, axis=1)])
    none, thin = np.zeros(2 * count, np.int64), np.ones(2 * count, np.bool_)
    return Sight(ends, smooth, none, thin, none, none - 1, SPACING, none[:0], thin[:0])


def shares_of(position, sight):
    """The shares (n, n) in which particles see each other, and the positions in their order."""
    n = len(position)
    rows = Columns.of(2).zeros(n)
    rows[:, :2] = position
    lists = NeighbourLists(2, n, 0, SUPPORT, 0.1 * SUPPORT, cluster=LANES, width=2.1 * SPACING, sight=sight)
    rows = rows[lists.sort(rows)]
    lists.build(rows, np.empty((0, 2)))
    shares = np.zeros((n, n))
    for c, entries in enumerate(lists.fluid):
        for k in range(lists.fluid_counts[c]):
            members = slice(LANES * c, min(LANES * (c + 1), n))
            shares[members, entries[k]] = lists.shares[c, k, : members.stop - members.start] / 128
    return shares, rows[:, :2]


@settings(max_examples=20, deadline=None)
@given(
    st.lists(st.tuples(st.floats(0.6, 4.0), st.floats(-1.0, 1.0)), min_size=1, max_size=6),
    st.floats(-3.0, 3.0),
    st.integers(0, 2**32 - 1),
)
def test_a_bent_line_hides_the_same_from_both_sides_and_nothing_that_is_beside_it(pieces, direction, seed):
    length, turn = np.transpose(pieces)
    angle = direction + np.cumsum(turn)
    line = np.vstack([np.zeros(2), np.cumsum(length[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1), axis=0)])
    random = np.random.default_rng(seed)
    around = random.uniform(line.min(axis=0) - 6.0, line.max(axis=0) + 6.0, (200, 2))
    beside = line[random.integers(0, len(line), 150)] + random.normal(0.0, (0.3, 4.0), (150, 2)) @ [
        [np.sin(direction), -np.cos(direction)],
        [np.cos(direction), np.sin(direction)],
    ]  # many near the line's continuation
    shares, position = shares_of(np.vstack([around, beside]), sides_of_a_line(line))
    i, j = np.nonzero(np.triu(np.hypot(*np.moveaxis(position[:, None] - position, -1, 0)) < SUPPORT, 1))
    np.testing.assert_array_equal(shares[i, j], shares[j, i])
    sight = shapely.linestrings(np.stack([position[i], position[j]], axis=1))
    wall, ends = shapely.LineString(line), shapely.multipoints(line[[0, -1]])
    apart = shapely.distance(sight, wall) > 0.501 * SPACING
    np.testing.assert_array_equal(shares[i, j][apart], 1.0)
    crossing = shapely.intersects(sight, wall) & (shapely.distance(sight, ends) > 0.501 * SPACING)
    assert crossing.any() or length.sum() < 2.0
    np.testing.assert_array_equal(shares[i, j][crossing], 0.0)


def test_an_end_hides_what_lies_beside_it_from_the_largest_distance():
    """Two groups of particles on the continuation of a line; its end is further from one than the lists reach."""
    random = np.random.default_rng(1)
    far, close = (random.uniform((-0.1, y), (0.1, y + 0.04), (16, 2)) for y in (4.32, 0.45))
    shares, position = shares_of(np.vstack([far, close]), sides_of_a_line(np.array([[0.0, 0.0], [0.0, -3.0]])))
    seen = shares[:, position[:, 1] < 1.0][position[:, 1] > 1.0]
    np.testing.assert_array_equal(seen, shares[:, position[:, 1] > 1.0][position[:, 1] < 1.0].T)
    assert 0.9 < seen.min() < 1.0
