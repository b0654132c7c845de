"""Geometry: walls and regions, and the particles, ghosts, mirror points and panels that are placed on them."""

from sphframe.geometry.frames import directions_to_world, to_body_frame, to_world
from sphframe.geometry.ghosts import GhostPoints, wall_ghosts
from sphframe.geometry.panels import Panels, wall_panels
from sphframe.geometry.shapes import BoxRegion, PolygonRegion, Region, lattice, lattice_cell
from sphframe.geometry.walls import BoxWall, PolygonWall, Wall

__all__ = [
    "BoxRegion",
    "BoxWall",
    "GhostPoints",
    "Panels",
    "PolygonRegion",
    "PolygonWall",
    "Region",
    "Wall",
    "directions_to_world",
    "lattice",
    "lattice_cell",
    "to_body_frame",
    "to_world",
    "wall_ghosts",
    "wall_panels",
]
