"""Thin walls: each particle sees its surroundings filled once, past plates, ends of plates and junctions."""

import numpy as np
import pytest
import shapely

from sphframe.boundary.sides import WallSides
from sphframe.geometry import Box, BoxWall, Polygon, PolygonWall, fill, ghosts_of, sides_of, wall_groups
from sphframe.geometry.walls import PolylineWall
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns

from .wall_integrals import gaussian

SPACING, LANES = 0.02, 8
TANK = BoxWall(name="tank", lower=(0, 0), upper=(1, 0.6), open_faces=("+y",))


class Seen:
    """Fluid and ghosts, and in which shares (particle, neighbour) they are seen."""

    def __init__(self, walls, fluid, smooth=True):
        groups = [group for _, group in wall_groups((TANK, *walls), fluid, SPACING)]
        self.ghosts = ghosts_of(groups, SPACING, 4)
        self.sides, _ = sides_of(groups, SPACING, 4)
        fills = [fill(region, SPACING) for region in fluid]
        position = np.vstack([filled.position for filled in fills])
        volume = np.concatenate([filled.volume for filled in fills])
        n, columns = len(position), Columns.of(2)
        rows = columns.zeros(n + len(self.ghosts.position))
        rows[:n, :2], rows[n:, :2] = position, self.ghosts.position
        at_rest = np.full(len(self.sides.ends), -1)
        sight = WallSides(self.sides, at_rest, np.zeros((0, 2)), SPACING if smooth else 0.0, 0.1).sight
        lists = NeighbourLists(
            2, n, len(rows) - n, 3.9 * SPACING, 0.39 * SPACING, cluster=LANES, width=2.1 * SPACING, sight=sight
        )
        order = lists.sort(rows)
        rows[:n] = rows[:n][order]
        lists.build(rows, self.ghosts.mirror)
        self.shares = np.zeros((n, len(rows)))
        for c, entries in enumerate(lists.fluid):
            for k in range(lists.fluid_counts[c] + lists.ghost_counts[c]):
                members = slice(LANES * c, min(LANES * (c + 1), n))
                self.shares[members, entries[k]] = lists.shares[c, k, : members.stop - members.start] / 128
        np.fill_diagonal(self.shares, 1.0)
        self.lists, self.count, self.position = lists, n, rows[:, :2]
        distance = np.hypot(*np.moveaxis(self.position[:n, None] - self.position, -1, 0))
        self.near = distance < 3.9 * SPACING
        self.filling = (self.shares * gaussian(distance, 1.3 * SPACING)) @ np.append(volume[order], self.ghosts.volume)


def plate(*points, **other):
    return PolygonWall(name="plate", points=points, **other)


def solid(width):
    low, high = 0.5 - 0.5 * width, 0.5 + 0.5 * width
    return plate((low, 0), (low, 0.5), (high, 0.5), (high, 0), closed=True)


def halves(edge, top=0.3):
    return [Box(lower=(0, 0), upper=(0.5 - edge, top)), Box(lower=(0.5 + edge, 0), upper=(1, top))]


def around(start, stop, top=0.4):
    """Water above and below the line through two points."""
    start, stop = np.array(start), np.array(stop)
    along = (stop - start) / np.hypot(*(stop - start))
    across = np.array([-along[1], along[0]])
    corners = [start - 3 * along, start + 3 * along, start + 3 * along + 3 * across, start - 3 * along + 3 * across]
    water = shapely.box(0, 0, 1, top)
    above = water.intersection(shapely.Polygon(corners))
    parts = (above, water.difference(above))
    return [Polygon(points=shapely.get_coordinates(part.exterior)[:-1].tolist()) for part in parts]


@pytest.mark.parametrize("width", [0.0, 0.01, 0.04])
def test_two_basins_beside_a_plate_of_any_thickness_are_filled(width):
    seen = Seen([solid(width) if width else plate((0.5, 0), (0.5, 0.5))], halves(0.5 * width))
    deep = seen.position[: seen.count, 1] < 0.2
    np.testing.assert_allclose(seen.filling[deep], 1.0, atol=0.02)


@pytest.mark.parametrize(
    "ends",
    [
        ((0.5, 0), (0.5, 0.2)),
        ((0.3, 0.15), (0.7, 0.15)),
        *(((0.5 - 0.08 * c, 0.2 - 0.08 * s), (0.5 + 0.08 * c, 0.2 + 0.08 * s)) for c, s in [(0.97, 0.25), (0.71, 0.7)]),
    ],
)
def test_the_surroundings_of_a_free_end_are_filled(ends):
    seen = Seen([plate(*ends)], around(*ends))
    deep = seen.position[: seen.count, 1] < 0.3
    assert deep.sum() > 700
    np.testing.assert_allclose(seen.filling[deep], 1.0, atol=0.015)


def test_a_bent_line_and_a_junction_of_lines():
    bent = PolylineWall(name="bent", points=((0.5, 0), (0.5, 0.2), (0.6, 0.3), (0.6, 0.5)))
    branch = plate((0.5, 0.1), (0.2, 0.1))
    left = Polygon(points=((0, 0.1), (0.5, 0.1), (0.5, 0.2), (0.6, 0.3), (0.6, 0.4), (0, 0.4)))
    right = Polygon(points=((0.5, 0), (1, 0), (1, 0.4), (0.6, 0.4), (0.6, 0.3), (0.5, 0.2)))
    seen = Seen([bent, branch], [left, right, Box(lower=(0, 0), upper=(0.5, 0.1))])
    deep = seen.position[: seen.count, 1] < 0.3
    assert np.abs(seen.filling[deep] - 1.0).max() < 0.06
    assert np.sqrt(np.mean((seen.filling[deep] - 1.0) ** 2)) < 0.012


def test_what_is_seen_agrees_with_lines_of_sight():
    """Against shapely: fluid where no plate is on the line, ghosts where the first wall on it is their own side."""
    ends = ((0.45, 0.0), (0.55, 0.2))
    seen = Seen([plate(*ends)], around(*ends), smooth=False)
    n, sides = seen.count, seen.sides
    line = shapely.LineString(ends)
    close = np.argsort(shapely.distance(line, shapely.points(seen.position[:n])))[:60]
    edges = shapely.linestrings(sides.ends.reshape(-1, 2, 2))
    normal = np.stack([sides.ends[:, 3] - sides.ends[:, 1], sides.ends[:, 0] - sides.ends[:, 2]], axis=1)
    checked = 0
    for i in close:
        for j in np.flatnonzero(seen.near[i]):
            sight = shapely.LineString([seen.position[i], seen.position[j]])
            if i == j or shapely.distance(sight, shapely.multipoints(ends)) < 1e-6:
                continue
            hidden = shapely.crosses(sight, line)
            if j < n:
                expected = not hidden
            else:
                entered = shapely.crosses(sight, edges) & (normal @ (seen.position[j] - seen.position[i]) > 0)
                where = shapely.line_locate_point(sight, shapely.intersection(sight, edges[entered]))
                first = sides.chart[entered][np.argmin(where)] if np.any(entered) else -1
                expected = first == sides.ghost_chart[j - n]
            assert seen.shares[i, j] == expected, (seen.position[i], seen.position[j])
            checked += 1
    assert checked > 3000


def test_two_particles_see_each_other_in_the_same_share():
    ends = ((0.45, 0.1), (0.55, 0.3))
    seen = Seen([plate(*ends)], around(*ends))
    within = seen.shares[:, : seen.count] * seen.near[:, : seen.count]
    np.testing.assert_array_equal(within, within.T)
    assert np.any((within > 0) & (within < 1))


def test_mirror_points_see_only_their_own_side():
    seen = Seen([plate((0.5, 0), (0.5, 0.5))], halves(0.0))
    for g, entries, count in zip(seen.lists.near, seen.lists.points, seen.lists.point_counts, strict=False):
        own = seen.position[entries[:count], 0] < 0.5
        assert np.all(own == (seen.ghosts.mirror[g, 0] < 0.5))


def test_panels_of_a_plate_are_on_both_sides():
    (_, group), *_ = wall_groups((TANK, plate((0.5, 0), (0.5, 0.5))), halves(0.0), SPACING)
    panels = group.panels(SPACING)
    own = panels.wall == 1
    assert own.sum() == 50
    np.testing.assert_allclose(panels.area[own].sum(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.abs(panels.area[own]).sum(axis=0), [1.0, 0.0], atol=1e-12)


def test_walls_that_are_nowhere_thin_have_no_sides():
    groups = [group for _, group in wall_groups((TANK, solid(0.08)), halves(0.04), SPACING)]
    assert sides_of(groups, SPACING, 4) is None
