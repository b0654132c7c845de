"""A study that is killed continues where it stopped; on a cluster that the user started it gives the same results."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType

import pytest

from sphframe.studies import reproduce
from sphframe.studies.league import rank

Security = pytest.importorskip("distributed").Security
dask_config = pytest.importorskip("dask").config
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")

WAITS = """
import sys
from pathlib import Path

folder, done_before_waiting = Path(sys.argv[1]), int(sys.argv[2])


def wait_to_be_killed(progress):
    if progress.running and progress.done - progress.kept >= done_before_waiting:
        print("waiting", flush=True)
        sys.stdin.read()

"""
"""waits once so many tasks are done and another is running; its workers continue"""
STUDY = """
sys.path.insert(0, sys.argv[3])
import tiny
from sphframe.studies import reproduce

reproduce(tiny.Tiny(), output=folder, workers=2, on_progress=wait_to_be_killed)
"""
LEAGUE = """
from sphframe.studies.league import rank

methods, benchmarks = sys.argv[3].split(","), sys.argv[4].split(",")
rank(output=folder, methods=methods, benchmarks=benchmarks, quick=True, workers=2, on_progress=wait_to_be_killed)
"""


def kill_twice(program: str, folder: Path, *arguments: str) -> dict[str, tuple[int, int]]:
    """Start ``program`` twice, kill it each time, and return the runs that are finished."""
    generator = random.Random()
    for done_before in (1, 0):
        command = [sys.executable, "-W", "ignore", "-c", WAITS + program, str(folder), str(done_before), *arguments]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == b"waiting\n"
            time.sleep(generator.uniform(0.0, 0.5))  # the moment of the run at which it is killed
            os.kill(process.pid, signal.SIGKILL)
        assert results(folder)
    return results(folder)


def results(folder: Path) -> dict[str, tuple[int, int]]:
    """Return the finished runs, with inode and time, which would change if a run were repeated."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in (folder / "runs").glob("*.nc")}


def written(folder: Path) -> dict[str, bytes]:
    """Return the contents of report, figures and tables."""
    paths = [folder / "report.html", *(folder / "figures").iterdir(), *(folder / "tables").iterdir()]
    return {path.name: path.read_bytes() for path in paths}


@pytest.mark.long
@pytest.mark.slow
def test_killed_twice_it_repeats_nothing_and_reports_the_same(tiny: ModuleType, cluster: str, tmp_path: Path) -> None:
    folder, program = tmp_path / "killed", Path(tiny.__file__)
    done = kill_twice(STUDY, folder, str(program.parent))
    assert not (folder / "report.html").exists()
    subprocess.run([sys.executable, "-W", "ignore", str(program), str(folder)], check=True, capture_output=True)
    after = results(folder)
    assert len(after) == 4
    assert {name: after[name] for name in done} == done
    reproduce(tiny.Tiny(), output=tmp_path / "undisturbed", scheduler=cluster)
    assert written(folder) == written(tmp_path / "undisturbed")


@pytest.mark.long
def test_a_league_killed_twice_repeats_nothing_and_finishes_as_the_same(cluster: str, tmp_path: Path) -> None:
    folder, methods, benchmarks = tmp_path / "killed", ["adami-2012", "improved-shepard"], ["couette", "falling-tank"]
    done = kill_twice(LEAGUE, folder, ",".join(methods), ",".join(benchmarks))
    assert not (folder / "index.html").exists()
    league = rank(output=folder, methods=methods, benchmarks=benchmarks, quick=True, scheduler=cluster)
    after = results(folder)
    assert len(after) == 4
    assert {name: after[name] for name in done} == done
    other = rank(output=tmp_path / "whole", methods=methods, benchmarks=benchmarks, quick=True, scheduler=cluster)
    assert league.dataset.drop_vars("cost").identical(other.dataset.drop_vars("cost"))


@pytest.mark.long
def test_on_a_scheduler_and_two_workers_started_by_hand(tiny: ModuleType, tmp_path: Path) -> None:
    certificate = {"cert": str(tmp_path / "cert.pem"), "key": str(tmp_path / "key.pem")}
    temporary = Security.temporary()
    (tmp_path / "cert.pem").write_text(temporary.tls_ca_file)
    (tmp_path / "key.pem").write_text(temporary.tls_client_key)
    tls = {"ca-file": certificate["cert"], "scheduler": certificate, "worker": certificate, "client": certificate}
    (tmp_path / "tls.yaml").write_text(
        json.dumps({"distributed": {"comm": {"require-encryption": True, "tls": tls}}})  # JSON is YAML
    )
    environment = {**os.environ, "DASK_CONFIG": str(tmp_path)}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path, "env": environment}
    dask = [sys.executable, "-W", "ignore", "-m", "dask"]
    contact = tmp_path / "scheduler.json"
    arguments = [
        "--protocol",
        "tls",
        "--host",
        "127.0.0.1",
        "--port",
        "0",
        "--no-dashboard",
        "--scheduler-file",
        str(contact),
    ]
    processes = [subprocess.Popen([*dask, "scheduler", *arguments], **quiet)]  # type: ignore[call-overload]
    try:
        address = address_in(contact, processes[0])
        worker = [*dask, "worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
        processes += [subprocess.Popen([*worker, "--name", name], **quiet) for name in ("a", "b")]  # type: ignore[call-overload]
        assert address.startswith("tls://")
        with dask_config.set(
            {"distributed.comm.tls.ca-file": tls["ca-file"], "distributed.comm.tls.client": certificate}
        ):
            report = reproduce(tiny.Tiny(), output=tmp_path / "output", quick=True, scheduler=address)
        assert report.exists()
        assert len(results(tmp_path / "output")) == 4
        assert all(process.poll() is None for process in processes), "the user's scheduler and workers must go on"
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()


def address_in(contact: Path, scheduler: subprocess.Popen[bytes]) -> str:
    """Wait until the scheduler has written its file, and return the address in it."""
    while True:
        assert scheduler.poll() is None, "the scheduler does not start"
        try:
            return str(json.loads(contact.read_text())["address"])
        except (FileNotFoundError, ValueError):  # not there yet, or not complete
            time.sleep(0.05)
