"""Simulation: one call from a case to its dataset, and from a checkpoint to the end of its run."""

import atexit
import json
import os
import shutil
import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sphframe.cases import Case, load_case
from sphframe.errors import InputError, ResumeWarning
from sphframe.hooks import hook_manager
from sphframe.output import CheckpointWriter, NetCDFWriter, open_dataset
from sphframe.output.checkpoint import changed_versions, checkpoint_path, read_checkpoint
from sphframe.representation import html_table
from sphframe.simulation.simulation import Simulation

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Run:
    """A finished run: its ``case``, and the file at ``path`` as an open ``dataset``."""

    case: Case
    path: Path
    dataset: "xr.Dataset"

    def __repr__(self) -> str:
        """What was run, and where it is."""
        return f"Run({', '.join(text for _, text in self._facts())})"

    def _repr_html_(self) -> str:
        return html_table(self.case.title, ["", ""], self._facts()) + self.dataset._repr_html_()

    def _facts(self) -> list[tuple[str, str]]:
        case, sizes = self.case, self.dataset.sizes
        return [
            ("case", str(self.dataset.attrs["case_name"])),
            ("method", case.wall_method),
            ("particles", f"{sizes['particle']:,} particles of {case.particle_spacing:g} m, {case.dimension}-D"),
            ("time", f"{case.until:.4g} s in {sizes['time']} frames"),
            ("file", str(self.path)),
        ]


def run(
    case: Case | str | os.PathLike[str],
    *,
    preset: str | None = None,
    output: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    device: str = "cpu",
    overwrite: bool = False,
    hooks: Sequence[object] = (),
    progress: bool | None = None,
    checkpoint_every: float | None = 60.0,
    checkpoint_interval: float | None = None,
    **parameters: Any,
) -> Run:
    """Run a case to its end and return its dataset.

    Parameters
    ----------
    case
        a case, the name of one (``"dam-break"``), a TOML case file, or a NetCDF file of an earlier run to repeat.
    preset
        a named set of the case's parameters, such as ``"paper"``.
    output
        NetCDF file to write; by default a temporary file that is removed when Python ends.
    threads
        threads of the compiled loops; by default all cores.
    device
        where the steps are computed: ``"cpu"``, or an installed device such as ``"cuda"`` of sphframe-cuda.
    overwrite
        whether an existing ``output`` may be replaced.
    hooks
        listeners to the run's events, see :mod:`sphframe.hooks`.
    progress
        whether the progress is displayed on the standard error stream (:class:`sphframe.ProgressDisplay`); by default
        on a terminal, and in a notebook with ``ipywidgets``.
    checkpoint_every
        wall-clock time between checkpoints, s; None for none. See :func:`resume`.
    checkpoint_interval
        simulated time between checkpoints, s; None for none.
    **parameters
        parameters of the case by name, ``interpolator="mls-linear"``, ``particle_spacing=0.01``.

    Raises
    ------
    InputError, PluginError
        when the case or a component is not valid; nothing has been run.
    OutputError
        when the output cannot be written.
    SimulationError
        when the run goes wrong; what was computed until then is in the file.
    KeyboardInterrupt
        at Ctrl-C or SIGTERM, after the step and a checkpoint. Notes of each error that ends a run name
        the files that remain.
    """
    source = case if isinstance(case, Case) else os.fspath(case)
    ready = load_case(source, preset=preset, overrides=parameters)
    path = _temporary_file() if output is None else Path(output)
    writer = NetCDFWriter(path, overwrite=overwrite)
    checkpoints = CheckpointWriter(writer, every=checkpoint_every, interval=checkpoint_interval)
    simulation = Simulation(ready, threads=threads, device=device)
    try:
        _run(simulation, writer, checkpoints, hooks, progress)
    except BaseException as error:
        if output is None and path.exists():
            error.add_note("these files are removed when Python ends: copy them, or give output=FILE to keep them")
        raise
    return Run(ready, path, open_dataset(path))


def _temporary_file() -> Path:
    """Return the path of an output that is removed when Python ends."""
    folder = tempfile.mkdtemp(prefix="sphframe-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder) / "run.nc"


def _run(
    simulation: Simulation,
    writer: NetCDFWriter,
    checkpoints: CheckpointWriter,
    hooks: Sequence[object],
    progress: bool | None,
) -> None:
    """Run to the end; an error that ends the run before says in its traceback which files remain."""
    if progress is not False:
        from sphframe.analysis.progress import with_display

        hooks = with_display(hooks, always=bool(progress))
    try:
        simulation.run(hook_manager([writer, checkpoints, *hooks]))
    except BaseException as error:
        if writer.run_id and writer.path.exists():
            error.add_note(f"{writer.path} holds the run up to t = {simulation.time:.4g} s")
        if checkpoints.path.exists():
            error.add_note(f"sphframe.resume({str(writer.path)!r}) continues it from its last checkpoint")
        raise


def prepare_resume(
    path: str | os.PathLike[str],
    *,
    case: Case | None = None,
    trusted: bool = False,
    threads: int | None = None,
    device: str = "cpu",
) -> tuple[Simulation, NetCDFWriter]:
    """Read a checkpoint and set its run up, without running; parameters and errors are those of :func:`resume`.

    Returns the simulation and the writer of its output, ready to be continued.
    """
    output = Path(path)
    if output.name == checkpoint_path(Path(output.stem)).name:
        output = output.with_suffix("")
    with open_dataset(output) as dataset:
        complete, parameters = dataset.attrs["completed"] == "yes", dataset.attrs["case_parameters"]
    if complete:
        raise InputError(f"{output} is of a complete run: nothing is left to resume; open it, or run it again")
    checkpoint = read_checkpoint(checkpoint_path(output))
    ready = load_case(case or output, trusted=trusted)
    if json.loads(parameters) != ready.model_dump(mode="json"):
        raise InputError(f"{output} was begun with other parameters than those of the given case: resume it with those")
    changes = changed_versions(checkpoint, ready)
    if changes:
        warnings.warn(
            f"{output} is continued by other versions than began it, and may not end with the same bits:"
            f" {'; '.join(changes)}",
            ResumeWarning,
            stacklevel=3,
        )
    simulation = Simulation(ready, threads=threads, device=device)
    simulation.restore(checkpoint.state)
    return simulation, NetCDFWriter(output, resumed=checkpoint)


def resume(
    path: str | os.PathLike[str],
    *,
    case: Case | None = None,
    trusted: bool = False,
    threads: int | None = None,
    device: str = "cpu",
    hooks: Sequence[object] = (),
    progress: bool | None = None,
    checkpoint_every: float | None = 60.0,
    checkpoint_interval: float | None = None,
) -> Run:
    """Continue a run that was interrupted or killed from its last checkpoint to its end.

    The result has the same bits as that of a run that was never interrupted, whenever and wherever checkpoints were
    written and whatever the number of threads; only ``wall_clock`` differs. Of a component or hook that keeps a state
    of its own nothing is saved: components are functions of their arguments.

    Parameters
    ----------
    path
        the output of the run, ``run.nc``, or its checkpoint, ``run.nc.restart``. Both must be there.
    case
        the case, if it is a class or holds functions of your own; by default it is read from the output.
    trusted
        whether the file may name components as ``module:attribute``, whose code is then imported.
    threads, device, hooks, progress, checkpoint_every, checkpoint_interval
        as for :func:`run`.

    Warns
    -----
    ResumeWarning
        when the versions of sphframe, of a component or of what they compute with have changed.

    Raises
    ------
    InputError
        when there is nothing to resume, or a file is damaged.
    OutputError
        when output and checkpoint do not belong together, or another run is writing the output.
    SimulationError, KeyboardInterrupt
        as for :func:`run`.
    """
    simulation, writer = prepare_resume(path, case=case, trusted=trusted, threads=threads, device=device)
    checkpoints = CheckpointWriter(writer, every=checkpoint_every, interval=checkpoint_interval)
    _run(simulation, writer, checkpoints, hooks, progress)
    return Run(simulation.case, writer.path, open_dataset(writer.path))
