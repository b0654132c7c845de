"""Tasks run once each, also after failures, and only one command uses a folder at a time."""

import contextlib
import os
import socket
import ssl
import urllib.error
import urllib.request
from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType, SimpleNamespace

import dask
import pytest

from sphframe.errors import InputError, OutputError, SphframeError
from sphframe.output.lock import lock_file
from sphframe.studies import engine
from sphframe.studies.engine import Progress, carry_out
from sphframe.studies.tasks import PartListener, RunTask, Task

pytestmark = pytest.mark.filterwarnings("ignore:Sending large graph")


@dataclass(frozen=True)
class Fails(Task):
    """A task that fails."""

    def perform(self, path: Path, threads: int, on_part: PartListener) -> None:
        """Fail."""
        raise OutputError("the disk is full")


@pytest.fixture
def make(tiny: ModuleType) -> Callable[..., RunTask]:
    def make(label: str, **parameters: object) -> RunTask:
        return RunTask.of(label, tiny.tank(**{"until": 0.05, **parameters}))

    return make


def test_finished_tasks_are_kept_and_progress_is_reported(
    make: Callable[..., RunTask], cluster: str, tmp_path: Path
) -> None:
    one, two = make("one"), make("two", interpolator="shepard")
    seen: list[Progress] = []
    files = carry_out([one], tmp_path, scheduler=cluster)
    before = files["one"].stat().st_ino
    files = carry_out([one, two], tmp_path, scheduler=cluster, on_progress=lambda p: seen.append(replace(p)))
    assert files["one"].stat().st_ino == before
    assert files["two"].exists()
    assert (seen[0].total, seen[0].kept) == (2, 1)
    assert [p.last for p in seen if p.last] == ["two"]
    assert seen[-1].done == 2
    assert seen[-1].part == 1.0
    assert not (tmp_path / "unfinished").exists()


def test_what_another_command_left_unfinished_stays(make: Callable[..., RunTask], cluster: str, tmp_path: Path) -> None:
    (tmp_path / "unfinished").mkdir()
    (tmp_path / "unfinished" / "other-0123456789ab.nc").write_bytes(b"half a run")
    carry_out([make("one")], tmp_path, scheduler=cluster)
    assert [path.name for path in (tmp_path / "unfinished").iterdir()] == ["other-0123456789ab.nc"]


def test_all_done_needs_no_cluster(make: Callable[..., RunTask], cluster: str, tmp_path: Path) -> None:
    carry_out([make("one")], tmp_path, scheduler=cluster)
    carry_out([make("one")], tmp_path, scheduler="tcp://127.0.0.1:1")


def test_a_failure_leaves_the_others_results(make: Callable[..., RunTask], cluster: str, tmp_path: Path) -> None:
    good = make("good", until=1.0)  # more work, so done first
    bad = Fails("bad", good.case_name, {**good.parameters, "until": 0.01})
    with pytest.raises(OutputError, match="the disk is full"):
        carry_out([good, bad], tmp_path, scheduler=cluster)
    assert (tmp_path / good.name).exists()
    assert not (tmp_path / bad.name).exists()


def test_a_second_command_in_the_folder_is_refused(make: Callable[..., RunTask], cluster: str, tmp_path: Path) -> None:
    (tmp_path / ".lock").touch()
    descriptor = lock_file(tmp_path / ".lock")
    assert descriptor is not None
    try:
        with pytest.raises(OutputError, match="another command is at work"):
            carry_out([make("one")], tmp_path, scheduler=cluster)
    finally:
        os.close(descriptor)


def test_no_scheduler_and_no_workers_are_refused(make: Callable[..., RunTask], tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no dask scheduler answers there"):
        carry_out([make("one")], tmp_path, scheduler="nonsense://x:1")
    for address in ("localhost", "tcp://", "127.0.0.1:port", "tls://127.0.0.1:99999", "two words:1"):
        with pytest.raises(InputError, match="give its protocol, machine and port"):
            carry_out([make("one")], tmp_path, scheduler=address)
    with pytest.raises(InputError, match="--workers 0"):
        carry_out([make("one")], tmp_path, workers=0)
    with pytest.raises(InputError, match="give one of them"):
        carry_out([make("one")], tmp_path, workers=1, scheduler="tcp://127.0.0.1:1")


def test_nobody_else_on_the_machine_reaches_the_local_cluster() -> None:
    with dask.config.set(engine._DASK_SETTINGS), engine._local_cluster(0) as client:
        scheduler = client.cluster.scheduler
        assert scheduler.address.startswith("tls://127.0.0.1:")
        stranger = ssl.create_default_context()
        stranger.check_hostname, stranger.verify_mode = False, ssl.CERT_NONE
        plain = socket.create_connection(("127.0.0.1", scheduler.port))
        with stranger.wrap_socket(plain) as connection, pytest.raises(ssl.SSLError, match="certificate"):
            connection.recv(1)
        port = scheduler.http_server.port
        for page in ("info/main/workers.html", "status", "health", "metrics", "json/counts.json"):
            with pytest.raises(urllib.error.HTTPError, match="404"):
                urllib.request.urlopen(f"http://127.0.0.1:{port}/{page}")


class _TwoWorkers:
    """A client whose first task takes as long as all others together."""

    def __init__(self, count: int) -> None:
        self.count, self.submitted, self.under_way, self.most = count, 0, 0, 0
        self.end_the_first: Callable[[], None] | None = None

    def subscribe_topic(self, topic: str, handler: object) -> None: ...

    def scheduler_info(self, n_workers: int) -> dict[str, object]:
        return {"workers": {"one": {}, "two": {}}}

    def submit(self, work: object, task: Task, folder: str, name: str, *_: object, key: str, pure: bool) -> "_Future":
        (Path(folder) / name).touch()
        self.submitted += 1
        self.under_way += 1
        self.most = max(self.most, self.under_way)
        return _Future(self, key, self.submitted)


@dataclass(frozen=True)
class _Future:
    client: _TwoWorkers
    key: str
    number: int

    def result(self) -> None:
        self.client.under_way -= 1

    def add_done_callback(self, tell: Callable[["_Future"], None]) -> None:
        if self.number == 1:
            self.client.end_the_first = lambda: tell(self)
        else:
            tell(self)
        if self.number == self.client.count and self.client.end_the_first:
            self.client.end_the_first()


@dataclass(frozen=True)
class _Lost(_Future):
    def result(self) -> None:
        raise CancelledError("scheduler-connection-lost")


def test_a_lost_scheduler_and_lost_workers_are_reported(
    make: Callable[..., RunTask], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Client(_TwoWorkers):
        """One that loses its workers, and then, when somebody has looked for them, its scheduler."""

        scheduler = SimpleNamespace(address="tls://there:1")
        asked = 0

        def scheduler_info(self, n_workers: int) -> dict[str, object]:
            self.asked += 1
            if self.asked == 2 and self.end_the_first:
                self.end_the_first()
            return {"workers": {"one": {}} if self.asked == 1 else {}}

        def submit(self, *_: object, key: str, pure: bool) -> _Future:
            return _Lost(self, key, 1)

        def cancel(self, futures: object, force: bool) -> None: ...

    monkeypatch.setattr(engine, "_cluster", lambda *_: contextlib.nullcontext((Client(2), 1)))
    monkeypatch.setattr(engine, "_WITHOUT_WORKERS", 0.0)
    with (
        pytest.warns(RuntimeWarning, match="tls://there:1 has no worker"),
        pytest.raises(SphframeError, match=r"tls://there:1 does not answer .*repeat the command"),
    ):
        carry_out([make("one")], tmp_path)


def test_no_worker_is_idle_beside_a_long_task(
    make: Callable[..., RunTask], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tasks = [make(str(k), until=0.05 + 0.01 * k) for k in range(6)]
    client = _TwoWorkers(len(tasks))
    monkeypatch.setattr(engine, "_cluster", lambda *_: contextlib.nullcontext((client, 1)))
    carry_out(tasks, tmp_path)
    assert (client.submitted, client.under_way, client.most) == (6, 0, 2)
