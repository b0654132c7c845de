"""Cases: the dam break against a vertical wall."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from sphframe.arrays import Array
from sphframe.cases.box_tank import box_tank, domain_above, water_box, with_width
from sphframe.cases.case import Case
from sphframe.cases.dam_break_series import WaterColumn
from sphframe.cases.parameters import Derived, downward_gravity, quantity, with_default
from sphframe.cases.scene import Diagnostic, Probe, Scene
from sphframe.interfaces import Fields


class DamBreak(Case):
    """A column of water, 1.2 m by 0.6 m, collapses and runs against a wall: section 4.2 of Huang et al. (2019).

    The pressure at the start is that of the corrected series (:mod:`sphframe.cases.dam_break_series`), as if the gate
    were removed in an instant. ``P1`` is Buchner's sensor, a disc of 90 mm centred 160 mm above the bed of the right
    wall (for another water height: 0.15 H and 4/15 H), over which the pressure is averaged; ``P1-point`` is its centre
    alone. ``P1-shifted`` is the same disc half its diameter lower, its top where the sensor's centre was: published
    simulations of this experiment compare there (Adami et al. 2012, doi:10.1016/j.jcp.2012.05.005, sample at 0.19 H,
    since M. Greco found that it agrees better), and the pressure decreases steeply with height there.

    Diagnostics: ``front_position``, the x of the surge front, and ``column_height``, the height of the water at the
    left wall. Both use the water within max(H/20, 3 dx) of the bed (wall) and end at the first gap wider than two
    smoothing lengths: particles nearer than that still interact, and a drop ahead of the surge is not counted. Half a
    spacing is added, so that they start as L and H and the front at the wall is there when it is within a spacing of
    ``tank_length``.

    Source: Huang et al. (2019), doi:10.3390/w11051110, section 4.2; B. Buchner, Green water on ship-type offshore
    structures, PhD thesis, TU Delft (2002).

    Examples
    --------
    >>> round(DamBreak().tank_length, 4), round(DamBreak(water_height=0.3).until, 3)
    (3.2196, 1.224)
    """

    title: ClassVar[str] = "dam break against a vertical wall"
    presets: ClassVar[Mapping[str, Mapping[str, Any]]] = {
        "paper": {
            "particle_spacing": 0.004,
            "smoothing_length_ratio": 1.3,
            "time_step": 1e-4,
            "hydrostatic_lift": "mirror",
            "ghost_velocity": "interpolated",
            "frame_interval": 0.02,
            "probe_interval": 0.001,
        }
    }

    gravity: float = downward_gravity()
    water_height: float = quantity(0.6, "m", "height H of the water column", gt=0)
    water_length: float = quantity(
        Derived("2 water_height", lambda case: 2.0 * case.water_height), "m", "length L of the water column", gt=0
    )
    tank_length: float = quantity(
        Derived("5.366 water_height", lambda case: 5.366 * case.water_height), "m", "length of the tank", gt=0
    )
    tank_height: float = quantity(
        Derived("3 water_height", lambda case: 3.0 * case.water_height), "m", "height of the walls", gt=0
    )
    tank_width: float = quantity(
        Derived("water_height / 2", lambda case: 0.5 * case.water_height), "m", "width of the tank, in 3-D", gt=0
    )
    particle_spacing: float = with_default(Case, "particle_spacing", 0.01)
    until: float = with_default(
        Case, "until", Derived("7 sqrt(water_height / gravity)", lambda case: 7.0 * case.time_scale)
    )
    frame_interval: float = with_default(Case, "frame_interval", 0.02)
    probe_interval: float = with_default(Case, "probe_interval", 0.001)

    @property
    def time_scale(self) -> float:
        """sqrt(H/g), in s; one second without gravity."""
        return math.sqrt(self.water_height / self.gravity) if self.gravity > 0.0 else 1.0

    def references(self) -> Mapping[str, Path]:
        """Return the pressure that Buchner measured at P1, for a tank and a column of the shape of his."""
        shape = np.array([self.water_length, self.tank_length]) / self.water_height
        measured = Path(__file__).parent / "data" / "buchner2002.csv"
        return {"P1 measured by Buchner (2002)": measured} if np.allclose(shape, [2.0, 5.366], rtol=0.01) else {}

    def scene(self) -> Scene:
        """Draw the tank, the column at its left end, the sensor at its right end, and the diagnostics."""
        dim, height, length = self.dimension, self.water_height, self.water_length
        tank = box_tank(dim, self.tank_length, self.tank_width, self.tank_height)
        sound_speed = self.reference_sound_speed(height)
        column = WaterColumn(height, length, self.reference_density, self.gravity, sound_speed)
        band = max(0.05 * height, 3.0 * self.particle_spacing)
        gap = 2.0 * self.smoothing_length_ratio * self.particle_spacing

        def front_position(fluid: Fields) -> float:
            near_bed = fluid.position[:, -1] < band
            return connected_extent(fluid.position[near_bed, 0], gap) + 0.5 * self.particle_spacing

        def column_height(fluid: Fields) -> float:
            near_wall = fluid.position[:, 0] < band
            return connected_extent(fluid.position[near_wall, -1], gap) + 0.5 * self.particle_spacing

        sensor, shifted = (
            with_width(dim, self.tank_length, 0.5 * self.tank_width, height * share)
            for share in (4.0 / 15.0, 4.0 / 15.0 - 0.075)
        )
        upward = with_width(dim, 0.0, 0.0, 1.0)
        return Scene(
            walls=(tank,),
            fluid=(water_box(dim, length, self.tank_width, height),),
            depth=height,
            domain=domain_above(tank, margin=self.particle_spacing),
            probes=(
                Probe(name="P1", position=sensor, radius=0.075 * height, tangent=upward),
                Probe(name="P1-point", position=sensor),
                Probe(name="P1-shifted", position=shifted, radius=0.075 * height, tangent=upward),
            ),
            initial_pressure=lambda position: column.pressure(position[:, 0], position[:, -1]),
            diagnostics=(
                Diagnostic("front_position", "m", "x of the surge front", front_position),
                Diagnostic("column_height", "m", "height of the water at the left wall", column_height),
            ),
        )


def connected_extent(coordinate: Array, gap: float) -> float:
    """Return how far the particles reach from zero without a gap wider than ``gap``.

    Parameters
    ----------
    coordinate
        distances of the particles (n,), in m.
    gap
        widest gap that is bridged, in m; also that from zero to the first particle.

    Returns
    -------
    float
        The distance of the last particle before the first wide gap, in m; 0 where nothing is connected to zero.

    Examples
    --------
    >>> connected_extent(np.array([0.3, 0.1, 0.2, 0.9]), gap=0.25)
    0.3
    """
    reached = np.concatenate([[0.0], np.sort(coordinate)])
    wide = np.flatnonzero(np.diff(reached) > gap)
    return float(reached[wide[0]] if wide.size else reached[-1])
