"""What the solitary-wave flumes have in common."""

import math
from collections.abc import Callable, Mapping
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from sphframe import Array, Case, RigidBody
from sphframe.cases import Derived, Diagnostic, Fields, Gauge, Probe, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_waves.solitary_wave_paddle import SolitaryWavePaddle


class SolitaryWaveFlume(Case):
    """A flume with a piston at its left end and a seawall at its right end, in two dimensions.

    The paddle starts at t = 0 by the convention of :class:`sphframe_waves.SolitaryWavePaddle`, at x = 0 or up to half
    a particle spacing from it, so that a whole number of particles fits between it and the seawall, which rises from
    the bed at x = ``tank_length``. In addition to what every case records, the output holds
    ``gauge_elevation`` at gauges G1, G2, ... along the flume, ``probe_pressure`` at P0, P1, ... on the seawall, and the
    diagnostic ``run_up``.
    """

    dimension: Literal[2] = quantity(2, "1", "dimension of space; wave flumes are two-dimensional")
    gravity: float = downward_gravity()
    depth: float = quantity(0.25, "m", "still water depth d", gt=0)
    wave_height: float = quantity(0.075, "m", "height A of the wave that the paddle is to make", gt=0)
    wave_theory: Literal["rayleigh", "boussinesq"] = quantity("rayleigh", "1", "theory of the paddle's motion")
    tank_length: float = quantity(10.0, "m", "distance from the paddle at the start to the seawall's toe", gt=0)
    tank_height: float = quantity(
        Derived("depth + 4 wave_height", lambda case: case.depth + 4.0 * case.wave_height),
        "m",
        "height of paddle and seawall",
        gt=0,
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 25", lambda case: case.depth / 25.0)
    )
    gauge_positions: tuple[float, ...] = quantity(
        Derived(
            "nine, a tenth of tank_length apart", lambda case: tuple(case.tank_length * k / 10.0 for k in range(1, 10))
        ),
        "m",
        "distances of the free-surface gauges from the paddle at the start",
    )
    probe_heights: tuple[Annotated[float, Field(ge=0)], ...] = quantity(
        Derived("0.2 and 0.6 depth", lambda case: (0.2 * case.depth, 0.6 * case.depth)),
        "m",
        "heights of the pressure probes on the seawall above the bed",
    )
    until: float = with_default(
        Case,
        "until",
        Derived(
            "arrival at the wall + 6 sqrt(depth / gravity)",
            lambda case: case.paddle().arrival_time(case.tank_length) + 6.0 * math.sqrt(case.depth / case.gravity),
        ),
    )
    frame_interval: float = with_default(Case, "frame_interval", 0.1)
    probe_interval: float = with_default(Case, "probe_interval", 0.005)

    def paddle(self) -> SolitaryWavePaddle:
        """Return the paddle, which computes the theoretical speed and time of arrival of the wave."""
        return SolitaryWavePaddle(
            wave_height=self.wave_height, depth=self.depth, theory=self.wave_theory, gravity=self.gravity
        )

    def flume(
        self,
        angle: float,
        walls: tuple[PolygonWall, ...],
        bodies: Mapping[str, RigidBody],
        travel: float = 0.0,
        seawall_body: str | None = None,
    ) -> Scene:
        """Return a flume with a seawall at ``angle`` (degrees, in the water) to the bed; it may move ``travel`` m."""
        length, depth, height = self.tank_length, self.depth, self.tank_height
        toe = np.array([length, 0.0])
        upward = np.array([-math.cos(math.radians(angle)), math.sin(math.radians(angle))])

        def on_wall(z: float) -> tuple[float, float]:
            x, y = toe + z / upward[1] * upward
            return (round(float(x), 12), round(float(y), 12))

        start = self.paddle_start()
        contact = run_up_along(toe, upward, depth, self.particle_spacing, self.smoothing_length_ratio)
        margin = self.particle_spacing
        right = max(length, on_wall(height)[0]) + travel
        return Scene(
            walls=(
                PolygonWall(name="paddle", points=((start, height), (start, 0.0)), body="paddle", one_sided=True),
                *walls,
            ),
            fluid=(PolygonRegion(points=((start, 0.0), (length, 0.0), on_wall(depth), (start, depth))),),
            depth=depth,
            domain=((-margin, -margin), (right + margin, 2.0 * height)),
            probes=tuple(Probe(name=f"P{i}", position=on_wall(z)) for i, z in enumerate(self.probe_heights)),
            gauges=tuple(Gauge(name=f"G{i + 1}", position=(x,)) for i, x in enumerate(self.gauge_positions)),
            bodies={"paddle": self.paddle(), **bodies},
            diagnostics=(
                Diagnostic(
                    "run_up", "m", "height of the water on the seawall above still water", contact, seawall_body
                ),
            ),
        )

    def paddle_start(self) -> float:
        """Return the x at which the paddle starts, m."""
        return self.tank_length - round(self.tank_length / self.particle_spacing) * self.particle_spacing

    def bed_start(self) -> float:
        """Return the x at which the bed begins, behind the paddle, so that ghosts fill the corner between them."""
        return self.paddle_start() - 10.0 * self.particle_spacing


def run_up_along(toe: Array, upward: Array, depth: float, spacing: float, ratio: float) -> Callable[[Fields], float]:
    """Return the function that measures the height of the water on a wall above still water, m; -depth where dry.

    It is read on a line parallel to the wall, two smoothing lengths within the water, where the wall does not
    truncate the kernel: there the filling sum_j W_j dx^2 is one in the water and one half at its surface. Nearer to the
    wall, the outermost column of particles may stand up to one spacing higher.

    Parameters
    ----------
    toe
        point (2,) of the wall on the bed, m; ``upward`` (2,) unit vector along the wall.
    depth
        m.
    spacing
        m.
    ratio
        smoothing length over spacing.
    """
    h, step = ratio * spacing, 0.25 * spacing
    inward = np.array([-upward[1], upward[0]])
    start = toe + 2.0 * h * inward

    def run_up(fluid: Fields) -> float:
        offset = fluid.position - start
        along, across = offset @ upward, offset @ inward
        near = np.abs(across) < 3.0 * h
        if not np.any(near):
            return -depth
        s = np.arange(0.0, max(float(along[near].max()), 0.0) + 3.0 * h + step, step)
        q2 = ((s[:, None] - along[near]) ** 2 + across[near] ** 2) / h**2
        filling = np.where(q2 < 9.0, np.exp(-q2), 0.0).sum(axis=1) * spacing**2 / (math.pi * h**2)
        wet = np.flatnonzero(filling >= 0.5)
        if not len(wet):
            return -depth
        k = int(wet[-1])
        edge = s[k] + step * (filling[k] - 0.5) / (filling[k] - filling[k + 1])
        return float(start[1] + edge * upward[1] - depth)

    return run_up
