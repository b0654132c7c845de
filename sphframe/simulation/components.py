"""Simulation: the components that a case chooses by name."""

from dataclasses import dataclass
from typing import Any

from sphframe.cases import Case
from sphframe.compiled import compile_part
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, EquationOfState, Integrator, Kernel
from sphframe.kernels import compiled_kernel
from sphframe.particles import Columns
from sphframe.registry import COMPONENT_KINDS


@dataclass(frozen=True)
class Components:
    """The components of a case, and their compiled parts.

    Attributes
    ----------
    compiled_kernel: the kernel's compiled functions and constants in the case's dimension.
    parts: what the compiled loops are specialised with, by the name that the loops use.
    """

    interpolator: BoundaryInterpolator
    kernel: Kernel
    equation_of_state: EquationOfState
    integrator: Integrator
    compiled_kernel: CompiledKernel
    parts: dict[str, Any]

    @classmethod
    def of_case(cls, case: Case) -> "Components":
        """Make the components that ``case`` names, with their options.

        Raises
        ------
        InputError: when an option is not valid.
        PluginError: when a component is not installed, or cannot be loaded.
        """
        chosen = {field: getattr(case, field).create(kind) for field, kind in COMPONENT_KINDS.items()}
        kernel = compiled_kernel(chosen["kernel"], case.dimension)
        parts = loop_parts(kernel, chosen["equation_of_state"], case.dimension)
        return cls(**chosen, compiled_kernel=kernel, parts=parts)


def loop_parts(kernel: CompiledKernel, equation_of_state: EquationOfState, dim: int) -> dict[str, Any]:
    """Return the parts of the compiled loops that depend on the kernel, the equation of state and the dimension."""
    return {
        "DIM": dim,
        "COLUMNS": Columns.of(dim),
        "SUPPORT": kernel.support,
        "VALUE": kernel.value,
        "GRADIENT": kernel.gradient_of_square,
        "PRESSURE": compile_part(equation_of_state.pressure_function()),
        "DENSITY": compile_part(equation_of_state.density_function()),
    }
