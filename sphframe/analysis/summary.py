"""Analysis: key figures of a run."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from sphframe.analysis.exact import exact_case
from sphframe.analysis.fields import outline_nodes
from sphframe.analysis.scales import case_of, pressure_scale, time_scale
from sphframe.analysis.work import work_of_bodies
from sphframe.interfaces import Status


def summary(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the key figures of a run as plain numbers and texts, fit for a table or JSON.

    Returns
    -------
    dict[str, Any]
        A dictionary with, in SI units:

        - ``case``, ``wall_treatment``, ``interpolator``, ``hydrostatic_lift``, ``particle_spacing``, ``particles``,
          ``ghosts``, ``completed``;
        - ``time``, ``steps``, ``wall_clock`` and ``processor_time`` since the run started, output included;
          ``steps_per_second`` and ``particle_updates_per_second`` of wall-clock time; ``waited``: whether the run had
          to wait for processors or the disk, as its threads together got less than 90 % of one processor;
        - ``work_of_bodies``: work that bodies have done on the fluid, J, in 2-D per metre of width; 0 without bodies;
        - ``energy_excess``: largest total energy, without that work, over its initial value, minus 1; ``mass_drift``:
          largest relative change of the mass;
        - ``particles_outside``: largest number of particles behind walls in a frame;
        - ``particles_removed``: number of particles that left the domain; ``densities_outside``: largest number in a
          sample with a density outside the band of the guards;
        - ``statuses``: share of each interpolation status, over all ghosts and samples;
        - ``peaks``: largest ``pressure`` at each probe and its ``time``, also divided by rho0 g H and sqrt(H/g);
        - ``front_arrival``: see :func:`front_arrival`; None where the case has no front;
        - ``errors``: of a case with an exact solution, see :meth:`sphframe.cases.ExactCase.errors`.
    """
    result = _of_the_case(dataset) | {
        "time": 0.0,
        "steps": 0,
        "wall_clock": 0.0,
        "processor_time": 0.0,
        "waited": False,
    }
    result |= {"front_arrival": front_arrival(dataset), "particles_removed": 0, "densities_outside": 0}
    if dataset.sizes["time"]:
        result["particles_outside"] = int(dataset["particles_outside"].max())
    if (case := exact_case(dataset)) is not None:
        result["errors"] = case.errors(dataset)
    return result | _of_the_samples(dataset) if dataset.sizes["probe_time"] else result


def _of_the_case(dataset: xr.Dataset) -> dict[str, Any]:
    case = case_of(dataset)
    return {
        "case": dataset.attrs["case_name"],
        "wall_treatment": case["wall_treatment"]["name"],
        "interpolator": case["interpolator"]["name"],
        "hydrostatic_lift": case["hydrostatic_lift"],
        "particle_spacing": float(dataset.attrs["particle_spacing"]),
        "particles": int(dataset.sizes["particle"]),
        "ghosts": int(dataset.sizes.get("ghost", 0)),
        "completed": dataset.attrs["completed"],
    }


def _of_the_samples(dataset: xr.Dataset) -> dict[str, Any]:
    """Key figures from the samples of a run that has at least one."""
    last = dataset.isel(probe_time=-1)
    wall_clock, processor, steps = float(last["wall_clock"]), float(last["processor_time"]), int(last["step"])
    energy, mass = dataset["total_energy"].values, dataset["mass"].values
    counts = dataset["interpolation_status"].sum("probe_time")
    done = work_of_bodies(dataset)
    work = np.zeros(len(energy)) if done is None else done
    rate = steps / wall_clock if wall_clock > 0.0 else 0.0
    return {
        "time": float(last["probe_time"]),
        "steps": steps,
        "wall_clock": wall_clock,
        "processor_time": processor,
        "waited": processor < 0.9 * wall_clock,
        "steps_per_second": rate,
        "particle_updates_per_second": rate * int(dataset.sizes["particle"]),
        "particles_removed": int(last["particles_removed"]),
        "densities_outside": int(dataset["densities_outside"].max()),
        "work_of_bodies": float(work[-1]),
        "energy_excess": float(np.max(energy - work) / energy[0] - 1.0) if energy[0] else 0.0,
        "mass_drift": float(np.max(np.abs(mass / mass[0] - 1.0))),
        "statuses": {
            str(name): float(count) for name, count in zip(counts["status"].values, counts / counts.sum(), strict=True)
        },
        "peaks": _peaks(dataset),
    }


def front_arrival(dataset: xr.Dataset) -> dict[str, float] | None:
    """Return when the surge front reaches the far wall: ``time`` in s and ``dimensionless`` t sqrt(g/H).

    The front has arrived when ``front_position`` is within one particle spacing of the rightmost point of the walls,
    interpolated between samples. It is None if the case has no ``front_position`` or the front does not arrive.
    """
    if "front_position" not in dataset or dataset.sizes["probe_time"] == 0:
        return None
    there = float(outline_nodes(dataset)[:, 0].max()) - float(dataset.attrs["particle_spacing"])
    t, front = dataset["probe_time"].values, dataset["front_position"].values
    reached = np.flatnonzero(front >= there)
    if not reached.size:
        return None
    k = int(reached[0])
    time = float(t[k])
    if k > 0:
        time -= float((front[k] - there) / (front[k] - front[k - 1]) * (t[k] - t[k - 1]))
    return {"time": time, "dimensionless": time / time_scale(dataset)}


def _peaks(dataset: xr.Dataset) -> dict[str, dict[str, float]]:
    if "probe_pressure" not in dataset:
        return {}
    pressure = dataset["probe_pressure"].load()
    peaks = {}
    for name, series in zip(pressure["probe"].values, pressure.transpose("probe", ...), strict=True):
        k = int(np.argmax(series.values))
        value, time = float(series[k]), float(series["probe_time"][k])
        peaks[str(name)] = {
            "pressure": value,
            "time": time,
            "dimensionless_pressure": value / (pressure_scale(dataset) or 1.0),
            "dimensionless_time": time / time_scale(dataset),
        }
    return peaks


def concerns(*, outside: int, removed: int, densities: int, statuses: ArrayLike) -> list[str]:
    """Return texts about counted events that should not happen in a run; an empty list if there are none.

    Parameters
    ----------
    outside
        particles behind walls.
    removed
        particles that left the domain.
    densities
        particles with a
        density outside the band of the guards.
    statuses
        (statuses,) number of ghosts with each :class:`sphframe.Status`.

    Examples
    --------
    >>> concerns(outside=3, removed=0, densities=0, statuses=[70, 100, 30, 0])
    ['3 particles behind walls', '30 % of wet ghosts by fallback']
    """
    counts = np.asarray(statuses)
    wet = int(counts.sum() - counts[Status.DRY])
    fallen = wet - int(counts[Status.OK])
    found = [
        f"{number:,} {'particle' if number == 1 else 'particles'} {what}"
        for number, what in (
            (outside, "behind walls"),
            (removed, "removed"),
            (densities, "with a density out of range"),
        )
        if number
    ]
    return [*found, f"{100 * fallen / wet:.2g} % of wet ghosts by fallback"] if fallen else found
