"""Testing: particles read from files of this project and of other programs, to judge methods on them.

=================  ==================================================  =============================================
program            file                                                names
=================  ==================================================  =============================================
sphframe           ``.nc``, one of its frames                          ``position``, ``density``, ``pressure``
DualSPHysics 5     ``.vtk`` of PartVTK with                            ``Rhop``, ``Press``; in two dimensions the
                   ``-vars:+rhop,+press``                              particles are in the plane x, z
TrixiParticles.jl  ``.vtu`` of its ``SolutionSavingCallback``          ``density``, ``pressure``,
                                                                       ``particle_spacing``
PySPH              ``.hdf5`` of its ``dump``, one of its arrays,       ``x``, ``y``, ``z``, ``rho``, ``p``, ``m``,
                   ``particles/NAME/arrays``                           ``h``
=================  ==================================================  =============================================

Sources: the example scripts of DualSPHysics 5 that call PartVTK; ``src/io/write_vtk.jl`` of TrixiParticles.jl at
01abc6b; ``pysph/solver/output.py`` of PySPH at 0eb950b. Other names are given by ``fields``. A direction in which all
particles have the same coordinate is left out.

Wall particles are the ghosts of a run of sphframe, another array of a file of PySPH, or another file of the other
programs.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sphframe.arrays import Array
from sphframe.errors import InputError

NAMES = {
    "pressure": ("pressure", "Press", "p"),
    "density": ("density", "Rhop", "rho"),
    "mass": ("mass", "Mass", "m"),
    "smoothing_length": ("h", "smoothing_length"),
    "spacing": ("particle_spacing",),
    "normal": (),
}
"""names of fields in the files of the programs above"""


@dataclass(frozen=True)
class Particles:
    """Particles of a fluid, n of them, in the d directions in which they differ.

    Attributes
    ----------
    position
        (n, d), m.
    volume
        (n,), m^d.
    pressure
        (n,), Pa.
    spacing
        particle spacing, m.
    smoothing_length
        m, where the file gives it.
    axes
        directions of the file that are kept, of x, y, z.
    density
        median of the densities, kg/m^3, where the file has some.
    """

    position: Array
    volume: Array
    pressure: Array
    spacing: float
    smoothing_length: float | None = None
    axes: tuple[int, ...] = (0, 1, 2)
    density: float | None = None

    def length(self, given: float | None) -> float:
        """Return the smoothing length that is ``given``, m, else that of the file, else 1.3 spacings."""
        return given or self.smoothing_length or 1.3 * self.spacing


@dataclass(frozen=True)
class WallPoints:
    """Wall particles, w of them, at which methods are judged.

    Attributes
    ----------
    position
        (w, d), m.
    mirror
        (w, d), m: mirror points in the fluid, or the positions again where the file has none.
    pressure
        (w,), Pa, the stored one.
    force
        (d,), N/m^3: gravity times density, by which the pressure between particles and wall particle is corrected.
    """

    position: Array
    mirror: Array
    pressure: Array
    force: Array


def read_walls(
    path: str | Path,
    particles: Particles,
    *,
    walls: str | None = None,
    gravity: float | None = None,
    time: float | None = None,
    fields: Mapping[str, str] | None = None,
) -> WallPoints | None:
    """Read the wall particles that belong to the ``particles`` of a file; None where no ``walls`` are named.

    Parameters
    ----------
    path, time, fields
        as for :func:`read_particles`. The field ``normal``, (w, 3), m, leads from a wall particle to the surface of the
        wall; the mirror point is twice as far.
    particles
        read from ``path``.
    walls
        of PySPH, the array of wall particles; of DualSPHysics and TrixiParticles, their file. A run of sphframe has its
        ghosts at rest.
    gravity
        m/s^2, against the last direction; by default that of the run, or 0. The density is that of the particles, or
        1000 kg/m^3.

    Raises
    ------
    InputError
        when they cannot be read, have no pressure, or are in other directions than the particles.
    """
    source = Path(path)
    if source.suffix == ".nc":
        from sphframe.cases import load_case

        found = _read(source, lambda: _ghosts_of_run(source, time))
        if found is None:
            return None
        case = load_case(source)
        downward = case.gravity_vector if gravity is None else _downward(particles, gravity)
        position, mirror, stored_pressure = found
        return WallPoints(position, mirror, stored_pressure, case.reference_density * downward)
    if walls is None:
        return None
    inside = source.suffix in (".hdf5", ".h5")
    other = source if inside else Path(walls)
    reader = (lambda: _of_pysph(source, walls)) if inside else (lambda: _of_vtk(other))
    if not other.is_file():
        raise InputError(f"{other} does not exist")
    stored = _read(other, reader)
    names = NAMES | {kind: (name,) for kind, name in (fields or {}).items()}
    pressure, normal = (next((stored[n] for n in names[kind] if n in stored), None) for kind in ("pressure", "normal"))
    axes = list(particles.axes)
    everywhere = np.asarray(stored["position"], dtype=np.float64)
    if pressure is None or everywhere.shape[1] <= max(axes):
        raise InputError(f"{other} has no pressure of wall particles; it has {', '.join(sorted(stored))}")
    position = np.ascontiguousarray(everywhere[:, axes])
    mirror = position if normal is None else position + 2.0 * np.asarray(normal, dtype=np.float64)[:, axes]
    force = (particles.density or 1000.0) * _downward(particles, gravity or 0.0)
    return WallPoints(position, mirror, np.asarray(pressure, dtype=np.float64).reshape(-1), force)


def _downward(particles: Particles, gravity: float) -> Array:
    return np.asarray(-gravity * np.eye(particles.position.shape[1])[-1])


def _read(source: Path, reader: Callable[[], Any]) -> Any:
    try:
        return reader()
    except ImportError as error:
        raise InputError(f"{source} needs {error.name}: python -m pip install 'sphframe[evaluate]'") from None
    except (OSError, KeyError, ValueError, AttributeError) as error:
        raise InputError(f"cannot read particles from {source}: {error}") from None


def _ghosts_of_run(source: Path, time: float | None) -> tuple[Array, Array, Array] | None:
    from sphframe.output import open_dataset

    with open_dataset(source) as dataset:
        frame = dataset.isel(time=-1) if time is None else dataset.sel(time=time, method="nearest")
        if "ghost_pressure" not in frame:
            return None
        pressure = frame["ghost_pressure"].values
        found = np.isfinite(pressure) & (frame["ghost_body"].values < 0)
        position, mirror = (frame[f"ghost_{name}"].values[found] for name in ("position", "mirror_position"))
        return np.ascontiguousarray(position), np.ascontiguousarray(mirror), pressure[found]


def read_particles(
    path: str | Path,
    *,
    time: float | None = None,
    spacing: float | None = None,
    array: str | None = None,
    fields: Mapping[str, str] | None = None,
) -> Particles:
    """Read the fluid particles of a file.

    Parameters
    ----------
    path
        ``.nc``, ``.vtk``, ``.vtu``, ``.vtp``, ``.hdf5`` or ``.h5``.
    time
        s; the frame of a file of several that is nearest to it, by default the last one.
    spacing
        m; by default that of the file, or the median distance of nearest neighbours.
    array
        of a file of PySPH, the particle array; by default ``fluid``, or the only one.
    fields
        other names of the fields, by the keys of :data:`NAMES`.

    Raises
    ------
    InputError
        when the file cannot be read, or has no pressure.
    """
    source = Path(path)
    readers: dict[str, Callable[[], dict[str, Any]]] = {
        ".nc": lambda: _of_run(source, time),
        **dict.fromkeys((".vtk", ".vtu", ".vtp"), lambda: _of_vtk(source)),
        **dict.fromkeys((".hdf5", ".h5"), lambda: _of_pysph(source, array)),
    }
    if source.suffix not in readers:
        raise InputError(f"{source}: expected a file that ends in {', '.join(readers)}")
    if not source.is_file():
        raise InputError(f"{source} does not exist")
    return _particles(source, _read(source, readers[source.suffix]), spacing, fields or {})


def _particles(source: Path, found: dict[str, Any], spacing: float | None, fields: Mapping[str, str]) -> Particles:
    unknown = sorted(set(fields) - set(NAMES))
    if unknown:
        raise InputError(f"fields {', '.join(unknown)} are unknown: choose {', '.join(NAMES)}")

    def field(kind: str) -> Array | None:
        names = (fields[kind],) if kind in fields else NAMES[kind]
        name = next((name for name in names if name in found), None)
        if name is None and kind in fields:
            raise InputError(f"{source} has no field {fields[kind]!r}; it has {', '.join(sorted(found))}")
        return None if name is None else np.asarray(found[name], dtype=np.float64).reshape(-1)

    position = np.asarray(found.pop("position"), dtype=np.float64)
    pressure, density, mass = field("pressure"), field("density"), field("mass")
    if pressure is None or len(position) < 2:
        raise InputError(
            f"{source} has no pressure of particles; it has {', '.join(sorted(found))}: name the field, such as"
            " --field pressure=Press"
        )
    present = np.isfinite(position).all(axis=1) & np.isfinite(pressure)
    position = position[present]
    extent = np.ptp(position, axis=0)
    axes = tuple(np.flatnonzero(extent > 1e-9 * extent.max()).tolist())
    position = np.ascontiguousarray(position[:, axes])
    if position.shape[1] not in (2, 3):
        raise InputError(f"{source}: the particles lie on one line; expected two or three dimensions")
    given, h = field("spacing"), field("smoothing_length")
    dx = spacing or (float(np.median(given)) if given is not None and np.median(given) > 0.0 else _spacing(position))
    volume = np.full(len(position), dx ** position.shape[1])
    if mass is not None and density is not None:
        volume = (mass / density)[present]
    length, middle = (None if values is None else float(np.median(values)) for values in (h, density))
    return Particles(position, volume, pressure[present], dx, length, axes, middle)


def _spacing(position: Array) -> float:
    from scipy.spatial import cKDTree

    return float(np.median(cKDTree(position).query(position, k=2)[0][:, 1]))


def _of_run(source: Path, time: float | None) -> dict[str, Any]:
    from sphframe.cases import load_case
    from sphframe.output import open_dataset

    with open_dataset(source) as dataset:
        frame = dataset.isel(time=-1) if time is None else dataset.sel(time=time, method="nearest")
        found: dict[str, Any] = {name: frame[name].values for name in ("position", "pressure", "density")}
    case = load_case(source)
    number = len(found["pressure"])
    h = case.smoothing_length_ratio * case.particle_spacing
    return found | {"particle_spacing": np.full(number, case.particle_spacing), "h": np.full(number, h)}


def _of_vtk(source: Path) -> dict[str, Any]:
    import pyvista

    mesh: Any = pyvista.read(source)
    return {**{name: mesh.point_data[name] for name in mesh.point_data}, "position": mesh.points}


def _of_pysph(source: Path, array: str | None) -> dict[str, Any]:
    import h5py

    with h5py.File(source) as file:
        arrays = list(file["particles"])
        chosen = array or ("fluid" if "fluid" in arrays else arrays[0] if len(arrays) == 1 else "")
        if chosen not in arrays:
            raise InputError(f"{source} holds the particle arrays {', '.join(arrays)}: choose one by --array")
        group = file["particles"][chosen]["arrays"]
        found = {name: group[name][()] for name in group if group[name].shape != (0,)}
    return {**found, "position": np.column_stack([found[axis] for axis in "xyz" if axis in found])}
