"""Geometry: regions of fluid, closed shapes with the state in which their fluid starts."""

from typing import Annotated, Any, Self

from pydantic import BaseModel, Field, model_validator

from sphframe.geometry.shapes import (
    Box,
    Circle,
    Curve,
    Cylinder,
    Difference,
    Ellipse,
    Mesh,
    Plane,
    PointsFile,
    Polygon,
    Sphere,
    Union,
    plane_area,
)


class InitialState(BaseModel):
    """How the fluid of a region starts: hydrostatic below a ``level``, or at a uniform ``pressure``, and its velocity.

    By default the fluid is at rest below the highest point of all regions that it touches.
    """

    level: float | None = None
    """height of the still water level, m"""
    pressure: float | None = None
    """uniform pressure, Pa"""
    velocity: tuple[float, ...] | None = None
    """m/s"""

    @model_validator(mode="after")
    def _one_state_of_an_area(self) -> Self:
        region: Any = self
        if region.dimension == 2:
            plane_area(region, region.coarse)
        if self.level is not None and self.pressure is not None:
            raise ValueError("level and pressure are both given; a region is hydrostatic or has a uniform pressure")
        if self.level is not None and self.level <= region.bounds()[0][-1]:
            raise ValueError(f"level = {self.level:g} m lies below the region; give the height of its still water")
        if self.velocity is not None and len(self.velocity) != region.dimension:
            raise ValueError(f"velocity {self.velocity} must have {region.dimension} components, as the shape has")
        return self


class PolygonRegion(Polygon, InitialState):
    """A polygon full of fluid."""


class BoxRegion(Box, InitialState):
    """A rectangle (2-D) or box (3-D) full of fluid."""


class CircleRegion(Circle, InitialState):
    """A disc of fluid."""


class EllipseRegion(Ellipse, InitialState):
    """An ellipse full of fluid."""


class CurveRegion(Curve, InitialState):
    """The area within a closed curve, full of fluid."""


class PointsRegion(PointsFile, InitialState):
    """The area within the points of a file, full of fluid."""


class UnionRegion(Union, InitialState):
    """Several closed shapes full of fluid, as one region."""


class DifferenceRegion(Difference, InitialState):
    """A closed shape without others, full of fluid."""


class SphereRegion(Sphere, InitialState):
    """A ball of fluid (3-D)."""


class CylinderRegion(Cylinder, InitialState):
    """A circular cylinder full of fluid (3-D)."""


class PlaneRegion(Plane, InitialState):
    """The part of a box behind a plane, full of fluid (3-D)."""


class MeshRegion(Mesh, InitialState):
    """The inside of a triangle mesh, full of fluid (3-D)."""


Region = Annotated[
    PolygonRegion
    | BoxRegion
    | CircleRegion
    | EllipseRegion
    | CurveRegion
    | PointsRegion
    | UnionRegion
    | DifferenceRegion
    | SphereRegion
    | CylinderRegion
    | PlaneRegion
    | MeshRegion,
    Field(discriminator="shape"),
]
