"""Analysis: export of a run for ParaView (a PVD series or VTKHDF), of its sampled series as CSV, and as Zarr.

VTK writes the files; PyVista makes its data sets from arrays. Positions have three components, with z = 0 in 2-D.
"""

import os
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import xarray as xr

from sphframe.analysis.fields import particles_at
from sphframe.analysis.placed import ghosts_at, triangles_at, walls_at
from sphframe.analysis.water import check_water_surface, in_water, pyvista_for, water_surface
from sphframe.arrays import Array
from sphframe.errors import InputError, OutputError

if TYPE_CHECKING:
    import pyvista

FORMATS = ("pvd", "vtkhdf", "csv", "zarr")


def export_run(
    dataset: xr.Dataset, folder: str | os.PathLike[str], to: str, *, surface: bool = False, track: Any = iter
) -> list[Path]:
    """Write a run into ``folder`` and return the files to open.

    Parameters
    ----------
    dataset
        the run, finished or still going.
    folder
        created if it is missing; files of an earlier export are replaced.
    to
        ``pvd`` for one series of files per part, ``vtkhdf`` for one file per part with all times (VTK's HDF format);
        ParaView opens both with their times. ``csv`` for probes, gauges, energies and diagnostics, ``zarr`` for
        everything, as a store that :func:`sphframe.open_dataset` and xarray open. The parts are ``fluid``, ``ghosts``,
        ``walls`` as lines and, in 3-D, ``surfaces``: the walls as triangles.
    surface
        add the part ``water``: the surface of the water of a run in 3-D as triangles.
    track
        wraps the list of times, such as ``rich.progress.track``.

    Raises
    ------
    InputError
        the format is unknown, the run has no frame yet, PyVista is not installed, or ``surface`` is asked for with a
        format that is not for ParaView; with it also those of :func:`sphframe.analysis.water_surface`.
    OutputError
        a file cannot be written.
    """
    if to not in FORMATS:
        raise InputError(f"no format {to!r}; choose one of {', '.join(FORMATS)}")
    if surface:
        if to not in ("pvd", "vtkhdf"):
            raise InputError(f"the surface of the water is written as pvd or vtkhdf, not as {to}: leave out surface")
        check_water_surface(dataset)
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if to == "zarr":
            return [_export_zarr(dataset, folder / "run.zarr")]
        if to == "csv":
            return [export_csv(dataset, folder / "series.csv")]
        return _export_vtk(dataset, folder, to, surface, track)
    except OSError as error:
        raise OutputError(f"cannot write to {folder}: {error.strerror or error}; choose another --output") from None


def _export_zarr(dataset: xr.Dataset, path: Path) -> Path:
    """Write all of a run as a Zarr store, which xarray opens in pieces."""
    if find_spec("zarr") is None:
        raise InputError("exports to Zarr need zarr: install it with pip install 'sphframe[zarr]'")
    dataset.drop_encoding().to_zarr(path, mode="w", zarr_format=2, consolidated=True)
    return path


def export_csv(dataset: xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write all sampled series into one table with one column per series, named ``variable[label] (unit)``."""
    columns = {}
    for name, variable in dataset.data_vars.items():
        if variable.dims[:1] == ("probe_time",):
            rest = variable.dims[1:]
            for label in np.ndindex(*(variable.sizes[dim] for dim in rest)):
                chosen = variable[(slice(None), *label)]
                labels = ",".join(str(chosen[dim].values) for dim in rest if dim in chosen.coords)
                heading = f"{name}[{labels}]" if rest else str(name)
                columns[f"{heading} ({variable.attrs.get('units', '1')})"] = chosen.values
    table = xr.Dataset(
        {heading: ("probe_time", values) for heading, values in columns.items()},
        coords={"time (s)": ("probe_time", dataset["probe_time"].values)},
    ).drop_vars("probe_time", errors="ignore")
    table.to_dataframe().set_index("time (s)").to_csv(path)
    return Path(path)


def vtk_parts(
    dataset: xr.Dataset, time: float | None = None, *, surface: bool = False
) -> "dict[str, pyvista.PolyData]":
    """Return those of ``fluid``, ``ghosts``, ``walls`` and ``surfaces`` that the run has, as VTK data sets.

    They are those of the frame nearest to ``time``, s. Walls and ghosts are where their bodies have taken them. With
    ``surface`` there is ``water`` too, the surface of the water with pressure, speed and velocity at its nodes.

    Raises
    ------
    InputError
        the run has no frame yet, the frame has no water, or PyVista is not installed; with ``surface`` also those of
        :func:`sphframe.analysis.water_surface`.
    """
    pyvista = pyvista_for("exports for ParaView need")
    frame = particles_at(dataset, time)
    alive = in_water(frame)
    fluid = pyvista.PolyData(_in_space(frame["position"].values[alive]))
    for name in ("pressure", "density"):
        fluid[name] = frame[name].values[alive]
    fluid["velocity"] = _in_space(frame["velocity"].values[alive])
    fluid["mass"] = dataset["particle_mass"].values[alive]
    fluid["id"] = alive.astype(np.int32)
    parts = {"fluid": fluid}
    now = float(frame["time"])
    if "ghost_position" in dataset:
        ghosts = pyvista.PolyData(_in_space(ghosts_at(dataset, now)))
        ghosts["pressure"] = dataset["ghost_pressure"].sel(time=now).values
        parts["ghosts"] = ghosts
    lines = walls_at(dataset, now)
    if lines:
        walls = pyvista.PolyData()
        walls.points = np.concatenate([_in_space(points) for points, _ in lines])
        starts = np.cumsum([0, *(len(points) for points, _ in lines)])
        walls.lines = np.concatenate(
            [[len(p), *range(s, s + len(p))] for s, (p, _) in zip(starts, lines, strict=False)]
        )
        walls["wall"] = np.concatenate([np.full(len(points), wall) for points, wall in lines])
        parts["walls"] = walls
    if "triangle_node" in dataset:
        triangles, owners = triangles_at(dataset, now)
        corners: Any = np.arange(3 * len(triangles)).reshape(-1, 3)
        parts["surfaces"] = pyvista.PolyData.from_regular_faces(triangles.reshape(-1, 3), corners)
        parts["surfaces"].cell_data["wall"] = owners
    if surface:
        parts["water"] = _water(dataset, frame)
    return parts


def _water(dataset: xr.Dataset, frame: xr.Dataset) -> "pyvista.PolyData":
    """Return the surface of the water in single precision, which is that of the contour."""
    import pyvista

    water = water_surface(dataset, float(frame["time"]))
    mesh = pyvista.PolyData.from_regular_faces(water.nodes.astype(np.float32), water.triangles)
    mesh.point_data.active_normals = water.normals.astype(np.float32)
    for name in ("pressure", "speed", "velocity"):
        mesh[name] = (water.average @ frame[name].values).astype(np.float32)
    return mesh


def _export_vtk(dataset: xr.Dataset, folder: Path, to: str, surface: bool, track: Callable[..., Any]) -> list[Path]:
    times = [float(time) for time in dataset["time"].values]
    parts = vtk_parts(dataset, times[0] if times else None, surface=surface)  # raises the error that there is no frame
    if to == "vtkhdf":
        return [_write_hdf(dataset, part, folder / f"{part}.vtkhdf", times) for part in track(list(parts))]
    written: dict[str, list[tuple[float, Path]]] = {}
    for number, time in enumerate(track(times)):
        for part, mesh in vtk_parts(dataset, time, surface=surface).items():
            path = folder / f"{part}_{number:04d}.vtp"
            mesh.field_data["TimeValue"] = [time]
            _write_xml(mesh, path)
            written.setdefault(part, []).append((time, path))
    return [_write_pvd(folder / f"{part}.pvd", files) for part, files in written.items()]


def _write_xml(mesh: Any, path: Path) -> None:
    """Write one data set as bytes behind the XML, compressed: a third less than as text within it."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(mesh)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToZLib()
    if not writer.Write():
        raise OutputError(f"cannot write {path}; choose another --output")


def _write_hdf(dataset: xr.Dataset, part: str, path: Path, times: list[float]) -> Path:
    """Write all frames of one part, with their times, into one compressed file."""
    from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    from vtkmodules.vtkIOHDF import vtkHDFWriter

    class Frames(VTKPythonAlgorithmBase):
        def __init__(self) -> None:
            super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")  # type: ignore[no-untyped-call]

        def RequestInformation(self, request: Any, before: Any, after: Any) -> int:  # noqa: N802
            information = after.GetInformationObject(0)
            information.Set(Pipeline.TIME_STEPS(), times, len(times))
            information.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)
            return 1

        def RequestData(self, request: Any, before: Any, after: Any) -> int:  # noqa: N802
            information = after.GetInformationObject(0)
            time = (
                information.Get(Pipeline.UPDATE_TIME_STEP()) if information.Has(Pipeline.UPDATE_TIME_STEP()) else None
            )
            self.GetOutputDataObject(0).ShallowCopy(vtk_parts(dataset, time, surface=part == "water")[part])
            return 1

    path.unlink(missing_ok=True)
    frames, writer = Frames(), vtkHDFWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(frames.GetOutputPort())
    writer.SetWriteAllTimeSteps(True)
    writer.SetChunkSize(max(vtk_parts(dataset, times[0], surface=part == "water")[part].n_points, 1))
    writer.SetCompressionLevel(4)
    if not writer.Write() or not path.exists():
        raise OutputError(f"cannot write {path}; choose another --output")
    return path


def _write_pvd(path: Path, files: list[tuple[float, Path]]) -> Path:
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for time, file in files:
        ElementTree.SubElement(collection, "DataSet", timestep=repr(time), part="0", file=file.name)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
    return path


def _in_space(vectors: Array) -> Array:
    """Vectors (n, dim) with a third component, zero in 2-D."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))
