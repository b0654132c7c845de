"""Geometry: walls and regions, and the particles, ghosts, mirror points and panels that are placed on them."""

from sphframe.geometry.curves import sampled
from sphframe.geometry.frames import directions_to_world, rotation_matrix, to_body_frame, to_world, turned
from sphframe.geometry.ghosts import GhostPoints, wall_ghosts
from sphframe.geometry.panels import Panels, wall_panels
from sphframe.geometry.regions import BoxRegion, PolygonRegion, Region, lattice, lattice_cell
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
    "Curve",
    "Cylinder",
    "Difference",
    "Ellipse",
    "GhostPoints",
    "Mesh",
    "Panels",
    "PointsFile",
    "Polygon",
    "PolygonRegion",
    "PolygonWall",
    "Polyline",
    "Region",
    "Shape",
    "Sphere",
    "Union",
    "Wall",
    "directions_to_world",
    "lattice",
    "lattice_cell",
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
