"""Testing: the order of convergence of a treatment of walls or of an interpolation method, in one evaluation of rates.

Exact fields with no particular symmetry (:mod:`sphframe.testing.order_fields`) are given to the fluid beside a
straight, a circular and a wavy wall. The solver fills the wall particles and computes rates once. Those of the
particles within the support of the wall are compared with what wall particles with the exact values would give. The
walls move, gravity is oblique, and the pressure is not zero at the wall, so that no term vanishes by chance. The RMS
error e of each operator at several spacings dx is fitted by log e = log C + p log dx.

The fields vary by about one over the unit of length, and so do the errors: that of the pressure gradient over
rho0 * 1 m/s^2, of the divergence over 1/s, of the viscous force over rho0 nu * 1/(m s), of the density gradient, times
c0^2, over rho0 * 1 m/s^2. The error of ``shear`` is
|int d e_t G| / int G^2 over the particles near the wall, d their distance from it, e_t the tangential error of the
viscous force: the velocity that a flow gets far from the wall. One order of dx comes from d, and one from the width of
the layer, so that the flow converges where the Laplacian at the wall does not.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from scipy import stats

from sphframe.arrays import Array
from sphframe.errors import InputError
from sphframe.interfaces import BoundaryInterpolator, Order, Orders, WallTreatment
from sphframe.registry import create
from sphframe.testing.order_fields import DENSITY, WALLS, TestWall
from sphframe.testing.order_scenes import ARRANGEMENTS, Beside, Sums
from sphframe.testing.verification import choices

COUNTS = (20, 24, 28, 34, 40, 48, 56)
"""spacings over the unit of length"""
OPERATORS = (*(field.name for field in fields(Orders)), "density_gradient")
"""the last, which the density diffusion uses, sees the fluid alone, whatever the treatment"""
TOLERANCE = 0.3
"""how far a measured order may stay below the promised one"""
_DEVIATION = 0.01
"""how far a measured error may be from the promised one, over this"""
_REFERENCE = 32.0
_EXACT = 1e-8
"""error of round-off: the pressure follows from the density"""


@dataclass(frozen=True)
class Fit:
    """Errors (counts,) of an operator and what they say: the ``order`` p, infinite where the rule is exact.

    ``spread``: half of the 95 % confidence interval of p; ``error``: of the fit at 32 spacings.
    """

    errors: tuple[float, ...]
    order: float
    spread: float
    error: float

    @classmethod
    def of(cls, counts: Sequence[int], errors: Sequence[float]) -> "Fit":
        """Fit log e = log C + p log dx to ``errors`` with ``counts`` spacings over the unit of length."""
        given = tuple(map(float, errors))
        if max(given) < _EXACT:
            return cls(given, math.inf, 0.0, max(given))
        line = stats.linregress(-np.log(counts), np.log(np.maximum(given, 1e-300)))
        spread = float(line.stderr * stats.t.ppf(0.975, len(given) - 2)) if len(given) > 2 else math.inf
        error = math.exp(line.intercept - line.slope * math.log(_REFERENCE))
        return cls(given, float(line.slope), spread, error)


@dataclass(frozen=True)
class OrderReport:
    """What was measured of one component: ``fits`` by operator, wall and arrangement, beside what it promises."""

    name: str
    kind: str
    counts: tuple[int, ...]
    promised: Orders
    fits: dict[str, dict[tuple[str, str], Fit]]
    error: str | None = None

    def straight(self, operator: str) -> Fit:
        """Return the fit at the straight wall, on the lattice."""
        return self.fits[operator]["straight", "lattice"]

    def lowest(self, operator: str) -> tuple[tuple[str, str], Fit] | None:
        """Return wall, arrangement and fit of the lowest order anywhere else; None where nothing else was measured."""
        others = [(place, fit) for place, fit in self.fits[operator].items() if place != ("straight", "lattice")]
        return min(others, key=lambda found: found[1].order, default=None)

    def failures(self) -> list[str]:
        """Return what does not hold of the promise, one line each."""
        found = [] if self.error is None else [self.error]
        return found + [text for texts in self.by_promise().values() for text in texts]

    def by_promise(self) -> dict[str, list[str]]:
        """Return what does not hold of each promise, by operator: nothing where it is kept."""
        promises = {operator: getattr(self.promised, operator, None) for operator in self.fits}
        return {operator: list(self._broken(operator, one)) for operator, one in promises.items() if one is not None}

    def _broken(self, operator: str, promise: Order) -> Iterator[str]:
        for (wall, arrangement), fit in self.fits[operator].items():
            at_straight = (wall, arrangement) == ("straight", "lattice")
            order = promise.straight if at_straight else promise.anywhere
            if order is not None and fit.order + min(fit.spread, 0.5) < order - TOLERANCE:
                yield (
                    f"{operator.replace('_', ' ')}: order {fit.order:.2f} +- {fit.spread:.2f} at the {wall} wall,"
                    f" {arrangement}; {order:g} is promised"
                )
            if at_straight and promise.error is not None and abs(fit.error / promise.error - 1.0) > _DEVIATION:
                yield (
                    f"{operator.replace('_', ' ')}: error {fit.error:.4g} at the straight wall with {_REFERENCE:g}"
                    f" spacings; {promise.error:g} is promised"
                )

    @property
    def broken(self) -> bool:
        """Whether a promise does not hold, or nothing could be measured."""
        return bool(self.failures())

    def as_data(self) -> dict[str, Any]:
        """Return the report as plain data, for JSON; infinite numbers are None."""
        measured = [
            {"operator": operator, "wall": wall, "particles": arrangement, **asdict(fit)}
            for operator, places in self.fits.items()
            for (wall, arrangement), fit in places.items()
        ]
        promised = {name: order and asdict(order) for name, order in vars(self.promised).items()}
        data = {"name": self.name, "kind": self.kind, "broken": self.broken, "failures": self.failures()}
        return {**data, "counts": [*self.counts], "promised": _finite(promised), "measured": _finite(measured)}


def _finite(data: Any) -> Any:
    if isinstance(data, dict):
        return {name: _finite(value) for name, value in data.items()}
    if isinstance(data, list | tuple):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data


def verify_order(names: Sequence[str] = (), *, progress: Callable[[str], None] | None = None) -> Iterator[OrderReport]:
    """Measure the orders of all components with ``names``, as for :func:`sphframe.testing.verify`, one report each.

    Raises
    ------
    InputError
        when something else than an interpolation method or a wall treatment is named.
    """
    chosen = choices(names)
    for kind, label, _, _ in chosen:
        if kind not in ("interpolators", "wall_treatments"):
            raise InputError(f"{label} is one of {kind}: orders are those of interpolators and wall_treatments")
    for kind, label, name, options in chosen:
        try:
            component = create(kind, name, **options)
            report = measure_order(component, name=label, progress=progress)
        except Exception as error:
            report = OrderReport(label, kind, COUNTS, Orders(), {}, f"{type(error).__name__}: {error}")
        yield report


def measure_order(
    component: WallTreatment | BoundaryInterpolator,
    *,
    name: str = "",
    walls: Sequence[str] = tuple(WALLS),
    arrangements: Sequence[str] = ARRANGEMENTS,
    slips: Sequence[str] = ("no", "free"),
    counts: Sequence[int] = COUNTS,
    progress: Callable[[str], None] | None = None,
) -> OrderReport:
    """Measure the orders of a treatment, or of an interpolation method with fixed ghosts, in two dimensions.

    Parameters
    ----------
    name
        how the report calls it.
    walls
        some of ``straight``, ``circle`` and ``wavy``.
    arrangements
        some of :data:`ARRANGEMENTS`.
    slips
        ``no``, ``free`` or both: the first gives pressure, divergence, viscosity and shear, the second the rest.
    counts
        spacings over the unit of length, at least two.
    progress
        called with a line of text before each wall.
    """
    errors: dict[str, dict[tuple[str, str], list[float]]] = {}
    for wall in walls:
        for slip in slips:
            if progress is not None:
                progress(f"{name or type(component).__name__}: {wall} wall, {slip} slip")
            for count in counts:
                beside = Beside(component, WALLS[wall], count, slip)
                for arrangement in arrangements:
                    for operator, error in _errors(beside, beside.arrange(arrangement)).items():
                        errors.setdefault(operator, {}).setdefault((wall, arrangement), []).append(error)
    found = {
        operator: {place: Fit.of(counts, values) for place, values in errors[operator].items()}
        for operator in OPERATORS
        if operator in errors
    }
    kind = "interpolators" if isinstance(component, BoundaryInterpolator) else "wall_treatments"
    return OrderReport(name or type(component).__name__, kind, tuple(counts), component.traits.order, found)


def _errors(beside: Beside, sums: Sums) -> dict[str, float]:
    """Return the errors of the operators with the slip of the scene."""
    wall, chosen = beside.wall, sums.chosen
    found: dict[str, float] = {}
    if beside.slip == "no":
        rates = beside.rates(pressure=wall.pressure)[chosen]
        found["pressure"] = _rms(-rates[:, :2] - sums.pressure_gradient(wall.pressure)) / DENSITY
        found["density_gradient"] = _rms(rates[:, 3:] - sums.renormalised_gradient(wall.pressure)) / DENSITY
    velocity = wall.no_slip if beside.slip == "no" else wall.slip
    rates = beside.rates(velocity=velocity)[chosen]
    divergence = _rms(rates[:, 2:3] - sums.divergence(velocity))
    friction = rates[:, :2] / DENSITY - sums.laplacian(velocity)
    if beside.slip == "no":
        shear = _far_velocity(wall, sums.cloud[chosen], friction) / beside.count**2
        return {**found, "divergence": divergence, "viscosity": _rms(friction), "shear": shear}
    return {"slip_divergence": divergence, **({} if wall.name == "wavy" else {"slip_viscosity": _rms(friction)})}


def _rms(error: Array) -> float:
    return float(np.sqrt(np.square(error).sum(axis=1).mean()))


def _far_velocity(wall: TestWall, place: Array, friction: Array) -> float:
    """Return |sum d e_t G| / int G^2, times V an error of velocity; all V are nearly dx^2."""
    normal, profile = wall.normal(place), wall.profile(place)
    tangential = friction[:, 0] * normal[:, 1] - friction[:, 1] * normal[:, 0]
    moment = (wall.distance(place) * tangential * profile).sum()
    return float(abs(moment) / (wall.length * np.mean(profile**2)))
