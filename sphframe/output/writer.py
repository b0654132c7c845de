"""Output: writes a run into one NetCDF file as it goes.

The file appears under its name complete with header and everything that does not change, by an atomic rename. From
then on numbers are only added: a frame counts once the record number in the header says so, which is written after
the frame's data, and a sample counts once its ``probe_time`` is no longer NaN, which is written last. So the file is
readable at any moment, and after a crash at any moment.
"""

import contextlib
import errno
import json
import os
import shutil
import time
import uuid
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import netCDF4
import numpy as np
from numpy.typing import NDArray

from sphframe.errors import OutputError
from sphframe.hooks import hookimpl
from sphframe.interfaces import CaseView, RunView, Status
from sphframe.output.lock import lock_file
from sphframe.output.provenance import distributions, registered_name, software
from sphframe.output.schema import CONVENTIONS, FORMAT, VARIABLES, RunStatus, Variable, unit_of
from sphframe.registry import COMPONENT_KINDS

if TYPE_CHECKING:
    from sphframe.output.checkpoint import Checkpoint

__all__ = ["NetCDFWriter", "checkpoint_path"]

_MESSAGE_LENGTH = 500


class NetCDFWriter:
    """A hook plugin that writes a run to ``path``.

    Parameters
    ----------
    path: where the file goes; conventionally ending in ``.nc``.
    overwrite: replace an existing file. It is replaced when the run starts, not before.
    flush_interval: seconds of wall-clock time after which samples are written at the latest; a killed run loses at
        most these.
    resumed: the checkpoint from which an existing file is continued, in place of a new one.

    Raises
    ------
    OutputError: the file exists and ``overwrite`` is false, its folder is missing or cannot be written to, or another
        run is writing it. All of this is checked here, before anything is computed.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        overwrite: bool = False,
        *,
        flush_interval: float = 1.0,
        resumed: "Checkpoint | None" = None,
    ) -> None:
        self.path = Path(path)
        self.run_id = ""
        """what tells this run's files from those of another, once it has started"""
        self._resumed = resumed
        self.overwrite = overwrite
        self.flush_interval = flush_interval
        self._file: netCDF4.Dataset | None = None
        self._lock: int | None = None
        self._samples: list[dict[str, Any]] = []
        self._written = 0
        self._frames = 0
        self._flushed_at = 0.0
        if resumed is None:
            _check_target(self.path, overwrite)

    @hookimpl
    def sphframe_run_started(self, simulation: RunView) -> None:
        """Create the file, with all that is known at the start; or open it again, to continue it."""
        if self._resumed is not None:
            self._reopen(self._resumed)
            return
        _check_target(self.path, self.overwrite)
        lengths = _dimensions(simulation)
        _check_space(self.path, lengths, _planned_frames(simulation.case))
        draft = self.path.with_name(f".{self.path.name}.draft")
        with self._keeping():
            draft.touch()
            self._lock = lock_file(draft)
            if self._lock is None:
                raise OutputError(_taken(self.path))
            try:
                self._file = netCDF4.Dataset(draft, "w", format=FORMAT)
                self._file.set_auto_maskandscale(False)
                self._file.set_auto_chartostring(False)
                _define(self._file, simulation, lengths)
                self.run_id = uuid.uuid4().hex
                self._file.setncattr("run_id", self.run_id)
                _fill_start(self._file, simulation)
                self._file.sync()
                self._publish(draft)
                checkpoint_path(self.path).unlink(missing_ok=True)  # of the run that was replaced
            except BaseException:
                self._abandon()
                draft.unlink(missing_ok=True)
                raise
        self._flushed_at = time.monotonic()

    @hookimpl
    def sphframe_probes_due(self, simulation: RunView) -> None:
        """Take a sample of probes, sums and diagnostics."""
        self._samples.append(_sample(simulation))
        if time.monotonic() - self._flushed_at > self.flush_interval:
            self._flush()

    @hookimpl
    def sphframe_frame_due(self, simulation: RunView) -> None:
        """Write all particles."""
        file = self._open_file()
        fields = simulation.fields()
        with self._keeping():
            self._check_in_place()
            frame = self._frames
            for name in ("position", "velocity", "pressure", "density"):
                file[name][frame] = getattr(fields, name)
            file["particles_outside"][frame] = simulation.particles_outside()
            file["ghost_pressure"][frame] = simulation.ghost_fields().pressure
            file["time"][frame] = simulation.time
            file.sync()
            self._frames += 1
        self._flush()

    @hookimpl
    def sphframe_run_finished(self, simulation: RunView) -> None:
        """Write what is left, mark the run as completed and close the file."""
        self._end(RunStatus.COMPLETED, "")

    @hookimpl
    def sphframe_run_failed(self, simulation: RunView, error: BaseException) -> None:
        """Write what is left, with the reason of the failure, and close the file."""
        if self._file is None:
            return
        with contextlib.suppress(OutputError):  # the run has failed already, perhaps for want of space
            interrupted = isinstance(error, KeyboardInterrupt)
            self._end(RunStatus.FAILED, "interrupted" if interrupted else f"{type(error).__name__}: {error}")

    def _end(self, status: RunStatus, message: str) -> None:
        self._flush()
        with self._keeping():
            self._mark(status, message)
            self._close()

    def flush(self) -> None:
        """Bring all that was told so far to the disk.

        Raises
        ------
        OutputError: when that fails.
        """
        if self._file is None:
            return
        self._flush()
        with self._keeping():
            if self._lock is not None:
                os.fsync(self._lock)

    def _reopen(self, checkpoint: "Checkpoint") -> None:
        with self._keeping():
            self._lock = lock_file(self.path)
            if self._lock is None:
                raise OutputError(_taken(self.path))
            self._file = file = netCDF4.Dataset(self.path, "r+")
            file.set_auto_maskandscale(False)
            file.set_auto_chartostring(False)
            samples = int(np.isfinite(file["probe_time"][:]).sum())
            if getattr(file, "run_id", "") != checkpoint.run_id:
                self._abandon()
                raise OutputError(f"{self.path} is of another run than its checkpoint; run the case again")
            if len(file["time"]) < checkpoint.frames or samples < checkpoint.samples:
                self._abandon()
                raise OutputError(
                    f"{self.path} holds less than its checkpoint counts: it is an older copy; put them together again,"
                    " or run the case again"
                )
            self.run_id = checkpoint.run_id
            self._frames, self._written = checkpoint.frames, checkpoint.samples
            self._mark(RunStatus.RUNNING, "")
        self._flushed_at = time.monotonic()

    def _mark(self, status: RunStatus, message: str) -> None:
        file = self._open_file()
        file["run_message"][:] = _characters([message], _MESSAGE_LENGTH)[0]
        file["run_status"][...] = int(status)
        file.sync()

    def _flush(self) -> None:
        """Write the samples gathered so far: first their values, then, once these are on disk, their times."""
        file = self._open_file()
        with self._keeping():
            if self._samples:
                self._check_in_place()
                rows = slice(self._written, self._written + len(self._samples))
                for name in self._samples[0]:
                    if name != "probe_time":
                        file[name][rows] = np.array([sample[name] for sample in self._samples])
                file.sync()
                file["probe_time"][rows] = np.array([sample["probe_time"] for sample in self._samples])
            file.sync()
        self._written += len(self._samples)
        self._samples.clear()
        self._flushed_at = time.monotonic()

    def _publish(self, draft: Path) -> None:
        """Give the finished draft its name. Never replaces a file that another run is writing."""
        if self.overwrite and self.path.exists():
            old = lock_file(self.path)
            if old is None:
                raise OutputError(_taken(self.path))
            try:
                draft.replace(self.path)
            finally:
                os.close(old)
        else:
            try:
                os.link(draft, self.path)
            except FileExistsError:
                raise OutputError(_exists(self.path)) from None
            except OSError:  # a file system without hard links
                draft.rename(self.path)
            else:
                draft.unlink()

    def _check_in_place(self) -> None:
        if self._lock is None:
            return
        try:
            same = os.path.samestat(os.fstat(self._lock), os.stat(self.path))
        except FileNotFoundError:
            same = False
        if not same:
            raise OutputError(
                f"{self.path} was deleted or replaced while the run was writing it; the run stops."
                " Run it again, with another --output if something cleans that folder"
            )

    @contextlib.contextmanager
    def _keeping(self) -> Iterator[None]:
        """Turn failures to write into an OutputError that says what was kept."""
        try:
            yield
        except (OSError, RuntimeError) as error:
            if self._written or self._frames:
                kept = f"{self._frames} frames and {self._written} samples written before are intact in {self.path}"
            else:
                kept = "nothing was written"
            self._abandon()
            full = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
            if getattr(error, "errno", None) in full or any(os.strerror(number) in str(error) for number in full):
                cause = "the disk is full or the size limit is reached"
                remedy = "free some space or choose another --output, or a larger frame_interval"
            else:
                cause = str(error)
                remedy = "check the folder and its permissions, or choose another --output"
            raise OutputError(f"cannot write {self.path}: {cause}; {kept}. To mend it: {remedy}") from error

    def _open_file(self) -> netCDF4.Dataset:
        if self._file is None:
            raise OutputError(f"{self.path} is not open: the run has not started, or writing has failed before")
        return self._file

    def _abandon(self) -> None:
        """Let go of a file that cannot be written to. Closing it would fail too, and netCDF4 then frees it twice."""
        self._file = None
        self._close()

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None


def checkpoint_path(output: Path) -> Path:
    """Return where the checkpoint of a run with this output lies."""
    return output.with_name(f"{output.name}.restart")


def _exists(path: Path) -> str:
    resume = f", sphframe resume {path} to continue it" if checkpoint_path(path).exists() else ""
    return f"{path} exists: give --overwrite (overwrite=True) to replace it{resume}, or another --output"


def _taken(path: Path) -> str:
    return f"another run is writing {path}: wait for it, stop it, or give another --output"


def _check_target(path: Path, overwrite: bool) -> None:
    folder = path.parent
    if path.is_dir():
        raise OutputError(f"{path} is a folder: name a file in it, such as {path / 'run.nc'}")
    if path.exists():
        if not overwrite:
            raise OutputError(_exists(path))
        try:
            descriptor = lock_file(path)
        except OSError as error:
            raise OutputError(f"cannot replace {path}: {error.strerror}; choose another --output") from None
        if descriptor is None:
            raise OutputError(_taken(path))
        os.close(descriptor)
    elif checkpoint_path(path).exists() and not overwrite:
        raise OutputError(
            f"{checkpoint_path(path)} exists, the checkpoint of a run whose output is gone: give --overwrite"
            " (overwrite=True) to remove it, or another --output"
        )
    if not folder.is_dir():
        raise OutputError(f"the folder {folder} for {path.name} does not exist: create it (mkdir -p {folder})")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputError(
            f"the folder {folder} cannot be written to: change its permissions or choose another --output"
        )


def _check_space(path: Path, lengths: Mapping[str, int | None], frames: int) -> None:
    planned = sum(
        8 * int(np.prod([frames if (n := lengths[d]) is None else n for d in variable.dimensions]))
        for variable in VARIABLES.values()
        if all(d in lengths for d in variable.dimensions) and variable.type == "f8"
    )
    free = shutil.disk_usage(path.parent).free
    if planned > free:
        raise OutputError(
            f"{path} would need about {planned / 1e9:.1f} GB for {frames} frames, but only {free / 1e9:.1f} GB are"
            " free: choose another --output, a larger frame_interval, or free some space"
        )


def _planned_frames(case: CaseView) -> int:
    return int(case.until / case.frame_interval) + 2


def _dimensions(simulation: RunView) -> dict[str, int | None]:
    """Lengths of the dimensions; what the case does not have is left out (a classic file has no length 0)."""
    scene, case = simulation.scene, simulation.case
    outlines = [line for wall in scene.walls for line in wall.outline()]
    lengths = {
        "space": case.dimension,
        "motion": 3,
        "probe": len(scene.probes),
        "gauge": len(scene.gauges),
        "wall": len(scene.walls),
        "body": len(scene.bodies),
        "status": len(Status),
        "outline": len(outlines),
        "node": sum(map(len, outlines)),
        "ghost": simulation.ghost_count,
        "particle": simulation.fluid_count,
        "probe_time": int(np.ceil(case.until / case.probe_interval)) + 2,
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
                fill = np.nan if variable.type == "f8" else None
                made = file.createVariable(name, variable.type, variable.dimensions, fill_value=fill)
                made.setncattr("units", unit_of(variable, dimension))
            made.setncattr("long_name", variable.long_name)
            made.setncatts(variable.attributes)
    axes = "xyz"[:dimension]
    for name, where in (("probe_pressure", "probe"), ("gauge_elevation", "gauge")):
        if where in lengths:
            known = axes if where == "probe" else axes[:-1]
            file[name].setncattr("coordinates", " ".join(f"{where}_{axis}" for axis in known))
    file["run_status"].setncattr("flag_values", np.array([int(status) for status in RunStatus], dtype=np.int32))
    file["interpolation_status"].setncattr("comment", "; ".join(f"{s.name}: {s.advice}" for s in Status))
    file.setncatts(_attributes(simulation))


def _variables(simulation: RunView) -> dict[str, Variable]:
    """The schema with the case's diagnostics added, ``particle_mass`` staying the last of the fixed part."""
    dimension = simulation.case.dimension
    absent = {"probe_z", "gauge_y"} if dimension == 2 else set()
    diagnostics = {}
    for diagnostic in simulation.scene.diagnostics:
        if diagnostic.name in VARIABLES:
            raise OutputError(f"the case's diagnostic {diagnostic.name!r} has the name of another variable: rename it")
        diagnostics[diagnostic.name] = Variable(("probe_time",), diagnostic.unit, diagnostic.long_name)
    known = {name: variable for name, variable in VARIABLES.items() if name not in absent}
    mass = known.pop("particle_mass")
    fixed = {name: variable for name, variable in known.items() if "time" not in variable.dimensions}
    return {**fixed, **diagnostics, "particle_mass": mass, **known}


def _names(simulation: RunView) -> dict[str, Sequence[str]]:
    scene, dimension = simulation.scene, simulation.case.dimension
    return {
        "space": tuple("xyz"[:dimension]),
        "motion": ("x", "y", "angle") if dimension == 2 else ("x", "y", "z"),
        "probe": [probe.name for probe in scene.probes],
        "gauge": [gauge.name for gauge in scene.gauges],
        "wall": [wall.name for wall in scene.walls],
        "body": list(scene.bodies),
        "status": [status.name for status in Status],
    }


def _fill_start(file: netCDF4.Dataset, simulation: RunView) -> None:
    scene, dimension = simulation.scene, simulation.case.dimension
    for name, names in _names(simulation).items():
        if names:
            file[name][:] = _characters(names, len(file.dimensions[f"{name}_length"]))
    file["run_status"][...] = int(RunStatus.RUNNING)
    file["run_message"][:] = _characters([""], _MESSAGE_LENGTH)[0]
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
        bodies = list(scene.bodies)
        file["wall_body"][:] = [-1 if wall.body is None else bodies.index(wall.body) for wall in scene.walls]
    if simulation.ghost_count:
        ghosts = simulation.ghosts
        file["ghost_position"][:] = ghosts.position
        file["ghost_mirror_position"][:] = ghosts.mirror
    file["particle_mass"][:] = simulation.masses()


def _sample(simulation: RunView) -> dict[str, Any]:
    scene = simulation.scene
    energies = simulation.energies()
    sample: dict[str, Any] = {
        "probe_time": simulation.time,
        "step": simulation.step,
        "time_step": simulation.time_step,
        "wall_clock": simulation.wall_clock,
        **{f"{name}_energy": energies[name] for name in ("kinetic", "potential", "internal")},
        "total_energy": sum(energies[name] for name in ("kinetic", "potential", "internal")),
        "mass": float(np.nansum(simulation.masses())),
        "particles_removed": simulation.removed_count,
        "densities_outside": simulation.densities_outside,
        "interpolation_status": simulation.status_counts(),
        **simulation.diagnostics(),
    }
    if scene.probes:
        sample["probe_pressure"] = simulation.probe_pressures()
    if scene.gauges:
        sample["gauge_elevation"] = simulation.gauge_elevations()
    if scene.walls:
        forces = simulation.wall_forces()
        sample["wall_force"] = [forces[wall.name][0] for wall in scene.walls]
        sample["wall_force_by_pressure"] = [forces[wall.name][1] for wall in scene.walls]
    if scene.bodies:
        motions = simulation.body_motions()
        for name in ("position", "velocity", "acceleration"):
            sample[f"body_{name}"] = [getattr(motions[body], name) for body in scene.bodies]
    return sample


def _attributes(simulation: RunView) -> dict[str, Any]:
    """Global attributes: all that repeats the run, and the scales that make its numbers dimensionless."""
    case, scene = simulation.case, simulation.scene
    components = {}
    for field in COMPONENT_KINDS:
        chosen = getattr(case, field)
        components[field] = {"name": chosen.name, **chosen.options}
    versions = distributions(case)
    return {
        "Conventions": CONVENTIONS,
        "title": case.title,
        "source": f"sphframe {versions['sphframe']}",
        "case_name": registered_name(type(case)),
        "case_parameters": json.dumps(case.model_dump(mode="json")),
        "components": json.dumps(components),
        "distributions": json.dumps(versions),
        "software": json.dumps(software()),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "dimension": np.int32(case.dimension),
        "particle_spacing": case.particle_spacing,
        "smoothing_length": simulation.smoothing_length,
        "sound_speed": simulation.sound_speed,
        "reference_density": case.reference_density,
        "gravity": case.gravity,
        "depth": scene.depth,
        "domain_lower": np.array(scene.domain[0], dtype=np.float64),
        "domain_upper": np.array(scene.domain[1], dtype=np.float64),
    }


def _text_length(name: str, simulation: RunView) -> int:
    if name == "run_message":
        return _MESSAGE_LENGTH
    return max(1, *(len(text.encode()) for text in _names(simulation)[name]))


def _characters(texts: Sequence[str], width: int) -> NDArray[np.bytes_]:
    """Texts as an array (n, width) of bytes, cut at ``width``."""
    encoded = [text.encode()[:width].decode(errors="ignore").encode() for text in texts]
    return np.array(encoded, dtype=f"S{width}").view("S1").reshape(len(encoded), width)
