"""Testing: the checks of a component, and the pytest decorator that runs them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sphframe.cases import Case
from sphframe.interfaces import (
    BodyForce,
    BoundaryInterpolator,
    EquationOfState,
    Integrator,
    Kernel,
    RigidBody,
    Traits,
    WallTreatment,
)
from sphframe.testing import (
    body_forces,
    equations_of_state,
    integrators,
    interpolators,
    kernels,
    rigid_bodies,
    wall_treatments,
)
from sphframe.testing import cases as case_checks
from sphframe.testing.evaluation import title


@dataclass(frozen=True)
class Check:
    """A check of a component. Calling it with the component runs it."""

    name: str
    function: Callable[..., None]
    dim: int | None = None
    """2 or 3 for a check of an interpolation method"""
    promised: bool = True
    """whether the component declares the property by its traits, or all components must have it"""
    optional: bool = False
    """whether the property is one of the traits"""

    def __call__(self, component: Any) -> None:
        """Run the check.

        Raises
        ------
        BrokenPromiseError
            when the component does not have the property.
        """
        if self.dim is None:
            self.function(component)
        else:
            self.function(component, self.dim)

    def __str__(self) -> str:
        return self.name if self.dim is None else f"{self.name}-{self.dim}d"


_OTHER_INTERFACES: dict[type, dict[str, Callable[[Any], None]]] = {
    Kernel: kernels.CHECKS,
    EquationOfState: equations_of_state.CHECKS,
    Integrator: integrators.CHECKS,
    RigidBody: rigid_bodies.CHECKS,
    BodyForce: body_forces.CHECKS,
    Case: case_checks.CHECKS,
}


def checks_of(component: Any, *, promised_only: bool = True) -> list[Check]:
    """Return the checks of ``component``, chosen by its interface and its traits.

    Parameters
    ----------
    component
        an interpolation method, wall treatment, kernel, equation of state, integrator, rigid body,
        body force or case.
    promised_only
        leave out the checks of traits that a method does not declare.

    Raises
    ------
    TypeError
        when it is none of these.
    """
    if isinstance(component, BoundaryInterpolator):
        return _checks_of_method(component, promised_only)
    if isinstance(component, WallTreatment):
        return _checks_of_treatment(component, promised_only)
    for interface, checks in _OTHER_INTERFACES.items():
        if isinstance(component, interface):
            return [Check(name, function) for name, function in checks.items()]
    raise TypeError(
        f"there are no checks for {component!r}: give an instance of BoundaryInterpolator, WallTreatment, Kernel,"
        f" EquationOfState, Integrator, RigidBody, BodyForce or Case"
    )


def _checks_of_method(method: BoundaryInterpolator, promised_only: bool) -> list[Check]:
    traits = method.traits
    if not isinstance(traits, Traits):
        return [Check("traits", interpolators.CHECKS["traits"], 2)]
    found = []
    for dim in traits.dimensions:
        found += [Check(name, function, dim) for name, function in interpolators.CHECKS.items()]
        found += [
            Check(name, function, dim, promised=is_promised(traits), optional=True)
            for name, (function, is_promised) in interpolators.CHECKS_OF_TRAITS.items()
            if is_promised(traits) or not promised_only
        ]
    return found


def _checks_of_treatment(treatment: WallTreatment, promised_only: bool) -> list[Check]:
    found = [
        Check(name, function, dim)
        for name, function in wall_treatments.CHECKS.items()
        for dim in treatment.traits.dimensions
    ]
    found += [
        Check(name, function, promised=is_promised(treatment.traits), optional=True)
        for name, (function, is_promised) in wall_treatments.CHECKS_OF_TRAITS.items()
        if is_promised(treatment.traits) or not promised_only
    ]
    return found


def parametrize_with_checks(
    components: Sequence[Any] | Iterable[Any],
    *,
    expected_failed_checks: Mapping[str, str] | Callable[[Any], Mapping[str, str]] | None = None,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Parametrise a pytest function of two arguments, component and check, with all checks of each component.

    Parameters
    ----------
    components
        instances to be checked; the test ids show them as code.
    expected_failed_checks
        names of checks (``"continuity"``, or ``"continuity-3d"`` for one dimension), each with the
        reason why it fails, or a function that returns them for a component; a check that then succeeds is an error.

    Raises
    ------
    ValueError
        when no component has a check of that name.

    Examples
    --------
    ::

        @parametrize_with_checks([MyMethod()])
        def test_has_its_traits(method, check):
            check(method)
    """
    import pytest

    cases = []
    known: set[str] = set()
    given: dict[str, str] = {}
    for component in components:
        reasons = expected_failed_checks or {}
        reasons = reasons(component) if callable(reasons) else reasons
        given |= reasons
        known |= {name for check in checks_of(component) for name in (check.name, str(check))}
        for check in checks_of(component):
            reason = reasons.get(str(check), reasons.get(check.name))
            marks = [] if reason is None else [pytest.mark.xfail(reason=reason, strict=True)]
            cases.append(pytest.param(component, check, id=f"{title(component)}-{check}", marks=marks))

    if set(given) - known:
        raise ValueError(f"no component has the checks {', '.join(sorted(set(given) - known))}")

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        names = function.__code__.co_varnames[: function.__code__.co_argcount]
        if len(names) != 2:
            raise TypeError(
                f"a function parametrised with checks takes two arguments, the component and the check, and"
                f" {function.__name__} takes {len(names)}"
            )
        decorated: Callable[..., Any] = pytest.mark.parametrize(names, cases)(function)
        return decorated

    return decorate
