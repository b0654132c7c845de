"""Benchmark: the flow of all measurements: the dam break of the paper, of any size, at rest or developed."""

import math
import warnings
from collections.abc import Callable
from typing import Any

from sphframe.cases import CaseWarning, load_case
from sphframe.cases.dam_break import DamBreak
from sphframe.simulation import Simulation

DEVELOPED = 5.0
"""t sqrt(g/H) from which the flow counts as developed: the water has run up the wall and falls back"""
_WARM_UP = 3


def dam_break(particles: int, dim: int, **parameters: Any) -> DamBreak:
    """Return the paper's dam break with about ``particles`` fluid particles.

    In 2-D the Courant number is that of the paper for every size. In 3-D the time step is the default of the case, and
    the smoothing length is 1.1 spacings.

    Examples
    --------
    >>> case = dam_break(45_000, 2)
    >>> round(case.particle_spacing, 9), case.smoothing_length_ratio, round(case.time_step, 9)
    (0.004, 1.3, 0.0001)
    """
    extent = 1.2 * 0.6 if dim == 2 else 1.2 * 0.3 * 0.6
    spacing = (extent / particles) ** (1.0 / dim)
    own: dict[str, Any] = {"dimension": dim, "particle_spacing": spacing, "time_step": 1e-4 * spacing / 0.004}
    if dim == 3:
        own |= {"smoothing_length_ratio": 1.1, "time_step": None}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseWarning)  # about coarse cases
        case = load_case("dam-break", "paper", {**own, **parameters})
    assert isinstance(case, DamBreak)
    return case


def warm_up(simulation: Simulation) -> None:
    """Make the first steps, which compile and load all loops and allocate all memory."""
    for _ in range(_WARM_UP):
        simulation.advance()


def run_to_developed_flow(simulation: Simulation, tell: Callable[[float], None]) -> None:
    """Run a dam break until the flow is developed, and call ``tell`` with the part that is done after each step."""
    until = DEVELOPED * math.sqrt(simulation.scene.depth / simulation.parameters.gravity)
    while simulation.time < until:
        simulation.advance()
        tell(simulation.time / until)
