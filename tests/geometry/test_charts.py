"""Charts: thin walls are cut at their sharp corners, so that a strip of fluid lies in front of each piece."""

import numpy as np
import shapely

from sphframe.geometry.charts import charts_of, thin_edges
from sphframe.geometry.domain import domain_of

SPACING, LAYERS = 0.02, 3


def charts(solid: shapely.Polygon):
    """The charts of a thin solid in the middle of a lake."""
    region = shapely.box(-1.0, -1.0, 2.0, 1.0) - solid
    line = shapely.LineString(solid.exterior.coords)
    domain = domain_of(region, [line], np.array([0]), 1e-9)
    return charts_of(domain, thin_edges(domain, LAYERS * SPACING), SPACING, LAYERS)


def test_a_drop_is_cut_at_its_only_corner() -> None:
    """A round end, and a tip of 10 degrees: one chart, which ends at the tip on both sides."""
    angle = np.radians(85.0)
    around = np.linspace(-angle - np.pi / 2, angle - np.pi / 2, 30)[::-1] - np.pi / 2
    round_end = 0.02 * np.column_stack([np.cos(around), np.sin(around)])
    (chart,) = charts(shapely.Polygon([(0.02 / np.cos(angle), 0.0), *round_end]))
    assert len(chart.edges) == 31
    assert chart.tips.tolist() == [-1, -1]


def test_a_thin_ring_without_corners_is_one_closed_chart() -> None:
    (chart,) = charts(shapely.Point(0.0, 0.0).buffer(0.03, quad_segs=10))
    assert len(chart.edges) == 40
    assert chart.tips.tolist() == [0, 0]


def test_a_thin_plate_is_cut_at_each_corner() -> None:
    found = charts(shapely.box(0.0, 0.0, 0.4, 0.02))
    assert len(found) == 4
    assert all(len(chart.edges) == 1 and chart.tips.tolist() == [-1, -1] for chart in found)
