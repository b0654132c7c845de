"""Deliberately wrong interpolation methods, each of which fails the check that is meant to find it, for any seed."""

import math
import statistics
from collections.abc import Callable
from typing import Any, NamedTuple

import hypothesis.core
import numba
import numpy as np
import pytest
from scipy.optimize import nnls

from sphframe import (
    DRY,
    OK,
    SINGULAR,
    TOO_FEW,
    BoundaryInterpolator,
    CompiledKernel,
    EvaluationPoint,
    Traits,
    WeightsFunction,
    create,
    local_array,
)
from sphframe.testing import BrokenPromiseError, checks_of
from sphframe.testing.interpolators.declaration import check_fewest_points

Factory = Callable[[CompiledKernel, int], WeightsFunction]


class Wrong(BoundaryInterpolator):
    """A method made of a factory and declared traits."""

    def __init__(self, factory: Factory, traits: Traits, fallback: Factory | None = None) -> None:
        self.factory = factory
        self.claimed = traits
        self.fallback = fallback

    def __repr__(self) -> str:
        return f"Wrong({self.factory.__name__})"

    @property
    def traits(self) -> Traits:
        return self.claimed

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        return self.factory(kernel, dim)

    def fallback_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        return (self.fallback or super().fallback_weights)(kernel, dim)


class Case(NamedTuple):
    method: Wrong
    caught_by: str


CASES: dict[str, Case] = {}
AVERAGE = {"non_negative": True, "range_restricted": True}
SHEPARD = {**AVERAGE, "interpolates_particles": True, "volume_independent": True}


def wrong(mistake: str, caught_by: str, **claims: Any) -> Callable[[Factory], Factory]:
    def register(factory: Factory) -> Factory:
        fallback = claims.pop("fallback", None)
        CASES[mistake] = Case(Wrong(factory, Traits(**claims), fallback), caught_by)
        return factory

    return register


# wrong normalisation


@wrong("a forgotten V_j", "partition_of_unity", **AVERAGE)
def forgotten_volume(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = 0.0
        for j in range(out.shape[0]):
            total += kernel_values[j] * volumes[j]
        if total <= 0.0:
            return TOO_FEW
        for j in range(out.shape[0]):
            out[j] = kernel_values[j] / total
        return OK

    return weights


@wrong("not normalised at all", "partition_of_unity", non_negative=True)
def plain_sum(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for j in range(out.shape[0]):
            out[j] = kernel_values[j] * volumes[j]
        return OK

    return weights


def improved_shepard(kernel, dim, volume=False, shifted=True, exponent_scale=0.0, power=4, softening=0.0):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        nearest = distances[0]
        for j in range(n):
            nearest = min(nearest, distances[j])
        total = 0.0
        for j in range(n):
            r = distances[j]
            scale = support if exponent_scale == 0.0 else exponent_scale
            if nearest == 0.0 and softening == 0.0:
                out[j] = 1.0 if r == 0.0 else 0.0
            else:
                s = min(r / scale, 1.0 - 1e-15)
                first = min(nearest / scale, 1.0 - 1e-15)
                exponent = -s * s / (1.0 - s * s)
                if shifted:
                    exponent += first * first / (1.0 - first * first)
                out[j] = (math.exp(exponent) * (nearest + softening) / (r + softening)) ** power
            total += out[j]
        for j in range(n):
            out[j] /= total
            if volume:
                out[j] *= volumes[j]
        return OK

    return weights


@wrong("the V_j of Eq. 21", "partition_of_unity", **AVERAGE)
def volume_of_eq_21(kernel, dim):
    return improved_shepard(kernel, dim, volume=True)


@wrong(
    "a fallback of zeros", "partition_of_unity", fewest_points=(3, 4), fallback=lambda kernel, dim: zeros(kernel, dim)
)
def zero_fallback(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        if out.shape[0] < dim + 1:
            return TOO_FEW
        for j in range(out.shape[0]):
            out[j] = 1.0 / out.shape[0]
        return OK

    return weights


def zeros(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for j in range(out.shape[0]):
            out[j] = 0.0
        return OK

    return weights


@wrong("float32 inside", "partition_of_unity", **AVERAGE)
def single_precision(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = np.float32(0.0)
        for j in range(out.shape[0]):
            out[j] = np.exp(-((3.0 * distances[j] / support) ** 2))
            total += np.float32(out[j])
        for j in range(out.shape[0]):
            out[j] /= total
        return OK

    return weights


# errors at special places


@wrong("a NaN at r = 0", "honest_status", **SHEPARD)
def nan_at_particle(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = 0.0
        for j in range(out.shape[0]):
            out[j] = 1.0 / distances[j] ** 2
            total += out[j]
        for j in range(out.shape[0]):
            out[j] /= total
        return OK

    return weights


@wrong("underflow near the cut-off", "honest_status", **SHEPARD)
def underflow(kernel, dim):
    return improved_shepard(kernel, dim, shifted=False)


@wrong("the last neighbour's weight is never set", "honest_status", **AVERAGE)
def last_unset(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        for j in range(n - 1):
            out[j] = 1.0 / (n - 1)
        return OK

    return weights


@wrong("an exception for two neighbours", "honest_status", **AVERAGE)
def raising(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        if out.shape[0] == 2:
            raise ValueError("two neighbours")
        for j in range(out.shape[0]):
            out[j] = 1.0 / out.shape[0]
        return OK

    return weights


@wrong("a status of its own", "honest_status", **AVERAGE)
def unknown_status(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for j in range(out.shape[0]):
            out[j] = 1.0 / out.shape[0]
        return 7

    return weights


@wrong("DRY with neighbours", "honest_status", **AVERAGE)
def dry(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        return DRY

    return weights


# wrong order of consistency


def first_order(kernel, dim, sign=1.0, lift_factor=1.0, ridge=0.0, guarded=True, shift=0, thinnest=1e-8):
    """Moving least squares about the centre of mass of the weights, or the same with a mistake."""
    entries = dim * dim

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        if guarded and n < dim + 1:
            return TOO_FEW
        total = 0.0
        centre = local_array(dim)
        target = local_array(dim)
        matrix = local_array(entries)
        for a in range(dim):
            centre[a] = 0.0
            for b in range(dim):
                matrix[a * dim + b] = 0.0
        for j in range(n):
            total += kernel_values[j] * volumes[j]
        if total <= 0.0:
            return TOO_FEW
        for j in range(n):
            for a in range(dim):
                centre[a] += kernel_values[j] * volumes[j] / total * offsets[j, a] / support
        trace = 0.0
        for j in range(n):
            for a in range(dim):
                for b in range(dim):
                    x = offsets[j, a] / support - centre[a]
                    y = offsets[j, b] / support - centre[b]
                    matrix[a * dim + b] += kernel_values[j] * volumes[j] / total * x * y
        for a in range(dim):
            trace += matrix[a * dim + a]
            target[a] = sign * (lift_factor * lift[a] / support - centre[a])
        for a in range(dim):
            matrix[a * dim + a] += ridge
            if guarded and not matrix[a * dim + a] > thinnest * trace:
                return SINGULAR
            for b in range(a + 1, dim):
                factor = matrix[b * dim + a] / matrix[a * dim + a]
                for c in range(a, dim):
                    matrix[b * dim + c] -= factor * matrix[a * dim + c]
                target[b] -= factor * target[a]
        for k in range(dim):
            a = dim - 1 - k
            for b in range(a + 1, dim):
                target[a] -= matrix[a * dim + b] * target[b]
            target[a] /= matrix[a * dim + a]
        for j in range(n):
            out[(j + shift) % n] = kernel_values[j] * volumes[j] / total
            for a in range(dim):
                x = offsets[j, a] / support - centre[a]
                out[(j + shift) % n] += kernel_values[j] * volumes[j] / total * x * target[a]
        return OK

    return weights


LINEAR = {"reproduces_degree": 1, "fewest_points": (3, 4)}


@wrong("a sign", "linear_reproduction", **LINEAR)
def sign(kernel, dim):
    return first_order(kernel, dim, sign=-1.0)


@wrong("d instead of 2d", "linear_reproduction", **LINEAR, evaluation_point=EvaluationPoint.EXTRAPOLATED)
def half_the_lift(kernel, dim):
    return first_order(kernel, dim, lift_factor=0.5)


@wrong("a silent wrong solve for two points", "linear_reproduction", **LINEAR)
def silent_solve(kernel, dim):
    return first_order(kernel, dim, ridge=1e-14, guarded=False)


@wrong("OK for two neighbours", "fewest_points", **LINEAR)
def dishonest_solve(kernel, dim):
    return first_order(kernel, dim, ridge=1e-14, guarded=False)


@wrong("unlimited weights", "bounded_weights", **LINEAR)
def unlimited(kernel, dim):
    return first_order(kernel, dim, ridge=1e-14, guarded=False)


@wrong("a rank decided by round-off", "rank", **LINEAR)
def any_pivot(kernel, dim):
    return first_order(kernel, dim, thinnest=0.0)


def slopes_by_round_off(kernel, dim, smallest=0.0):
    """Linear along every direction whose eigenvalue is larger than ``smallest``."""

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        shares = kernel_values * volumes / (kernel_values * volumes).sum()
        mean = shares @ offsets
        away = offsets - mean
        values, vectors = np.linalg.eigh((shares * away.T) @ away)
        kept = values > smallest * support**2
        slope = (vectors[:, kept] / values[kept]) @ (vectors[:, kept].T @ mean)
        out[:] = shares * (1.0 - away @ slope)
        return OK

    return weights


@wrong("a fallback whose rank is decided by round-off", "rank", fallback=slopes_by_round_off, **LINEAR)
def slopes_across(kernel, dim):
    return first_order(kernel, dim)


def slope_along_the_longest_axis(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        shares = kernel_values * volumes / (kernel_values * volumes).sum()
        mean = shares @ offsets
        variances = shares @ (offsets - mean) ** 2
        a = int(np.argmax(variances))
        out[:] = shares
        if variances[a] > 1e-3 * support**2:
            out[:] *= 1.0 - (offsets[:, a] - mean[a]) * mean[a] / variances[a]
        return OK

    return weights


@wrong(
    "a fallback that is linear along an axis", "rotation_invariance", fallback=slope_along_the_longest_axis, **LINEAR
)
def slope_along_an_axis(kernel, dim):
    return first_order(kernel, dim)


@wrong("a thickness measured along the axes", "rank", **LINEAR)
def along_axes(kernel, dim):
    right = first_order(kernel, dim, thinnest=1e-30)

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for a in range(dim):
            low = high = offsets[0, a]
            for j in range(out.shape[0]):
                low, high = min(low, offsets[j, a]), max(high, offsets[j, a])
            if high - low < 1e-4 * support:
                return SINGULAR
        return right(offsets, distances, kernel_values, volumes, support, lift, out)

    return weights


@wrong("weights off by one neighbour", "linear_reproduction", **LINEAR)
def off_by_one(kernel, dim):
    return first_order(kernel, dim, shift=1)


@wrong("linear declared, constant reproduced", "linear_reproduction", **LINEAR)
def constant_only(kernel, dim):
    return first_order(kernel, dim, sign=0.0)


@wrong("quadratic declared, linear reproduced", "quadratic_reproduction", reproduces_degree=2, fewest_points=(3, 4))
def linear_only(kernel, dim):
    return first_order(kernel, dim)


@wrong("positive weights declared for least squares", "non_negative", **LINEAR, non_negative=True)
def negative(kernel, dim):
    return first_order(kernel, dim)


@wrong("a restricted range declared for least squares", "range_restricted", **LINEAR, **AVERAGE)
def out_of_range(kernel, dim):
    return first_order(kernel, dim)


@wrong("independence of volumes declared for least squares", "volume_independence", **LINEAR, volume_independent=True)
def uses_volumes(kernel, dim):
    return first_order(kernel, dim)


# missing symmetries


@wrong("the exponent of Eq. 20 as printed, in metres", "unit_independence", **SHEPARD)
def metres_in_exponent(kernel, dim):
    return improved_shepard(kernel, dim, exponent_scale=10.0)


@wrong("an absolute softening length", "scale_invariance", **AVERAGE, volume_independent=True)
def softening(kernel, dim):
    return improved_shepard(kernel, dim, softening=1e-3)


def skewed(kernel, dim, metric=0, tilt=0.0, first=0.0):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = 0.0
        for j in range(out.shape[0]):
            s = distances[j] / support
            if metric == 1:
                s = 0.0
                for a in range(dim):
                    s += abs(offsets[j, a]) / support
            out[j] = math.exp(-9.0 * s * s) * (1.0 + tilt * offsets[j, 0] / support)
            if j == 0:
                out[j] *= 1.0 + first
            total += out[j]
        for j in range(out.shape[0]):
            out[j] /= total
        return OK

    return weights


@wrong("distance measured along the axes", "rotation_invariance", **AVERAGE, volume_independent=True)
def taxicab(kernel, dim):
    return skewed(kernel, dim, metric=1)


@wrong("a preference for one side", "reflection_invariance", **AVERAGE, volume_independent=True)
def one_sided(kernel, dim):
    return skewed(kernel, dim, tilt=0.3)


@wrong("a hidden dependence on particle order", "permutation_invariance", **AVERAGE, volume_independent=True)
def first_counts_more(kernel, dim):
    return skewed(kernel, dim, first=1e-6)


@wrong("the last neighbour left out", "permutation_invariance", **AVERAGE)
def last_left_out(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        out[n - 1] = 0.0 if n > 1 else 1.0
        for j in range(n - 1):
            out[j] = 1.0 / (n - 1)
        return OK

    return weights


@wrong("float32 distances", "rotation_invariance", **AVERAGE, volume_independent=True)
def single_precision_distances(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = 0.0
        for j in range(out.shape[0]):
            s = np.float32(0.0)
            for a in range(dim):
                s += np.float32(offsets[j, a] / support) ** 2
            out[j] = math.exp(-9.0 * s)
            total += out[j]
        for j in range(out.shape[0]):
            out[j] /= total
        return OK

    return weights


@wrong("a jump at the nearest particle, continuity declared", "continuity", **SHEPARD)
def nearest_only(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        nearest = 0
        for j in range(out.shape[0]):
            out[j] = 0.0
            if distances[j] < distances[nearest]:
                nearest = j
        out[nearest] = 1.0
        return OK

    return weights


@wrong("softened distances, interpolation declared", "interpolates_particles", **SHEPARD)
def blurred(kernel, dim):
    return skewed(kernel, dim)


# violations of the calling convention


@wrong("adds to the previous values of out", "repeatable", **AVERAGE)
def stale_out(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for j in range(out.shape[0]):
            out[j] += 1.0 / out.shape[0]
        return OK

    return weights


@wrong("writes behind out", "writes_only_out", **AVERAGE)
def writes_behind(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        for j in range(n + 1):
            out[j] = 1.0 / n
        return OK

    return weights


@wrong("changes its arguments", "writes_only_out", **AVERAGE)
def changes_arguments(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = 0.0
        for j in range(out.shape[0]):
            volumes[j] *= kernel_values[j]
            total += volumes[j]
        if total <= 0.0:
            return TOO_FEW
        for j in range(out.shape[0]):
            out[j] = volumes[j] / total
        return OK

    return weights


@wrong("allocates", "no_allocation", **AVERAGE)
def allocates(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        scratch = np.zeros(out.shape[0])
        for j in range(out.shape[0]):
            scratch[j] = 1.0 + distances[j]
        total = scratch.sum()
        for j in range(out.shape[0]):
            out[j] = scratch[j] / total
        return OK

    return weights


@wrong("integers that overflow when compiled", "plain_python_agrees", **AVERAGE)
def overflows(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        total = 0.0
        for j in range(out.shape[0]):
            big = (j + 1) * 4611686018427387904
            out[j] = 1.0 if big > 0 else 2.0
            total += out[j]
        for j in range(out.shape[0]):
            out[j] /= total
        return OK

    return weights


@wrong("does not compile", "compiles", **AVERAGE)
def does_not_compile(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        out[:] = statistics.mean(distances)
        return OK

    return weights


@wrong("returns nothing", "compiles", **AVERAGE)
def returns_nothing(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for j in range(out.shape[0]):
            out[j] = 1.0 / out.shape[0]

    return weights


@wrong("never OK", "fewest_points", **AVERAGE)
def never_ok(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        return SINGULAR

    return weights


@wrong("reads the neighbour behind the last", "solver_agrees", **AVERAGE)
def reads_behind(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        total = 0.0
        for j in range(n):
            out[j] = volumes[j + 1]
            total += out[j]
        for j in range(n):
            out[j] /= total
        return OK

    return weights


@wrong("a count of points for one dimension only", "traits", fewest_points=3)
def malformed_trait(kernel, dim):
    return skewed(kernel, dim)


@wrong("contradicting traits", "traits", range_restricted=True)
def contradiction(kernel, dim):
    return skewed(kernel, dim)


# what depends on kernel, size and shape of the neighbourhood


def weighted(weight, *, fewest=1, refuse=None):
    """Weights proportional to ``weight(s, v, n)`` of the distance over R, the volume and the number of neighbours."""

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        total = 0.0
        for j in range(n):
            out[j] = weight(distances[j] / support, volumes[j], kernel_values[j], j)
            total += out[j]
        if not total > 0.0 or n < fewest:
            return TOO_FEW
        for j in range(n):
            out[j] /= total
        return OK

    return weights


@wrong("a Gaussian hard coded", "kernel", **AVERAGE)
def hard_coded(kernel, dim):
    return weighted(lambda s, v, w, j: v * (math.exp(-9.0 * s * s) - math.exp(-9.0)))


@wrong("h = R/3", "kernel", **AVERAGE)
def one_third(kernel, dim):
    value = kernel.value
    return weighted(lambda s, v, w, j: v * value(min(3.0 * s, 0.999 * kernel.support)))


@wrong(
    "the derivative of a Gaussian hard coded",
    "kernel",
    **LINEAR,
    kernel_gradient=True,
    evaluation_point=EvaluationPoint.EXTRAPOLATED,
)
def hard_coded_gradient(kernel, dim):
    gradient = create("kernels", "gaussian").gradient_function()
    return create("interpolators", "mdbc").point_weights(kernel._replace(gradient=gradient), dim)


@wrong("the derivative of the kernel, not declared", "kernel", **AVERAGE)
def undeclared_gradient(kernel, dim):
    slope, q = kernel.gradient, kernel.support
    return weighted(lambda s, v, w, j: v * w - 1e-3 * v * slope(q * s))


@wrong("V squared", "additivity", **AVERAGE)
def volumes_squared(kernel, dim):
    return weighted(lambda s, v, w, j: v * v * w)


@wrong("the farthest particle heaviest", "locality", **AVERAGE, kernel_independent=True)
def farthest(kernel, dim):
    return weighted(lambda s, v, w, j: v * (0.1 + s) * (1.0 - s))


@wrong("a weight that jumps by 30 % at R/2", "continuity", **AVERAGE)
def jumps(kernel, dim):
    return weighted(lambda s, v, w, j: v * w * (1.0 if s < 0.5 else 0.7))


@wrong("a weight that jumps by 30 % at R/2, in least squares", "continuity", **LINEAR)
def jumps_in_least_squares(kernel, dim):
    right = first_order(kernel, dim)

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        lowered = np.where(distances < 0.5 * support, kernel_values, 0.7 * kernel_values)
        return right(offsets, distances, lowered, volumes, support, lift, out)

    return weights


@wrong("a particle that enters with a weight", "continuity", **AVERAGE, kernel_independent=True)
def enters(kernel, dim):
    return weighted(lambda s, v, w, j: v / (s * s + 0.01))


@wrong("neighbours beyond the 60th ignored", "permutation_invariance", **AVERAGE)
def sixty(kernel, dim):
    return weighted(lambda s, v, w, j: v * w if j < 60 else 0.0)


@wrong("distances in single precision", "continuity", **AVERAGE, kernel_independent=True)
def rounded(kernel, dim):
    return weighted(lambda s, v, w, j: v * (1.0 - np.float32(s)) ** 3)


@wrong(
    "the fallback at a particle with few neighbours", "interpolates_particles", **{**SHEPARD, "fewest_points": (3, 4)}
)
def falls_back(kernel, dim):
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        n = out.shape[0]
        if n < dim + 1:
            return TOO_FEW
        total = 0.0
        here = 0
        for j in range(n):
            here += 1 if distances[j] == 0.0 else 0
        for j in range(n):
            out[j] = (1.0 if distances[j] == 0.0 else 0.0) if here else (1.0 - distances[j] / support) / distances[j]
            total += out[j]
        for j in range(n):
            out[j] /= total
        return OK

    return weights


@wrong("a lift of at most R", "linear_reproduction", **LINEAR, evaluation_point=EvaluationPoint.EXTRAPOLATED)
def limited_lift(kernel, dim):
    right = first_order(kernel, dim)

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        length = 0.0
        for a in range(dim):
            length += lift[a] ** 2
        limited = local_array(dim)
        for a in range(dim):
            limited[a] = lift[a] * min(1.0, support / max(math.sqrt(length), 1e-300))
        return right(offsets, distances, kernel_values, volumes, support, limited, out)

    return weights


@wrong("a refusal of 5 to 9 neighbours", "fewest_points", **LINEAR)
def refuses_some(kernel, dim):
    right = first_order(kernel, dim)

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        if 5 <= out.shape[0] <= 9:
            return SINGULAR
        return right(offsets, distances, kernel_values, volumes, support, lift, out)

    return weights


@wrong("a refusal of stretched neighbourhoods", "fewest_points", **LINEAR)
def refuses_stretched(kernel, dim):
    right = first_order(kernel, dim)

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        xx = yy = xy = 0.0
        for j in range(out.shape[0]):
            xx += offsets[j, 0] ** 2 * kernel_values[j]
            yy += offsets[j, 1] ** 2 * kernel_values[j]
            xy += offsets[j, 0] * offsets[j, 1] * kernel_values[j]
        half, apart = 0.5 * (xx + yy), math.sqrt(0.25 * (xx - yy) ** 2 + xy * xy)
        if half - apart < 0.6 * (half + apart):
            return SINGULAR
        return right(offsets, distances, kernel_values, volumes, support, lift, out)

    return weights


def check_called(case, name):
    return next(check for check in checks_of(case.method) if check.name == name)


def test_there_are_enough_wrong_methods():
    assert len(CASES) >= 25


PLAIN = (
    "rank",
    "rotation_invariance",
    "kernel",
    "additivity",
    "locality",
    "continuity",
    "interpolates_particles",
    "fewest_points",
)
"""checks that run here in plain Python, since the compilation of each wrong method would take longer"""


@pytest.mark.parametrize(
    "seeds", [pytest.param(range(2), id="two"), pytest.param(range(2, 10), id="ten", marks=pytest.mark.long)]
)
@pytest.mark.parametrize("mistake", CASES)
def test_is_caught_with_every_seed(mistake, seeds, monkeypatch):
    case = CASES[mistake]
    monkeypatch.setattr(numba.config, "DISABLE_JIT", case.caught_by in PLAIN)
    check = check_called(case, case.caught_by)
    for seed in seeds:
        monkeypatch.setattr(hypothesis.core, "global_force_seed", seed)
        with pytest.raises(BrokenPromiseError) as caught:
            check(case.method)
    message = str(caught.value)
    assert message.startswith("Wrong(")
    assert len(message) > 40


@pytest.mark.parametrize("dim", [2, 3])
def test_a_convex_linear_method_may_refuse_points_outside_the_hull(dim, monkeypatch):
    """Linear fields are reproduced by weights of at least zero in the hull of the particles alone."""

    def convex(kernel, dim):
        def weights(offsets, distances, kernel_values, volumes, support, lift, out):
            if len(out) < dim + 1:
                return TOO_FEW
            matrix = np.vstack([offsets.T / support, np.ones(len(out))])
            out[:], residual = nnls(matrix, np.append(np.zeros(dim), 1.0))
            return OK if residual < 1e-9 else SINGULAR

        return weights

    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    traits = Traits(reproduces_degree=1, fewest_points=(3, 4), non_negative=True, range_restricted=True)
    check_fewest_points(Wrong(convex, traits), dim)
    with pytest.raises(BrokenPromiseError, match=r"with [0-9]+ well-placed neighbours"):
        check_fewest_points(Wrong(convex, Traits(reproduces_degree=1, fewest_points=(3, 4))), dim)


def test_the_smallest_cloud_can_be_pasted_into_a_test():
    case = CASES["a sign"]
    with pytest.raises(BrokenPromiseError) as caught:
        check_called(case, "linear_reproduction")(case.method)
    code = str(caught.value).partition("as code:")[2]
    names = {"method": case.method}
    exec("\n".join(line.strip() for line in code.splitlines()), names)
    assert len(names["cloud"]) == 3
