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
    """

    position: Array
    volume: Array
    pressure: Array
    spacing: float
    smoothing_length: float | None = None

    def length(self, given: float | None) -> float:
        """Return the smoothing length that is ``given``, m, else that of the file, else 1.3 spacings."""
        return given or self.smoothing_length or 1.3 * self.spacing


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
    try:
        found = readers[source.suffix]()
    except ImportError as error:
        raise InputError(f"{source} needs {error.name}: python -m pip install 'sphframe[evaluate]'") from None
    except (OSError, KeyError, ValueError, AttributeError) as error:
        raise InputError(f"cannot read particles from {source}: {error}") from None
    return _particles(source, found, spacing, fields or {})


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
    position = np.ascontiguousarray(position[:, extent > 1e-9 * extent.max()])
    if position.shape[1] not in (2, 3):
        raise InputError(f"{source}: the particles lie on one line; expected two or three dimensions")
    given, h = field("spacing"), field("smoothing_length")
    dx = spacing or (float(np.median(given)) if given is not None and np.median(given) > 0.0 else _spacing(position))
    volume = np.full(len(position), dx ** position.shape[1])
    if mass is not None and density is not None:
        volume = (mass / density)[present]
    return Particles(position, volume, pressure[present], dx, None if h is None else float(np.median(h)))


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
