"""The compiler uses the widest registers of the processor, unless the user has chosen its features."""

import os
import subprocess
import sys

import numba
import pytest
from numba.core import codegen

from sphframe.compiled import prefer_avx512

SHOWS = """
from sphframe import Simulation
from numba.core.registry import cpu_target
print(cpu_target.target_context.codegen().magic_tuple())
"""


@pytest.mark.skipif("+avx512f" not in codegen.get_host_cpu_features().split(","), reason="no AVX-512 here")
@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_the_widest_registers_are_used() -> None:
    own = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_CPU")}
    found = subprocess.run([sys.executable, "-c", SHOWS], env=own, capture_output=True, text=True, check=True)
    assert "-prefer-256-bit" in found.stdout


def test_the_choice_of_the_user_is_respected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba.config, "CPU_NAME", "generic")
    monkeypatch.setattr(numba.config, "CPU_FEATURES", None)
    prefer_avx512()
    assert numba.config.CPU_FEATURES is None
