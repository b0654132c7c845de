"""Two parts with one name but different closure values, loaded from the cache on disk, must not be confused."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

MODULE = """
import math
import sys

import numpy as np

from sphframe.compiled import specialise

def make(value):
    def part(x, y):  # long enough not to be inlined
        total = 0.0
        for a in range(len(y)):
            for b in range(a):
                for c in range(b):
                    if y[a] * y[b] > x:
                        y[c] += math.sin(x * y[b]) * math.exp(-y[a]) + y[c] ** 2
                    else:
                        y[c] -= math.cos(x * y[b]) * math.exp(-y[b]) + y[a] ** 2
            total += math.atan2(y[a], x) * 0.0 + value
        return total
    return part

def template(x, y):
    return PART(x, y) + PART(x + 1.0, y) + PART(x + 2.0, y) + PART(2.0 * x, y)

for value in sys.argv[1:]:
    print(specialise(template, {"PART": make(float(value))}, parallel=False)(1.0, np.ones(1)))
"""


HELPED = """
import numba

def jitted(part):
    return numba.njit(part)

""" + MODULE.replace(
    "    return part\n",
    """\
    helper = jitted(part)
    return lambda x, y: helper(x, y)
""",
)
"""the same in a function that the part calls"""


@pytest.mark.parametrize("module", [MODULE, HELPED], ids=["part", "helper of a part"])
def test_namesakes_from_the_cache_stay_apart(tmp_path: Path, module: str) -> None:
    (tmp_path / "loops.py").write_text(module)
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}

    def run(*values: str) -> list[str]:
        command = [sys.executable, "-c", f"import sys; sys.argv[1:] = {list(values)}; import loops"]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()

    assert run("1") == ["4.0"]
    assert run("2") == ["8.0"]
    assert run("1", "2") == ["4.0", "8.0"]
