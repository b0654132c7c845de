"""Cases: contradictions between parameters that are each valid alone."""

import math
import warnings
from collections import Counter
from collections.abc import Iterator

import numpy as np

from sphframe.cases.case import Case
from sphframe.cases.fluid_checks import fluid_problems, fluid_reservations
from sphframe.cases.open_boundaries import open_boundary_problems
from sphframe.cases.parameters import Component
from sphframe.cases.placement import placed_force, placed_scene
from sphframe.cases.scene import Scene
from sphframe.errors import InputError, SphframeError
from sphframe.interfaces import Integrator
from sphframe.particles import Periods
from sphframe.registry import COMPONENT_KINDS

_MOST_PARTICLES = 50_000_000
_MOST_FRAMES = 100_000
_MOST_SAMPLES = 20_000_000
_MOST_STEPS = 1e10
_MOST_CELLS = 1e8
_MOST_WALL_POINTS = 1e8
_UNSTABLE = 10.0
"""time step over the stability limit above which nothing is computed; below it, a warning is given"""
_SHORTEST_PERIOD = 2.3
"""shortest period over the support of the kernel, with the skin of the neighbour lists"""


class CaseWarning(UserWarning):
    """Warns that a case can be run, but is unlikely to give a useful result."""


def check_case(case: Case) -> None:
    """Check what depends on several parameters: components with their options, the scene, sizes and stability.

    Warns
    -----
    CaseWarning
        few particles over the depth, a time step above the stability limit, a sound speed that makes the
        water too compressible.

    Raises
    ------
    InputError
        when parameters contradict each other; the message has one line for each error.
    PluginError
        when the only error is in a component.
    """
    errors = _component_errors(case)
    if not errors:
        try:
            scene = placed_scene(case)
        except SphframeError as error:
            errors.append(error)
        else:
            errors.extend(InputError(problem) for problem in _scene_problems(case, scene))
    if len(errors) == 1:
        raise errors[0]
    if errors:
        title = f"{type(case).__name__}: {len(errors)} things are wrong:"
        raise InputError("\n".join([title, *(f"  {error}" for error in errors)]))
    for message in _reservations(case, scene):
        warnings.warn(message, CaseWarning, stacklevel=2)


def _component_errors(case: Case) -> list[SphframeError]:
    errors = []
    for field, kind in COMPONENT_KINDS.items():
        component: Component = getattr(case, field)
        try:
            component.create(kind)
        except SphframeError as error:
            errors.append(error)
    try:
        placed_force(case)
    except SphframeError as error:
        errors.append(error)
    return errors


def _scene_problems(case: Case, scene: Scene) -> Iterator[str]:
    dim, spacing = case.dimension, case.particle_spacing
    if not scene.fluid or not (scene.walls or case.periodic):
        yield "the case has no wall, or no fluid; it needs at least one of each (no wall if it is periodic)"
        return
    foreign = [axis for axis in case.periodic if axis not in "xyz"[:dim]]
    if foreign or len(set(case.periodic)) < len(case.periodic):
        yield f"periodic = {list(case.periodic)}: give each of {list('xyz'[:dim])} at most once"
        return
    shape_problems = [*_dimension_problems(dim, scene), *_name_problems(scene)]
    yield from shape_problems
    if case.weight == 0.0 and case.sound_speed is None:
        yield "gravity = 0 gives no default sound speed; give sound_speed, ten times the largest flow speed or more"
    yield from _force_problems(case, scene)
    if spacing > scene.depth / 4.0:
        yield (
            f"particle_spacing = {spacing:g} m is more than a quarter of the water depth, {scene.depth:g} m;"
            f" choose {scene.depth / 20.0:.2g} m or less"
        )
    if spacing > scene.depth:
        return  # no geometry can be made with it
    yield from _output_problems(case)
    yield from _step_problems(case, scene)
    if shape_problems:
        return
    with np.errstate(over="ignore", under="ignore"):
        count = sum(float(np.prod(np.subtract(*region.bounds()[::-1]) / spacing)) for region in scene.fluid)
    if count > _MOST_PARTICLES:
        yield (
            f"particle_spacing = {spacing:g} m would need {count:.2g} particles; choose a larger spacing"
            f" (at most {_MOST_PARTICLES:,} particles)"
        )
        return
    size_problems = [*_size_problems(case, scene)]
    yield from size_problems
    if size_problems:
        return
    support = case.kernel.create("kernels").support * case.smoothing_length_ratio * spacing
    periods = Periods.of(case.periodic, scene.domain)
    for axis, length in zip("xyz", periods.length, strict=False):
        if 0.0 < length < _SHORTEST_PERIOD * support:
            yield (
                f"the period {length:g} m along {axis} is too short: a particle would see another one twice; make the"
                f" domain {_SHORTEST_PERIOD * support:.3g} m long or longer, or choose a smaller particle_spacing"
            )
            return
    yield from fluid_problems(scene, spacing, support, periods)
    if case.open_boundaries is not None:
        yield from open_boundary_problems(case, scene, support)
    lower, upper = np.array(scene.domain)
    for probe in scene.probes:
        if np.any(np.array(probe.position) < lower) or np.any(np.array(probe.position) > upper):
            yield f"probe {probe.name!r} at {probe.position} lies outside the domain {scene.domain}; move it to a wall"


def _force_problems(case: Case, scene: Scene) -> Iterator[str]:
    if case.weight and case.upward[-1] < 1.0:
        for index, region in enumerate(scene.fluid):
            if region.level is not None:
                yield (
                    f"fluid[{index}] has a level, a height along the last axis, but gravity = {case.gravity} does not"
                    " act along it; draw the region up to its level surface and leave the level out"
                )
    if placed_force(case) is not None:
        for name, body in scene.bodies.items():
            if body.needs_load:
                yield (
                    f"body {name!r} is moved by the fluid, but acceleration = {case.acceleration.name!r} acts on the"
                    " fluid alone; give it as gravity, which acts on both, or move the walls by a prescribed body"
                )


def _dimension_problems(dim: int, scene: Scene) -> Iterator[str]:
    def expected(what: str, found: int, wanted: int) -> Iterator[str]:
        if found != wanted:
            yield f"{what} has {found} coordinates, but dimension = {dim} needs {wanted}"

    for wall in scene.walls:
        yield from expected(f"wall {wall.name!r}", wall.dimension, dim)
        yield from expected(f"surface_velocity of wall {wall.name!r}", len(wall.surface_velocity or (0.0,) * dim), dim)
        yield from expected(f"reference_point of wall {wall.name!r}", len(wall.reference_point or (0.0,) * dim), dim)
    for index, region in enumerate(scene.fluid):
        yield from expected(f"fluid[{index}]", region.dimension, dim)
    for probe in scene.probes:
        yield from expected(f"position of probe {probe.name!r}", len(probe.position), dim)
        if probe.tangent is not None:
            yield from expected(f"tangent of probe {probe.name!r}", len(probe.tangent), dim)
    for gauge in scene.gauges:
        yield from expected(f"position of gauge {gauge.name!r}", len(gauge.position), dim - 1)
    for part in scene.wall_parts:
        yield from expected(f"lower corner of part {part.name!r}", len(part.lower), dim)
        yield from expected(f"upper corner of part {part.name!r}", len(part.upper), dim)
    for corner, name in zip(scene.domain, ("lower", "upper"), strict=True):
        yield from expected(f"{name} corner of the domain", len(corner), dim)


def _name_problems(scene: Scene) -> Iterator[str]:
    named = {
        "walls": [wall.name for wall in scene.walls],
        "probes": [probe.name for probe in scene.probes],
        "gauges": [gauge.name for gauge in scene.gauges],
        "walls and parts": [*{wall.name for wall in scene.walls}, *(part.name for part in scene.wall_parts)],
    }
    for what, names in named.items():
        for name, count in Counter(names).items():
            if count > 1:
                yield f"{count} {what} are called {name!r}; each needs a different name"
    named |= {"walls and parts": [part.name for part in scene.wall_parts], "bodies": list(scene.bodies)}
    for what, names in named.items():
        for name in names:
            if not name.strip() or not name.isprintable():
                yield f"{name!r}, one of the {what}, is no name: give it one of letters, digits and signs"
    carried = {"wall": scene.walls, "probe": scene.probes, "gauge": scene.gauges}
    for what, members in carried.items():
        for member in members:
            if member.body is not None and member.body not in scene.bodies:
                known = ", ".join(scene.bodies) or "none"
                yield f"{what} {member.name!r} belongs to body {member.body!r}, which is not given; bodies: {known}"
    for part in scene.wall_parts:
        if part.wall not in named["walls"]:
            yield f"part {part.name!r} is of wall {part.wall!r}, which is not given; walls: {', '.join(named['walls'])}"


def _output_problems(case: Case) -> Iterator[str]:
    for name, limit in (("frame_interval", _MOST_FRAMES), ("probe_interval", _MOST_SAMPLES)):
        interval = getattr(case, name)
        if interval == 0.0:
            yield f"until = {case.until:g} s is too short for any {name}; give a later end of the run"
        elif case.until / interval > limit:
            yield (
                f"{name} = {interval:g} s with until = {case.until:g} s gives {case.until / interval:.2g} outputs;"
                f" choose {case.until / limit:.2g} s or more"
            )


def _step_problems(case: Case, scene: Scene) -> Iterator[str]:
    sound_speed = case.reference_sound_speed(scene.depth)
    if case.time_step is not None:
        step, parameter = case.time_step, f"time_step = {case.time_step:g} s"
    elif sound_speed > 0.0:
        courant = case.courant_number or 1.0
        step = courant * case.smoothing_length_ratio * case.particle_spacing / sound_speed
        given = f"courant_number = {case.courant_number:g} and " if case.courant_number else ""
        parameter = f"{given}sound speed {sound_speed:g} m/s"
    else:
        return
    if not case.until < _MOST_STEPS * step:
        yield (
            f"{parameter} with until = {case.until:g} s ask for more than {_MOST_STEPS:g} steps;"
            f" choose a time step of {case.until / _MOST_STEPS:.2g} s or more, or a smaller until"
        )
    if case.time_step is not None and case.time_step > case.until:
        yield f"time_step = {case.time_step:g} s is above until = {case.until:g} s; give a smaller step, or a later end"
    excess, advice = _instability(case, scene)
    if excess > _UNSTABLE:
        yield advice


def _instability(case: Case, scene: Scene) -> tuple[float, str]:
    """Return the time step that is given over the stability limit, 0 if none is given, and what to do about it."""
    integrator: Integrator = case.integrator.create("integrators")
    sound_speed = case.reference_sound_speed(scene.depth)
    smoothing_length, number, parameter = case.smoothing_length_ratio * case.particle_spacing, 0.0, ""
    if case.time_step is not None:
        number, parameter = sound_speed * case.time_step / smoothing_length, f"time_step = {case.time_step:g} s"
    elif case.courant_number is not None:
        number, parameter = case.courant_number, f"courant_number = {case.courant_number:g}"
    limit = integrator.stability_limit * smoothing_length / sound_speed
    return number / integrator.stability_limit, (
        f"{parameter} gives c0 dt/h = {number:.3g}, above the stability limit {integrator.stability_limit:g} of"
        f" {case.integrator.name}; choose a time step below {limit:.3g} s"
    )


def _size_problems(case: Case, scene: Scene) -> Iterator[str]:
    with np.errstate(over="ignore"):
        extents = np.subtract(scene.domain[1], scene.domain[0])
    if not np.all(extents > 0.0):
        yield f"domain = {scene.domain}: its first corner must be the lower one, its second the upper one on all axes"
        return
    spacing = case.particle_spacing
    with np.errstate(over="ignore", invalid="ignore"):
        cells = float(np.prod(np.ceil(extents / (3.0 * spacing))))
        points = sum(
            float(np.sum(np.linalg.norm(np.diff(line, axis=0), axis=1))) / spacing
            for wall in scene.walls
            for line in wall.outline()
        )
    if not cells < _MOST_CELLS:
        yield (
            f"the domain {scene.domain} is too large for particle_spacing = {spacing:g} m ({cells:.2g} cells of the"
            " neighbour search); draw smaller walls, give a smaller domain, or choose a larger spacing"
        )
    if not points < _MOST_WALL_POINTS:
        yield (
            f"the walls are too long for particle_spacing = {spacing:g} m ({points:.2g} spacings); draw them smaller,"
            " or choose a larger spacing"
        )


def _reservations(case: Case, scene: Scene) -> Iterator[str]:
    yield from fluid_reservations(scene, case.particle_spacing)
    layers = scene.depth / case.particle_spacing
    if layers < 9.5:
        yield (
            f"particle_spacing = {case.particle_spacing:g} m leaves {layers:.3g} particles over the depth of"
            f" {scene.depth:g} m; 10 or more are needed for a useful result"
        )
    wave_speed = math.sqrt(case.weight * scene.depth)
    sound_speed = case.reference_sound_speed(scene.depth)
    if sound_speed < 9.999 * wave_speed:
        yield (
            f"sound_speed = {sound_speed:g} m/s is below 10 sqrt(g H) = {10 * wave_speed:.3g} m/s: the density will"
            f" vary by more than one per cent"
        )
    excess, advice = _instability(case, scene)
    if excess > 1.0:
        yield advice
