"""Simulation: guards, which stop a run that has gone wrong before its state is written.

Every state between two steps is checked. NaN, a time step that has collapsed and a component that violates its declared
traits always stop a run; for the rest a case says what is to happen (:class:`sphframe.cases.Guards`).
"""

from typing import NamedTuple, NoReturn

import numpy as np

from sphframe.arrays import Array, BoolArray
from sphframe.boundary.operator import operator_of, row_starts
from sphframe.boundary.promises import first_contradiction
from sphframe.cases import Case
from sphframe.errors import SimulationError
from sphframe.interfaces import BoundaryInterpolator, Kernel, Status
from sphframe.registry import Entry, find
from sphframe.simulation.system import FluidSystem

COLLAPSED = 0.02
"""lowest adaptive time step over that at rest; below it, at speeds above 50 c0, the time step has collapsed"""
FASTEST_BODY = 0.5
"""highest speed of a body over the sound speed: above it, the water is no longer weakly compressible"""
GATHERED = 4
"""number of particles within half a spacing of one of them from which the stable time step is shorter"""
SAMPLED = 1000
"""number of ghosts whose weights are checked at each frame"""
SLOW = 0.1
"""speed over the sound speed up to which the sound speed is high enough for the flow"""


class Tolerated(NamedTuple):
    """Faults of the fluid that the case tolerates."""

    outside: BoolArray | None
    """(n,) particles that have left the domain and are to be removed"""
    densities_outside: int
    """number of particles whose density is out of range"""


def check_state(system: FluidSystem, case: Case, lower: Array, upper: Array, time_step: float = 0.0) -> Tolerated:
    """Check all particles and ghosts.

    Parameters
    ----------
    lower, upper
        (dim,) corners of the domain, m.
    time_step
        that led to this state, s.

    Raises
    ------
    SimulationError
        when something is wrong that the case does not tolerate; the caller adds time and step.
    """
    guards, columns = case.guards, system.columns
    n = system.fluid_count
    lowest, highest = (factor * case.reference_density for factor in guards.density_band)
    broken, outside, out_of_range, densities_outside = system.check_fluid(lower, upper, lowest, highest)

    def stop(index: int, what: str, cause: str, remedy: str = "") -> NoReturn:
        causes = f"{_likely(system, case, time_step, cause)}{remedy}"
        row = system.host_rows[index]
        velocity = ", ".join(f"{u:.4g}" for u in row[columns.velocity])
        raise SimulationError(
            f"particle {system.ids[index]} {what} (velocity ({velocity}) m/s, density {row[columns.density]:.6g}"
            f" kg/m^3); likely causes: {causes}",
            place=tuple(float(x) for x in row[columns.position]),
        )

    if broken < n:
        stop(broken, "has a state that is not finite", "a component or a hook that wrote NaN")
    if densities_outside:  # a band may be wide and its guard only count, but no volume belongs to such a density
        least = int(np.argmin(system.host_rows[:n, columns.density]))
        if system.host_rows[least, columns.density] <= 0.0:
            stop(least, "has a density that is not positive", "fluid that is torn apart within a step")
    _check_ghosts(system, case, time_step)
    if outside < n and guards.domain == "stop":
        stop(
            outside,
            "has left the domain",
            "walls that leak or end too low",
            '; to remove and count such particles instead, set guards.domain = "remove"',
        )
    if out_of_range < n and guards.density == "stop":
        stop(
            out_of_range,
            f"has a density outside the band {lowest:g} to {highest:g} kg/m^3",
            _cause_of_density(system, case, out_of_range),
            '; to go on and count such particles, set guards.density = "count", or widen guards.density_band',
        )
    if guards.fallbacks == "stop":
        _check_fallbacks(system, case)
    if system.boundary.bodies:
        check_bodies(system, case, lower, upper, time_step)
    if outside == n:
        return Tolerated(None, densities_outside)
    position = system.host_rows[:n, columns.position]
    return Tolerated(np.any((position < lower) | (position > upper), axis=1), densities_outside)


def _likely(system: FluidSystem, case: Case, time_step: float, cause: str) -> str:
    """Return ``cause``, and with it a long time step and a low sound speed where they may be."""
    parameters = system.parameters
    number = parameters.sound_speed * time_step / parameters.smoothing_length
    limit = case.integrator.create("integrators").stability_limit
    if number > limit:  # high speeds are then its effect
        return f"a time step above the stability limit (set a smaller courant_number or time_step), or {cause}"
    velocity = system.host_rows[: system.fluid_count, system.columns.velocity]
    fastest = float(np.max(np.abs(velocity), initial=0.0, where=np.isfinite(velocity)))
    if fastest > SLOW * parameters.sound_speed:
        return f"{cause}, or a sound speed too low for the flow (raise sound_speed)"
    return cause


def _cause_of_density(system: FluidSystem, case: Case, index: int) -> str:
    """Return what has probably compressed or torn a particle: others that gathered, a wall, or another one."""
    from scipy.spatial import cKDTree

    support, position = system.parameters.support, system.host_rows[: system.fluid_count, system.columns.position]
    offset = system.boundary.periods.nearest(position - position[index])
    near = offset[np.linalg.norm(offset, axis=1) < support]
    gathered = cKDTree(near).query_ball_point(near, 0.5 * system.parameters.spacing, return_length=True).max()
    if gathered >= GATHERED:
        remedy = "set" if case.tension == "none" else 'set tension = "none", if air can reach the walls, or'
        return f"{gathered} particles in one place, for which the step is too long ({remedy} a smaller courant_number)"
    ghosts, _ = system.boundary.periods.with_copies(system.boundary.position, support)
    near_wall = np.any(np.linalg.norm(ghosts - position[index], axis=1) < support)
    return "walls that overlap or squeeze the fluid" if near_wall else "two particles that met"


def check_bodies(system: FluidSystem, case: Case, lower: Array, upper: Array, time_step: float = 0.0) -> None:
    """Check that bodies have finite positions and velocities, are not too fast, in the domain and outside of walls.

    Raises
    ------
    SimulationError
        when one does not; the message names it.
    """
    boundary, fastest, deepest = system.boundary, FASTEST_BODY * system.parameters.sound_speed, system.contacts.deepest
    for k, name in enumerate(boundary.bodies):
        own = boundary.body == k
        beside, speeds = boundary.mirror[own], np.linalg.norm(boundary.velocity[own], axis=1)
        velocity = system.bodies.velocity[k]
        fault, cause = "", "a body too light for the flow, hit too hard, or moved by a wrong motion"
        if not np.all(np.isfinite([system.bodies.position[k], velocity])):
            fault = "has a position or a velocity that is not finite"
        elif speeds.max(initial=0.0) > fastest:
            fault = f"moves at {speeds.max():.4g} m/s, above {FASTEST_BODY:g} c0 = {fastest:.4g} m/s"
        elif len(beside) and (np.any(beside.max(axis=0) < lower) or np.any(beside.min(axis=0) > upper)):
            fault, cause = "has left the domain", f"{cause}, or walls that end too low"
        elif deepest is not None and deepest.body == k and deepest.depth > 0.5 * case.particle_spacing:
            fault = f"has sunk {deepest.depth:.3g} m into wall {deepest.wall!r}, more than half a particle spacing"
        if fault:
            raise SimulationError(
                f"body {name!r} {fault} (velocity {velocity.tolist()}); likely causes:"
                f" {_likely(system, case, time_step, cause)}",
                place=tuple((boundary.centres[k] + system.bodies.position[k, : boundary.dim]).tolist()),
            )


def _check_ghosts(system: FluidSystem, case: Case, time_step: float) -> None:
    boundary = system.boundary
    g = system.first_bad_ghost()
    if g < boundary.count:
        row, columns = system.host_rows[system.fluid_count + g], system.columns
        raise SimulationError(
            f"ghost {g} got pressure {row[columns.pressure]:g} Pa, velocity {row[columns.velocity]} m/s and status"
            f" {system.statuses[g]} from {_method(case).label}; likely causes: "
            + _likely(system, case, time_step, f"weights that are not finite (sphframe verify {_method(case).name})"),
            place=tuple(float(x) for x in boundary.position[g]),
        )


def _method(case: Case) -> Entry:
    """Return the interpolator of the case, or its treatment of walls if that is another one than fixed ghosts."""
    own = case.wall_treatment.name == "fixed-ghosts"
    return find("interpolators", case.interpolator.name) if own else find("wall_treatments", case.wall_treatment.name)


def _check_fallbacks(system: FluidSystem, case: Case) -> None:
    wet = system.statuses != int(Status.DRY)
    fallen = wet & (system.statuses != int(Status.OK))
    share = float(fallen.sum()) / max(1, int(wet.sum()))
    if share > case.guards.fallback_limit:
        g = int(np.argmax(fallen))
        raise SimulationError(
            f"{100 * share:.3g} % of the wet ghosts use the fallback of {_method(case).title}, above"
            f" guards.fallback_limit = {case.guards.fallback_limit:g}; likely causes: the flow has broken up into"
            " spray, or the method needs more neighbours than there are: refine particle_spacing, choose a method of"
            ' lower order, or set guards.fallbacks = "count"',
            place=tuple(float(x) for x in system.boundary.position[g]),
        )


def check_time_step(step: float, at_rest: float, speed: float) -> None:
    """Raise an error if the adaptive time ``step`` (s) at the largest ``speed`` has collapsed from that ``at_rest``."""
    if step < COLLAPSED * at_rest:
        raise SimulationError(
            f"the time step has collapsed to {step:.3g} s, from {at_rest:.3g} s at rest, for a speed of"
            f" {speed:.3g} m/s; likely causes: a Courant number above the stability limit (set a smaller"
            " courant_number), or a sound speed too low for the flow (raise sound_speed)"
        )


def check_traits(
    system: FluidSystem, interpolator: BoundaryInterpolator | None, kernel: Kernel, case: Case, turn: int = 0
) -> None:
    """Check at present that the weights have the properties that the method's traits declare.

    Of many ghosts near the fluid, about :data:`SAMPLED` are checked, others at each ``turn``.

    Raises
    ------
    SimulationError
        when they are not finite, negative in spite of ``non_negative``, or do not add up to one in spite
        of ``partition_of_unity``.
    """
    boundary, columns, count = system.boundary, system.columns, len(system.lists.near)
    stride = -(-count // SAMPLED)
    if interpolator is None or not count:
        return
    ghosts, lists, lengths = system.lists.of_points(np.arange(turn % stride, count, stride))
    points = boundary.periods.wrapped(boundary.points)[ghosts]
    listed = np.arange(lists.shape[1]) < lengths[:, None]
    of, around = np.nonzero(listed)[0], system.host_rows[lists[listed]]
    offset = boundary.periods.nearest(around[:, columns.position] - points[of])
    inside = np.square(offset).sum(axis=1) < system.parameters.support**2
    of, count = of[inside], int(inside.sum())
    lift = boundary.lift_of_weights
    matrix, _ = checked = operator_of(
        interpolator,
        points,
        points[of] + offset[inside],
        around[inside, columns.volume],
        (row_starts(of, len(points)), np.arange(count)),
        np.zeros_like(points) if lift is None else lift[ghosts],
        system.parameters.smoothing_length,
        kernel,
    )
    found = first_contradiction(interpolator.traits, *checked)
    if found is not None:
        neighbours = int(np.diff(matrix.indptr)[found.point])
        raise SimulationError(
            f"{_method(case).label} returned {found.what} for ghost {ghosts[found.point]} with {neighbours} neighbours"
            f" (lowest {found.lowest:.4g}, sum {found.sum:.6g}); fix the method or its traits: sphframe verify"
            f" {_method(case).name} makes the same check and shows a small example",
            place=tuple(float(x) for x in boundary.points[ghosts[found.point]]),
        )
