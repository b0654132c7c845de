"""Compiled: vector registers in the full width of the processor, chosen when this module is imported."""

import contextlib
from typing import Any

import numba as typed_numba
from numba.core import codegen

numba: Any = typed_numba  # its settings have no types


def prefer_avx512() -> None:
    """Let the compiler use the vector registers of 512 bits of a processor that has them.

    For most processors of Intel, LLVM prefers those of 256 bits; the pair loops, which hold eight particles in a
    register, then take 1.5 times as long. The results have the same bits. It has to be done before the first function
    is decorated. NUMBA_CPU_NAME and NUMBA_CPU_FEATURES are respected.
    """
    if numba.config.CPU_NAME is None and numba.config.CPU_FEATURES is None:
        with contextlib.suppress(RuntimeError):  # LLVM does not know the processor
            features: str = codegen.get_host_cpu_features()  # type: ignore[no-untyped-call]
            if "+avx512f" in features.split(","):
                numba.config.CPU_FEATURES = f"{features},-prefer-256-bit"


prefer_avx512()
