"""A solitary wave against a seawall on a spring."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

from sphframe import create
from sphframe.cases import Derived, Scene, quantity, with_default
from sphframe.geometry import PolygonWall
from sphframe_waves.flume import SolitaryWaveFlume


class SolitaryWaveMovableWall(SolitaryWaveFlume):
    """A solitary wave pushes a vertical seawall against a spring: section 4.4 of Huang et al. (2019).

    The seawall is the body ``seawall``, whose displacement ``body_position`` starts at zero, and the wall of that name,
    with its ``wall_force``. It stands still until the force exceeds ``threshold_ratio`` times the hydrostatic force
    rho g d^2 / 2 (the body ``spring-mass``). The bed continues behind it. Probe P0 lies on the bed at the
    toe of the wall where it is drawn; probes do not move.

    Departs from the paper, which does not give the wave's height: 0.3 d by default, with which the wall begins to move
    at 2.1 s, within the paper's 2.0 to 2.2 s. A piston by Rayleigh's theory makes the wave.

    Source: X. Huang et al. (2019), doi:10.3390/w11051110, section 4.4; D. Liang et al. (2017),
    doi:10.1016/j.jfluidstructs.2016.12.009.
    """

    title: ClassVar[str] = "solitary wave against a seawall on a spring"
    presets: ClassVar[Mapping[str, Mapping[str, Any]]] = {
        "paper": {
            "depth": 0.2,
            "wave_height": 0.06,
            "tank_length": 2.5,
            "particle_spacing": 0.008,
            "smoothing_length_ratio": 1.3,
            "time_step": 5e-4,
            "sound_speed": 10.0 * (9.81 * 0.2) ** 0.5,
            "hydrostatic_lift": "mirror",
            "ghost_velocity": "interpolated",
            "wall_mass": 250.0,
            "spring_stiffness": 10.0,
            "threshold_ratio": 1.1,
            "until": 4.5,
            "probe_interval": 0.002,
        }
    }

    depth: float = with_default(SolitaryWaveFlume, "depth", 0.2)
    wave_height: float = with_default(
        SolitaryWaveFlume, "wave_height", Derived("0.3 depth", lambda case: 0.3 * case.depth)
    )
    tank_length: float = quantity(2.5, "m", "distance from the paddle to the seawall, both at the start", gt=0)
    wall_mass: float = quantity(250.0, "kg m-1", "mass of the seawall per metre of width", gt=0)
    spring_stiffness: float = quantity(10.0, "N m-2", "stiffness of the spring per metre of width", ge=0)
    threshold_ratio: float = quantity(
        1.1, "1", "force at which the seawall begins to move, over the hydrostatic force", ge=0
    )
    wall_travel: float = quantity(
        Derived("tank_length", lambda case: case.tank_length), "m", "length of the bed behind the seawall", gt=0
    )
    probe_heights: tuple[float, ...] = quantity((0.0,), "m", "heights of the pressure probes at the seawall's start")
    until: float = with_default(SolitaryWaveFlume, "until", 4.5)

    def scene(self) -> Scene:
        """Draw the flume."""
        length = self.tank_length
        wall = create(
            "rigid_bodies",
            "spring-mass",
            mass=self.wall_mass,
            stiffness=self.spring_stiffness,
            threshold=self.threshold_ratio * 0.5 * self.reference_density * self.gravity * self.depth**2,
        )
        seawall = PolygonWall(
            name="seawall", points=((length, 0.0), (length, self.tank_height)), body="seawall", one_sided=True
        )
        travel = math.ceil(self.wall_travel / self.particle_spacing) * self.particle_spacing
        bed = PolygonWall(name="bed", points=((self.bed_start(), 0.0), (length + travel, 0.0)))
        return self.flume(90.0, (bed, seawall), {"seawall": wall}, travel=travel, seawall_body="seawall")
