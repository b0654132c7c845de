"""A dam break, beside a published computation of the pressure on the far wall."""

import math
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Case
from sphframe.analysis import running_mean
from sphframe.cases import Benchmark, Derived, ExactCase, Probe, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable

_HEIGHTS = {"P1": 0.01, "P2": 0.05, "P3": 0.1, "P4": 0.267}
_MEASURED = ("P1", "P3", "P4")
_DATA = Path(str(files("sphframe_flows") / "data"))
_WINDOW = (2.3, 6.6)
_MEAN_OVER = 0.1


@final
class DamBreakImpact(ExactCase):
    """A column of water, 2 H by H, collapses and runs against the wall of a tank of length 5.366 H.

    ``exact`` is the computation of De Courcy et al. (2024) with 400 particles over H: the pressure on the wall at 0.01,
    0.05, 0.1 and 0.267 H. It is no measurement. Experiments with this tank (Lobovsky et al. 2014,
    doi:10.1016/j.jfluidstructs.2014.03.009) have a mean of 0.63 rho g H at 0.01 H from 3.4 to 4.6 sqrt(H/g), where
    published computations agree on 1.0 whatever their walls; so methods are compared with a computation. The column
    starts in hydrostatic equilibrium. ``errors``: ``pressure``, RMS of the differences of running means over
    0.1 sqrt(H/g) at all four places, from 2.3 to 6.6 sqrt(H/g), over rho g H, and that at each place.

    Source: J. J. De Courcy, T. C. S. Rendall, L. Constantin, B. Titurus & J. E. Cooper (2024),
    doi:10.1016/j.cma.2023.116700.
    """

    title: ClassVar[str] = "dam break beside a published computation"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "dam-break-impact": Benchmark(
            "pressure", "Everything at once: a jet on a wall, and the wave that falls back.", (0.02, 0.0125)
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    water_height: float = quantity(0.6, "m", "height H of the column", gt=0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("water_height / 40", lambda case: case.water_height / 40.0)
    )
    until: float = with_default(Case, "until", Derived("6.7 sqrt(H/g)", lambda case: 6.7 * case.time_scale))
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("sqrt(H/g) / 200", lambda case: case.time_scale / 200.0)
    )

    @property
    def time_scale(self) -> float:
        """The time sqrt(H/g), s."""
        return math.sqrt(self.water_height / max(self.gravity, 1e-12))

    def references(self) -> Mapping[str, Path]:
        """Return what Lobovsky et al. measured with this tank, to be seen beside the run and the computation."""
        return {f"{name} measured by Lobovsky (2014)": _DATA / f"lobovsky2014_{name}.csv" for name in _MEASURED}

    def scene(self) -> Scene:
        """Draw tank and column."""
        high = self.water_height
        length, top = 5.366 * high, 3.0 * high
        return Scene(
            walls=(PolygonWall(name="tank", points=((0, top), (0, 0), (length, 0), (length, top))),),
            fluid=(PolygonRegion(points=((0, 0), (2.0 * high, 0), (2.0 * high, high), (0, high))),),
            depth=high,
            domain=((-0.1 * high, -0.1 * high), (length + 0.1 * high, 2.0 * top)),
            probes=tuple(Probe(name=name, position=(length, share * high)) for name, share in _HEIGHTS.items()),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the published pressure at each place over time; NaN where it is not published."""
        table = np.loadtxt(_DATA / "decourcy2024.csv", delimiter=",")
        times = dataset["probe_time"].values / self.time_scale
        scale = self.reference_density * self.gravity * self.water_height
        return xr.Dataset(
            {
                name: variable(
                    "probe_time",
                    scale * np.interp(times, table[:, 0], column, left=np.nan, right=np.nan),
                    "Pa",
                    f"pressure at {_HEIGHTS[name]} H",
                )
                for name, column in zip(_HEIGHTS, table.T[1:], strict=True)
            },
            coords={"probe_time": sample_times(dataset)},
            attrs={"label": "computed by De Courcy (2024)"},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the pressure of the run."""
        return self.exact(dataset).assign(
            {
                name: variable("probe_time", dataset["probe_pressure"].sel(probe=name).values, "Pa", "pressure")
                for name in _HEIGHTS
            }
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of the pressure; none if the run ends before the impact."""
        exact, run = self.exact(dataset), self.measured(dataset)
        times = dataset["probe_time"].values / self.time_scale
        if times[-1] < _WINDOW[0] + 1.0:
            return {}
        scale = self.reference_density * self.gravity * self.water_height
        published = times[np.isfinite(exact["P1"].values)]
        compared = slice(max(_WINDOW[0], published[0]), min(_WINDOW[1], published[-1]))
        squares = {}
        for name in _HEIGHTS:
            difference = run[name].values - np.nan_to_num(exact[name].values)
            mean = running_mean(times, difference, _MEAN_OVER, 0.05 * _MEAN_OVER).sel(t=compared)
            squares[name] = float(np.square(mean).mean()) / scale**2
        return {"pressure": math.sqrt(sum(squares.values()) / len(squares))} | {
            name: math.sqrt(value) for name, value in squares.items()
        }
