"""Geometry: walls as they are drawn: lines and closed outlines of any shape in 2-D, surfaces of solids in 3-D."""

import itertools
from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
import shapely
from pydantic import BaseModel, ConfigDict, Field, model_validator
from shapely import LineString

from sphframe.arrays import Array
from sphframe.geometry.curves import area_within, line_through, unit_circle
from sphframe.geometry.shapes import (
    CHORD,
    Arc,
    Circle,
    Curve,
    Cylinder,
    Difference,
    Ellipse,
    Mesh,
    Plane,
    Point,
    PointsFile,
    Polyline,
    Shape,
    Sphere,
    Union,
    check_box,
)
from sphframe.geometry.wall_solids import WallSolid, box_solid, cylinder_solid, drawn_lines


class Drawn(BaseModel):
    """What all walls have beside their shape.

    The fluid at the start tells which side of a wall is wet. A line that ends in the open and that the fluid could
    flow round is wet on both sides; ``one_sided`` says that its back stays dry, as that of a piston does.
    """

    name: str = "wall"
    """name of the wall in outputs, messages and for `wall_parts`"""
    body: str | None = None
    """name of the body that carries the wall; None means a wall at rest"""
    one_sided: bool = False
    """whether the side without fluid at the start stays dry"""
    reference_point: tuple[float, ...] | None = Field(default=None, min_length=2, max_length=3)
    """point to which the moment on the wall refers, as drawn, m; by default the centre of its body, or the origin"""
    surface_velocity: tuple[float, ...] | None = Field(default=None, min_length=2, max_length=3)
    """velocity along the surface of a wall that stays where it is, as of a belt, m/s; None for a surface at rest"""

    def bounds(self) -> tuple[Array, Array]:
        """Return the lower and the upper corner (dim,) of the box around the wall, m."""
        drawn: Any = self
        points = np.vstack(drawn.outline())
        return points.min(axis=0), points.max(axis=0)

    def triangles(self) -> Array:
        """Return triangles (t, 3, 3), m, that show a wall in 3-D; none in 2-D."""
        drawn: Any = self
        if drawn.dimension == 2:
            return np.empty((0, 3, 3))
        solid = self.solid(1e-3 * float(np.ptp(self.bounds(), axis=0).max()), 1.0)
        return np.asarray(solid.vertices[solid.triangles[~solid.open]])

    def solid(self, tolerance: float, far: float) -> WallSolid:
        """Return the closed surface of a wall in 3-D, at most ``tolerance`` (m) away from the wall."""
        shape: Any = self
        mesh = shape.geometry(tolerance)
        return WallSolid(np.array(mesh.vertices), np.array(mesh.faces), np.zeros(len(mesh.faces), dtype=np.bool_))


class ShapeWall(Drawn):
    """A wall along the outline of a plane shape, along an open line, or on the surface of a solid."""

    def outline(self, tolerance: float | None = None) -> list[Array]:
        """Return polylines (k, dim), m, at most ``tolerance`` (m) away from the wall; in 3-D edges and sections."""
        shape: Any = self
        geometry = shape.geometry(shape.coarse if tolerance is None else tolerance)
        if shape.dimension == 3:
            return drawn_lines(geometry)
        lines = [geometry] if isinstance(geometry, LineString) else shapely.get_rings(shapely.get_parts(geometry))
        return [shapely.get_coordinates(line) for line in lines]

    @property
    def is_line(self) -> bool:
        """Whether it is an open line, which may be wet on both sides."""
        lines = self.outline()
        return len(lines) == 1 and not np.array_equal(lines[0][0], lines[0][-1])


class PolylineWall(Polyline, ShapeWall):
    """A wall of straight lines from point to point."""


class CircleWall(Circle, ShapeWall):
    """A circular wall, around the fluid or within it."""


class ArcWall(Arc, ShapeWall):
    """A wall along a part of a circle."""


class EllipseWall(Ellipse, ShapeWall):
    """An elliptic wall, around the fluid or within it."""


class CurveWall(Curve, ShapeWall):
    """A wall along a curve given by expressions."""


class PointsWall(PointsFile, ShapeWall):
    """A wall through the points of a file."""


class UnionWall(Union, ShapeWall):
    """A wall along the outline of several closed shapes."""


class DifferenceWall(Difference, ShapeWall):
    """A wall along the outline of a closed shape without others."""


class SphereWall(Sphere, ShapeWall):
    """A spherical wall, around the fluid or within it."""


class CylinderWall(Cylinder, ShapeWall):
    """A circular cylinder around the fluid, whose ends may be open, or within it."""

    open_ends: tuple[Literal["start", "stop"], ...] = ()
    """ends that are no wall"""

    def solid(self, tolerance: float, far: float) -> WallSolid:  # noqa: D102
        circle = self.radius * unit_circle(tolerance / self.radius)
        return cylinder_solid(self.start, self.stop, circle, self.open_ends, far)


class PlaneWall(Plane, ShapeWall):
    """A plane wall, on the surface of the part of a box behind it."""


class MeshWall(Mesh, ShapeWall):
    """A wall on the surface of a closed mesh, around the fluid or within it."""


class PolygonWall(Shape, ShapeWall):
    """A line through points, in either direction; ``closed`` joins the last point to the first."""

    shape: Literal["polygon"] = "polygon"
    points: tuple[Point, ...] = Field(min_length=2)
    """points of the line, m, in either direction"""
    closed: bool = False
    """whether the last point is joined to the first"""

    def geometry(self, tolerance: float) -> shapely.Polygon | LineString:  # noqa: D102
        return area_within(self.points) if self.closed else line_through(self.points)

    @property
    def is_line(self) -> bool:
        """Whether it is a straight line, which may be wet on both sides; more points bound a solid."""
        return len(self.points) == 2


class BoxWall(Drawn):
    """A rectangular (2-D) or box-shaped (3-D) container around the fluid, with some faces left open."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    shape: Literal["box"] = "box"
    """kind of the shape, by which a table chooses it"""
    lower: tuple[float, ...] = Field(min_length=2, max_length=3)
    """corner with the smallest coordinates, m"""
    upper: tuple[float, ...] = Field(min_length=2, max_length=3)
    """corner with the largest coordinates, m"""
    open_faces: tuple[Literal["-x", "+x", "-y", "+y", "-z", "+z"], ...] = ()
    """faces that are no wall, such as ["+y"] for an open top"""

    @model_validator(mode="after")
    def _box(self) -> "BoxWall":
        check_box(self.lower, self.upper)
        if self.dimension == 2 and any(face[1] == "z" for face in self.open_faces):
            raise ValueError(f"open_faces {self.open_faces} name z, but wall {self.name!r} is two-dimensional")
        return self

    @property
    def dimension(self) -> int:
        """Dimension of space."""
        return len(self.lower)

    @property
    def is_line(self) -> bool:
        """Whether it may be wet on both sides; a box contains its fluid."""
        return False

    def outline(self, tolerance: float | None = None) -> list[Array]:
        """Return polylines (k, dim), m, of the edges of the box, in 3-D without those between two open faces."""
        low, high = np.array(self.lower), np.array(self.upper)
        lines = []
        for axis in range(self.dimension):
            others = [k for k in range(self.dimension) if k != axis]
            for ends in itertools.product((0, 1), repeat=self.dimension - 1):
                if all("-+"[end] + "xyz"[k] in self.open_faces for k, end in zip(others, ends, strict=True)):
                    continue
                first = np.where(np.insert(ends, axis, 0), high, low)
                second = np.where(np.insert(ends, axis, 1), high, low)
                lines.append(np.array([first, second]))
        return lines

    def solid(self, tolerance: float, far: float) -> WallSolid:
        """Return the closed surface of the box in 3-D, continued by ``far`` (m) across its open faces."""
        return box_solid(self.lower, self.upper, self.open_faces, far)


Wall = Annotated[
    PolygonWall
    | BoxWall
    | PolylineWall
    | CircleWall
    | ArcWall
    | EllipseWall
    | CurveWall
    | PointsWall
    | UnionWall
    | DifferenceWall
    | SphereWall
    | CylinderWall
    | PlaneWall
    | MeshWall,
    Field(discriminator="shape"),
]


def wall_lines(walls: Sequence[Wall], spacing: float) -> shapely.Geometry:
    """Return the lines of all plane ``walls``, with chords fine enough for particles one ``spacing`` (m) apart."""
    plane = [wall for wall in walls if wall.dimension == 2]
    return shapely.union_all([LineString(line) for wall in plane for line in wall.outline(CHORD * spacing)])
