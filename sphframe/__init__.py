"""sphframe: a laboratory for wall boundaries in SPH free-surface flow.

The public names below are loaded on first use, so that importing sphframe loads no plugin and compiles nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphframe.boundary.operator import ParticleCloud
    from sphframe.cases import Case, load_case
    from sphframe.compiled import fast_exp, local_array
    from sphframe.errors import InputError, OutputError, PluginError, SimulationError, SphframeError
    from sphframe.hooks import hookimpl
    from sphframe.interfaces import (
        DRY,
        OK,
        SINGULAR,
        TOO_FEW,
        BoundaryInterpolator,
        CompiledKernel,
        EquationOfState,
        EvaluationPoint,
        Integrator,
        Kernel,
        Motion,
        RigidBody,
        Status,
        System,
        Traits,
        WeightsFunction,
    )
    from sphframe.output import open_dataset
    from sphframe.registry import available, create
    from sphframe.simulation.run import Run, resume, run
    from sphframe.simulation.simulation import Simulation

__version__ = "0.1.0"

_HOMES = {
    "sphframe.boundary.operator": ["ParticleCloud"],
    "sphframe.cases": ["Case", "load_case"],
    "sphframe.compiled": ["fast_exp", "local_array"],
    "sphframe.errors": ["InputError", "OutputError", "PluginError", "SimulationError", "SphframeError"],
    "sphframe.hooks": ["hookimpl"],
    "sphframe.interfaces": [
        "DRY",
        "OK",
        "SINGULAR",
        "TOO_FEW",
        "BoundaryInterpolator",
        "CompiledKernel",
        "EquationOfState",
        "EvaluationPoint",
        "Integrator",
        "Kernel",
        "Motion",
        "RigidBody",
        "Status",
        "System",
        "Traits",
        "WeightsFunction",
    ],
    "sphframe.output": ["open_dataset"],
    "sphframe.registry": ["available", "create"],
    "sphframe.simulation": ["Run", "Simulation", "resume", "run"],
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "DRY",
    "OK",
    "SINGULAR",
    "TOO_FEW",
    "BoundaryInterpolator",
    "Case",
    "CompiledKernel",
    "EquationOfState",
    "EvaluationPoint",
    "InputError",
    "Integrator",
    "Kernel",
    "Motion",
    "OutputError",
    "ParticleCloud",
    "PluginError",
    "RigidBody",
    "Run",
    "Simulation",
    "SimulationError",
    "SphframeError",
    "Status",
    "System",
    "Traits",
    "WeightsFunction",
    "available",
    "create",
    "fast_exp",
    "hookimpl",
    "load_case",
    "local_array",
    "open_dataset",
    "resume",
    "run",
]


def __getattr__(name: str) -> Any:
    if name in _HOME_OF:
        value = getattr(import_module(_HOME_OF[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'sphframe' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
