"""A reproduction that is killed goes on where it stopped; on a cluster of one's own it does the same."""

import os
import random
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType

import pytest

from sphframe.studies import reproduce

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")


def results(folder: Path) -> dict[str, tuple[int, int]]:
    """The runs that are done, with what would change if one were done again."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in (folder / "runs").glob("*.nc")}


def written(folder: Path) -> dict[str, bytes]:
    """The report, figures and tables."""
    paths = [folder / "report.html", *(folder / "figures").iterdir(), *(folder / "tables").iterdir()]
    return {path.name: path.read_bytes() for path in paths}


def test_killed_twice_it_repeats_nothing_and_reports_the_same(tiny: ModuleType, cluster: str, tmp_path: Path) -> None:
    folder, generator = tmp_path / "killed", random.Random()
    command = [sys.executable, "-W", "ignore", str(Path(tiny.__file__)), str(folder)]
    for kill in (1, 2):
        wanted = len(results(folder)) + (kill == 1)
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until = time.monotonic() + 60.0
        while len(results(folder)) < wanted or not list((folder / "runs" / "unfinished").glob("*.nc")):
            assert process.poll() is None, "it ended before it was killed"
            assert time.monotonic() < until
            time.sleep(0.002)
        time.sleep(generator.uniform(0.0, 0.5))
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        assert not (folder / "report.html").exists()
        done = results(folder)
        assert len(done) >= 1
    subprocess.run(command, check=True, timeout=120, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = results(folder)
    assert len(after) == 4
    assert {name: after[name] for name in done} == done
    reproduce(tiny.Tiny(), output=tmp_path / "undisturbed", scheduler=cluster)
    assert written(folder) == written(tmp_path / "undisturbed")


def test_on_a_scheduler_and_two_workers_started_by_hand(tiny: ModuleType, tmp_path: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address = f"tcp://127.0.0.1:{port}"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    dask = [sys.executable, "-W", "ignore", "-m", "dask"]
    worker = [*dask, "worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    processes = [
        subprocess.Popen([*dask, "scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard"], **quiet),  # type: ignore[call-overload]
        *(subprocess.Popen([*worker, "--name", name], **quiet) for name in ("a", "b")),  # type: ignore[call-overload]
    ]
    try:
        until = time.monotonic() + 60.0
        while True:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    break
            assert time.monotonic() < until, "the scheduler does not start"
            time.sleep(0.1)
        report = reproduce(tiny.Tiny(), output=tmp_path / "output", quick=True, scheduler=address)
        assert report.exists()
        assert len(results(tmp_path / "output")) == 4
        assert all(process.poll() is None for process in processes), "what the user has started goes on"
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()
