"""Studies: a task is one run, and its result is one file, which is complete or does not exist.

The file's name contains a hash of all that the result depends on, so that a finished task is recognised by its name.
"""

import dataclasses
import hashlib
import json
import os
import threading
import time
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import xarray as xr

import sphframe
from sphframe.cases import Case, CaseWarning
from sphframe.compiled import fingerprint
from sphframe.errors import InputError, OutputError, SimulationError
from sphframe.geometry import fill
from sphframe.hooks import hookimpl
from sphframe.interfaces import RunView
from sphframe.output import open_dataset
from sphframe.output.checkpoint import checkpoint_path
from sphframe.output.lock import lock_file
from sphframe.output.provenance import distributions, registered_name, software
from sphframe.registry import load
from sphframe.simulation.components import Components
from sphframe.simulation.run import resume, run

UNFINISHED = "unfinished"
"""name of the folder, beside the results, that holds the files of tasks that are running or were interrupted"""
CHECKPOINT_EVERY = 30.0
"""s of wall-clock time between checkpoints, which a killed run loses at most"""

PartListener = Callable[[float], None]
"""function that is called with the completed part of a task, from 0 to 1"""

_one_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Task(ABC):
    """Work for one worker. A task is plain data, so that it can be sent to any worker.

    Attributes
    ----------
    label
        name of the task in messages and reports, and, as a slug, in the name of its file.
    case_name, parameters
        the case, and all its parameters in their JSON form.
    """

    label: str
    case_name: str
    parameters: Mapping[str, Any] = field(repr=False)

    alone: ClassVar[bool] = False
    """whether no other task may run at the same time, as when times are measured"""

    @abstractmethod
    def perform(self, path: Path, threads: int, on_part: PartListener) -> None:
        """Write the result to ``path``; an interrupted attempt may have left a file there, which can be continued."""

    def case(self) -> Case:
        """Return the case, checked."""
        case: Case = load("cases", self.case_name)(**self.parameters)
        return case

    def recipe(self) -> dict[str, Any]:
        """Return all that the result depends on."""
        return {
            "kind": type(self).__name__,
            "case": self.case_name,
            "parameters": self.parameters,
            "made_with": made_with(self.case()),
        }

    def is_done(self, path: Path) -> bool:
        """Return whether ``path`` holds the result: a file that is missing, cut off or damaged does not."""
        try:
            xr.open_dataset(path, engine="netcdf4", decode_times=False).close()
        except (OSError, ValueError, RuntimeError):
            return False
        return True

    @property
    def name(self) -> str:
        """Name of the result's file."""
        recipe = json.dumps(self.recipe(), sort_keys=True, allow_nan=False)
        return f"{slug(self.label)}-{hashlib.sha256(recipe.encode()).hexdigest()[:12]}.nc"

    @property
    def weight(self) -> float:
        """Expected work: particles times steps."""
        case = self.case()
        scene = case.scene()
        particles = sum(len(fill(region, case.particle_spacing).volume) for region in scene.fluid)
        sound_speed = case.reference_sound_speed(scene.depth)
        step = case.time_step or 0.5 * case.smoothing_length_ratio * case.particle_spacing / sound_speed
        return particles * case.until / step


@dataclass(frozen=True)
class RunTask(Task):
    """Run a case to its end.

    A run that fails is a result as well: its file ends where the run failed and holds the message. It is not repeated.
    """

    @classmethod
    def of(cls, label: str, case: Case) -> "RunTask":
        """Return the task that runs ``case``."""
        return cls(label, registered_name(type(case)), case.model_dump(mode="json"))

    def is_done(self, path: Path) -> bool:
        """Return whether ``path`` holds the whole file of a run."""
        try:
            open_dataset(path).close()
        except InputError:
            return False
        return True

    def perform(self, path: Path, threads: int, on_part: PartListener) -> None:
        """Run the case, or continue from the last checkpoint."""
        if path.exists() and _is_complete(path):
            return
        options: dict[str, Any] = {
            "threads": threads,
            "checkpoint_every": CHECKPOINT_EVERY,
            "hooks": [PartHook(on_part)],
            "progress": False,
        }
        case = self.case()
        try:
            if path.exists() and checkpoint_path(path).exists():
                try:
                    resume(path, case=case, **options).dataset.close()
                    return
                except (InputError, OutputError):  # the files of the interrupted attempt are damaged
                    pass
            run(case, output=path, overwrite=True, **options).dataset.close()
        except SimulationError:
            if not path.exists():
                raise


class PartHook:
    """A hook plugin that calls a listener once per second with the completed part of a run."""

    def __init__(self, on_part: PartListener) -> None:
        self._on_part, self._called = on_part, time.monotonic()

    @hookimpl
    def sphframe_step_completed(self, simulation: RunView) -> None:
        """Call the listener if a second has passed."""
        if time.monotonic() - self._called > 1.0:
            self._called = time.monotonic()
            self._on_part(simulation.time / simulation.case.until)


def work(task: Task, folder: str, name: str, threads: int, on_part: PartListener) -> str:
    """Perform ``task`` unless it is done; return the name of its file in ``folder``. Workers call this function.

    One process performs one task at a time, with all ``threads``. If another process is performing the same task, such
    as a worker of a command that was killed, this one waits for it.

    Raises
    ------
    InputError
        ``name``, the expected name of the result, is not the name that this worker computes.
    """
    if task.name != name:
        raise InputError(
            f"a worker would write {task.name} where {name} is expected: it has other versions of sphframe or of its"
            " plugins; start workers from the environment of this command"
        )
    result = Path(folder) / name
    unfinished = Path(folder) / UNFINISHED / name
    with _one_at_a_time, _Locked(lock_of(unfinished)), warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseWarning)
        if not task.is_done(result):
            task.perform(unfinished, threads, on_part)
            os.replace(unfinished, result)
            checkpoint_path(unfinished).unlink(missing_ok=True)
    return name


def made_with(case: Case) -> dict[str, str]:
    """Return the versions of the distributions that ``case`` is run with, and the fingerprint of its method's code.

    The fingerprint is there because the author of a method changes its code without changing its version.
    """
    components = Components.of_case(case)
    walls = (getattr(components.walls, part.name) for part in dataclasses.fields(components.walls))
    pieces = [fingerprint(part) if callable(part) else str(part) for part in walls]
    methods = [method for method in (components.interpolator, components.velocity_interpolator) if method is not None]
    pieces += [fingerprint(method.point_weights(components.compiled_kernel, case.dimension)) for method in methods]
    return {**distributions(case), "method": " ".join(pieces)}


def software_of(tasks: Iterable[Task]) -> dict[str, str]:
    """Return the versions of sphframe, of the plugins that the tasks use, and of the libraries, for a report."""
    versions = dict[str, str]()
    for task in tasks:
        versions |= distributions(task.case())
    return {"sphframe": sphframe.__version__, **dict(sorted(versions.items())), **software()}


def wall_boundary(interpolator: Mapping[str, Any], lift: str) -> dict[str, Any]:
    """Return the parameters of a case that choose its wall boundary.

    With the lift ``mirror`` the ghosts have the velocity that the method interpolates, as in Huang et al. (2019); with
    ``balanced`` they have the corrected velocity.
    """
    return {
        "interpolator": dict(interpolator),
        "hydrostatic_lift": lift,
        "ghost_velocity": "interpolated" if lift == "mirror" else "corrected",
    }


def lock_of(unfinished: Path) -> Path:
    """Return the path of the lock of an unfinished file."""
    return unfinished.with_name(f"{unfinished.name}.lock")


def slug(text: str) -> str:
    """Return ``text`` in a form that can be part of a file's name.

    >>> slug("dam break: improved-shepard (mirror)")
    'dam-break-improved-shepard-mirror'
    """
    words = "".join(c.lower() if c.isascii() and (c.isalnum() or c in ".-") else " " for c in text).split()
    return "-".join(words).strip(".-") or "run"


def _is_complete(path: Path) -> bool:
    """Return whether the run in ``path`` reached its end, so that only the file has to be moved."""
    try:
        with open_dataset(path) as dataset:
            return bool(dataset.attrs["completed"] == "yes")
    except InputError:
        return False


class _Locked:
    """Hold the lock of the file ``path``; wait until it is free."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> None:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._path.touch()
        while (descriptor := lock_file(self._path)) is None:
            time.sleep(0.2)
        self._descriptor = descriptor

    def __exit__(self, *_: object) -> None:
        os.close(self._descriptor)
