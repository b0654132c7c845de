"""Simulation: guards, which stop a run that has gone wrong before anything of it is written.

They look at every state between two steps. NaN, a vanishing time step and a component that breaks its word always stop
a run; for the rest a case says what is to happen (:class:`sphframe.cases.Guards`).
"""

import math
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, NoReturn

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.boundary.boundary import Boundary
from sphframe.boundary.operator import operator
from sphframe.cases.case import Case
from sphframe.errors import BrokenPluginError, SimulationError, SphframeError
from sphframe.interfaces import EvaluationPoint, Status
from sphframe.registry import COMPONENT_KINDS, Entry, available, find
from sphframe.simulation.system import FluidSystem

__all__ = ["Watch", "check_promises", "check_time_step", "naming_component", "naming_hook", "watch"]

Array = NDArray[np.float64]

COLLAPSED = 0.02
"""an adaptive time step below this part of that at rest, a speed of 50 c0, has collapsed"""
_ROUND_OFF = 1e-8
_STEP_IS_TOO_LONG = "a time step above the stability limit (set a smaller courant_number or time_step)"


class Watch(NamedTuple):
    """What one look at the fluid found: speed in m/s, ``moved`` in m since the neighbour search."""

    speed: float
    moved: float
    outside: NDArray[np.bool_] | None
    """(n,) particles that have left the domain and are to be removed"""
    densities: int
    """number of particles with a density outside the band"""


def watch(
    system: FluidSystem, reference: Array, ids: NDArray[np.int64], case: Case, lower: Array, upper: Array
) -> Watch:
    """Look at all particles, ghosts and bodies.

    Parameters
    ----------
    reference: (n, dim) positions at the last neighbour search; ``ids`` (n,) the particles' original numbers.
    lower, upper: (dim,) corners of the domain.

    Raises
    ------
    SimulationError: when something is wrong that the case does not tolerate. Its time and step are left to the caller.
    """
    guards, columns, boundary = case.guards, system.columns, system.boundary
    rows, n = system.rows, system.fluid_count
    lowest, highest = (factor * case.reference_density for factor in guards.density_band)
    speed2, moved2, broken, outside, first_outside, astray, first_astray = _watch_fluid(
        rows, reference, case.dimension, lower, upper, lowest, highest
    )

    def stop(index: int, what: str, causes: str) -> NoReturn:
        row = rows[index]
        velocity = ", ".join(f"{u:.4g}" for u in row[columns.velocity])
        raise SimulationError(
            f"particle {ids[index]} {what} (velocity ({velocity}) m/s, density {row[columns.density]:.6g} kg/m^3);"
            f" likely causes: {causes}",
            place=tuple(float(x) for x in row[columns.position]),
        )

    if broken < n:
        stop(broken, "has a state that is not finite", f"{_STEP_IS_TOO_LONG}, or a component that returned NaN")
    _watch_ghosts(system, case)
    if outside and guards.domain == "stop":
        stop(
            first_outside,
            "has left the domain",
            f"{_STEP_IS_TOO_LONG}, walls that leak or end too low, or a sound speed too low for the flow; to remove and"
            ' count such particles instead, set guards.domain = "remove"',
        )
    if astray and guards.density == "stop":
        stop(
            first_astray,
            f"has a density outside the band {lowest:g} to {highest:g} kg/m^3",
            f"{_STEP_IS_TOO_LONG}, a sound speed too low for the flow, or overlapping walls; to go on and count such"
            ' particles, set guards.density = "count", or widen guards.density_band',
        )
    if guards.fallbacks == "stop":
        _check_fallbacks(boundary, case)
    gone = _outside(rows[:n, columns.position], lower, upper) if outside else None
    return Watch(math.sqrt(speed2), math.sqrt(moved2), gone, astray)


def _outside(position: Array, lower: Array, upper: Array) -> NDArray[np.bool_]:
    gone: NDArray[np.bool_] = np.any((position < lower) | (position > upper), axis=1)
    return gone


def _watch_ghosts(system: FluidSystem, case: Case) -> None:
    boundary = system.boundary
    g = _first_bad_ghost(system.rows, system.fluid_count, case.dimension, boundary.statuses, len(Status))
    if g < boundary.count:
        row, columns = system.rows[system.fluid_count + g], system.columns
        raise SimulationError(
            f"ghost {g} got pressure {row[columns.pressure]:g} Pa, velocity {row[columns.velocity]} m/s and status"
            f" {boundary.statuses[g]} from interpolator {_origin('interpolators', case.interpolator.name)}; likely"
            f" causes: weights that are not finite (sphframe verify {case.interpolator.name}), or"
            f" {_STEP_IS_TOO_LONG}",
            place=tuple(float(x) for x in boundary.position[g]),
        )


def _check_fallbacks(boundary: Boundary, case: Case) -> None:
    wet = boundary.statuses != int(Status.DRY)
    fallen = wet & (boundary.statuses != int(Status.OK))
    share = float(fallen.sum()) / max(1, int(wet.sum()))
    if share > case.guards.fallback_limit:
        g = int(np.argmax(fallen))
        raise SimulationError(
            f"{100 * share:.3g} % of the wet ghosts use the fallback of interpolator {case.interpolator.name!r}, above"
            f" guards.fallback_limit = {case.guards.fallback_limit:g}; likely causes: the flow has broken up into"
            " spray, or the method needs more neighbours than there are: refine particle_spacing, choose a method of"
            ' lower order, or set guards.fallbacks = "count"',
            place=tuple(float(x) for x in boundary.position[g]),
        )


def check_time_step(step: float, at_rest: float, speed: float) -> None:
    """Stop where the adaptive time ``step`` (s) has collapsed against that ``at_rest``, at the largest ``speed``."""
    if step < COLLAPSED * at_rest:
        raise SimulationError(
            f"the time step has collapsed to {step:.3g} s, from {at_rest:.3g} s at rest, for a speed of"
            f" {speed:.3g} m/s; likely causes: a Courant number above the stability limit (set a smaller"
            " courant_number), or a sound speed too low for the flow (raise sound_speed)"
        )


def check_promises(system: FluidSystem, interpolator: Any, kernel: Any, case: Case) -> None:
    """Check at the present ghosts that the weights keep what the method's traits promise.

    Raises
    ------
    SimulationError: when they are not finite, negative in spite of ``non_negative``, or do not add up to one in spite
        of ``partition_of_unity``.
    """
    boundary, columns, n = system.boundary, system.columns, system.fluid_count
    traits, fluid = interpolator.traits, system.rows[: system.fluid_count]
    points = boundary.points
    if not np.all(np.isfinite(points)) or n == 0:
        return
    lift = boundary.lifts if traits.evaluation_point is EvaluationPoint.EXTRAPOLATED else None
    matrix, statuses = operator(
        interpolator,
        points,
        fluid[:, columns.position],
        fluid[:, columns.volume],
        smoothing_length=system.parameters.smoothing_length,
        kernel=kernel,
        lift=lift,
    )
    sums, lowest = matrix.sum(axis=1), np.zeros(len(points))
    rows = np.repeat(np.arange(len(points)), np.diff(matrix.indptr))
    np.minimum.at(lowest, rows, matrix.data)
    size = np.zeros(len(points))
    np.add.at(size, rows, np.abs(matrix.data))
    wet = statuses != int(Status.DRY)
    for wrong, what in (
        (~np.isfinite(sums), "weights that are not finite"),
        (traits.non_negative & (lowest < -_ROUND_OFF * size), "negative weights, which its traits rule out,"),
        (
            traits.partition_of_unity & wet & (np.abs(sums - 1.0) > 1e-6 * np.maximum(1.0, size)),
            "weights that do not add up to one, which its traits promise,",
        ),
    ):
        if np.any(wrong):
            g = int(np.argmax(wrong))
            raise SimulationError(
                f"interpolator {_origin('interpolators', case.interpolator.name)} returned {what} for ghost {g}"
                f" (lowest {lowest[g]:.4g}, sum {sums[g]:.6g}); mend the method or its traits: sphframe verify"
                f" {case.interpolator.name} shows a small example",
                place=tuple(float(x) for x in points[g]),
            )


@contextmanager
def naming_component(case: Case, *, running: bool) -> Iterator[None]:
    """Turn what a component of the case raises, or fails to compile with, into an error that names it.

    Raises
    ------
    BrokenPluginError: when nothing has run yet. SimulationError: when it is ``running``.
    """
    try:
        yield
    except (SphframeError, MemoryError):
        raise
    except Exception as error:
        strangers = [find(kind, getattr(case, field).name) for field, kind in COMPONENT_KINDS.items()]
        strangers = [entry for entry in strangers if entry.distribution != "sphframe"]
        compiled = isinstance(error, numba.core.errors.NumbaError | SystemError)
        if not compiled:
            strangers = [entry for entry in strangers if _passed_through(error, entry)]
        if not strangers:
            raise
        doing = "does not compile" if isinstance(error, numba.core.errors.NumbaError) else "failed"
        text = (
            f"{' or '.join(entry.label for entry in strangers)} {doing}: {type(error).__name__}: {_shortened(error)}\n"
            "to see where, run sphframe verify NAME, or run with NUMBA_DISABLE_JIT=1, which is slow but debugs as"
            " plain Python"
        )
        raise (SimulationError(text) if running else BrokenPluginError(text)) from error


@contextmanager
def naming_hook() -> Iterator[None]:
    """Turn what an installed hook plugin raises into an error that names it.

    Raises
    ------
    SimulationError: in its place.
    """
    try:
        yield
    except (SphframeError, MemoryError):
        raise
    except Exception as error:
        for entry in available("hooks"):
            if _passed_through(error, entry):
                raise SimulationError(
                    f"{entry.label} failed: {type(error).__name__}: {_shortened(error)}\n"
                    f"what was computed is kept; mend the plugin or take it away (pip uninstall {entry.distribution})"
                    " and continue with sphframe resume"
                ) from error
        raise


def _passed_through(error: BaseException, entry: Entry) -> bool:
    """Whether ``error`` was raised in, or by something called from, the module of ``entry``."""
    package = entry.value.partition(":")[0].partition(".")[0]
    frames = traceback.walk_tb(error.__traceback__)
    return any(str(frame.f_globals.get("__name__")).partition(".")[0] == package for frame, _ in frames)


def _shortened(error: BaseException) -> str:
    """The first line of a message, and of a compiler's those that say what and where."""
    first, *rest = [line.strip() for line in str(error).splitlines() if line.strip()] or [""]
    telling = [line for line in rest if line.startswith(("NameError", "Unknown", "No implementation", "File"))]
    return "; ".join([first, *telling[:3]])


def _origin(kind: str, name: str) -> str:
    for entry in available(kind):
        if entry.name == name:
            return f"{name!r} of {entry.distribution} {entry.version}"
    return repr(name)


@numba.njit(parallel=True, cache=True)
def _watch_fluid(rows, reference, dim, lower, upper, lowest, highest):  # type: ignore[no-untyped-def]
    """Largest squared speed and displacement; the first row that is not finite; number and first outside the box;
    number and first with a density outside ``lowest`` .. ``highest``. A first one that is not there is n."""
    n = reference.shape[0]
    speed2 = 0.0
    moved2 = 0.0
    broken = n
    outside = 0
    first_outside = n
    astray = 0
    first_astray = n
    for i in numba.prange(n):
        speed = 0.0
        moved = 0.0
        inside = True
        density = rows[i, 2 * dim]
        total = density
        for k in range(dim):
            speed += rows[i, dim + k] ** 2
            moved += (rows[i, k] - reference[i, k]) ** 2
            inside = inside and rows[i, k] >= lower[k] and rows[i, k] <= upper[k]
            total += rows[i, k]
        if not math.isfinite(total + speed):
            broken = min(broken, i)
        elif not inside:
            outside += 1
            first_outside = min(first_outside, i)
        elif density < lowest or density > highest:
            astray += 1
            first_astray = min(first_astray, i)
        speed2 = max(speed2, speed)
        moved2 = max(moved2, moved)
    return speed2, moved2, broken, outside, first_outside, astray, first_astray


@numba.njit(cache=True)
def _first_bad_ghost(rows, first, dim, statuses, status_count):  # type: ignore[no-untyped-def]
    """Return the first ghost whose state is not finite or whose status is none; their number where all is well."""
    for g in range(statuses.shape[0]):
        total = rows[first + g, 2 * dim] + rows[first + g, 2 * dim + 1]
        for k in range(2 * dim):
            total += rows[first + g, k]
        if not math.isfinite(total) or statuses[g] < 0 or statuses[g] >= status_count:
            return g
    return statuses.shape[0]
