"""Studies: carries out tasks on dask.distributed, each once.

By default a cluster of this machine's cores, one process a worker; or any existing cluster whose workers see the same
folder. Results are files, not what travels over the network: whatever is killed, what is written stays done.
"""

# mypy: disable-error-code="no-untyped-call"

import contextlib
import itertools
import logging
import os
import queue
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from sphframe.errors import InputError, OutputError, SphframeError
from sphframe.output.lock import lock_file
from sphframe.studies.tasks import UNFINISHED, Task, lock_of, work

__all__ = ["Progress", "Watch", "carry_out"]

_TOPIC = "sphframe-progress"


@dataclass
class Progress:
    """How far the whole is.

    Attributes
    ----------
    total: number of tasks; ``kept``: those that had been done before; ``done``: those done, the kept ones included.
    running: part done (0 to 1) of each task under way, by label.
    part: part done of the work that was left, weighted by expected work.
    last: label of the task that has just been done, if one has.
    """

    total: int
    kept: int
    done: int
    running: dict[str, float] = field(default_factory=dict)
    part: float = 0.0
    last: str | None = None


Watch = Callable[[Progress], None]
"""is told of every change"""


def carry_out(
    tasks: Iterable[Task],
    folder: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    watch: Watch = lambda progress: None,
) -> dict[str, Path]:
    """Do the tasks that are not done yet and return the file of each, by label.

    Parameters
    ----------
    tasks: with labels that differ.
    folder: of the results; it is made.
    workers: processes of the local cluster, each with its share of this machine's cores as threads; by default as many
        as there are cores, but not more than tasks: independent runs gain more from processes than from threads.
    scheduler: address of a running dask scheduler, such as ``tcp://127.0.0.1:8786``, in place of a local cluster. Its
        workers must see ``folder`` under the same path; a task uses as many threads as its worker has.
    watch: see :class:`Progress`.

    Raises
    ------
    InputError: dask.distributed is not installed, the scheduler is not there, or ``workers`` is not a positive number.
    OutputError: another command is at work in the folder, or a worker does not see it.
    SphframeError: what a task raised; the other tasks' results stay.
    """
    if workers is not None and not 1 <= workers <= 1024:
        raise InputError(f"--workers {workers}: give a number of processes from 1 to 1024")
    if workers is not None and scheduler is not None:
        raise InputError("--workers is of the local cluster and --scheduler names another: give one of them")
    wanted = {task.label: task for task in tasks}
    names = {label: task.name for label, task in wanted.items()}
    (folder / UNFINISHED).mkdir(parents=True, exist_ok=True)
    with _alone_in(folder):
        left = {names[label]: task for label, task in wanted.items() if not (folder / names[label]).exists()}
        kept = len(set(names.values())) - len(left)
        progress = Progress(total=kept + len(left), kept=kept, done=kept)
        watch(progress)
        if left:
            with _cluster(len(left), workers, scheduler) as (client, threads):
                _Foreman(client, threads, folder, left, progress, watch).work()
        _tidy_up(folder / UNFINISHED, names.values())
    return {label: folder / name for label, name in names.items()}


class _Foreman:
    """Hands tasks to the cluster: first those that bear company, the longest first, then the others one by one."""

    def __init__(
        self,
        client: Any,
        threads: int | None,
        folder: Path,
        left: Mapping[str, Task],
        progress: Progress,
        watch: Watch,
    ) -> None:
        self._client, self._threads, self._folder = client, threads, folder
        self._left, self._progress, self._watch = left, progress, watch
        self._weights = {name: max(task.weight, 1e-9) for name, task in left.items()}
        self._parts = dict.fromkeys(left, 0.0)
        client.subscribe_topic(_TOPIC, self._hear)

    def work(self) -> None:
        """Do all."""
        order = sorted(self._left, key=lambda name: -self._weights[name])
        self._do([name for name in order if not self._left[name].alone])
        for name in order:
            if self._left[name].alone:
                self._do([name])

    def _do(self, names: list[str]) -> None:
        folder = str(self._folder.resolve())
        finished = queue.SimpleQueue[Any]()
        waiting, under_way = iter(names), set[Any]()
        try:
            while True:
                # no more than can be worked on: what dask has given to one worker it leaves there, another may idle
                for name in itertools.islice(waiting, max(0, self._hands() - len(under_way))):
                    future = self._client.submit(
                        _work, self._left[name], folder, name, self._threads, key=name, pure=False
                    )
                    future.add_done_callback(finished.put)
                    under_way.add(future)
                if not under_way:
                    return
                future = finished.get()
                under_way.remove(future)
                self._finish(future)
        except BaseException:
            self._client.cancel(list(under_way), force=True)
            raise

    def _hands(self) -> int:
        """Number of workers there are; the first task waits for the first worker."""
        return max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))

    def _finish(self, future: Any) -> None:
        from distributed import KilledWorker

        name = future.key
        try:
            future.result()
        except KilledWorker:
            raise SphframeError(
                f"workers died again and again at {self._left[name].label}: is there too little memory? Give fewer"
                " --workers; what is done is kept"
            ) from None
        if not (self._folder / name).exists():
            raise OutputError(
                f"the workers do not write into {self._folder}: they run on another machine; give an --output on a"
                " file system that they share with this command"
            )
        self._progress.done += 1
        self._note(name, 1.0)
        self._progress.running.pop(self._left[name].label, None)
        self._progress.last = self._left[name].label
        self._watch(self._progress)
        self._progress.last = None

    def _hear(self, event: tuple[float, Any]) -> None:
        message = event[1]
        if message["name"] in self._left and self._parts[message["name"]] < 1.0:
            self._progress.running[self._left[message["name"]].label] = message["part"]
            self._note(message["name"], message["part"])
            self._watch(self._progress)

    def _note(self, name: str, part: float) -> None:
        self._parts[name] = part
        self._progress.part = sum(self._weights[n] * p for n, p in self._parts.items()) / sum(self._weights.values())


def _tidy_up(unfinished: Path, names: Iterable[str]) -> None:
    """Remove the locks of what is done; what other commands have left unfinished stays."""
    for name in names:
        lock_of(unfinished / name).unlink(missing_ok=True)
    with contextlib.suppress(OSError):
        unfinished.rmdir()


def _work(task: Task, folder: str, name: str, threads: int | None) -> str:
    """Perform a task on a worker and tell the client how far it is."""
    from distributed import get_worker

    worker = get_worker()

    def tell(part: float) -> None:
        worker.log_event(_TOPIC, {"name": name, "part": part})

    tell(0.0)
    return work(task, folder, name, threads or _threads_of(worker), tell)


def _threads_of(worker: Any) -> int:
    import numba

    return min(int(worker.state.nthreads), int(numba.config.NUMBA_NUM_THREADS))  # type: ignore[attr-defined]


@contextlib.contextmanager
def _cluster(count: int, workers: int | None, scheduler: str | None) -> Iterator[tuple[Any, int | None]]:
    """A client of the cluster, and the threads of each task (None: those of its worker)."""
    if find_spec("distributed") is None:
        raise InputError("this needs dask.distributed: python -m pip install 'sphframe[reproduce]'")
    import dask
    from distributed import Client, LocalCluster

    settings = {
        "distributed.scheduler.worker-ttl": None,  # a worker that compiles is silent for a while
        "distributed.admin.tick.limit": "1h",
        "distributed.worker.memory.target": False,
        "distributed.worker.memory.spill": False,
        "distributed.worker.memory.pause": False,
        "distributed.worker.memory.terminate": False,
    }
    with dask.config.set(settings), contextlib.ExitStack() as stack:
        if scheduler is not None:
            logging.getLogger("distributed").setLevel(logging.ERROR)
            try:
                client = stack.enter_context(Client(scheduler, timeout="10s", set_as_default=False))
            except (OSError, ValueError, TimeoutError) as error:
                raise InputError(
                    f"--scheduler {scheduler}: no dask scheduler answers there ({error}); start one with"
                    " dask scheduler, and workers with dask worker ADDRESS"
                ) from None
            yield client, None
            return
        cores = _cores()
        processes = workers or min(cores, count)
        threads = max(1, cores // processes)
        cluster = LocalCluster(
            n_workers=processes,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            silence_logs=logging.CRITICAL,
        )
        stack.enter_context(cluster)
        yield stack.enter_context(Client(cluster, set_as_default=False)), threads


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextlib.contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """Keep a second command out of the folder."""
    path = folder / ".lock"
    path.touch()
    descriptor = lock_file(path)
    if descriptor is None:
        raise OutputError(f"another command is at work in {folder}: wait for it, or give another --output")
    try:
        yield
    finally:
        os.close(descriptor)
