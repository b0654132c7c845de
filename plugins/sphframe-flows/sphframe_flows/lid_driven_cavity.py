"""Flow in a cavity under a lid that slides."""

from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Case
from sphframe.cases import Benchmark, Derived, Scene, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.confined import ConfinedFlow
from sphframe_flows.solutions import mean_velocity, variable

# s/L, then u and v at Re 100, at Re 400, at Re 1000
_TABLE = np.array([
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0312, -0.02219, 0.05301, -0.04844, 0.11161, -0.11281, 0.18481),
    (0.0625, -0.04198, 0.09481, -0.09261, 0.18516, -0.20222, 0.28068),
    (0.0938, -0.0601, 0.12643, -0.13546, 0.23175, -0.28204, 0.33302),
    (0.125, -0.07713, 0.14925, -0.17876, 0.26228, -0.34782, 0.36504),
    (0.1562, -0.09358, 0.16479, -0.22244, 0.28352, -0.38423, 0.37695),
    (0.1875, -0.10982, 0.17435, -0.26394, 0.29751, -0.38453, 0.3679),
    (0.2188, -0.12595, 0.1789, -0.29856, 0.30367, -0.35745, 0.3422),
    (0.25, -0.14193, 0.17925, -0.32127, 0.30099, -0.31898, 0.30713),
    (0.2812, -0.15763, 0.1759, -0.32877, 0.28907, -0.28049, 0.26898),
    (0.3125, -0.17271, 0.16913, -0.32029, 0.26833, -0.24569, 0.23126),
    (0.3438, -0.18659, 0.15906, -0.29806, 0.24016, -0.21398, 0.19519),
    (0.375, -0.19847, 0.14573, -0.26632, 0.20658, -0.18375, 0.16056),
    (0.4062, -0.20757, 0.12903, -0.22944, 0.16951, -0.15374, 0.12667),
    (0.4375, -0.21296, 0.10878, -0.19073, 0.13057, -0.12343, 0.09297),
    (0.4688, -0.21374, 0.08493, -0.15232, 0.09113, -0.09284, 0.05934),
    (0.5, -0.20915, 0.05754, -0.11505, 0.05205, -0.06208, 0.0258),
    (0.5312, -0.19869, 0.0266, -0.07866, 0.01348, -0.03101, -0.00787),
    (0.5625, -0.18208, -0.00775, -0.04257, -0.02473, 0.00054, -0.04185),
    (0.5938, -0.15944, -0.04495, -0.00635, -0.06272, 0.0326, -0.07616),
    (0.625, -0.13126, -0.08407, 0.03024, -0.10089, 0.06523, -0.11081),
    (0.6562, -0.09804, -0.12397, 0.0675, -0.1402, 0.09874, -0.14597),
    (0.6875, -0.06024, -0.16301, 0.10546, -0.18212, 0.13355, -0.18169),
    (0.7188, -0.01831, -0.19866, 0.14364, -0.22846, 0.16988, -0.21762),
    (0.75, 0.02788, -0.22783, 0.18131, -0.281, 0.20789, -0.25339),
    (0.7812, 0.07974, -0.2473, 0.21777, -0.34, 0.24765, -0.28986),
    (0.8125, 0.14043, -0.25377, 0.25222, -0.40007, 0.28843, -0.33156),
    (0.8438, 0.21498, -0.24456, 0.28425, -0.44505, 0.32795, -0.38897),
    (0.875, 0.31056, -0.21869, 0.31686, -0.44906, 0.36254, -0.46784),
    (0.9062, 0.43589, -0.17724, 0.36504, -0.39002, 0.38903, -0.52649),
    (0.9375, 0.59747, -0.12332, 0.46964, -0.27038, 0.42296, -0.45615),
    (0.9531, 0.69103, -0.09339, 0.56164, -0.19823, 0.47241, -0.35525),
    (0.9688, 0.79194, -0.06219, 0.68728, -0.12516, 0.58102, -0.22782),
    (1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0),
])  # fmt: skip
_COLUMN = {100: 1, 400: 3, 1000: 5}


class LidDrivenCavity(ConfinedFlow):
    """Fluid in a square cavity of side L whose lid slides along x with the speed U, full of fluid, without gravity.

    The solution is a table of a stationary flow: u on the vertical, v on the horizontal centre line, over U, at the
    Reynolds numbers U L / nu of 100, 400 and 1000. It was computed for this project with the stream function and second
    differences on 128^2 and 192^2 cells, extrapolated, and differs by 4e-4 in u and 1e-4 in v from O. Botella,
    R. Peyret (1998), doi:10.1016/S0045-7930(98)00002-4, at Re 1000. The run's profiles are means over the last fifth of
    its frames. ``errors``: RMS of both over U.
    """

    title: ClassVar[str] = "cavity under a sliding lid"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "lid-driven-cavity": Benchmark(
            "u",
            "A closed vessel with no slip, and corners where a wall slides past another.",
            (0.05, 0.025),
            {"until": 10.0},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    side: float = quantity(1.0, "m", "side L of the cavity", gt=0)
    lid_speed: float = quantity(1.0, "m s-1", "speed U of the lid", gt=0)
    reynolds_number: Literal[100, 400, 1000] = quantity(100, "1", "Reynolds number U L / nu")
    kinematic_viscosity: float = with_default(
        Case,
        "kinematic_viscosity",
        Derived("lid_speed side / reynolds_number", lambda case: case.lid_speed * case.side / case.reynolds_number),
    )
    sound_speed: float | None = with_default(
        Case, "sound_speed", Derived("10 lid_speed", lambda case: 10.0 * case.lid_speed)
    )
    background_pressure: float = quantity(
        Derived("rho U^2", lambda case: case.reference_density * case.lid_speed**2), "Pa", "pressure at rest"
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("side / 40", lambda case: case.side / 40.0)
    )
    until: float = with_default(
        Case, "until", Derived("20 side / lid_speed", lambda case: 20.0 * case.side / case.lid_speed)
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 50", lambda case: case.until / 50.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    def scene(self) -> Scene:
        """Draw the cavity."""
        side, pressure = self.side, self.background_pressure
        corners = ((0.0, side), (0.0, 0.0), (side, 0.0), (side, side))
        return Scene(
            walls=(
                PolygonWall(name="box", points=corners),
                PolygonWall(name="lid", points=((side, side), (0.0, side)), surface_velocity=(self.lid_speed, 0.0)),
            ),
            fluid=(PolygonRegion(points=corners, pressure=pressure),),
            depth=side,
            domain=((-0.1 * side, -0.1 * side), (1.1 * side, 1.1 * side)),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return ``u`` over the height y and ``v`` over x, on the centre lines."""
        first = _COLUMN[self.reynolds_number]
        s, u, v = _TABLE[1:-1, [0, first, first + 1]].T
        return xr.Dataset(
            {
                "u": variable("y", u * self.lid_speed, "m s-1", "horizontal velocity at x = L/2"),
                "v": variable("x", v * self.lid_speed, "m s-1", "vertical velocity at y = L/2"),
            },
            coords={name: variable(name, s * self.side, "m", name) for name in ("y", "x")},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        exact, half = self.exact(dataset), 0.5 * self.side
        frames = max(dataset.sizes["time"] // 5, 1)
        y, x = exact["y"].values, exact["x"].values
        u = mean_velocity(dataset, np.column_stack([np.full_like(y, half), y]), frames)[:, 0]
        v = mean_velocity(dataset, np.column_stack([x, np.full_like(x, half)]), frames)[:, 1]
        return exact.assign(
            u=variable("y", u, "m s-1", "horizontal velocity at x = L/2"),
            v=variable("x", v, "m s-1", "vertical velocity at y = L/2"),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the RMS differences over the speed of the lid."""
        exact, run = self.exact(dataset), self.measured(dataset)
        return {name: float(np.sqrt(((run[name] - exact[name]) ** 2).mean())) / self.lid_speed for name in ("u", "v")}
