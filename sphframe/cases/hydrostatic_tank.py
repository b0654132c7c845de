"""Cases: still water in a tank."""

from collections.abc import Mapping
from typing import Any, ClassVar

from sphframe.cases.box_tank import box_tank, domain_above, water_box, with_width
from sphframe.cases.case import Case
from sphframe.cases.parameters import Derived, downward_gravity, quantity, with_default
from sphframe.cases.scene import Probe, Scene


class HydrostaticTank(Case):
    """Water at rest, 1 m by 0.3 m, section 4.1 of Huang et al. (2019).

    It starts from the compressible rest state, so nothing should move: any motion is an error of the boundary.
    Probes P0..P3 lie on the left wall at 0, 1/3, 2/3 and 5/6 of the depth above the bed, where the rest pressure is
    2943, 1962, 981 and 490.5 Pa. P0 lies in the corner.

    Departs from the paper, which gives no sound speed: 20 sqrt(g H); its preset uses the paper's lift, ``mirror``.

    Source: Huang et al. (2019), doi:10.3390/w11051110, section 4.1.

    Examples
    --------
    >>> [probe.position for probe in HydrostaticTank().scene().probes]
    [(0.0, 0.0), (0.0, 0.1), (0.0, 0.2), (0.0, 0.25)]
    """

    title: ClassVar[str] = "still water in a rectangular tank"
    presets: ClassVar[Mapping[str, Mapping[str, Any]]] = {
        "paper": {
            "particle_spacing": 0.01,
            "smoothing_length_ratio": 1.3,
            "time_step": 1e-4,
            "until": 35.0,
            "hydrostatic_lift": "mirror",
            "ghost_velocity": "interpolated",
            "frame_interval": 0.5,
            "probe_interval": 0.01,
        }
    }

    gravity: float = downward_gravity()
    water_depth: float = quantity(0.3, "m", "depth of the water", gt=0)
    tank_length: float = quantity(1.0, "m", "length of the tank", gt=0)
    tank_width: float = quantity(0.3, "m", "width of the tank, in 3-D", gt=0)
    tank_height: float = quantity(
        Derived("4/3 water_depth", lambda case: case.water_depth * 4.0 / 3.0), "m", "height of the walls", gt=0
    )
    particle_spacing: float = with_default(Case, "particle_spacing", 0.01)
    until: float = with_default(Case, "until", 2.0)
    frame_interval: float = with_default(Case, "frame_interval", 0.1)
    probe_interval: float = with_default(Case, "probe_interval", 0.002)

    def scene(self) -> Scene:
        """Draw a tank full of water with four probes on its left wall."""
        dim, depth = self.dimension, self.water_depth
        tank = box_tank(dim, self.tank_length, self.tank_width, self.tank_height)
        heights = (0.0, depth / 3.0, depth * 2.0 / 3.0, depth * 5.0 / 6.0)
        return Scene(
            walls=(tank,),
            fluid=(water_box(dim, self.tank_length, self.tank_width, depth),),
            depth=depth,
            domain=domain_above(tank, margin=self.particle_spacing),
            probes=tuple(
                Probe(name=f"P{i}", position=with_width(dim, 0.0, 0.5 * self.tank_width, round(height, 12)))
                for i, height in enumerate(heights)
            ),
        )
