"""Studies: one task is one run, whose result is one file that is there completely or not at all.

The file's name holds a hash of all that the result depends on, so that work that is done is recognised by its name.
"""

import hashlib
import json
import os
import threading
import time
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from sphframe.cases import Case, CaseWarning
from sphframe.compiled import fingerprint
from sphframe.errors import InputError, OutputError, SimulationError
from sphframe.geometry import lattice
from sphframe.hooks import hookimpl
from sphframe.interfaces import RunView
from sphframe.kernels import compiled_kernel
from sphframe.output import open_dataset
from sphframe.output.checkpoint import checkpoint_path
from sphframe.output.lock import lock_file
from sphframe.output.provenance import distributions, registered_name
from sphframe.registry import load
from sphframe.simulation.run import resume, run

__all__ = ["UNFINISHED", "RunTask", "Task", "Tell", "lock_of", "made_with", "slug", "wall_boundary", "work"]

UNFINISHED = "unfinished"
"""folder, beside the results, of what is being computed or was interrupted"""
CHECKPOINT_EVERY = 30.0
"""s of wall-clock time that a killed run loses at most"""

Tell = Callable[[float], None]
"""is told how much of a task is done, from 0 to 1"""

_one_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Task(ABC):
    """What a worker does: plain data, so that it travels to any worker.

    Attributes
    ----------
    label: names the task to people and, in the name of its file, to the file system.
    case_name, parameters: the case, all its parameters in their JSON form.
    """

    label: str
    case_name: str
    parameters: Mapping[str, Any] = field(repr=False)

    alone: ClassVar[bool] = False
    """whether nothing else may run at the same time, as when times are measured"""

    @abstractmethod
    def perform(self, path: Path, threads: int, tell: Tell) -> None:
        """Write the result to ``path``, where an earlier attempt may have left something to continue."""

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
        particles = sum(len(lattice(region, case.particle_spacing)) for region in scene.fluid)
        sound_speed = case.reference_sound_speed(scene.depth)
        step = case.time_step or 0.5 * case.smoothing_length_ratio * case.particle_spacing / sound_speed
        return particles * case.until / step


@dataclass(frozen=True)
class RunTask(Task):
    """Run a case to its end.

    A run that goes wrong is a result as well: its file says so, as far as it came. It is not tried again.
    """

    @classmethod
    def of(cls, label: str, case: Case) -> "RunTask":
        """Return the task that runs ``case``."""
        return cls(label, registered_name(type(case)), case.model_dump(mode="json"))

    def perform(self, path: Path, threads: int, tell: Tell) -> None:
        """Run, or continue from the last checkpoint."""
        if path.exists() and _is_complete(path):
            return
        options: dict[str, Any] = {
            "threads": threads,
            "checkpoint_every": CHECKPOINT_EVERY,
            "hooks": [_Teller(tell)],
        }
        case = self.case()
        try:
            if path.exists() and checkpoint_path(path).exists():
                try:
                    resume(path, case=case, **options).dataset.close()
                    return
                except (InputError, OutputError):  # what is left of the attempt before is of no use
                    pass
            run(case, output=path, overwrite=True, **options).dataset.close()
        except SimulationError:
            if not path.exists():
                raise


class _Teller:
    """A hook plugin that tells, once a second, how much of a run is done."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._told = tell, time.monotonic()

    @hookimpl
    def sphframe_step_completed(self, simulation: RunView) -> None:
        """Tell, if it is time."""
        if time.monotonic() - self._told > 1.0:
            self._told = time.monotonic()
            self._tell(simulation.time / simulation.case.until)


def work(task: Task, folder: str, name: str, threads: int, tell: Tell) -> str:
    """Perform ``task`` unless it is done; return the name of its file in ``folder``. Workers call this.

    Tasks of one process wait for each other: each has all ``threads``. A task that another process is still at, such
    as one left behind by a command that was killed, is waited for.

    Raises
    ------
    InputError: ``name``, by which the result is expected, is not that by which this worker would write it.
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
        if not result.exists():
            task.perform(unfinished, threads, tell)
            os.replace(unfinished, result)
            checkpoint_path(unfinished).unlink(missing_ok=True)
    return name


def made_with(case: Case) -> dict[str, str]:
    """Return the versions of what ``case`` is run with, and the fingerprint of its method, whose author is at work."""
    method = case.interpolator.create("interpolators")
    kernel = compiled_kernel(case.kernel.create("kernels"), case.dimension)
    return {**distributions(case), "method": fingerprint(method.point_weights(kernel, case.dimension))}


def wall_boundary(interpolator: Mapping[str, Any], lift: str) -> dict[str, Any]:
    """Return the parameters of a case that make its boundary the paper's (``mirror``) or ours (``balanced``)."""
    return {
        "interpolator": dict(interpolator),
        "hydrostatic_lift": lift,
        "ghost_velocity": "interpolated" if lift == "mirror" else "corrected",
    }


def lock_of(unfinished: Path) -> Path:
    """Return the lock of a file that is being made."""
    return unfinished.with_name(f"{unfinished.name}.lock")


def slug(text: str) -> str:
    """Return ``text`` as a part of a file's name.

    >>> slug("dam break: improved-shepard (mirror)")
    'dam-break-improved-shepard-mirror'
    """
    words = "".join(c.lower() if c.isascii() and (c.isalnum() or c in ".-") else " " for c in text).split()
    return "-".join(words).strip(".-") or "run"


def _is_complete(path: Path) -> bool:
    """Whether the run in ``path`` came to its end, and only its file was not yet put in its place."""
    try:
        with open_dataset(path) as dataset:
            return bool(dataset.attrs["completed"] == "yes")
    except InputError:
        return False


class _Locked:
    """Hold the lock of the file ``path``, waiting for it."""

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
