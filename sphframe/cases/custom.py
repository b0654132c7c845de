"""Cases: a case whose walls, fluid, bodies, probes and gauges are given as data."""

from collections.abc import Iterable
from typing import ClassVar

import numpy as np

from sphframe.arrays import Array
from sphframe.cases.case import Case
from sphframe.cases.parameters import Component, Derived, quantity, with_default
from sphframe.cases.scene import Gauge, Probe, Scene, WallPart
from sphframe.errors import InputError
from sphframe.geometry import Region, Wall


class Custom(Case):
    """Walls, fluid, bodies, probes and gauges, as fields here or as tables of a TOML file.

    All lengths in m. The side of a wall on which fluid is at the start is wet; a box wall contains the fluid. Bodies
    carry the walls that name them. Fluid fills closed shapes (``sphframe show circle`` describes one and names the
    others), each with its own ``level`` (m) or ``pressure`` (Pa) and ``velocity`` (m/s); by default it starts
    at rest, below the highest point of all regions that touch.

    Examples
    --------
    A tank one metre long with a slope at its right end:

    >>> from sphframe.geometry import PolygonRegion, PolygonWall
    >>> case = Custom(
    ...     particle_spacing=0.02,
    ...     until=1.0,
    ...     walls=[PolygonWall(name="tank", points=[(0, 0.5), (0, 0), (1, 0), (1.5, 0.5)])],
    ...     fluid=[PolygonRegion(points=[(0, 0), (1, 0), (1.3, 0.3), (0, 0.3)])],
    ...     probes=[{"name": "corner", "position": (0, 0)}],
    ... )
    >>> case.scene().depth
    0.3
    """

    title: ClassVar[str] = "walls, fluid, bodies, probes and gauges of your own"

    walls: tuple[Wall, ...] = quantity(..., "m", "walls of any shape; none only in a periodic case")
    fluid: tuple[Region, ...] = quantity(..., "m", "regions full of fluid, any closed shapes", min_length=1)
    bodies: dict[str, Component] = quantity({}, "1", "bodies that carry walls, by the name that the walls refer to")
    probes: tuple[Probe, ...] = quantity((), "m", "pressure sensors on walls")
    gauges: tuple[Gauge, ...] = quantity((), "m", "gauges of the free surface")
    wall_parts: tuple[WallPart, ...] = quantity((), "m", "parts of walls on which force and moment are recorded")
    depth: float | None = quantity(
        None, "m", "still water depth H, the scale of pressure; by default the fluid's vertical extent", gt=0
    )
    domain: tuple[tuple[float, ...], tuple[float, ...]] | None = quantity(
        None,
        "m",
        "corners of the box that no particle may leave; by default around all walls, twice as high; in periodic"
        " directions its extent is the period, by default that of the fluid",
    )
    frame_interval: float = with_default(
        Case, "frame_interval", Derived("until / 100", lambda case: case.until / 100.0)
    )
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 2000", lambda case: case.until / 2000.0)
    )

    def scene(self) -> Scene:
        """Return what was given, with its bodies made."""
        self._check_dimensions()
        lower = np.min([region.bounds()[0] for region in self.fluid], axis=0)
        upper = np.max([region.bounds()[1] for region in self.fluid], axis=0)
        levels = (region.level for region in self.fluid if region.level is not None)
        return Scene(
            walls=self.walls,
            fluid=self.fluid,
            depth=self.depth or self._vertical_extent(lower, upper, levels),
            domain=self.domain or self._around_everything(lower, upper),
            probes=self.probes,
            gauges=self.gauges,
            wall_parts=self.wall_parts,
            bodies={name: body.create("rigid_bodies") for name, body in self.bodies.items()},
        )

    def _check_dimensions(self) -> None:
        """Raise an error if some parts are drawn in 2-D and others in 3-D, which have no common bounds."""
        parts = [(f"fluid[{number}]", region.dimension) for number, region in enumerate(self.fluid)]
        parts += [(f"wall {wall.name!r}", wall.dimension) for wall in self.walls]
        if len({found for _, found in parts}) > 1:
            wrong = [f"{part} has {found} coordinates" for part, found in parts if found != self.dimension]
            raise InputError(f"{', '.join(wrong)}, but dimension = {self.dimension} needs {self.dimension}")

    def _vertical_extent(self, lower: Array, upper: Array, levels: Iterable[float]) -> float:
        """Return the extent of the fluid against gravity, m."""
        if self.upward[-1] == 1.0:
            return max([float(upper[-1]), *levels]) - float(lower[-1])
        return float(np.abs(self.upward) @ (upper - lower))

    def _around_everything(self, lower: Array, upper: Array) -> tuple[tuple[float, ...], tuple[float, ...]]:
        corners = np.vstack([*(corner for wall in self.walls for corner in wall.bounds()), lower, upper])
        low, high = corners.min(axis=0), corners.max(axis=0)
        extent = high - low
        if self.upward[-1] < 1.0:  # fluid may be thrown to all sides
            high, low = high + extent, low - extent
        else:
            high[-1] += extent[-1]
        margin = self.particle_spacing
        repeats = [axis in self.periodic for axis in "xyz"[: len(low)]]
        low, high = np.where(repeats, lower, low - margin), np.where(repeats, upper, high + margin)
        return tuple(low.tolist()), tuple(high.tolist())
