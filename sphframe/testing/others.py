"""Testing: kernels, equations of state, integrators and rigid bodies, one check function per property."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sphframe.interfaces import EquationOfState, Integrator, Kernel, RigidBody
from sphframe.specialise import compile_part
from sphframe.testing.evaluation import title
from sphframe.testing.proof import BrokenPromiseError

__all__ = ["Oscillator", "checks_of"]

Array = NDArray[np.float64]


def checks_of(component: Any) -> dict[str, Callable[[Any], None]]:
    """Return the checks of a kernel, an equation of state, an integrator or a rigid body, by name.

    Raises
    ------
    TypeError: when ``component`` is none of these.
    """
    for interface, checks in _CHECKS.items():
        if isinstance(component, interface):
            return checks
    raise TypeError(
        f"there are no checks for {component!r}: give an instance of BoundaryInterpolator, Kernel, EquationOfState,"
        f" Integrator or RigidBody"
    )


# kernels


def check_unit_integral(kernel: Kernel) -> None:
    """The integral of W is one in one, two and three dimensions."""
    value = kernel.value_function()
    for dim, sphere in ((1, 2.0), (2, 2.0 * math.pi), (3, 4.0 * math.pi)):
        integral = kernel.normalisation(dim) * _integral(value, dim - 1, kernel.support) * sphere
        _hold(
            abs(integral - 1.0) < 1e-9,
            f"{title(kernel)}: the integral of W in {dim}-D is {integral:.12g}, not 1: mend normalisation({dim})",
        )


def check_moments(kernel: Kernel) -> None:
    """The second moment is positive and below that of all mass at the cut-off: W is a smoothing kernel."""
    value = kernel.value_function()
    for dim, sphere in ((1, 2.0), (2, 2.0 * math.pi), (3, 4.0 * math.pi)):
        moment = kernel.normalisation(dim) * _integral(value, dim + 1, kernel.support) * sphere
        _hold(
            0.0 < moment < kernel.support**2,
            f"{title(kernel)}: the second moment of W in {dim}-D is {moment:.6g} h^2, outside of 0 .."
            f" {kernel.support**2:g}",
        )


def check_gradient(kernel: Kernel) -> None:
    """The gradient factor is the derivative of the value divided by q, and finite at the centre."""
    value, factor = kernel.value_function(), kernel.gradient_function()
    largest = max(abs(value(q)) for q in (0.0, 0.5 * kernel.support))
    for q in np.linspace(0.013, 0.987, 57) * kernel.support:
        step = 1e-5 * kernel.support
        slope = (value(q + step) - value(q - step)) / (2.0 * step)
        given = factor(q) * q
        _hold(
            abs(slope - given) < 1e-6 * largest,
            f"{title(kernel)}: at q = {q:.6g} the gradient function times q is {given:.9g}, but differences of the"
            f" value give {slope:.9g}; it must return w'(q)/q",
        )
    centre = factor(0.0)
    _hold(
        math.isfinite(centre) and abs(centre - factor(1e-4)) < 1e-3 * abs(centre),
        f"{title(kernel)}: the gradient function is {centre} at q = 0 and {factor(1e-4)} beside it; return the"
        f" limit w''(0)",
    )
    of_square = kernel.gradient_of_square_function()
    for q in np.linspace(0.0, 0.999, 37) * kernel.support:
        _hold(
            math.isclose(of_square(float(q * q)), factor(float(q)), rel_tol=1e-9, abs_tol=1e-12 * abs(centre)),
            f"{title(kernel)}: at q = {q:.6g} the gradient function of q^2 gives {of_square(float(q * q))}, that of q"
            f" {factor(float(q))}",
        )


def check_compact_support(kernel: Kernel) -> None:
    """The value falls to zero at the cut-off."""
    value = kernel.value_function()
    edge = value(kernel.support * (1.0 - 1e-9))
    _hold(
        abs(edge) < 1e-6 * value(0.0),
        f"{title(kernel)}: w is {edge:.3g} at the cut-off q = {kernel.support:g}, not 0",
    )


def check_monotone(kernel: Kernel) -> None:
    """The value is positive and falls from the centre to the cut-off."""
    value = kernel.value_function()
    q = np.linspace(0.0, 0.9999, 400) * kernel.support
    values = np.array([value(x) for x in q])
    _hold(bool(np.all(values > 0.0)), f"{title(kernel)}: w is not positive at q = {q[np.argmin(values)]:.6g}")
    rises = np.flatnonzero(np.diff(values) >= 0.0)
    _hold(not len(rises), f"{title(kernel)}: w does not fall at q = {q[rises[0]] if len(rises) else 0.0:.6g}")


def check_kernel_compiles(kernel: Kernel) -> None:
    """Compiled and plain Python agree."""
    for function in (kernel.value_function(), kernel.gradient_function(), kernel.gradient_of_square_function()):
        compiled = compile_part(function)
        for q in np.linspace(0.0, 0.999, 37) * kernel.support:
            _hold(
                math.isclose(compiled(float(q)), function(float(q)), rel_tol=1e-9, abs_tol=1e-12),
                f"{title(kernel)}: at q = {q:.6g}, compiled {compiled(float(q))} and plain Python {function(float(q))}"
                f" differ",
            )


# equations of state

_DENSITIES = 1000.0 * np.array([0.99, 0.999, 1.0, 1.0001, 1.001, 1.01, 1.03])


def check_inverse(state: EquationOfState) -> None:
    """rho(p(rho)) = rho, and p is zero at the reference density."""
    pressure, density = state.pressure_function(), state.density_function()
    for c0 in (10.0, 1500.0):
        rest = pressure(1000.0, 1000.0, c0)
        _hold(abs(rest) < 1e-9 * 1000.0 * c0**2, f"{title(state)}: p(rho0) is {rest:.6g} Pa, not 0")
        for rho in _DENSITIES:
            back = density(pressure(rho, 1000.0, c0), 1000.0, c0)
            _hold(
                abs(back - rho) < 1e-9 * rho,
                f"{title(state)}: rho(p({rho:g})) is {back:.12g} kg/m^3 with c0 = {c0:g} m/s; density_function must"
                f" invert pressure_function",
            )


def check_pressure_rises(state: EquationOfState) -> None:
    """P rises with rho."""
    pressure = state.pressure_function()
    values = [pressure(rho, 1000.0, 40.0) for rho in _DENSITIES]
    _hold(bool(np.all(np.diff(values) > 0.0)), f"{title(state)}: p does not rise with rho: {values} Pa")


def check_sound_speed(state: EquationOfState) -> None:
    """c^2 = dp/drho, and c = c0 at the reference density."""
    pressure, speed = state.pressure_function(), state.sound_speed_function()
    for c0 in (10.0, 1500.0):
        _hold(
            math.isclose(speed(1000.0, 1000.0, c0), c0, rel_tol=1e-9),
            f"{title(state)}: c(rho0) is {speed(1000.0, 1000.0, c0):.9g} m/s with c0 = {c0:g} m/s",
        )
        for rho in _DENSITIES:
            slope = (pressure(rho + 1e-3, 1000.0, c0) - pressure(rho - 1e-3, 1000.0, c0)) / 2e-3
            given = speed(rho, 1000.0, c0) ** 2
            _hold(
                math.isclose(slope, given, rel_tol=1e-5),
                f"{title(state)}: c^2 = {given:.9g} at rho = {rho:g}, but dp/drho = {slope:.9g} m^2/s^2",
            )


def check_state_compiles(state: EquationOfState) -> None:
    """Compiled and plain Python agree."""
    pressure = state.pressure_function()
    for function, argument in (
        (pressure, 1003.0),
        (state.sound_speed_function(), 1003.0),
        (state.density_function(), pressure(1003.0, 1000.0, 40.0)),
    ):
        compiled = compile_part(function)(argument, 1000.0, 40.0)
        plain = function(argument, 1000.0, 40.0)
        _hold(
            math.isclose(compiled, plain, rel_tol=1e-9),
            f"{title(state)}: compiled {compiled} and plain Python {plain} differ at {argument:g}",
        )


# integrators


class Oscillator:
    """An acoustic mode as a System: dx/dt = u, du/dt = -rho, drho/dt = u + forcing cos(2t), from x = rho = 1, u = 0."""

    def __init__(self, forcing: float = 0.0) -> None:
        self.x, self.u, self.rho = 1.0, 0.0, 1.0
        self.forcing = forcing
        self.evaluations = 0.0
        self._rates = np.array([0.0, -1.0, forcing])
        self._total = np.zeros(3)
        self._start = np.zeros(3)

    def exact(self, time: float) -> tuple[float, float, float]:
        """Return x, u and rho at ``time``."""
        c, s, c2, s2 = math.cos(time), math.sin(time), math.cos(2.0 * time), math.sin(2.0 * time)
        f = self.forcing / 3.0
        return c - f * s + 0.5 * f * s2, -s - f * c + f * c2, c - f * s + 2.0 * f * s2

    def evaluate(self, time: float) -> None:
        """Compute all rates."""
        self.evaluate_density(time)
        self._rates[0] = self.u
        self.evaluate_acceleration(time)

    def evaluate_density(self, time: float) -> None:
        """Compute the density rate."""
        self.evaluations += 0.5
        self._rates[2] = self.u + self.forcing * math.cos(2.0 * time)

    def evaluate_acceleration(self, time: float) -> None:
        """Compute the acceleration."""
        self.evaluations += 0.5
        self._rates[1] = -self.rho

    def hold(self) -> None:
        """Remember the present state."""
        self._start = np.array([self.x, self.u, self.rho])
        self._total = np.zeros(3)

    def advance(self, interval: float) -> None:
        """y = y0 + interval f."""
        self.x, self.u, self.rho = (self._start + interval * self._rates).tolist()

    def accumulate(self, weight: float) -> None:
        """Total = total + weight f."""
        self._total += weight * self._rates

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval total."""
        self.x, self.u, self.rho = (self._start + interval * self._total).tolist()

    def drift(self, interval: float) -> None:
        """x = x + interval u."""
        self.x += interval * self.u

    def kick(self, interval: float) -> None:
        """u = u + interval a."""
        self.u += interval * float(self._rates[1])

    def update_density(self, interval: float) -> None:
        """Rho = rho + interval drho/dt."""
        self.rho += interval * float(self._rates[2])


def _integrate(integrator: Integrator, steps: int, time: float, forcing: float = 0.0) -> Oscillator:
    system = Oscillator(forcing)
    interval = time / steps
    for k in range(steps):
        integrator.step(system, k * interval, interval)
    return system


def check_order(integrator: Integrator) -> None:
    """The error on a forced acoustic mode, in position, velocity and density, falls with the declared order."""
    for name, k in (("position", 0), ("velocity", 1), ("density", 2)):
        errors = []
        for steps in (40, 80):
            end = _integrate(integrator, steps, 3.0, forcing=0.5)
            errors.append(abs((end.x, end.u, end.rho)[k] - end.exact(3.0)[k]))
        measured = math.log2(errors[0] / errors[1]) if errors[1] > 0.0 else math.inf
        _hold(
            measured > integrator.order - 0.4,
            f"{title(integrator)}: the {name} converges with order {measured:.2f}, and order says {integrator.order}",
        )


def check_evaluations(integrator: Integrator) -> None:
    """The rates are evaluated as often per step as declared."""
    counted = _integrate(integrator, 10, 1.0).evaluations / 10
    _hold(
        counted == integrator.evaluations,
        f"{title(integrator)}: {counted:g} evaluations a step, and evaluations says {integrator.evaluations}",
    )


def check_energy(integrator: Integrator) -> None:
    """The energy of an acoustic mode neither grows nor decays by more than 1 % in a hundred periods of 60 steps."""
    end = _integrate(integrator, 6000, 200.0 * math.pi)
    energy = end.rho**2 + end.u**2
    _hold(
        abs(energy - 1.0) < 0.01,
        f"{title(integrator)}: after a hundred periods of 60 steps an acoustic mode has {energy:.4f} of its energy",
    )


def check_time_reversal(integrator: Integrator) -> None:
    """Where ``time_reversible`` is set: run backwards in time, the acoustic mode returns to its start."""
    if not getattr(integrator, "time_reversible", False):
        return
    system = _integrate(integrator, 50, 5.0)
    for k in range(50):
        integrator.step(system, 5.0 - 0.1 * k, -0.1)
    back = (system.x, system.u, system.rho)
    _hold(
        bool(np.allclose(back, (1.0, 0.0, 1.0), atol=1e-10)),
        f"{title(integrator)}: it says time_reversible, but returns to x, u, rho = {back}, not to 1, 0, 1",
    )


def check_stability(integrator: Integrator) -> None:
    """The recommended Courant number lies below the stability limit."""
    _hold(
        0.0 < integrator.courant_number < integrator.stability_limit,
        f"{title(integrator)}: courant_number {integrator.courant_number} must lie between 0 and stability_limit"
        f" {integrator.stability_limit}",
    )


# rigid bodies


def check_motion(body: RigidBody) -> None:
    """The motion is finite, of three generalised coordinates, and the same for the same arguments."""
    for time in (0.0, 0.3, 2.7):
        first, second = (body.motion(time, np.zeros(3), np.zeros(3), np.zeros(3)) for _ in range(2))
        for name, a, b in zip(first._fields, first, second, strict=True):
            _hold(
                np.shape(a) == (3,) and bool(np.all(np.isfinite(a))),
                f"{title(body)}: the {name} at {time} s is {a!r}; it must be three finite numbers",
            )
            _hold(
                np.array_equal(a, b),
                f"{title(body)}: the {name} at {time} s differs between two calls with the same arguments; keep no"
                f" state",
            )


def check_derivatives(body: RigidBody) -> None:
    """A prescribed motion has consistent derivatives; a dynamic body keeps the position and velocity it is given."""
    given, moving = np.array([0.01, -0.02, 0.03]), np.array([0.1, 0.2, -0.1])
    kept = body.motion(0.5, given, moving, np.zeros(3))
    if np.array_equal(kept.position, given) or not _is_prescribed(body):
        return
    step = 1e-5
    for time in (0.11, 0.37, 1.3, 2.9):
        before, now, after = (body.motion(t, given, moving, np.zeros(3)) for t in (time - step, time, time + step))
        for name, low, high, rate in (
            ("velocity", before.position, after.position, now.velocity),
            ("acceleration", before.velocity, after.velocity, now.acceleration),
        ):
            slope = (high - low) / (2.0 * step)
            _hold(
                bool(np.allclose(slope, rate, rtol=1e-4, atol=1e-4 * (1.0 + float(np.max(np.abs(rate)))))),
                f"{title(body)}: at {time} s the {name} is {rate.tolist()}, but differences give {slope.tolist()}",
            )


def check_momentum(body: RigidBody) -> None:
    """The acceleration of a dynamic body away from its stops is affine in the load: force = mass times acceleration."""
    if not body.needs_load:
        return
    position, velocity = np.full(3, 1e-3), np.zeros(3)
    loads = [np.array([1e6 + 1e3 * k, 1e3 * k, 10.0 * k]) for k in range(3)]
    a0, a1, a2 = (body.motion(0.0, position, velocity, load).acceleration for load in loads)
    _hold(
        bool(np.allclose(a2 - a1, a1 - a0, rtol=1e-6, atol=1e-12 * float(np.max(np.abs(a0)) + 1.0))),
        f"{title(body)}: load steps of equal size change the acceleration by {(a1 - a0).tolist()} and then by"
        f" {(a2 - a1).tolist()}: force = mass times acceleration",
    )


def check_spring_period(body: RigidBody) -> None:
    """A body with ``mass`` and ``stiffness`` along x swings with the period 2 pi sqrt(m/k) about a constant load."""
    mass, stiffness = getattr(body, "mass", None), getattr(body, "stiffness", None)
    if not (body.needs_load and mass and stiffness):
        return
    period = 2.0 * math.pi * math.sqrt(mass / stiffness)
    load = np.array([1e3 * stiffness + 1e6, 0.0, 0.0])
    near, far = (body.motion(0.0, np.array([x, 0.0, 0.0]), np.zeros(3), load).acceleration[0] for x in (1.0, 2.0))
    measured = 2.0 * math.pi / math.sqrt(max(near - far, 1e-300))
    _hold(
        math.isclose(measured, period, rel_tol=1e-6),
        f"{title(body)}: the acceleration falls by {near - far:.6g} m/s^2 per metre, a period of {measured:.6g} s"
        f" instead of 2 pi sqrt(m/k) = {period:.6g} s",
    )


def check_stop(body: RigidBody) -> None:
    """A body corrected to another position, at a stop, has no velocity left towards the stop."""
    if not body.needs_load:
        return
    for direction in (-1.0, 1.0):
        position, velocity = np.array([10.0 * direction, 0.0, 0.0]), np.array([direction, 0.0, 0.0])
        motion = body.motion(0.0, position, velocity, np.zeros(3))
        if motion.position[0] != position[0]:
            _hold(
                motion.velocity[0] * direction <= 0.0,
                f"{title(body)}: at its stop x = {motion.position[0]:g} the velocity is {motion.velocity[0]:g}, further"
                f" into the stop",
            )


def _is_prescribed(body: RigidBody) -> bool:
    """Whether the motion ignores where the body is said to be."""
    one, other = (body.motion(0.5, np.full(3, x), np.full(3, x), np.zeros(3)) for x in (0.0, 0.01))
    return bool(np.array_equal(one.position, other.position))


def _integral(value: Callable[[float], float], power: int, upper: float) -> float:
    """The integral of w(q) q^power by Gauss-Legendre in 60 pieces; the knots of the usual splines lie between them."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    width = upper / 60
    total = 0.0
    for k in range(60):
        q = width * (k + 0.5 + 0.5 * nodes)
        total += 0.5 * width * float(weights @ np.array([value(float(x)) * x**power for x in q]))
    return total


def _hold(condition: bool, message: str) -> None:
    if not condition:
        raise BrokenPromiseError(message)


_CHECKS: dict[type, dict[str, Callable[[Any], None]]] = {
    Kernel: {
        "unit_integral": check_unit_integral,
        "moments": check_moments,
        "gradient": check_gradient,
        "compact_support": check_compact_support,
        "monotone": check_monotone,
        "compiles": check_kernel_compiles,
    },
    EquationOfState: {
        "inverse": check_inverse,
        "pressure_rises": check_pressure_rises,
        "sound_speed": check_sound_speed,
        "compiles": check_state_compiles,
    },
    Integrator: {
        "order": check_order,
        "evaluations": check_evaluations,
        "energy": check_energy,
        "time_reversal": check_time_reversal,
        "stability": check_stability,
    },
    RigidBody: {
        "motion": check_motion,
        "derivatives": check_derivatives,
        "momentum": check_momentum,
        "spring_period": check_spring_period,
        "stop": check_stop,
    },
}
