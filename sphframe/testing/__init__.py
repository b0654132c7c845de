"""Testing: the verification suite that plugin authors import.

A conformance test is a few lines::

    from sphframe.testing import parametrize_with_checks

    @parametrize_with_checks([MyMethod(), MyMethod(order=2)])
    def test_has_its_traits(method, check):
        check(method)

The names below are loaded on first use; importing this package compiles nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphframe.testing.evaluation import Outcome, evaluate
    from sphframe.testing.ghost_response import GhostResponse, ghost_responses
    from sphframe.testing.judgement import Judgement, judge, judge_walls
    from sphframe.testing.neighbourhoods import FAMILIES, Cloud, catalogue
    from sphframe.testing.order import Fit, OrderReport, measure_order, verify_order
    from sphframe.testing.particle_files import Particles, WallPoints, read_particles, read_walls
    from sphframe.testing.proof import BrokenPromiseError
    from sphframe.testing.strategies import (
        basins,
        body_states,
        clouds,
        flattened_clouds,
        kernel_arguments,
        oscillators,
        states,
    )
    from sphframe.testing.suite import Check, checks_of, parametrize_with_checks
    from sphframe.testing.verification import Report, verify
    from sphframe.testing.wall_treatments import WallResiduals, poiseuille_error, wall_residuals

_HOMES = {
    "sphframe.testing.neighbourhoods": ["FAMILIES", "Cloud", "catalogue"],
    "sphframe.testing.evaluation": ["Outcome", "evaluate"],
    "sphframe.testing.ghost_response": ["GhostResponse", "ghost_responses"],
    "sphframe.testing.judgement": ["Judgement", "judge", "judge_walls"],
    "sphframe.testing.particle_files": ["Particles", "WallPoints", "read_particles", "read_walls"],
    "sphframe.testing.order": ["Fit", "OrderReport", "measure_order", "verify_order"],
    "sphframe.testing.proof": ["BrokenPromiseError"],
    "sphframe.testing.strategies": [
        "basins",
        "body_states",
        "clouds",
        "flattened_clouds",
        "kernel_arguments",
        "oscillators",
        "states",
    ],
    "sphframe.testing.suite": ["Check", "checks_of", "parametrize_with_checks"],
    "sphframe.testing.verification": ["Report", "verify"],
    "sphframe.testing.wall_treatments": ["WallResiduals", "poiseuille_error", "wall_residuals"],
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "FAMILIES",
    "BrokenPromiseError",
    "Check",
    "Cloud",
    "Fit",
    "GhostResponse",
    "Judgement",
    "OrderReport",
    "Outcome",
    "Particles",
    "Report",
    "WallPoints",
    "WallResiduals",
    "basins",
    "body_states",
    "catalogue",
    "checks_of",
    "clouds",
    "evaluate",
    "flattened_clouds",
    "ghost_responses",
    "judge",
    "judge_walls",
    "kernel_arguments",
    "measure_order",
    "oscillators",
    "parametrize_with_checks",
    "poiseuille_error",
    "read_particles",
    "read_walls",
    "states",
    "verify",
    "verify_order",
    "wall_residuals",
]


def __getattr__(name: str) -> Any:
    if name in _HOME_OF:
        value = getattr(import_module(_HOME_OF[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'sphframe.testing' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
