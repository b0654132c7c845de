"""Benchmark: measurements in a new process, in which nothing is loaded or compiled yet."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

from sphframe.errors import SimulationError


class Fresh(NamedTuple):
    """The JSON value that a new process has printed, and the time from its start to its end, s."""

    found: Any
    seconds: float


def run_fresh(code: str, environment: Mapping[str, str] | None = None) -> Fresh:
    """Run Python ``code`` that prints one line of JSON, with additions to the ``environment``.

    Raises
    ------
    SimulationError
        the process fails.
    """
    began = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **(environment or {})},
        capture_output=True,
        text=True,
        check=False,
    )
    elapsed = time.perf_counter() - began
    if done.returncode:
        raise SimulationError(f"a fresh Python could not be measured: {(done.stderr.strip() or 'no message')[-500:]}")
    return Fresh(json.loads(done.stdout.splitlines()[-1]), elapsed)
