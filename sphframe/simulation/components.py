"""Simulation: the components that a case chooses by name."""

from dataclasses import dataclass
from typing import Any

from sphframe.boundary.trial import try_weights
from sphframe.boundary.wall_trial import checked_parts
from sphframe.cases import Case
from sphframe.cases.placement import placed_force
from sphframe.compiled import compile_part
from sphframe.compiled.parts import checked_function, checked_scalar
from sphframe.errors import InputError
from sphframe.interfaces import (
    BodyForce,
    BoundaryInterpolator,
    CompiledKernel,
    EquationOfState,
    Integrator,
    Kernel,
    WallContext,
    WallParts,
    WallTreatment,
)
from sphframe.kernels import compiled_kernel
from sphframe.particles import Columns
from sphframe.registry import COMPONENT_KINDS


@dataclass(frozen=True)
class Components:
    """The components of a case, and their compiled parts.

    Attributes
    ----------
    interpolator
        the one that the treatment uses; None if it uses none. ``velocity_interpolator``: another one for
        velocities.
    compiled_kernel
        the kernel's compiled functions and constants in the case's dimension.
    walls
        the functions of the treatment of walls. ``body_force``: None without acceleration.
    parts
        what the compiled loops are specialised with, by the name that the loops use.
    """

    interpolator: BoundaryInterpolator | None
    velocity_interpolator: BoundaryInterpolator | None
    wall_treatment: WallTreatment
    kernel: Kernel
    equation_of_state: EquationOfState
    integrator: Integrator
    compiled_kernel: CompiledKernel
    walls: WallParts
    parts: dict[str, Any]
    body_force: BodyForce | None = None

    @classmethod
    def of_case(cls, case: Case) -> "Components":
        """Make the components that ``case`` names, with their options.

        Raises
        ------
        InputError
            when an option is not valid.
        PluginError
            when a component is not installed, or cannot be loaded.
        """
        chosen = {field: getattr(case, field).create(kind) for field, kind in COMPONENT_KINDS.items()}
        kernel = compiled_kernel(chosen["kernel"], case.dimension)
        parts = loop_parts(kernel, chosen["equation_of_state"], case.dimension)
        parts["PERIODIC"] = bool(case.periodic)
        parts["MORRIS"] = case.kinematic_viscosity > 0.0 and case.viscosity_model == "morris"
        treatment: WallTreatment = chosen["wall_treatment"]
        if case.dimension not in treatment.traits.dimensions:
            works = " or ".join(map(str, treatment.traits.dimensions))
            raise InputError(
                f"wall_treatment {case.wall_treatment.name!r} works in {works} dimensions, but the case has"
                f" {case.dimension}: choose another one, see `sphframe list wall_treatments`"
            )
        velocity_interpolator = treatment.velocity_interpolator(chosen["interpolator"])
        chosen["interpolator"] = treatment.interpolator(chosen["interpolator"])
        for method in (chosen["interpolator"], velocity_interpolator):
            if method is not None and case.dimension not in method.traits.dimensions:
                works = " or ".join(map(str, method.traits.dimensions))
                raise InputError(
                    f"interpolator {type(method).__name__} works in {works} dimensions, but the case has"
                    f" {case.dimension}: choose another one, see `sphframe list interpolators`"
                )
        context = WallContext(
            kernel=kernel,
            dim=case.dimension,
            interpolator=chosen["interpolator"],
            no_slip=case.slip == "no",
            balanced_lift=case.hydrostatic_lift == "balanced",
            corrected_velocity=case.ghost_velocity == "corrected",
            velocity_interpolator=velocity_interpolator,
            pressure=parts["PRESSURE"],
        )
        chosen["velocity_interpolator"] = velocity_interpolator
        for method in (chosen["interpolator"], velocity_interpolator):
            if method is not None:
                try_weights(method, kernel, case.dimension, case.smoothing_length_ratio)
        checked_function(chosen["integrator"], "step", chosen["integrator"].step, ("system", "time", "time_step"))
        walls, force = checked_parts(treatment, context), placed_force(case)
        return cls(**chosen, compiled_kernel=kernel, walls=walls, parts=parts, body_force=force)


def loop_parts(kernel: CompiledKernel, equation_of_state: EquationOfState, dim: int) -> dict[str, Any]:
    """Return the parts of the compiled loops that depend on the kernel, the equation of state and the dimension."""
    pressure, density = (
        checked_scalar(equation_of_state, maker.__name__, maker(), ("variable", "rho0", "c0"), (1e3, 1e3, 10.0))
        for maker in (equation_of_state.pressure_function, equation_of_state.density_function)
    )
    return {
        "DIM": dim,
        "COLUMNS": Columns.of(dim),
        "SUPPORT": kernel.support,
        "VALUE": kernel.value,
        "GRADIENT": kernel.gradient_of_square,
        "PRESSURE": compile_part(pressure),
        "DENSITY": compile_part(density),
    }
