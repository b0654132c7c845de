"""The process that compiles the loops, and the next one, which loads them from disk, compute the same bits."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

RUN = """
import hashlib, sys
from sphframe import run
last = run("dam-break", output=sys.argv[1], particle_spacing=0.03, until=0.2).dataset.isel(time=-1)
state = b"".join(last[name].values.tobytes() for name in ("position", "velocity", "density"))
print(hashlib.sha256(state).hexdigest())
"""


@pytest.mark.long
def test_freshly_compiled_and_cached_loops_have_the_same_bits(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    states = [
        subprocess.run(
            [sys.executable, "-c", RUN, str(tmp_path / f"{name}.nc")],
            env=environment, check=True, capture_output=True, text=True,
        ).stdout
        for name in ("fresh", "cached")
    ]  # fmt: skip
    assert states[0] == states[1]
