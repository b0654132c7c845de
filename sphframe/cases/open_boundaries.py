"""Cases: open boundaries: what flows into a channel, what it flows out against, and which scenes can have them."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, Literal, NamedTuple, Self

import numpy as np
import shapely
from pydantic import BaseModel, ConfigDict, Field, model_validator

from sphframe.arrays import Array
from sphframe.cases.scene import Scene
from sphframe.geometry import wall_lines
from sphframe.geometry.shapes import CHORD


class OpenBoundaries(BaseModel):
    """Inflow at the left end of the fluid, outflow at its right end, along x; see :mod:`sphframe.physics.open_ends`.

    The drawn fluid holds both zones, each two supports of the kernel long: the flow is computed between them.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    velocity: Annotated[float, Field(gt=0)] | None = None
    """largest velocity of the inflow along x, m/s"""
    profile: Literal["uniform", "parabola"] = "uniform"
    """how the velocity depends on the height between the walls"""
    table: tuple[tuple[float, Annotated[float, Field(gt=0)]], ...] = ()
    """heights, m, and velocities there, m/s, in place of velocity and profile; linear in between"""
    ramp: float = Field(default=0.0, ge=0)
    """time in which the inflow grows from zero to its velocity, s"""
    pressure: float | None = None
    """pressure at the outflow, Pa; by default that at the reference density"""

    @model_validator(mode="after")
    def _one_profile(self) -> Self:
        if (self.velocity is None) == (not self.table):
            raise ValueError("give the velocity of the inflow, or a table of heights and velocities, not both")
        heights = [height for height, _ in self.table]
        if heights != sorted(set(heights)) or len(heights) == 1:
            raise ValueError("table needs two or more heights, each above the one before")
        return self

    def growth(self, time: float) -> float:
        """Return the share of the velocity that is reached at ``time``, s: half a period of a cosine."""
        return 0.5 - 0.5 * math.cos(math.pi * time / self.ramp) if time < self.ramp else 1.0

    def velocities(self, height: Array, ends: "ChannelEnds") -> Array:
        """Return the velocity (n,) at ``height`` (n,), m, when it is fully grown, m/s."""
        if self.table:
            heights, velocities = np.array(self.table).T
            return np.asarray(np.interp(height, heights, velocities))
        shape = np.ones_like(height)
        if self.profile == "parabola":
            shape = 4.0 * (height - ends.bottom) * (ends.top - height) / (ends.top - ends.bottom) ** 2
        velocity: Array = (self.velocity or 0.0) * shape
        return velocity


class ChannelEnds(NamedTuple):
    """Where the fluid is open, m: it enters at ``inflow``, leaves at ``outflow``, each with a zone of ``length``."""

    inflow: float
    outflow: float
    length: float
    bottom: float
    top: float


def zone_length(spacing: float, support: float) -> float:
    """Return the length of a zone: two supports, in whole spacings, m."""
    return math.ceil(2.0 * support / spacing - 1e-9) * spacing


def channel_ends(scene: Scene, spacing: float, support: float) -> ChannelEnds:
    """Return where the fluid of ``scene`` is open at its left and right end."""
    lower = np.min([region.bounds()[0] for region in scene.fluid], axis=0)
    upper = np.max([region.bounds()[1] for region in scene.fluid], axis=0)
    length = zone_length(spacing, support)
    return ChannelEnds(float(lower[0]) + length, float(upper[0]) - length, length, float(lower[1]), float(upper[1]))


def open_boundary_problems(case: Any, scene: Scene, support: float) -> Iterator[str]:
    """Yield why ``scene`` cannot have the open boundaries of ``case``; ``support`` of the kernel, m."""
    refused = {
        "dimension = 3; open boundaries are in 2 dimensions": case.dimension == 3,
        f"periodic = {list(case.periodic)}; leave it out": bool(case.periodic),
        f"gravity = {case.gravity}; set it to 0, fluid with a free surface is not carried through": case.weight > 0.0,
        'guards.domain = "remove"; fluid leaves at the outflow alone, set it to "stop"': case.guards.domain == "remove",
    }
    problems = [text for text, holds in refused.items() if holds]
    yield from (f"open_boundaries cannot be together with {text}" for text in problems)
    if problems:
        return
    spacing = case.particle_spacing
    ends = channel_ends(scene, spacing, support)
    width = (ends.top - ends.bottom) / spacing
    if abs(width - round(width)) > 1e-6:
        yield f"open_boundaries: the fluid is {width:.6g} spacings wide; choose a spacing that divides its width"
    if ends.outflow - ends.inflow < 2.0 * support:
        yield (
            f"open_boundaries: the fluid is too short for two zones of {ends.length:.3g} m; draw it at least"
            f" {2.0 * (ends.length + support):.3g} m long"
        )
        return
    fluid = shapely.union_all([region.geometry(CHORD * spacing) for region in scene.fluid], grid_size=1e-6 * spacing)
    lines = wall_lines(scene.walls, spacing)
    for name, left in (("inflow", ends.inflow - ends.length), ("outflow", ends.outflow)):
        zone = shapely.box(left, ends.bottom, left + ends.length, ends.top)
        if zone.difference(fluid).area > 1e-3 * spacing * ends.length:
            yield f"open_boundaries: the {name} zone, {left:.6g} to {left + ends.length:.6g} m along x, is not full"
        yield from _wall_problems(lines, name, left, ends, spacing)
    (low, _), (high, _) = scene.domain
    if low > ends.inflow - ends.length - spacing or high < ends.outflow + ends.length + spacing:
        yield f"open_boundaries: the domain {scene.domain} must reach a spacing beyond both ends of the fluid"


def _wall_problems(lines: Any, name: str, left: float, ends: ChannelEnds, spacing: float) -> Iterator[str]:
    """Yield what is wrong with the walls beside a zone: they must be its bottom and its top, and nothing else."""
    right, slack = left + ends.length, 1e-3 * spacing
    where = f"open_boundaries: the {name} zone, {left:.6g} to {right:.6g} m along x,"
    if lines.intersects(shapely.box(left, ends.bottom + slack, right, ends.top - slack)):
        yield f"{where} is crossed by a wall; move the wall, or draw the fluid longer"
    for side, height in (("below", ends.bottom), ("above", ends.top)):
        edge = shapely.LineString([(left, height), (right, height)])
        if edge.difference(lines.buffer(slack)).length > 0.01 * spacing:
            yield f"{where} has no wall {side} it, at y = {height:.6g} m; draw one, or fill the channel up to the wall"
