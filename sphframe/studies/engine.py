"""Studies: carries out tasks with dask.distributed, each once.

By default the workers are processes on this machine; any dask cluster whose workers see the same folder can be used
instead. Results are files, and only tasks and names travel over the network: whatever process is killed, the results
that have been written stay.
"""

# mypy: disable-error-code="no-untyped-call"

import contextlib
import itertools
import logging
import os
import queue
import re
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import CancelledError
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from sphframe.compiled import default_threads
from sphframe.errors import InputError, OutputError, SphframeError
from sphframe.output.lock import lock_file
from sphframe.studies.tasks import UNFINISHED, Task, lock_of, work

_TOPIC = "sphframe-progress"
_CONNECT_TIMEOUT = "30s"
_WITHOUT_WORKERS = 30.0
"""s after which a cluster without workers is reported"""
_DASK_SETTINGS: dict[str, Any] = {
    "distributed.scheduler.worker-ttl": None,  # a worker that compiles does not answer for a while
    "distributed.comm.timeouts.connect": "600s",  # the machine may be busy
    "distributed.comm.timeouts.tcp": "600s",
    "distributed.admin.tick.limit": "1h",
    "distributed.scheduler.http.routes": [],  # pages without a password, about the runs
    "distributed.worker.http.routes": [],
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.worker.memory.terminate": False,
}


@dataclass
class Progress:
    """Progress of a set of tasks.

    Attributes
    ----------
    total
        number of tasks.
    kept
        number of tasks that were done before.
    done
        number of tasks that are done, including those done before.
    running
        completed part (0 to 1) of each running task, by label.
    part
        completed part of the work that was not done before, weighted by expected work.
    last
        label of the task that has just ended, if one has.
    """

    total: int
    kept: int
    done: int
    running: dict[str, float] = field(default_factory=dict)
    part: float = 0.0
    last: str | None = None


ProgressListener = Callable[[Progress], None]
"""function that is called at each change of the progress"""


def carry_out(
    tasks: Iterable[Task],
    folder: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    on_progress: ProgressListener | None = None,
) -> dict[str, Path]:
    """Carry out the tasks that are not done yet and return the file of each task, by label.

    Parameters
    ----------
    tasks
        with different labels.
    folder
        folder of the results; it is created.
    workers
        number of processes of the local cluster, among which this machine's cores are shared out as threads; by
        default one process per core, but not more than tasks: independent runs gain more from processes than from
        threads.
    scheduler
        address of a running dask scheduler, such as ``tcp://127.0.0.1:8786``, instead of a local cluster. Its
        workers must see ``folder`` under the same path; a task uses as many threads as its worker has.
    on_progress
        called at each change with the :class:`Progress`.

    Raises
    ------
    InputError
        dask.distributed is not installed, the scheduler does not answer, or ``workers`` is out of range.
    OutputError
        the folder cannot be created, another command uses it, or a worker does not see it.
    SphframeError
        raised by a task; the results of the other tasks stay.
    """
    if workers is not None and not 1 <= workers <= 1024:
        raise InputError(f"--workers {workers}: give a number of processes from 1 to 1024")
    if workers is not None and scheduler is not None:
        raise InputError("--workers sets the size of a local cluster and --scheduler names another: give one of them")
    wanted = {task.label: task for task in tasks}
    names = {label: task.name for label, task in wanted.items()}
    _make_folder(folder)
    with _locked(folder):
        missing = {names[label]: task for label, task in wanted.items() if not task.is_done(folder / names[label])}
        kept = len(set(names.values())) - len(missing)
        progress = Progress(total=kept + len(missing), kept=kept, done=kept)
        listener = on_progress or _ignore
        listener(progress)
        if missing:
            with _cluster(len(missing), workers, scheduler) as (client, threads):
                _TaskRunner(client, threads, folder, missing, progress, listener).run_all()
        _remove_locks(folder / UNFINISHED, names.values())
    return {label: folder / name for label, name in names.items()}


def _ignore(progress: Progress) -> None:
    """Do nothing: the listener where none was given."""


def _make_folder(folder: Path) -> None:
    try:
        (folder / UNFINISHED).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot make the folder {folder}: {error.strerror or error}; give another --output"
        ) from None


class _TaskRunner:
    """Runs tasks on the cluster: first those that may run concurrently, the longest first; then the others in turn."""

    def __init__(
        self,
        client: Any,
        threads: int | None,
        folder: Path,
        missing: Mapping[str, Task],
        progress: Progress,
        listener: ProgressListener,
    ) -> None:
        self._client, self._threads, self._folder = client, threads, folder
        self._missing, self._progress, self._listener = missing, progress, listener
        self._weights = {name: max(task.weight, 1e-9) for name, task in missing.items()}
        self._parts = dict.fromkeys(missing, 0.0)
        client.subscribe_topic(_TOPIC, self._receive_part)

    def run_all(self) -> None:
        """Run all tasks to their end."""
        order = sorted(self._missing, key=lambda name: -self._weights[name])
        self._run([name for name in order if not self._missing[name].alone])
        for name in order:
            if self._missing[name].alone:
                self._run([name])

    def _run(self, names: list[str]) -> None:
        folder = str(self._folder.resolve())
        ended = queue.SimpleQueue[Any]()
        waiting, submitted = iter(names), set[Any]()
        try:
            while True:
                # Never submit more tasks than there are workers: dask does not move a task that it has assigned to a
                # busy worker, so that another worker could be idle.
                for name in itertools.islice(waiting, max(0, self._worker_count() - len(submitted))):
                    future = self._client.submit(
                        _work, self._missing[name], folder, name, self._threads, key=name, pure=False
                    )
                    future.add_done_callback(ended.put)
                    submitted.add(future)
                if not submitted:
                    return
                future = self._next(ended)
                submitted.remove(future)
                self._finish(future)
        except BaseException:
            self._client.cancel(list(submitted), force=True)
            raise

    def _next(self, ended: "queue.SimpleQueue[Any]") -> Any:
        """Wait for the next future that ends; say so if there is no worker that could end one."""
        looked = time.monotonic()
        while True:
            with contextlib.suppress(queue.Empty):
                return ended.get(timeout=1.0)
            if time.monotonic() - looked > _WITHOUT_WORKERS:
                looked = time.monotonic()
                if not self._client.scheduler_info(n_workers=-1)["workers"]:
                    warnings.warn(
                        f"the cluster {self._client.scheduler.address} has no worker: start one with dask worker"
                        " ADDRESS; waiting, Ctrl-C ends this",
                        RuntimeWarning,
                        stacklevel=2,
                    )

    def _worker_count(self) -> int:
        """Return the number of workers, at least one: the first task waits until the first worker has started."""
        return max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))

    def _finish(self, future: Any) -> None:
        from distributed import KilledWorker

        name = future.key
        try:
            future.result()
        except KilledWorker:
            raise SphframeError(
                f"several workers died while they ran {self._missing[name].label}; if memory is short, give fewer"
                " --workers; finished runs are kept"
            ) from None
        except CancelledError:
            raise SphframeError(
                f"the scheduler {self._client.scheduler.address} does not answer any more while"
                f" {self._missing[name].label} is running; finished runs are kept: repeat the command to continue"
            ) from None
        if not (self._folder / name).exists():
            raise OutputError(
                f"the workers do not write into {self._folder}: they run on another machine; give an --output on a"
                " file system that they share with this command"
            )
        self._progress.done += 1
        self._set_part(name, 1.0)
        self._progress.running.pop(self._missing[name].label, None)
        self._progress.last = self._missing[name].label
        self._listener(self._progress)
        self._progress.last = None

    def _receive_part(self, event: tuple[float, Any]) -> None:
        name, part = event[1]["name"], event[1]["part"]
        if name in self._missing and self._parts[name] < 1.0:
            self._progress.running[self._missing[name].label] = part
            self._set_part(name, part)
            self._listener(self._progress)

    def _set_part(self, name: str, part: float) -> None:
        self._parts[name] = part
        self._progress.part = sum(self._weights[n] * p for n, p in self._parts.items()) / sum(self._weights.values())


def _remove_locks(unfinished: Path, names: Iterable[str]) -> None:
    """Remove the locks of these tasks, and the folder if nothing of another command is in it."""
    for name in names:
        lock_of(unfinished / name).unlink(missing_ok=True)
    with contextlib.suppress(OSError):
        unfinished.rmdir()


def _work(task: Task, folder: str, name: str, threads: int | None) -> str:
    """Perform a task on a worker and send its progress to the client."""
    from distributed import get_worker

    worker = get_worker()

    def send_part(part: float) -> None:
        worker.log_event(_TOPIC, {"name": name, "part": part})

    send_part(0.0)
    return work(task, folder, name, threads or _threads_of(worker), send_part)


def _threads_of(worker: Any) -> int:
    import numba

    return min(int(worker.state.nthreads), int(numba.config.NUMBA_NUM_THREADS))  # type: ignore[attr-defined]


@contextlib.contextmanager
def _cluster(count: int, workers: int | None, scheduler: str | None) -> Iterator[tuple[Any, int | None]]:
    """Yield a client of the cluster, and the number of threads per task (None: as many as its worker has)."""
    if find_spec("distributed") is None:
        raise InputError("this needs dask.distributed: install it with python -m pip install 'sphframe[reproduce]'")
    import dask
    import distributed  # noqa: F401  (before the settings: they would remove those of distributed at their end)

    with dask.config.set(_DASK_SETTINGS):
        if scheduler is not None:
            with _running_cluster(scheduler) as client:
                yield client, None
        else:
            processes = workers or min(default_threads(), count)
            with _local_cluster(processes) as client:
                yield client, max(1, default_threads() // processes)


@contextlib.contextmanager
def _running_cluster(scheduler: str) -> Iterator[Any]:
    from distributed import Client

    host = r"([a-z]+://)?([^\s/:\[\]]+|\[[0-9a-fA-F:.]+\]):(\d{1,5})/?"
    inside = scheduler.startswith("inproc://")  # a scheduler in a thread of this process
    if not inside and (not re.fullmatch(host, scheduler) or int(scheduler.rstrip("/").rpartition(":")[2]) > 65535):
        raise InputError(f"--scheduler {scheduler}: give its protocol, machine and port, such as tls://127.0.0.1:8786")
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what is lost is reported by this command
    try:
        client = Client(scheduler, timeout=_CONNECT_TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError, TimeoutError) as error:  # TypeError: no certificates for TLS
        raise InputError(
            f"--scheduler {scheduler}: no dask scheduler answers there ({error}); start one with"
            " dask scheduler, and workers with dask worker ADDRESS"
        ) from None
    with client:
        yield client


@contextlib.contextmanager
def _local_cluster(processes: int) -> Iterator[Any]:
    from distributed import Client, LocalCluster

    cluster = LocalCluster(
        n_workers=processes,
        threads_per_worker=1,
        processes=True,
        host="127.0.0.1",
        security=True,  # else anybody on this machine could connect and have code run by this user
        dashboard_address=None,
        scheduler_kwargs={"dashboard": False, "dashboard_address": "127.0.0.1:0"},  # else port 8787, or a warning
        memory_limit=0,
        silence_logs=logging.CRITICAL,
    )
    with cluster, Client(cluster, set_as_default=False) as client:
        yield client


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the lock of the folder, so that no second command uses it."""
    path = folder / ".lock"
    path.touch()
    descriptor = lock_file(path)
    if descriptor is None:
        raise OutputError(f"another command is at work in {folder}: wait for it, or give another --output")
    try:
        yield
    finally:
        os.close(descriptor)
