"""Threads: the library that makes them, their number, forks, and runs side by side."""

import importlib.util
import os
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from sphframe.compiled.threads import _group_limits

LOOP = """
import os, numba, numpy as np, sphframe.compiled as compiled
@numba.njit(parallel=True, cache=False)
def total(values):
    result = 0.0
    for i in numba.prange(len(values)):
        result += values[i]
    return result
def run(threads):
    compiled.use_threads(threads)
    return total(np.ones(8)) == 8.0 and numba.threading_layer()
"""


def python(program: str, **environment: str) -> str:
    settings = {**os.environ, "NUMBA_NUM_THREADS": "2", **environment}
    done = subprocess.run(
        [sys.executable, "-c", LOOP + program], env=settings, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


FORK = """
run(2)
if os.fork() == 0:
    try:
        print(run(2), flush=True)
    except Exception as error:
        print(error, flush=True)
    os._exit(0)
os.wait()
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_fork_after_a_run_works_or_is_refused_with_advice() -> None:
    if importlib.util.find_spec("tbb") or Path(sys.prefix, "lib", "libtbb.so.12").exists():
        assert python(FORK) == "tbb\n", "TBB is preferred, found without LD_LIBRARY_PATH, and survives a fork"
    assert "get_context('spawn')" in python(FORK, NUMBA_THREADING_LAYER="omp")


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no affinity")
def test_one_thread_for_each_processor_that_may_be_used() -> None:
    core = min(os.sched_getaffinity(0))
    program = f"import os; os.sched_setaffinity(0, [{core}]); import sphframe.compiled as c; print(c.default_threads())"
    settings = {name: value for name, value in os.environ.items() if name != "NUMBA_NUM_THREADS"}
    done = subprocess.run([sys.executable, "-c", program], env=settings, capture_output=True, text=True, check=True)
    assert done.stdout == "1\n"


def test_limits_of_control_groups_are_read(tmp_path: Path) -> None:
    own, inner = tmp_path / "cgroup", tmp_path / "user" / "run"
    inner.mkdir(parents=True)
    (inner / "cpu.max").write_text("max 100000\n")
    (inner.parent / "cpu.max").write_text("150000 100000\n")
    own.write_text("0::/user/run\n")
    assert list(_group_limits(tmp_path, own)) == [float("inf"), 1.5]
    old = tmp_path / "cpu" / "box"
    old.mkdir(parents=True)
    (old / "cpu.cfs_quota_us").write_text("300000\n")
    (old / "cpu.cfs_period_us").write_text("100000\n")
    own.write_text("4:cpu,cpuacct:/box\n0::/\n")
    assert list(_group_limits(tmp_path, own)) == [float("inf"), 3.0]
    (old / "cpu.cfs_quota_us").write_text("-1\n")
    assert list(_group_limits(tmp_path, own)) == [float("inf")]
    assert list(_group_limits(tmp_path, tmp_path / "none")) == [float("inf")]


@pytest.mark.long
@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="one processor")
def test_two_runs_side_by_side_do_not_starve_each_other(tmp_path: Path) -> None:
    if psutil.cpu_percent(1.0) > 10.0:
        pytest.skip("the machine is not idle")
    program = (
        "import sys, time, sphframe; s = sphframe.Simulation(sphframe.load_case('dam-break'), threads=2)\n"
        "for _ in range(20): s.advance()\n"
        "print('ready', flush=True); sys.stdin.readline(); began = time.perf_counter()\n"
        "for _ in range(1500): s.advance()\n"
        "print(time.perf_counter() - began, flush=True)"
    )

    def times(count: int) -> list[float]:
        processes = [
            subprocess.Popen([sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            for _ in range(count)
        ]
        for process in processes:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        for process in processes:
            assert process.stdin is not None
            process.stdin.write("\n")
            process.stdin.flush()
        return [float(process.communicate()[0]) for process in processes]

    (alone,) = times(1)
    assert max(times(2)) < 2.3 * alone
