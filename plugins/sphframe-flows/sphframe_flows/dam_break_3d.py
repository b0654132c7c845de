"""A dam break in three dimensions: the water runs against a box that stands on the bed of the tank."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Case
from sphframe.cases import Derived, Gauge, Guards, Probe, Scene, WaterColumn, downward_gravity, quantity, with_default
from sphframe.geometry import BoxRegion, BoxWall

_SENSORS = np.array([0.021, 0.061, 0.101, 0.141]) / 0.161
"""heights of P1 to P4 on the front of the box over its own, and distances of P5 to P8 behind it over its length"""
_ACROSS = 0.176 / 0.403
"""distance of P1 to P4 from one side of the box, and of P5 to P8 from the other, over its width"""
_GAUGES = {"H1": 0.496 / 3.22, "H2": 0.992 / 3.22, "H3": 1.488 / 3.22, "H4": 2.638 / 3.22}
"""x of the gauges over the length of the tank"""
_IMPACT = (0.4, 0.6)
"""s, start and end of the impulses"""


@final
class DamBreak3D(Case):
    """Water at the right end of a tank collapses and runs against a box on the bed: the experiment of MARIN.

    Pressure is sampled at four places on the front of the box, ``P1`` (the lowest) to ``P4``, and at four on its top,
    ``P5`` to ``P8``; the height of the water on the middle line of the tank by ``H1`` (behind the box), ``H2``, ``H3``
    and ``H4`` (where the water was); all are scaled with the sizes of box and tank. The pressure at the start is that
    of a column at the instant at which its gate is removed. Water that splashes over the walls is removed.

    The default spacing is coarse: 4 spacings over the height of the box. The preset ``spheric`` has the spacing for
    which test 2 of SPHERIC asks. The measured series are not part of sphframe. ``impulses`` are the integrals of the
    pressure from 0.40 to 0.60 s, which are known from the measurement: 1391, 1127, 910 and 792 Pa s at P1 to P4.

    Source: K. M. T. Kleefsman, G. Fekken, A. E. P. Veldman, B. Iwanowski & B. Buchner (2005),
    doi:10.1016/j.jcp.2004.12.007; R. Issa & D. Violeau, SPHERIC test 2 (2006).
    """

    title: ClassVar[str] = "dam break on a box, three-dimensional"
    presets: ClassVar[Mapping[str, Mapping[str, Any]]] = {
        "spheric": {"particle_spacing": 0.55 / 30.0, "probe_interval": 0.002, "until": 6.0}
    }

    dimension: Literal[3] = quantity(3, "1", "dimension of space")
    gravity: float = downward_gravity()
    water_height: float = quantity(0.55, "m", "height H of the water column", gt=0)
    water_length: float = quantity(1.228, "m", "length of the water column", gt=0)
    tank_length: float = quantity(3.22, "m", "length of the tank", gt=0)
    tank_width: float = quantity(1.0, "m", "width of the tank", gt=0)
    tank_height: float = quantity(1.0, "m", "height of the tank's walls", gt=0)
    box_position: float = quantity(0.744, "m", "x of the middle of the box", gt=0)
    box_length: float = quantity(0.161, "m", "length of the box, along the tank", gt=0)
    box_width: float = quantity(0.403, "m", "width of the box", gt=0)
    box_height: float = quantity(0.161, "m", "height of the box", gt=0)
    sound_speed: float | None = with_default(
        Case,
        "sound_speed",
        Derived("15 sqrt(g H)", lambda case: 15.0 * math.sqrt(max(case.gravity, 1e-12) * case.water_height)),
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("water_height / 14", lambda case: case.water_height / 14.0)
    )
    until: float = with_default(Case, "until", 2.0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")
    guards: Guards = with_default(Case, "guards", Guards(domain="remove"))
    frame_interval: float = with_default(Case, "frame_interval", 0.05)
    probe_interval: float = with_default(Case, "probe_interval", 0.005)

    def scene(self) -> Scene:
        """Draw the tank with the column at its right end, the box, the sensors and the gauges."""
        tank = BoxWall(
            name="tank",
            lower=(0.0, 0.0, 0.0),
            upper=(self.tank_length, self.tank_width, self.tank_height),
            open_faces=("+z",),
        )
        front, middle = self.box_position + 0.5 * self.box_length, 0.5 * self.tank_width
        side = middle - 0.5 * self.box_width
        box = BoxWall(
            name="box",
            lower=(front - self.box_length, side, 0.0),
            upper=(front, side + self.box_width, self.box_height),
        )
        across = _ACROSS * self.box_width
        places = [
            *((front, side + across, share * self.box_height) for share in _SENSORS),
            *((front - share * self.box_length, box.upper[1] - across, self.box_height) for share in _SENSORS),
        ]
        margin, start = self.particle_spacing, self.tank_length - self.water_length
        column = WaterColumn(
            self.water_height,
            self.water_length,
            self.reference_density,
            self.gravity,
            self.reference_sound_speed(self.water_height),
        )
        return Scene(
            walls=(tank, box),
            fluid=(BoxRegion(lower=(start, 0.0, 0.0), upper=(self.tank_length, self.tank_width, self.water_height)),),
            depth=self.water_height,
            domain=(
                (-margin, -margin, -margin),
                (self.tank_length + margin, self.tank_width + margin, 3.0 * self.tank_height),
            ),
            probes=tuple(Probe(name=f"P{k}", position=place) for k, place in enumerate(places, 1)),
            gauges=tuple(
                Gauge(name=name, position=(share * self.tank_length, middle)) for name, share in _GAUGES.items()
            ),
            initial_pressure=lambda x: column.pressure(self.tank_length - x[:, 0], x[:, 2]),
        )

    def impulses(self, dataset: xr.Dataset) -> xr.DataArray:
        """Return the integrals of the pressure at each probe from 0.40 to 0.60 s, Pa s, of a run that lasts longer."""
        times = np.union1d(dataset["probe_time"].values, _IMPACT)
        pressure = dataset["probe_pressure"].interp(probe_time=times).sel(probe_time=slice(*_IMPACT))
        return pressure.integrate("probe_time").assign_attrs(units="Pa s", long_name="impulse of the pressure")
