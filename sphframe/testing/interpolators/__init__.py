"""Testing: interpolation methods, one check function per property.

Each check takes the method and the dimension, and raises :class:`sphframe.testing.BrokenPromiseError` with an
explanation.
"""

from collections.abc import Callable

from sphframe.interfaces import Traits
from sphframe.testing.interpolators import compiled, declaration, invariance, rank, solver, weights
from sphframe.testing.interpolators.comparison import CheckFunction, with_each_kernel

__all__ = ["CHECKS", "CHECKS_OF_TRAITS"]

CHECKS: dict[str, CheckFunction] = {
    "traits": declaration.check_traits,
    "compiles": compiled.check_compiles,
    "honest_status": weights.check_honest_status,
    "fewest_points": declaration.check_fewest_points,
    "guards": weights.check_guards,
    "bounded_weights": weights.check_bounded_weights,
    "rank": rank.check_rank,
    "reflection_invariance": invariance.check_reflection_invariance,
    "permutation_invariance": invariance.check_permutation_invariance,
    "translation_invariance": invariance.check_translation_invariance,
    "scale_invariance": invariance.check_scale_invariance,
    "unit_independence": invariance.check_unit_independence,
    "additivity": invariance.check_additivity,
    "locality": invariance.check_locality,
    "kernel": invariance.check_kernel,
    "repeatable": compiled.check_repeatable,
    "plain_python_agrees": compiled.check_plain_python_agrees,
    "solver_agrees": solver.check_solver_agrees,
    "shear": solver.check_shear,
    "writes_only_out": compiled.check_writes_only_out,
    "no_allocation": compiled.check_no_allocation,
}
"""the checks of every method, by the name of the property"""

CHECKS_OF_TRAITS: dict[str, tuple[CheckFunction, Callable[[Traits], bool]]] = {
    "partition_of_unity": (weights.check_partition_of_unity, lambda t: t.partition_of_unity),
    "non_negative": (weights.check_non_negative, lambda t: t.non_negative),
    "range_restricted": (weights.check_range_restricted, lambda t: t.range_restricted),
    "linear_reproduction": (weights.check_linear_reproduction, lambda t: t.reproduces_degree >= 1),
    "quadratic_reproduction": (weights.check_quadratic_reproduction, lambda t: t.reproduces_degree >= 2),
    "interpolates_particles": (weights.check_interpolates_particles, lambda t: t.interpolates_particles),
    "rotation_invariance": (invariance.check_rotation_invariance, lambda t: t.rotation_invariant),
    "volume_independence": (invariance.check_volume_independence, lambda t: t.volume_independent),
    "continuity": (invariance.check_continuity, lambda t: t.continuous),
}
"""the checks of a trait, by the name of the property, each with whether given traits declare it"""

_ONCE = {"traits", "kernel", "plain_python_agrees", "solver_agrees", "shear", "writes_only_out", "no_allocation"}
_ONCE |= {"compiles", "translation_invariance"}
"""checks that do not depend on the kernel, or compile much"""
CHECKS |= {name: with_each_kernel(check) for name, check in CHECKS.items() if name not in _ONCE}
CHECKS_OF_TRAITS |= {name: (with_each_kernel(check), declared) for name, (check, declared) in CHECKS_OF_TRAITS.items()}
