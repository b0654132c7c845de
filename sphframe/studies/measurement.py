"""Studies: measures the cost of boundary methods on the same state, of the interpolation alone and of a whole step."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import xarray as xr

from sphframe.benchmark.flow import warm_up
from sphframe.benchmark.machine import machine
from sphframe.benchmark.methods import Side, side_by_side, wet_points
from sphframe.simulation import Simulation
from sphframe.studies.tasks import PartListener, Task, made_with, wall_boundary


@dataclass(frozen=True)
class CostTask(Task):
    """Time several methods on one state of a case.

    The case runs to ``after`` (s) with its own method; every method then starts from that state. Compilation and the
    first steps are not timed. Each of ``repeats`` times all methods in turn, so that other load on the machine affects
    all of them; medians are reported. One thread is used. The time is processor time, which on a quiet machine equals
    wall-clock time; the attribute ``busy`` of the result is the ratio of wall-clock time to processor time.

    Attributes
    ----------
    methods
        the methods' components and lifts, by the name under which they are reported.
    after
        simulated time of the state at which the methods are timed, s.
    repeats
        number of measurements per method.
    """

    methods: Mapping[str, tuple[Mapping[str, Any], str]]
    after: float = 0.0
    repeats: int = 25

    alone: ClassVar[bool] = True

    @property
    def weight(self) -> float:
        """Expected work: particles times steps."""
        case = self.case()
        steps = self.after / case.until + len(self.methods) * self.repeats * 2e-4
        return super().weight * steps

    def recipe(self) -> dict[str, Any]:
        """Return all that the measurement depends on, except the machine."""
        made = {label: made_with(self._case_of(label)) for label in self.methods}
        own = {
            "clock": "processor",
            "methods": self.methods,
            "after": self.after,
            "repeats": self.repeats,
            "made_with": made,
        }
        return {**super().recipe(), **own}

    def _case_of(self, label: str) -> Any:
        return type(self.case())(**{**self.parameters, **wall_boundary(*self.methods[label])})

    def perform(self, path: Path, threads: int, on_part: PartListener) -> None:
        """Measure the times and write them."""
        import dask

        first = Simulation(self.case(), threads=1)
        warm_up(first)
        while first.time < self.after:
            first.advance()
            on_part(0.5 * first.time / self.after)
        cases = {label: self._case_of(label) for label in self.methods}
        side = side_by_side(cases, first.state(), self.repeats, lambda part: on_part(0.5 + 0.5 * part))
        with dask.config.set(scheduler="synchronous"):  # else xarray asks the cluster for a lock
            _dataset(side).assign_attrs(busy=side.busy).to_netcdf(path, engine="netcdf4")


def _dataset(side: Side) -> xr.Dataset:
    counted = [wet_points(simulation) for simulation in side.simulations.values()]
    one = next(iter(side.simulations.values()))
    return xr.Dataset(
        {
            "fill": (("interpolator", "repeat"), side.fill, {"units": "s", "long_name": "filling all ghosts once"}),
            "step": (("interpolator", "repeat"), side.step, {"units": "s", "long_name": "one whole time step"}),
            "points": ("interpolator", [points for points, _ in counted], {"units": "1", "long_name": "wet ghosts"}),
            "neighbours": (
                "interpolator",
                [n for _, n in counted],
                {"units": "1", "long_name": "mean within the support"},
            ),
        },
        coords={"interpolator": list(side.simulations)},
        attrs={
            "particles": one.fluid_count,
            "ghosts": one.ghost_count,
            "particle_spacing": one.case.particle_spacing,
            "smoothing_length_ratio": one.case.smoothing_length_ratio,
            "time": one.time,
            **{f"machine: {name}": value for name, value in machine().items()},
        },
    )
