"""Studies: a run of the league table, and the small file that is kept of it."""

import math
import time
import warnings
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from sphframe.analysis import summary
from sphframe.analysis.exact import references_by_name
from sphframe.analysis.placed import walls_at
from sphframe.analysis.reference import shipped_references
from sphframe.cases import CaseWarning, ExactCase
from sphframe.errors import InputError, PluginError, SimulationError
from sphframe.hooks import hookimpl
from sphframe.interfaces import RunView
from sphframe.output import open_dataset
from sphframe.output.checkpoint import checkpoint_path
from sphframe.simulation.run import run
from sphframe.studies.drawing import thinned
from sphframe.studies.series import fallback_share
from sphframe.studies.tasks import PartHook, PartListener, RunTask, Task

_CURVE = 400
"""largest number of points that are kept of a curve"""


class Outcome(StrEnum):
    """How a run of the table ended."""

    COMPLETED = "completed"
    STOPPED = "stopped"
    """by the guards of the solver: the method fails on this benchmark"""
    NOT_APPLICABLE = "not applicable"
    """refused before it started: the method does not have what the case needs"""
    BROKEN = "broken"
    """the method raised an error"""


@dataclass(frozen=True)
class ScoreTask(RunTask):
    """Run a case with an exact solution, and keep its errors, its cost and what is drawn of it.

    Any outcome is a result, which is not repeated. Runs take seconds, so that an interrupted one starts again.
    """

    is_done = Task.is_done

    def perform(self, path: Path, threads: int, on_part: PartListener) -> None:
        """Run the case and write the result."""
        import dask

        run_path = path.with_name(f"{path.name}.run.nc")
        clock = StepClock()
        hooks = [clock, PartHook(on_part)]
        outcome, message = Outcome.COMPLETED, ""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", CaseWarning)
                run(
                    self.case(), output=run_path, overwrite=True, threads=threads, hooks=hooks, progress=False
                ).dataset.close()
        except SimulationError as error:
            outcome, message = Outcome.STOPPED, str(error)
        except PluginError as error:
            outcome, message = Outcome.BROKEN, str(error)
        except InputError as error:
            outcome, message = Outcome.NOT_APPLICABLE, str(error)
        kept = xr.Dataset()
        with dask.config.set(scheduler="synchronous"):  # else xarray asks the cluster for a lock
            if outcome in (Outcome.COMPLETED, Outcome.STOPPED) and run_path.exists():
                with open_dataset(run_path) as dataset:
                    kept = _kept(dataset, self.case(), clock)
            kept.assign_attrs(outcome=str(outcome), message=message).to_netcdf(path, engine="netcdf4")
        run_path.unlink(missing_ok=True)
        checkpoint_path(run_path).unlink(missing_ok=True)


class StepClock:
    """A hook plugin that measures the processor time of the steps but the first, in which loops are compiled."""

    def __init__(self) -> None:
        self._steps, self._start, self._now = 0, 0.0, 0.0

    @hookimpl
    def sphframe_step_completed(self, simulation: RunView) -> None:
        """Note the time."""
        self._now = time.process_time()
        if self._steps == 0:
            self._start = self._now
        self._steps += 1

    @property
    def per_step(self) -> float:
        """Mean processor time of a step, s; NaN for less than two steps."""
        return (self._now - self._start) / (self._steps - 1) if self._steps > 1 else math.nan


def _kept(dataset: xr.Dataset, case: Any, clock: StepClock) -> xr.Dataset:
    """Return the errors and figures of a run as attributes, its curves, and its last frame."""
    found = summary(dataset)
    attributes = {
        "case_title": case.title,
        "particles": found["particles"],
        "steps": int(found["steps"]),
        "end": float(found["time"]),
        "cost": 1e6 * clock.per_step / max(found["particles"], 1),
        "energy_excess": float(found.get("energy_excess", math.nan)),
        "fallback": fallback_share(dataset) if dataset.sizes["probe_time"] else math.nan,
        "outside": int(found.get("particles_outside", 0)),
        "removed": int(found["particles_removed"]),
        **{f"error: {name}": float(value) for name, value in found.get("errors", {}).items()},
    }
    variables: dict[str, Any] = {}
    if isinstance(case, ExactCase) and dataset.sizes["time"] and dataset.sizes["probe_time"]:
        exact = case.exact(dataset)
        attributes |= exact.attrs
        variables |= _curves(exact, case.measured(dataset)) | _measurements(exact, dataset)
    if dataset.sizes["time"]:
        last = dataset.isel(time=-1)
        variables["position"] = (("particle", "space"), last["position"].values.astype(np.float32))
        variables["pressure"] = ("particle", last["pressure"].values.astype(np.float32))
        lines = [
            np.vstack([points, np.full((1, points.shape[1]), np.nan)])
            for points, _ in walls_at(dataset, float(last["time"]))
        ]
        variables["walls"] = (("node", "space"), np.vstack(lines) if lines else np.zeros((0, 2)))
    return xr.Dataset(variables, attrs=attributes)


def _measurements(exact: xr.Dataset, dataset: xr.Dataset) -> dict[str, Any]:
    """Return the series that the case ships for its variables as ``NAME reference`` over ``NAME reference at``."""
    result: dict[str, Any] = {}
    for name, found in references_by_name(shipped_references(dataset), dataset, exact.data_vars).items():
        for series in found:
            own = f"{name} reference point"
            result[f"{name} reference at"] = (own, series[series.dims[0]].values)
            result[f"{name} reference"] = (own, series.values, {"label": str(series.name)})
    return result


def _curves(exact: xr.Dataset, measured: xr.Dataset) -> dict[str, Any]:
    """Return the variables ``NAME exact`` and ``NAME measured`` over ``NAME at``, thinned."""
    result: dict[str, Any] = {}
    for name, value in exact.data_vars.items():
        (dim,) = value.dims
        x = value[dim]
        order = np.argsort(x.values, kind="stable")
        own = f"{name} point"
        places, found = thinned(x.values[order], measured[name].values[order], _CURVE)
        about = {"units": value.attrs.get("units", "1"), "long_name": value.attrs.get("long_name", str(name))}
        where = {"units": x.attrs.get("units", "1"), "long_name": x.attrs.get("long_name", str(dim))}
        where["kind"] = "time" if dim in ("time", "probe_time") else "place"
        result[f"{name} at"] = (own, places, where)
        result[f"{name} measured"] = (own, found, about)
        result[f"{name} exact"] = (own, np.interp(places, x.values[order], value.values[order]), about)
    return result
