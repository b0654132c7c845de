"""A solitary wave against a fixed seawall."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

from sphframe.cases import Scene, quantity
from sphframe.geometry import PolygonWall
from sphframe_waves.flume import SolitaryWaveFlume


class SolitaryWaveFixedWall(SolitaryWaveFlume):
    """A solitary wave runs against a seawall, vertical or leaning: section 4.3 of Huang et al. (2019).

    The seawall and the bed are one wall, ``tank``; the x component of ``wall_force`` on it is the seawall's alone,
    since a bed without friction takes none.

    Departs from the paper, which names neither paddle nor sound speed: a piston by Rayleigh's theory, 20 sqrt(g d).

    Source: X. Huang et al. (2019), doi:10.3390/w11051110, section 4.3.

    Examples
    --------
    The preset's flume holds the paper's 25,180 particles; the wave comes to x = 10 m after 5.95 s:

    >>> from sphframe import load_case
    >>> from sphframe.geometry import fill
    >>> case = load_case("solitary-wave-fixed-wall", "paper")
    >>> len(fill(case.scene().fluid[0], case.particle_spacing).volume), round(case.paddle().arrival_time(10.0), 2)
    (25180, 5.95)
    """

    title: ClassVar[str] = "solitary wave against a fixed seawall"
    presets: ClassVar[Mapping[str, Mapping[str, Any]]] = {
        "paper": {
            "depth": 0.25,
            "wave_height": 0.15,
            "wall_angle": 120.0,
            "tank_length": 10.0,
            "particle_spacing": 0.01,
            "smoothing_length_ratio": 1.3,
            "time_step": 1e-4,
            "hydrostatic_lift": "mirror",
            "ghost_velocity": "interpolated",
            "probe_heights": (0.05, 0.15),
        }
    }

    wall_angle: float = quantity(
        90.0, "degrees", "angle of the seawall with the bed, within the water: 90 is vertical, more leans outwards",
        ge=30.0, le=150.0,
    )  # fmt: skip

    def scene(self) -> Scene:
        """Draw the flume."""
        height, angle = self.tank_height, math.radians(self.wall_angle)
        rim = self.tank_length - height * math.cos(angle) / math.sin(angle)
        tank = PolygonWall(name="tank", points=((self.bed_start(), 0.0), (self.tank_length, 0.0), (rim, height)))
        return self.flume(self.wall_angle, (tank,), {})
