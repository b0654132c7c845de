"""Output: the variables of a run's file with their dimensions, units and meaning.

Writer, reader, plots and exporters use these names and units. The file follows the CF conventions 1.11.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

CONVENTIONS = "CF-1.11"
FORMAT: Final = "NETCDF3_64BIT_DATA"
"""CDF-5, the classic format: a fixed header followed by data, so the file of a killed run stays readable"""


class RunStatus(IntEnum):
    """State of the run that wrote a file."""

    RUNNING = 0
    COMPLETED = 1
    FAILED = 2


@dataclass(frozen=True)
class Variable:
    """One variable of the file.

    Attributes
    ----------
    dimensions
        names, slowest first. ``time`` counts frames and is the unlimited dimension; ``probe_time`` counts the
        much more frequent samples of probes and sums.
    unit
        SI unit; see ``per_width``.
    long_name
        what it is, as the label of an axis.
    type
        ``f8``, ``i4``, or ``text`` (fixed-length UTF-8).
    per_width
        whether the quantity is per metre of width in 2-D; its unit is then divided by m.
    fill
        whether values that have not been written are marked by ``_FillValue``, which coordinates must not have.
    attributes
        further CF attributes.
    """

    dimensions: tuple[str, ...]
    unit: str
    long_name: str
    type: Literal["f8", "i4", "text"] = "f8"
    per_width: bool = False
    fill: bool = True
    attributes: Mapping[str, str] = field(default_factory=dict)


def unit_of(variable: Variable, dimension: int) -> str:
    """Return the unit of ``variable`` in ``dimension`` = 2 or 3.

    >>> unit_of(VARIABLES["kinetic_energy"], 2), unit_of(VARIABLES["kinetic_energy"], 3)
    ('J m-1', 'J')
    """
    return f"{variable.unit} m-1" if variable.per_width and dimension == 2 else variable.unit


def encode_texts(texts: Sequence[str], width: int) -> NDArray[np.bytes_]:
    """Return the values of a ``text`` variable: bytes (n, width) of UTF-8, each text cut at ``width`` bytes."""
    encoded = [text.encode()[:width].decode(errors="ignore").encode() for text in texts]
    return np.array(encoded, dtype=f"S{width}").view("S1").reshape(len(encoded), width)


def _text(dimensions: tuple[str, ...], long_name: str) -> Variable:
    return Variable(dimensions, "", long_name, "text")


_ABOUT = {"comment": "about the reference point of the wall, by default the centre of its body, or the origin"}

VARIABLES: Mapping[str, Variable] = {
    # names along the dimensions
    "space": _text(("space",), "axis of space; the last one is the height"),
    "probe": _text(("probe",), "pressure probe"),
    "gauge": _text(("gauge",), "free-surface gauge"),
    "wall": _text(("wall",), "wall"),
    "part": _text(("part",), "named part of a wall"),
    "body": _text(("body",), "body that carries walls"),
    "status": _text(("status",), "what became of the interpolation to a ghost particle"),
    # constant during a run
    "run_status": Variable(
        (), "1", "how the run stands", "i4", attributes={"flag_meanings": "running completed failed"}
    ),
    "run_message": _text((), "why the run failed"),
    **{f"probe_{axis}": Variable(("probe",), "m", f"position of the probe along {axis}", fill=False) for axis in "xyz"},
    "probe_radius": Variable(("probe",), "m", "radius over which the probe averages; 0 for a point"),
    **{f"gauge_{axis}": Variable(("gauge",), "m", f"position of the gauge along {axis}", fill=False) for axis in "xy"},
    "probe_body": Variable(("probe",), "1", "index of the body that carries the probe; -1 for a probe at rest", "i4"),
    "gauge_body": Variable(("gauge",), "1", "index of the body that carries the gauge; -1 for a gauge at rest", "i4"),
    "part_wall": Variable(("part",), "1", "index of the wall of which it is a part", "i4"),
    "outline_node": Variable(("node", "space"), "m", "points of the polylines that draw the walls, at the start"),
    "outline_node_count": Variable(
        ("outline",), "1", "points of each polyline", "i4", attributes={"sample_dimension": "node"}
    ),
    "outline_wall": Variable(("outline",), "1", "index of the wall that the polyline draws", "i4"),
    "triangle_node": Variable(("triangle", "corner", "space"), "m", "triangles of the walls in 3-D, at the start"),
    "triangle_wall": Variable(("triangle",), "1", "index of the wall of each triangle", "i4"),
    "wall_body": Variable(("wall",), "1", "index of the body that carries the wall; -1 for a fixed wall", "i4"),
    "wall_reference": Variable(("wall", "space"), "m", "point to which the moment on the wall refers, as drawn"),
    "body_centre": Variable(("body", "space"), "m", "centre about which the body turns, as drawn"),
    "ghost_position": Variable(("ghost", "space"), "m", "position of the ghost particle at the start"),
    "ghost_mirror_position": Variable(("ghost", "space"), "m", "mirror point of the ghost particle at the start"),
    "ghost_body": Variable(("ghost",), "1", "index of the body that carries the ghost; -1 for a ghost at rest", "i4"),
    # samples
    "probe_time": Variable(("probe_time",), "s", "time of the samples", fill=False),
    "step": Variable(("probe_time",), "1", "steps taken", "i4"),
    "time_step": Variable(("probe_time",), "s", "time step"),
    "wall_clock": Variable(("probe_time",), "s", "wall-clock time since the start of the run"),
    "processor_time": Variable(("probe_time",), "s", "processor time of all threads since the start of the run"),
    "probe_pressure": Variable(("probe_time", "probe"), "Pa", "pressure at the probe"),
    "probe_wet": Variable(("probe_time", "probe"), "1", "1 where the probe is wet, 0 where it is dry", "i4"),
    "gauge_elevation": Variable(("probe_time", "gauge"), "m", "elevation of the free surface"),
    "gauge_depth": Variable(("probe_time", "gauge"), "m", "length of the vertical that is in water"),
    "kinetic_energy": Variable(("probe_time",), "J", "kinetic energy", per_width=True),
    "potential_energy": Variable(("probe_time",), "J", "potential energy", per_width=True),
    "internal_energy": Variable(("probe_time",), "J", "internal energy of compression", per_width=True),
    "total_energy": Variable(("probe_time",), "J", "sum of kinetic, potential and internal energy", per_width=True),
    "mass": Variable(("probe_time",), "kg", "mass of the fluid", per_width=True),
    "interpolation_status": Variable(
        ("probe_time", "status"), "1", "ghost particles by the status of their interpolation", "i4"
    ),
    "particles_removed": Variable(("probe_time",), "1", "particles that left the domain and were removed", "i4"),
    "densities_outside": Variable(("probe_time",), "1", "particles with a density outside the guards' band", "i4"),
    **{
        f"{where}_{load}{suffix}": Variable(
            ("probe_time", where, "space"),
            unit,
            f"{load} of the fluid on the {what}, {how}",
            per_width=True,
            attributes=about,
        )
        for where, what in (("wall", "wall"), ("part", "part of a wall"))
        for load, unit, about in (("force", "N", {}), ("moment", "N m", _ABOUT))
        for suffix, how in (("", "reaction of its ghosts"), ("_by_pressure", "integral of pressure"))
    },
    "body_position": Variable(("probe_time", "body", "space"), "m", "displacement of the body's centre"),
    "body_velocity": Variable(("probe_time", "body", "space"), "m s-1", "velocity of the body's centre"),
    "body_acceleration": Variable(("probe_time", "body", "space"), "m s-2", "acceleration of the body's centre"),
    "body_angle": Variable(("probe_time", "body", "space"), "rad", "angle of the body, in 3-D a rotation vector"),
    "body_angular_velocity": Variable(("probe_time", "body", "space"), "rad s-1", "angular velocity of the body"),
    "body_angular_acceleration": Variable(
        ("probe_time", "body", "space"), "rad s-2", "angular acceleration of the body"
    ),
    # last of the fixed part: its last value is never zero, so a zero there reveals a truncated file
    "particle_mass": Variable(("particle",), "kg", "mass of the particle", per_width=True),
    # frames
    "time": Variable(("time",), "s", "time of the frames", fill=False),
    "position": Variable(("time", "particle", "space"), "m", "position"),
    "turns": Variable(
        ("time", "particle", "space"),
        "1",
        "periods by which the particle has left the domain, in periodic directions",
        "i4",
    ),
    "velocity": Variable(("time", "particle", "space"), "m s-1", "velocity"),
    "pressure": Variable(("time", "particle"), "Pa", "pressure"),
    "particles_outside": Variable(("time",), "1", "fluid particles behind a wall", "i4"),
    "ghost_pressure": Variable(("time", "ghost"), "Pa", "pressure of the ghost particle"),
    # last of every frame: never zero either, for the same reason
    "density": Variable(("time", "particle"), "kg m-3", "density"),
}
