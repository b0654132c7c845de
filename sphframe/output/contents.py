"""Output: what the file of a run contains: dimensions, variables, attributes, and the values of samples and frames."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import netCDF4
import numpy as np

from sphframe.errors import OutputError, SimulationError
from sphframe.interfaces import RunView, Status
from sphframe.output.check import dimensions_of
from sphframe.output.provenance import distributions, registered_name, software
from sphframe.output.schema import CONVENTIONS, VARIABLES, RunStatus, Variable, encode_texts, unit_of
from sphframe.registry import COMPONENT_KINDS

_MESSAGE_LENGTH = 500


def planned_size(simulation: RunView) -> tuple[int, int]:
    """Return the approximate size of the file at the end of the run, bytes, and its number of frames."""
    lengths, frames = _dimensions(simulation), int(simulation.case.until / simulation.case.frame_interval) + 2
    numbers = sum(
        int(np.prod([frames if (n := lengths[d]) is None else n for d in variable.dimensions]))
        for variable in VARIABLES.values()
        if all(d in lengths for d in variable.dimensions) and variable.type == "f8"
    )
    return 8 * numbers, frames


def sample_count(until: float, interval: float, time_step: float | None) -> int:
    """Return the number of samples of a complete run: one at the start, and one at or after each ``interval``, s.

    There is at most one per step; a fixed ``time_step`` above the interval gives one for each step.
    """
    if time_step is not None and time_step > interval:
        return int(np.ceil(until / time_step)) + 1
    last = round(until / interval)
    return last + (until >= last * interval - 1e-9 * interval)  # as the run loop finds whether a sample is due


def write_start(file: netCDF4.Dataset, simulation: RunView, run_id: str) -> None:
    """Write the header and all values that do not change during the run into the new ``file``.

    Raises
    ------
    OutputError
        a diagnostic of the case has the name of another variable.
    """
    _define(file, simulation, _dimensions(simulation))
    file.setncattr("run_id", run_id)
    _fill_start(file, simulation)


def sample_of(simulation: RunView) -> dict[str, Any]:
    """Return the values of a sample of probes, sums and diagnostics by the names of the variables."""
    scene = simulation.scene
    energies = simulation.energies()
    sample: dict[str, Any] = {
        "probe_time": simulation.time,
        "step": simulation.step,
        "time_step": simulation.time_step,
        "wall_clock": simulation.wall_clock,
        "processor_time": simulation.processor_time,
        **{f"{name}_energy": energy for name, energy in energies.items()},
        "total_energy": sum(energies.values()),
        "mass": float(np.nansum(simulation.masses())),
        "particles_removed": simulation.removed_count,
        "densities_outside": simulation.densities_outside,
        "interpolation_status": simulation.status_counts(),
        **simulation.diagnostics(),
    }
    if scene.probes:
        sample["probe_pressure"], sample["probe_wet"] = simulation.probe_readings()
    if scene.gauges:
        sample["gauge_elevation"], sample["gauge_depth"] = simulation.gauge_readings()
    if scene.walls:
        loads, squeezed = simulation.wall_loads(), 0 if simulation.case.dimension == 2 else slice(None)
        for where, members in (("wall", scene.walls), ("part", scene.wall_parts)):
            found = [loads[member.name] for member in members]
            for name in ("force", "force_by_pressure") if found else ():
                sample[f"{where}_{name}"] = [getattr(load, name) for load in found]
            for name in ("moment", "moment_by_pressure") if found else ():
                sample[f"{where}_{name}"] = [getattr(load, name)[squeezed] for load in found]
    if scene.bodies:
        motions, dim = simulation.body_motions(), simulation.case.dimension
        turning = 2 if dim == 2 else slice(3, None)
        for name in ("position", "velocity", "acceleration"):
            turned = "angle" if name == "position" else f"angular_{name}"
            sample[f"body_{name}"] = [getattr(motions[body], name)[:dim] for body in scene.bodies]
            sample[f"body_{turned}"] = [getattr(motions[body], name)[turning] for body in scene.bodies]
    return sample


def frame_of(simulation: RunView) -> dict[str, Any]:
    """Return the values of a frame by the names of the variables; ``time`` is the last."""
    fields = simulation.fields()
    return {
        **{name: getattr(fields, name) for name in ("position", "velocity", "pressure", "density")},
        **({"turns": simulation.turns()} if simulation.case.periodic else {}),
        "particles_outside": simulation.particles_outside(),
        **({"ghost_pressure": simulation.ghost_fields().pressure} if simulation.ghost_count else {}),
        "time": simulation.time,
    }


_FINITE = re.compile(r".*(energy|mass)|(wall|part|body)_.*|(ghost_|probe_|)pressure")
"""names of the values that are never missing"""


def check_finite(values: Mapping[str, Any]) -> None:
    """Check what is computed from a state, which may overflow although the state itself is finite.

    Raises
    ------
    SimulationError
        a value of a sample or a frame is not finite; particles that have been removed and dry gauges may have none.
    """
    removed = np.isnan(values["position"][:, 0]) if "position" in values else False
    for name, value in values.items():
        if _FINITE.fullmatch(name) and not np.all(np.isfinite(value) | (removed if name == "pressure" else False)):
            raise SimulationError(
                f"{name.replace('_', ' ')} is not finite, although the state of the particles is; likely causes:"
                " parameters of extreme size, such as artificial_viscosity, reference_density or sound_speed"
            )


def _dimensions(simulation: RunView) -> dict[str, int | None]:
    """Lengths of the dimensions. One that would be 0 is left out, since the classic format does not allow it."""
    scene, case = simulation.scene, simulation.case
    outlines = [line for wall in scene.walls for line in wall.outline()]
    triangles = sum(len(wall.triangles()) for wall in scene.walls)
    lengths = {
        **{name: len(names) for name, names in _names(simulation).items()},
        "outline": len(outlines),
        "node": sum(map(len, outlines)),
        "triangle": triangles,
        "corner": 3 * (triangles > 0),
        "ghost": simulation.ghost_count,
        "particle": simulation.particle_count,
        "probe_time": sample_count(case.until, case.probe_interval, case.time_step),
    }
    return {**{name: length for name, length in lengths.items() if length > 0}, "time": None}


def _define(file: netCDF4.Dataset, simulation: RunView, lengths: Mapping[str, int | None]) -> None:
    dimension = simulation.case.dimension
    for name, length in lengths.items():
        file.createDimension(name, length)
    for name, variable in _variables(simulation).items():
        if all(d in lengths for d in variable.dimensions):
            if variable.type == "text":
                width = f"{name}_length"
                file.createDimension(width, _text_length(name, simulation))
                made = file.createVariable(name, "S1", (*variable.dimensions, width))
                made.setncattr("_Encoding", "utf-8")
            else:
                fill = np.nan if variable.type == "f8" and variable.fill else None
                made = file.createVariable(name, variable.type, variable.dimensions, fill_value=fill)
                made.setncattr("units", unit_of(variable, dimension))
            made.setncattr("long_name", variable.long_name)
            made.setncatts(variable.attributes)
    axes = "xyz"[:dimension]
    for name, where in (("probe_pressure", "probe"), ("gauge_elevation", "gauge"), ("gauge_depth", "gauge")):
        if where in lengths:
            known = axes if where == "probe" else axes[:-1]
            file[name].setncattr("coordinates", " ".join(f"{where}_{axis}" for axis in known))
    for name in ("probe", "gauge"):
        for k, axis in enumerate(axes):
            if f"{name}_{axis}" in file.variables:
                upward = {"axis": "Z", "positive": "up"} if k == dimension - 1 else {"axis": axis.upper()}
                file[f"{name}_{axis}"].setncatts(upward)
    file["run_status"].setncattr("flag_values", np.array([int(status) for status in RunStatus], dtype=np.int32))
    file["interpolation_status"].setncattr("comment", "; ".join(f"{s.name}: {s.advice}" for s in Status))
    file.setncatts(_attributes(simulation))


def _variables(simulation: RunView) -> dict[str, Variable]:
    """The schema and the case's diagnostics; ``particle_mass`` stays the last variable of the fixed part."""
    dimension = simulation.case.dimension
    absent = {"probe_z", "gauge_y"} if dimension == 2 else set()
    absent |= set() if simulation.case.periodic else {"turns"}
    diagnostics = {}
    for diagnostic in simulation.scene.diagnostics:
        if diagnostic.name in VARIABLES:
            raise OutputError(f"the case's diagnostic {diagnostic.name!r} has the name of another variable: rename it")
        diagnostics[diagnostic.name] = Variable(("probe_time",), diagnostic.unit, diagnostic.long_name)
    known = {name: variable for name, variable in VARIABLES.items() if name not in absent}
    known = {name: replace(v, dimensions=dimensions_of(name, v, dimension)) for name, v in known.items()}
    mass = known.pop("particle_mass")
    fixed = {name: variable for name, variable in known.items() if "time" not in variable.dimensions}
    return {**fixed, **diagnostics, "particle_mass": mass, **known}


def _names(simulation: RunView) -> dict[str, Sequence[str]]:
    scene, dimension = simulation.scene, simulation.case.dimension
    return {
        "space": tuple("xyz"[:dimension]),
        "probe": [probe.name for probe in scene.probes],
        "gauge": [gauge.name for gauge in scene.gauges],
        "wall": [wall.name for wall in scene.walls],
        "part": [part.name for part in scene.wall_parts],
        "body": list(scene.bodies),
        "status": [status.name for status in Status],
    }


def _fill_start(file: netCDF4.Dataset, simulation: RunView) -> None:
    scene, dimension = simulation.scene, simulation.case.dimension
    for name, names in _names(simulation).items():
        if names:
            file[name][:] = encode_texts(names, len(file.dimensions[f"{name}_length"]))
    file["run_status"][...] = int(RunStatus.RUNNING)
    file["run_message"][:] = encode_texts([""], _MESSAGE_LENGTH)[0]
    file["probe_time"][:] = np.nan  # until a sample is written
    for k, axis in enumerate("xyz"[:dimension]):
        if scene.probes:
            file[f"probe_{axis}"][:] = [probe.position[k] for probe in scene.probes]
        if scene.gauges and k < dimension - 1:
            file[f"gauge_{axis}"][:] = [gauge.position[k] for gauge in scene.gauges]
    if scene.probes:
        file["probe_radius"][:] = [probe.radius for probe in scene.probes]
    if scene.walls:
        lines = [(index, line) for index, wall in enumerate(scene.walls) for line in wall.outline()]
        file["outline_node"][:] = np.concatenate([line for _, line in lines])
        file["outline_node_count"][:] = [len(line) for _, line in lines]
        file["outline_wall"][:] = [index for index, _ in lines]
        if dimension == 3:
            triangles = [wall.triangles() for wall in scene.walls]
            file["triangle_node"][:] = np.concatenate(triangles)
            file["triangle_wall"][:] = np.repeat(np.arange(len(triangles)), [len(part) for part in triangles])
        walls = [wall.name for wall in scene.walls]
        references = [
            wall.reference_point or (scene.bodies[wall.body].centre if wall.body else ()) for wall in scene.walls
        ]
        file["wall_reference"][:] = [(*point, 0.0, 0.0, 0.0)[:dimension] for point in references]
        if scene.wall_parts:
            file["part_wall"][:] = [walls.index(part.wall) for part in scene.wall_parts]
    bodies: dict[str | None, int] = {None: -1, **{name: index for index, name in enumerate(scene.bodies)}}
    for name, members in (("wall", scene.walls), ("probe", scene.probes), ("gauge", scene.gauges)):
        if members:
            file[f"{name}_body"][:] = [bodies[member.body] for member in members]
    if scene.bodies:
        file["body_centre"][:] = [(*body.centre, 0.0)[:dimension] for body in scene.bodies.values()]
    if simulation.ghost_count:
        ghosts = simulation.ghosts
        file["ghost_body"][:] = ghosts.body
        file["ghost_position"][:] = ghosts.position
        file["ghost_mirror_position"][:] = ghosts.mirror
    file["particle_mass"][:] = simulation.masses()


def _attributes(simulation: RunView) -> dict[str, Any]:
    """Global attributes: everything needed to repeat the run, and the scales for dimensionless numbers."""
    case, scene = simulation.case, simulation.scene
    chosen = {field: getattr(case, field) for field in COMPONENT_KINDS}
    components = {field: {"name": component.name, **component.options} for field, component in chosen.items()}
    versions, created = distributions(case), datetime.now(UTC).isoformat(timespec="seconds")
    return {
        "Conventions": CONVENTIONS,
        "title": case.title,
        "source": f"sphframe {versions['sphframe']}",
        "case_name": registered_name(type(case)),
        "case_parameters": json.dumps(case.model_dump(mode="json")),
        "components": json.dumps(components),
        "distributions": json.dumps(versions),
        "software": json.dumps(software()),
        "created": created,
        "history": f"{created} sphframe {versions['sphframe']}: simulated",
        "references": "https://sphframe.readthedocs.io",
        "dimension": np.int32(case.dimension),
        "particle_spacing": case.particle_spacing,
        "smoothing_length": simulation.smoothing_length,
        "sound_speed": simulation.sound_speed,
        "reference_density": case.reference_density,
        "gravity": simulation.case.weight,
        "gravity_vector": case.gravity_vector,
        "depth": scene.depth,
        "domain_lower": np.array(scene.domain[0], dtype=np.float64),
        "domain_upper": np.array(scene.domain[1], dtype=np.float64),
    }


def _text_length(name: str, simulation: RunView) -> int:
    texts = [] if name == "run_message" else [len(text.encode()) for text in _names(simulation)[name]]
    return max(1, *texts) if texts else _MESSAGE_LENGTH
