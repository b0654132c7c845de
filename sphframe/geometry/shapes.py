"""Geometry: shapes as data; plane ones become shapely geometries, solid ones triangle meshes."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
import shapely
from pydantic import BaseModel, ConfigDict, Field, model_validator

from sphframe.arrays import Array
from sphframe.geometry.curves import area_within, evaluate, line_through, points_of_csv, sampled, unit_circle
from sphframe.geometry.meshes import closed_mesh, digest

Point = tuple[float, float]
Point3 = tuple[float, float, float]
Length = Annotated[float, Field(gt=0)]

CHORD = 1e-3
"""greatest distance of a chord from the curve that it replaces, over the particle spacing"""
_COARSE = 1e-3
"""share of its extent to which a shape is followed where it is only checked or bounded"""


class Shape(BaseModel, ABC):
    """A shape in the plane, or a solid; lengths in m, angles in degrees.

    Raises
    ------
    ValueError
        when the shape is made, for a curve that crosses itself, repeated points, no area, or numbers that are
        not finite; the message says where and how to fix it.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    shape: str
    """kind of the shape, by which a table chooses it"""

    @property
    def dimension(self) -> int:
        """Dimension of space."""
        return 2

    @abstractmethod
    def geometry(self, tolerance: float) -> Any:
        """Return the shape, with curves replaced by chords at most ``tolerance`` (m) away from them.

        Returns
        -------
        Any
            In 2-D a polygon or several (closed shapes, with the area of the shape) or a line (open ones) of shapely; in
            3-D a mesh of trimesh.
        """

    def bounds(self) -> tuple[Array, Array]:
        """Return the lower and the upper corner (dim,) of the box around the shape, m."""
        bounds = np.reshape(self.geometry(self.coarse).bounds, (2, -1))
        return bounds[0], bounds[1]

    @property
    def coarse(self) -> float:
        """A tolerance, m, with which the shape is checked and bounded."""
        return _COARSE * self._extent()

    def _extent(self) -> float:
        """Return a length of the order of the shape's size, or of its smallest part; 1 where there are no curves."""
        return 1.0

    @model_validator(mode="after")
    def _sound(self) -> "Shape":
        self.geometry(self.coarse)
        return self


class Solid(Shape, ABC):
    """A closed shape in three dimensions."""

    @property
    def dimension(self) -> int:  # noqa: D102
        return 3


class Polygon(Shape):
    """The inside of a simple polygon, its corners in either sense of rotation.

    Examples
    --------
    >>> Polygon(points=[(0, 0), (1, 0), (0, 1)]).geometry(0.01).area
    0.5
    """

    shape: Literal["polygon"] = "polygon"
    points: tuple[Point, ...] = Field(min_length=3)
    """corners, m, three or more, in either sense of rotation"""

    def geometry(self, tolerance: float) -> shapely.Polygon:  # noqa: D102
        return area_within(self.points)


class Polyline(Shape):
    """Straight lines from point to point, open at both ends.

    Examples
    --------
    >>> Polyline(points=[(0, 1), (0, 0), (2, 0)]).geometry(0.01).length
    3.0
    """

    shape: Literal["polyline"] = "polyline"
    points: tuple[Point, ...] = Field(min_length=2)
    """points of the line, m, two or more"""

    def geometry(self, tolerance: float) -> shapely.LineString:  # noqa: D102
        return line_through(self.points)


class Box(Shape):
    """A rectangle (2-D) or box (3-D) between two corners.

    Examples
    --------
    >>> Box(lower=(0, 0), upper=(2, 1)).geometry(0.01).area
    2.0
    >>> Box(lower=(0, 0, 0), upper=(2, 1, 1)).dimension
    3
    """

    shape: Literal["box"] = "box"
    lower: tuple[float, ...] = Field(min_length=2, max_length=3)
    """corner with the smallest coordinates, m"""
    upper: tuple[float, ...] = Field(min_length=2, max_length=3)
    """corner with the largest coordinates, m"""

    @property
    def dimension(self) -> int:  # noqa: D102
        return len(self.lower)

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        check_box(self.lower, self.upper)
        if self.dimension == 2:
            return shapely.box(*self.lower, *self.upper)
        from trimesh.creation import box  # takes a second to import, and only solids need it

        return box(bounds=[self.lower, self.upper])

    def bounds(self) -> tuple[Array, Array]:  # noqa: D102
        return np.array(self.lower, dtype=np.float64), np.array(self.upper, dtype=np.float64)

    @model_validator(mode="after")
    def _sound(self) -> "Box":
        check_box(self.lower, self.upper)
        return self


class Circle(Shape):
    """A disc of ``radius`` around ``centre``.

    Examples
    --------
    >>> disc = Circle(centre=(0, 0), radius=2).geometry(0.001)
    >>> round(disc.area / math.pi, 9)
    4.0
    """

    shape: Literal["circle"] = "circle"
    centre: Point
    """centre, m"""
    radius: Length
    """radius, m"""

    def geometry(self, tolerance: float) -> shapely.Polygon:  # noqa: D102
        return area_within(self.centre + self.radius * unit_circle(tolerance / self.radius))

    def bounds(self) -> tuple[Array, Array]:  # noqa: D102
        return np.subtract(self.centre, self.radius), np.add(self.centre, self.radius)

    def _extent(self) -> float:
        return self.radius


class Ellipse(Shape):
    """The inside of an ellipse with two ``semi_axes``, the first at ``angle`` (degrees) from the x axis.

    Examples
    --------
    >>> round(Ellipse(centre=(0, 0), semi_axes=(2, 1), angle=30).geometry(0.001).area / math.pi, 9)
    2.0
    """

    shape: Literal["ellipse"] = "ellipse"
    centre: Point
    """centre, m"""
    semi_axes: tuple[Length, Length]
    """half of its two diameters, m"""
    angle: float = 0.0
    """of the first semi-axis from the x axis, degrees, counter-clockwise"""

    def geometry(self, tolerance: float) -> shapely.Polygon:  # noqa: D102
        cos, sin = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        stretched = unit_circle(tolerance / max(self.semi_axes)) * self.semi_axes
        return area_within(self.centre + stretched @ [[cos, sin], [-sin, cos]])

    def _extent(self) -> float:
        return max(self.semi_axes)


class Arc(Shape):
    """A part of a circle, an open curve from the angle ``start`` to ``stop`` (degrees, counter-clockwise from x).

    Examples
    --------
    >>> bowl = Arc(centre=(0, 1), radius=1, start=180, stop=360).geometry(0.0001)
    >>> round(bowl.length, 3)
    3.141
    """

    shape: Literal["arc"] = "arc"
    centre: Point
    """centre, m"""
    radius: Length
    """radius, m"""
    start: float
    """angle at which it starts, degrees, counter-clockwise from the x axis"""
    stop: float
    """angle at which it ends, degrees"""

    def geometry(self, tolerance: float) -> shapely.LineString:  # noqa: D102
        if not 0.0 < abs(self.stop - self.start) < 360.0:
            raise ValueError(
                f"an arc from {self.start:g} to {self.stop:g} degrees is empty or a full circle; give two angles less"
                ' than 360 degrees apart, or shape = "circle"'
            )
        step = 2.0 * math.acos(max(1.0 - tolerance / self.radius, 0.5))
        count = max(math.ceil(math.radians(abs(self.stop - self.start)) / step), 1)
        angle = np.radians(np.linspace(self.start, self.stop, count + 1))
        return line_through(self.centre + self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))

    def _extent(self) -> float:
        return self.radius


class Curve(Shape):
    """A curve whose coordinates ``x`` and ``y`` (m) are expressions of a parameter t between ``start`` and ``stop``.

    Expressions consist of numbers, t, pi, ``+ - * / **``, and the functions sqrt, exp, log, sin, cos, tan, asin, acos,
    atan, sinh, cosh, tanh and abs. A ``closed`` curve is the area within it. In Python, :func:`sampled` gives the
    points of any function for a :class:`Polygon` or :class:`Polyline`.

    Examples
    --------
    >>> bed = Curve(x="t", y="0.1 * sin(2 * pi * t) ** 2", start=0, stop=2)
    >>> round(bed.geometry(1e-6).length, 4)
    2.1848
    """

    shape: Literal["curve"] = "curve"
    x: str
    """expression of t for x, m, such as `0.5 * t`"""
    y: str
    """expression of t for y, m"""
    start: float = 0.0
    """value of t at which it starts"""
    stop: float = 1.0
    """value of t at which it ends"""
    closed: bool = False
    """whether it is the area within the curve"""

    def geometry(self, tolerance: float) -> shapely.Polygon | shapely.LineString:  # noqa: D102
        points = sampled(self._at, self.start, self.stop, tolerance)
        if not self.closed:
            return line_through(points)
        gap = float(np.linalg.norm(points[-1] - points[0]))
        return area_within(points[:-1] if gap <= 1e-9 * np.ptp(points) else points)

    def _at(self, t: Array) -> tuple[Array, Array]:
        return evaluate(self.x, t), evaluate(self.y, t)

    def _extent(self) -> float:
        return float(np.ptp(sampled(self._at, self.start, self.stop, math.inf), axis=0).max()) or 1.0


class PointsFile(Shape):
    """The points of a CSV file, one ``x, y`` (m) a line, joined by straight lines; ``closed``: the area within them.

    Lines that begin with ``#`` and a line of headings are left out. The file is read once; the points are kept with
    the case and its output, so that a run can be repeated without the file.
    """

    shape: Literal["points"] = "points"
    file: str
    """CSV file of x, y in m, looked for beside the case file"""
    closed: bool = False
    """whether it is the area within the points"""
    points: tuple[Point, ...] = ()
    """what the file contains, filled in when it is read"""

    @model_validator(mode="before")
    @classmethod
    def _read(cls, given: Any) -> Any:
        if isinstance(given, dict) and isinstance(given.get("file"), str) and not given.get("points"):
            return {**given, "points": points_of_csv(Path(given["file"]))}
        return given

    def geometry(self, tolerance: float) -> shapely.Polygon | shapely.LineString:  # noqa: D102
        return area_within(self.points) if self.closed else line_through(self.points)


class Union(Shape):
    """All that lies in any of the closed shapes ``of``.

    Examples
    --------
    >>> ell = Union(of=[Box(lower=(0, 0), upper=(3, 1)), Box(lower=(0, 0), upper=(1, 2))])
    >>> ell.geometry(0.01).area
    4.0
    """

    shape: Literal["union"] = "union"
    of: tuple["AnyShape", ...] = Field(min_length=2)
    """two closed shapes or more"""

    @property
    def dimension(self) -> int:  # noqa: D102
        return self.of[0].dimension

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        if self.dimension == 3:
            return _some(_solids("union", self.of, tolerance), "union")
        return _some(shapely.union_all([plane_area(shape, tolerance) for shape in self.of]), "union")

    def _extent(self) -> float:
        return min(shape._extent() for shape in self.of)


class Difference(Shape):
    """The closed shape ``of`` without the closed shapes ``minus``.

    Examples
    --------
    >>> ring = Difference(of=Circle(centre=(0, 0), radius=2), minus=[Circle(centre=(0, 0), radius=1)])
    >>> round(ring.geometry(0.001).area / math.pi, 9)
    3.0
    """

    shape: Literal["difference"] = "difference"
    of: "AnyShape"
    """a closed shape"""
    minus: tuple["AnyShape", ...] = Field(min_length=1)
    """closed shapes that are taken away from it"""

    @property
    def dimension(self) -> int:  # noqa: D102
        return self.of.dimension

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        if self.dimension == 3:
            return _some(_solids("difference", (self.of, *self.minus), tolerance), "difference")
        taken = shapely.union_all([plane_area(shape, tolerance) for shape in self.minus])
        return _some(plane_area(self.of, tolerance).difference(taken), "difference")

    def _extent(self) -> float:
        return min(shape._extent() for shape in (self.of, *self.minus))


class Sphere(Solid):
    """A ball of ``radius`` around ``centre`` (3-D).

    Examples
    --------
    >>> round(float(Sphere(centre=(0, 0, 0), radius=1).geometry(0.01).volume) / math.pi, 6)
    1.333333
    """

    shape: Literal["sphere"] = "sphere"
    centre: Point3
    """centre, m"""
    radius: Length
    """radius, m"""

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        from trimesh.creation import icosphere

        # an icosahedron's edge is about 1.1 radii, so the distance of its faces from the sphere 0.2; halving takes 1/4
        levels = max(math.ceil(0.5 * math.log2(max(0.2 * self.radius / tolerance, 1.0))), 1)
        mesh = icosphere(subdivisions=min(levels, 8))
        mesh.apply_scale(self.radius * (4.0 / 3.0 * math.pi / mesh.volume) ** (1.0 / 3.0))
        return mesh.apply_translation(self.centre)

    def bounds(self) -> tuple[Array, Array]:  # noqa: D102
        return np.subtract(self.centre, self.radius), np.add(self.centre, self.radius)

    def _extent(self) -> float:
        return 10.0 * self.radius


class Cylinder(Solid):
    """A circular cylinder of ``radius`` around the line from ``start`` to ``stop`` (3-D).

    Examples
    --------
    >>> rod = Cylinder(start=(0, 0, 0), stop=(0, 0, 2), radius=1).geometry(0.01)
    >>> round(float(rod.volume) / math.pi, 6)
    2.0
    """

    shape: Literal["cylinder"] = "cylinder"
    start: Point3
    """one end of its axis, m"""
    stop: Point3
    """the other end of its axis, m"""
    radius: Length
    """radius, m"""

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        if self.start == self.stop:
            raise ValueError(f"start and stop of the cylinder are equal, {self.start}; give the ends of its axis")
        from trimesh.creation import cylinder

        circle = unit_circle(tolerance / self.radius)
        return cylinder(
            float(np.hypot(*circle[0])) * self.radius, segment=[self.start, self.stop], sections=len(circle)
        )

    def _extent(self) -> float:
        return 10.0 * self.radius


class Plane(Solid):
    """The part of the box from ``lower`` to ``upper`` behind a plane through ``point`` across ``normal`` (3-D).

    The solid lies on the side from which ``normal`` points away. A wall on it is plane where the plane is in the box;
    a box that reaches beyond the other walls leaves nothing but the plane.

    Examples
    --------
    >>> bed = Plane(point=(1, 0, 0), normal=(-1, 0, 1), lower=(0, 0, -1), upper=(2, 1, 1))
    >>> round(float(bed.geometry(0.01).volume), 9)
    2.0
    """

    shape: Literal["plane"] = "plane"
    point: Point3
    """a point of the plane, m"""
    normal: Point3
    """direction across the plane, out of the solid, of any length"""
    lower: Point3
    """corner of the box with the smallest coordinates, m"""
    upper: Point3
    """corner of the box with the largest coordinates, m"""

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        check_box(self.lower, self.upper)
        corners = grid(list(np.array([self.lower, self.upper]).T))
        height = np.subtract(corners, self.point) @ self.normal
        if not height.min() < 0.0 < height.max():
            raise ValueError(
                f"the plane through {self.point} across {self.normal} does not cut the box from {self.lower} to"
                f" {self.upper}; give a point in the box, and a normal that is not zero"
            )
        from trimesh.convex import convex_hull

        edges = (corners[:, None] != corners).sum(axis=2) == 1
        i, j = np.nonzero(edges & (height[:, None] < 0.0) & (height > 0.0))
        share = height[i] / (height[i] - height[j])
        cut = corners[i] + share[:, None] * (corners[j] - corners[i])
        return convex_hull(np.vstack([corners[height <= 0.0], cut]))


class Mesh(Solid):
    """The inside of a closed triangle mesh in a file (STL, OBJ or PLY), times ``scale`` and then moved by ``offset``.

    Vertices that coincide are merged, triangles without area and repeated ones left out, and all triangles turned
    the same way. A mesh with holes is refused, since its inside is not defined.
    """

    shape: Literal["mesh"] = "mesh"
    file: str
    """STL, OBJ or PLY file, looked for beside the case file"""
    scale: Length = 1.0
    """factor from the unit of the file to m, such as 0.001 for mm"""
    offset: Point3 = (0.0, 0.0, 0.0)
    """displacement after scaling, m"""
    sha256: str = ""
    """hash of the file, stored with the case so that a repeated run notices a file that has changed"""

    @model_validator(mode="before")
    @classmethod
    def _same_file(cls, given: Any) -> Any:
        if not isinstance(given, dict) or not isinstance(given.get("file"), str):
            return given
        found = digest(Path(given["file"]))
        if given.get("sha256", found) != found:
            raise ValueError(f"the mesh {given['file']} has changed since the case was stored; give the original file")
        return {**given, "sha256": found}

    def geometry(self, tolerance: float) -> Any:  # noqa: D102
        mesh = closed_mesh(Path(self.file), self.sha256).copy()
        return mesh.apply_scale(self.scale).apply_translation(self.offset)


AnyShape = Annotated[
    Polygon
    | Polyline
    | Box
    | Circle
    | Ellipse
    | Arc
    | Curve
    | PointsFile
    | Union
    | Difference
    | Sphere
    | Cylinder
    | Plane
    | Mesh,
    Field(discriminator="shape"),
]
SHAPES: dict[str, type[Shape]] = {
    model.model_fields["shape"].default: model for model in get_args(get_args(AnyShape)[0])
}
"""the shapes by name, as in ``shape = "circle"``"""

Union.model_rebuild()
Difference.model_rebuild()


def plane_area(shape: Shape, tolerance: float) -> shapely.Polygon | shapely.MultiPolygon:
    """Return the area of a closed shape in the plane.

    Raises
    ------
    ValueError
        when the shape is open or a solid.
    """
    if shape.dimension != 2:
        raise ValueError(f"{shape.shape}: a solid cannot be joined to, or cut from, a shape of the plane")
    area = shape.geometry(tolerance)
    if not isinstance(area, shapely.Polygon | shapely.MultiPolygon):
        raise ValueError(f"{shape.shape} is an open line; give a closed shape, such as a polygon, or closed = true")
    return area


def _solids(operation: str, shapes: Sequence[Shape], tolerance: float) -> Any:
    """Return the union of solids, or the difference of the first and all others, as a mesh."""
    from trimesh import boolean

    plane = [shape.shape for shape in shapes if shape.dimension != 3]
    if plane:
        raise ValueError(f"{plane[0]}: a shape of the plane cannot be joined to, or cut from, a solid")
    return getattr(boolean, operation)([shape.geometry(tolerance) for shape in shapes])


def _some(area: Any, what: str) -> Any:
    if area.is_empty or area.area <= 0.0:
        raise ValueError(f"nothing is left of the {what}; check which shapes overlap")
    return area


def check_box(lower: tuple[float, ...], upper: tuple[float, ...]) -> None:
    """Raise ValueError unless ``lower`` is below ``upper`` along every axis."""
    if len(lower) != len(upper) or any(low >= high for low, high in zip(lower, upper, strict=True)):
        raise ValueError(
            f"lower {lower} and upper {upper} do not span a box: give the same number of coordinates,"
            " each of lower smaller than that of upper"
        )


def grid(axes: Sequence[Array]) -> Array:
    """Return the points (n, dim) of the grid whose coordinates along each axis are ``axes``; the last runs fastest."""
    return np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
