"""Geometry: walls and regions, and the particles, ghosts, mirror points and panels that are placed on them."""

from sphframe.geometry.curves import sampled
from sphframe.geometry.fill import Fill, fill
from sphframe.geometry.frames import directions_to_world, rotation_matrix, to_body_frame, to_world, turned
from sphframe.geometry.ghosts import GhostPoints, wall_ghosts
from sphframe.geometry.panels import Panels, wall_panels
from sphframe.geometry.regions import (
    BoxRegion,
    CircleRegion,
    CurveRegion,
    DifferenceRegion,
    EllipseRegion,
    PointsRegion,
    PolygonRegion,
    Region,
    UnionRegion,
)
from sphframe.geometry.shapes import (
    SHAPES,
    AnyShape,
    Arc,
    Box,
    Circle,
    Curve,
    Cylinder,
    Difference,
    Ellipse,
    Mesh,
    PointsFile,
    Polygon,
    Polyline,
    Shape,
    Sphere,
    Union,
)
from sphframe.geometry.solids import solid_of, solid_within
from sphframe.geometry.walls import BoxWall, PolygonWall, Wall

__all__ = [
    "SHAPES",
    "AnyShape",
    "Arc",
    "Box",
    "BoxRegion",
    "BoxWall",
    "Circle",
    "CircleRegion",
    "Curve",
    "CurveRegion",
    "Cylinder",
    "Difference",
    "DifferenceRegion",
    "Ellipse",
    "EllipseRegion",
    "Fill",
    "GhostPoints",
    "Mesh",
    "Panels",
    "PointsFile",
    "PointsRegion",
    "Polygon",
    "PolygonRegion",
    "PolygonWall",
    "Polyline",
    "Region",
    "Shape",
    "Sphere",
    "Union",
    "UnionRegion",
    "Wall",
    "directions_to_world",
    "fill",
    "rotation_matrix",
    "sampled",
    "solid_of",
    "solid_within",
    "to_body_frame",
    "to_world",
    "turned",
    "wall_ghosts",
    "wall_panels",
]
