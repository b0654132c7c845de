"""Testing: cases, one check function per property."""

from collections.abc import Callable

import numpy as np

from sphframe.cases import Case
from sphframe.errors import SphframeError
from sphframe.simulation.simulation import Simulation
from sphframe.testing.proof import BrokenPromiseError, require


def check_starts(case: Case) -> None:
    """The case with its own parameters passes all checks before a run, and its initial state has finite rates."""
    name = type(case).__name__
    try:
        rates = Simulation(case, threads=1).system.rates
    except SphframeError as error:
        raise BrokenPromiseError(f"{name}() cannot be started: {error}") from error
    require(bool(np.isfinite(rates).all()), f"{name}(): the rates of the initial state are not finite")


def check_presets(case: Case) -> None:
    """Each preset is a valid set of parameters, of which a scene can be drawn."""
    for preset, values in type(case).presets.items():
        try:
            type(case)(**values).scene()
        except (SphframeError, ValueError) as error:
            raise BrokenPromiseError(f"preset {preset!r} of {type(case).__name__}: {error}") from error


CHECKS: dict[str, Callable[[Case], None]] = {"starts": check_starts, "presets": check_presets}
"""checks of every case"""
