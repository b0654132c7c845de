"""Testing: what an interpolation method can promise, one check function per property.

Each check takes the method and the dimension and raises :class:`BrokenPromiseError` with an explanation. Weights are
compared within round-off times the condition number of the neighbourhood (:func:`tolerance`); where the geometry does
not determine an answer, only gross errors count.
"""

import numpy as np
from numpy.typing import NDArray

from sphframe.boundary.operator import compiled_kernel, operator, weights_loop
from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint, Traits
from sphframe.interfaces.traits import DRY, OK, Status
from sphframe.registry import create
from sphframe.specialise import compile_part
from sphframe.testing.evaluation import Evaluate, Outcome, evaluator, extrapolates, plain_evaluator, title
from sphframe.testing.neighbourhoods import REGULAR, SPARSE, Cloud, build, condition, magnification
from sphframe.testing.proof import BrokenPromiseError, prove

Array = NDArray[np.float64]

EPSILON = float(np.finfo(np.float64).eps)
LARGEST_SUM = 1000.0
"""largest sum of |weights| that a method may answer with: beyond, noise of a thousandth swamps the field"""
WELL_PLACED = 2.0
"""sum of |weights| of a quadratic fit up to which a neighbourhood leaves no reason to refuse an answer"""
_COARSEST = 1e-4
_CLEAR = 1e-3  # of the cut-off: beyond, round-off in r is magnified by methods whose weights vanish there


def tolerance(cloud: Cloud, outcome: Outcome, degree: int) -> float:
    """Return the round-off to be expected in a sum of weights of a method of ``degree``, times a safety factor."""
    limit = 100.0 * EPSILON * (condition(cloud, degree) + len(cloud)) * outcome.magnitude
    return min(limit, _COARSEST * outcome.magnitude)


def _invariance_tolerance(cloud: Cloud, outcome: Outcome, degree: int) -> float:
    return min(1e3 * tolerance(cloud, outcome, degree), _COARSEST * outcome.magnitude)


def _degree(method: BoundaryInterpolator) -> int:
    """The degree of the polynomials behind the method, for its condition number; a method may not keep what it has."""
    degree = method.traits.reproduces_degree
    return degree if method.traits.non_negative else max(1, degree)


def check_traits(method: BoundaryInterpolator, dim: int) -> None:
    """The traits are well formed, and do not contradict each other."""
    traits = method.traits
    if not isinstance(traits, Traits):
        raise BrokenPromiseError(f"{title(method)}: traits must be a sphframe.Traits, got {traits!r}")
    fewest: object = traits.fewest_points
    if not (isinstance(fewest, tuple) and len(fewest) == 2 and all(isinstance(n, int) and n >= 1 for n in fewest)):
        raise BrokenPromiseError(
            f"{title(method)}: fewest_points must be two whole numbers, for 2-D and 3-D, got {fewest!r}"
        )
    if traits.reproduces_degree not in (0, 1, 2):
        raise BrokenPromiseError(
            f"{title(method)}: reproduces_degree must be 0, 1 or 2, got {traits.reproduces_degree!r}"
        )
    if not isinstance(traits.evaluation_point, EvaluationPoint):
        raise BrokenPromiseError(
            f"{title(method)}: evaluation_point must be a sphframe.EvaluationPoint, got {traits.evaluation_point!r}"
        )
    if traits.range_restricted and not (traits.partition_of_unity and traits.non_negative):
        raise BrokenPromiseError(
            f"{title(method)}: range_restricted needs partition_of_unity and non_negative; a value between the smallest"
            f" and the largest for every field is a weighted mean"
        )
    if traits.reproduces_degree > 0 and not traits.partition_of_unity:
        raise BrokenPromiseError(
            f"{title(method)}: a method exact on linear fields is exact on constants: partition_of_unity"
        )
    needed = (dim + 1) if traits.reproduces_degree == 1 else (dim + 1) * (dim + 2) // 2
    if traits.reproduces_degree > 0 and fewest[dim - 2] < needed:
        raise BrokenPromiseError(
            f"{title(method)}: fewest_points says {fewest[dim - 2]} in {dim}-D, but polynomials of degree"
            f" {traits.reproduces_degree} have {needed} coefficients"
        )


def check_compiles(method: BoundaryInterpolator, dim: int) -> None:
    """The weights function compiles, runs and returns a number."""
    cloud = build("full support", dim, seed=0)
    try:
        _evaluator(method, dim)(cloud)
    except BrokenPromiseError:
        raise
    except Exception as error:
        raise BrokenPromiseError(
            f"{title(method)} in {dim}-D: the compiled weights function raises {type(error).__name__}: {error}.\n"
            f"A weights function must not raise: answer SINGULAR or TOO_FEW"
        ) from error


def check_honest_status(method: BoundaryInterpolator, dim: int) -> None:
    """Every cloud gets finite weights and a status; DRY is for points without neighbours, which no method sees."""
    run = _evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        try:
            outcome = run(cloud)
        except Exception as error:
            return f"the compiled function raises {type(error).__name__}: {error}; it must answer with a status instead"
        if outcome.status not in tuple(Status):
            return f"the status is {outcome.status}, which is not one of sphframe.Status"
        if outcome.status == DRY:
            return f"the status is DRY with {len(cloud)} neighbours; DRY is for points without any"
        if not np.all(np.isfinite(outcome.weights)):
            return f"the weights are {_short(outcome.weights)} (status {Status(outcome.status).name})"
        return None

    prove(method, dim, "weights must be finite, and the status known, for every cloud", wrong_with)

    far_away = np.full((1, dim), 10.0)
    matrix, statuses = operator(method, np.zeros(dim), far_away, 1.0, smoothing_length=1.0)
    if statuses.tolist() != [DRY] or matrix.nnz:
        raise _broken(method, dim, f"a point without neighbours has the status {statuses[0]} and {matrix.nnz} weights")


def check_bounded_weights(method: BoundaryInterpolator, dim: int) -> None:
    """sum_j |Phi_j| stays below 1000: a method answers SINGULAR rather than magnify noise without limit."""
    run = _evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.magnitude > LARGEST_SUM:
            return f"sum |Phi_j| = {outcome.magnitude:.3g} (status {_name(outcome)})"
        return None

    prove(method, dim, f"sum |Phi_j| must not exceed {LARGEST_SUM:g}", wrong_with)


def check_partition_of_unity(method: BoundaryInterpolator, dim: int) -> None:
    """sum_j Phi_j = 1, whatever the status: a constant field comes back."""
    run, degree = _evaluator(method, dim), _degree(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        total = float(np.sum(outcome.weights))
        if not abs(total - 1.0) <= tolerance(cloud, outcome, degree):
            return f"the weights of {len(cloud)} neighbours sum to {total:.15g}, not to 1 (status {_name(outcome)})"
        return None

    prove(method, dim, "weights must sum to one (partition of unity)", wrong_with)


def check_non_negative(method: BoundaryInterpolator, dim: int) -> None:
    """Phi_j >= 0."""
    run = _evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if not np.all(outcome.weights >= 0.0):
            return f"the smallest weight is {np.min(outcome.weights):.3g} (status {_name(outcome)})"
        return None

    prove(method, dim, "weights must not be negative", wrong_with)


def check_range_restricted(method: BoundaryInterpolator, dim: int) -> None:
    """Min f <= sum_j Phi_j f_j <= max f, for the fields that are hardest on the method and for random ones."""
    run = _evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        phi = outcome.weights
        fields = [
            np.where(phi > 0.0, 1.0, -1.0),
            np.ones(len(phi)),
            *np.random.default_rng(0).normal(size=(2, len(phi))),
        ]
        for field in fields:
            value = float(phi @ field)
            slack = tolerance(cloud, outcome, 0) * np.max(np.abs(field))
            if not field.min() - slack <= value <= field.max() + slack:
                return f"a field between {field.min():.6g} and {field.max():.6g} gives {value:.15g}"
        return None

    prove(method, dim, "the value must lie between the smallest and the largest of the neighbours'", wrong_with)


def check_linear_reproduction(method: BoundaryInterpolator, dim: int) -> None:
    """Linear fields are reproduced where the status is OK, at the ghost if the method extrapolates to it."""
    _check_reproduction(method, dim, 1)


def check_quadratic_reproduction(method: BoundaryInterpolator, dim: int) -> None:
    """Quadratic fields are reproduced where the status is OK."""
    _check_reproduction(method, dim, 2)


def _check_reproduction(method: BoundaryInterpolator, dim: int, degree: int) -> None:
    run = _evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.status != OK:
            return None
        scale = cloud.support
        x, target = cloud.offsets / scale, cloud.lift / scale
        # the ghost may lie outside the cut-off, where the monomials are larger
        slack = tolerance(cloud, outcome, degree) * max(1.0, float(np.sum(target**2)))
        for exponents, name in _monomials(dim, degree):
            value = float(outcome.weights @ np.prod(x**exponents, axis=1))
            wanted = float(np.prod(target**exponents))
            if not abs(value - wanted) <= slack:
                return f"with lengths in R, the field {name} gives {value:.12g} instead of {wanted:.12g}"
        return None

    name = "linear" if degree == 1 else "quadratic"
    prove(method, dim, f"{name} fields must be reproduced where the status is OK", wrong_with)


def check_fewest_points(method: BoundaryInterpolator, dim: int) -> None:
    """With ``fewest_points`` neighbours in general position the status is OK, with one fewer it is not."""
    run = _evaluator(method, dim)
    fewest = method.traits.fewest_points[dim - 2]
    for seed in range(10):
        cloud = _general_position(dim, fewest, seed)
        outcome = run(cloud)
        if outcome.status != OK:
            raise _broken(
                method,
                dim,
                f"fewest_points promises OK for {fewest} neighbours in general position, but the status is"
                f" {_name(outcome)}",
                cloud,
            )
        if fewest > 1:
            cloud = cloud.members(np.arange(fewest - 1))
            outcome = run(cloud)
            if outcome.status == OK:
                raise _broken(
                    method,
                    dim,
                    f"fewest_points says {fewest}, but the status is OK with {fewest - 1} neighbours: promise fewer, or"
                    f" answer TOO_FEW",
                    cloud,
                )

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        if outcome.status == OK and len(cloud) < fewest:
            return f"the status is OK with {len(cloud)} neighbours, and fewest_points says {fewest}"
        return None

    prove(method, dim, "fewer neighbours than fewest_points must not be answered with OK", wrong_with)

    def refused(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        well_placed = condition(cloud, 2) < 1e5 and magnification(cloud, 2) < WELL_PLACED
        if outcome.status != OK and len(cloud) >= 3 * fewest and well_placed:
            return f"the status is {_name(outcome)} with {len(cloud)} well-placed neighbours"
        return None

    prove(method, dim, "a well-placed neighbourhood must be answered with OK", refused, REGULAR)


def _general_position(dim: int, count: int, seed: int) -> Cloud:
    """Vertices, then edge midpoints, of a regular simplex around the point: six of them (3-D: ten) fix a quadratic."""
    rng = np.random.default_rng(seed)
    vertices = np.linalg.qr(np.column_stack([np.ones(dim + 1), np.eye(dim + 1)[:, :dim]]))[0][:, 1:]
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    middles = [0.5 * (vertices[a] + vertices[b]) for a in range(dim + 1) for b in range(a)]
    points = np.array([*vertices, *middles])
    if count > len(points):
        points = np.concatenate([points, rng.uniform(-0.5, 0.5, (count - len(points), dim))])
    rotation = np.linalg.qr(rng.normal(size=(dim, dim)))[0]
    points = points[:count] @ rotation.T + rng.uniform(-0.1, 0.1, (count, dim))
    return Cloud(1.5 * points, rng.uniform(0.8, 1.2, count), 3.9)


def check_interpolates_particles(method: BoundaryInterpolator, dim: int) -> None:
    """At a particle the value is that particle's own; where several coincide, it is made of theirs alone."""
    run = _evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        here = cloud.distances == 0.0
        if not here.any():
            return None
        outcome = run(cloud.changed(lift=np.zeros(dim)))
        there = float(np.sum(outcome.weights[here]))
        if not abs(there - 1.0) <= tolerance(cloud, outcome, 0) or np.any(outcome.weights[~here] != 0.0):
            return f"the {int(here.sum())} particle(s) at the point get {there:.12g} of the weight"
        return None

    prove(method, dim, "at a particle, the value must be that particle's", wrong_with, ("at a particle", "coincident"))


def check_rotation_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Rotating the cloud, and the lift with it, changes no weight."""
    rotations = [np.linalg.qr(np.random.default_rng(seed).normal(size=(dim, dim)))[0] for seed in (1, 2)]
    for rotation in rotations:
        rotation[:, 0] *= np.linalg.det(rotation)
    _check_orthogonal(method, dim, "rotating", rotations)


def check_reflection_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Reflecting the cloud, and the lift with it, changes no weight."""
    _check_orthogonal(method, dim, "reflecting", [np.diag([-1.0] + [1.0] * (dim - 1))])


def _check_orthogonal(method: BoundaryInterpolator, dim: int, doing: str, maps: list[Array]) -> None:
    run, degree = _evaluator(method, dim), _degree(method)

    def wrong_with(cloud: Cloud) -> str | None:
        cloud = cloud.clear_of_cut_off(_CLEAR)
        outcome = run(cloud)
        for matrix in maps:
            moved = cloud.changed(np.ascontiguousarray(cloud.offsets @ matrix.T), lift=matrix @ cloud.lift)
            difference = _difference(method, cloud, outcome, run(moved), degree)
            if difference is not None:
                return f"{doing} the cloud by {matrix.round(3).tolist()} {difference}"
        return None

    prove(method, dim, f"{doing} the neighbourhood must not change the weights", wrong_with, SPARSE)


def check_permutation_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """The order of the particles does not matter."""
    run, degree = _evaluator(method, dim), _degree(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        for order in (np.arange(len(cloud))[::-1], np.random.default_rng(0).permutation(len(cloud))):
            answer = run(cloud.members(order))
            unpermuted = np.empty(len(cloud))
            unpermuted[order] = answer.weights
            difference = _difference(method, cloud, outcome, Outcome(unpermuted, answer.status), degree)
            if difference is not None:
                return f"taking the particles in the order {order.tolist()[:12]} {difference}"
        return None

    prove(method, dim, "the order of the particles must not matter", wrong_with, (*SPARSE, "coincident", "lattice"))


def check_scale_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Scaling all lengths by a power of two, from micrometres to kilometres, changes no bit that matters."""
    _check_scaling(method, dim, (2.0**-20, 2.0**10))


def check_unit_independence(method: BoundaryInterpolator, dim: int) -> None:
    """Metres, millimetres and feet give the same weights."""
    _check_scaling(method, dim, (1000.0, 1.0 / 0.3048))


def _check_scaling(method: BoundaryInterpolator, dim: int, factors: tuple[float, ...]) -> None:
    run, degree = _evaluator(method, dim), _degree(method)

    def wrong_with(cloud: Cloud) -> str | None:
        cloud = cloud.clear_of_cut_off(_CLEAR)
        outcome = run(cloud)
        for factor in factors:
            difference = _difference(method, cloud, outcome, run(cloud.scaled(factor)), degree)
            if difference is not None:
                return f"multiplying all lengths by {factor:.6g} {difference}"
        return None

    prove(method, dim, "weights must not depend on the unit of length", wrong_with, SPARSE)


def check_translation_invariance(method: BoundaryInterpolator, dim: int) -> None:
    """Moving point and particles together changes no weight, in :func:`sphframe.boundary.operator.operator`."""
    lift = np.linspace(0.5, 1.0, dim) if extrapolates(method) else None
    for family in REGULAR:
        for seed in range(3):
            cloud = build(family, dim, seed, ratio=1.3 if dim == 2 else 1.0)
            positions = np.round(cloud.offsets * 2.0**20) * 2.0**-20  # so that shifting is exact
            h = cloud.support / 3.0
            point = np.zeros(dim)
            shift = 1024.0 * np.arange(1.0, dim + 1)
            here, _ = operator(method, point, positions, cloud.volumes, smoothing_length=h, lift=lift)
            there, _ = operator(method, point + shift, positions + shift, cloud.volumes, smoothing_length=h, lift=lift)
            difference = float(np.max(np.abs(here.toarray() - there.toarray())))
            if not difference <= 1e-12 * Outcome(here.data, OK).magnitude:
                raise _broken(
                    method,
                    dim,
                    f"moving the point and the particles by {shift.tolist()} changes a weight by {difference:.3g};"
                    f" weights must depend on offsets alone",
                    cloud,
                )


def check_volume_independence(method: BoundaryInterpolator, dim: int) -> None:
    """The weights do not depend on the particles' volumes, where the status is OK."""
    run, degree = _evaluator(method, dim), _degree(method)

    def wrong_with(cloud: Cloud) -> str | None:
        outcome = run(cloud)
        volumes = cloud.volumes.mean() * 10.0 ** np.random.default_rng(0).uniform(-1.0, 1.0, len(cloud))
        answer = run(cloud.changed(volumes=volumes))
        if OK not in (outcome.status, answer.status):
            return None  # the fallback may use them
        difference = _difference(method, cloud, outcome, answer, degree)
        return None if difference is None else f"other volumes {difference}"

    prove(method, dim, "weights must not depend on the volumes", wrong_with, SPARSE)


def check_continuity(method: BoundaryInterpolator, dim: int) -> None:
    """A tiny move of the evaluation point changes the weights but little, also where the nearest particle changes."""
    run, degree = _evaluator(method, dim), _degree(method)

    def wrong_with(cloud: Cloud) -> str | None:
        if len(cloud) < 2:
            return None
        step = 1e-9 * cloud.support
        first, second = cloud.offsets[np.argsort(cloud.distances, kind="stable")[:2]]
        apart = second - first
        if np.linalg.norm(apart) < 1e-2 * cloud.support:
            return None
        along = apart / np.linalg.norm(apart)
        for centre in (np.zeros(dim), 0.5 * (first + second)):
            near = cloud.changed(cloud.offsets - centre)
            near = near.members(near.distances < 0.999 * cloud.support)
            if len(near) < 2:
                continue
            before = run(near.changed(near.offsets + step * along))
            after = run(near.changed(near.offsets - step * along))
            if (before.status, after.status) != (OK, OK):
                continue
            jump = float(np.max(np.abs(before.weights - after.weights)))
            allowed = min(1e-6 * condition(near, degree), 1e-3) * max(before.magnitude, after.magnitude)
            if not jump <= allowed:
                return (
                    f"about {centre.tolist()}, moving the evaluation point by {2.0 * step:.3g} along {along.tolist()}"
                    f" changes a weight by {jump:.3g}"
                )
        return None

    prove(method, dim, "weights must be continuous in the evaluation point", wrong_with, REGULAR)


def check_repeatable(method: BoundaryInterpolator, dim: int) -> None:
    """The same cloud gets the same weights, whatever ``out`` held before and whatever was computed in between.

    To round-off: compiled loops check at run time whether their arrays lie far enough apart in memory to be vectorised,
    and fused multiply-adds round otherwise in the two forms of a loop.
    """
    run, again, degree = _evaluator(method, dim), _evaluator(method, dim, garbage=1e30), _degree(method)
    other = build("full support", dim, seed=99)

    def wrong_with(cloud: Cloud) -> str | None:
        first = run(cloud)
        run(other)
        second = again(cloud)
        difference = np.max(np.abs(first.weights - second.weights))
        if first.status != second.status or not difference <= _invariance_tolerance(cloud, first, degree):
            return (
                f"out full of NaN gives {_short(first.weights)}, out full of 1e30 gives {_short(second.weights)}: set"
                f" every entry of out before it is read, and keep no state"
            )
        return None

    prove(method, dim, "the same neighbourhood must get the same weights", wrong_with)


def check_plain_python_agrees(method: BoundaryInterpolator, dim: int) -> None:
    """The compiled function and the plain Python one give the same weights and status."""
    run, degree = _evaluator(method, dim), _degree(method)
    plain = plain_evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        cloud = cloud.clear_of_cut_off(_CLEAR)
        outcome = run(cloud)
        try:
            answer = plain(cloud)
        except Exception as error:
            return f"in plain Python it raises {type(error).__name__}: {error}"
        if answer.status != OK and answer.status == outcome.status:
            return None
        difference = _difference(method, cloud, outcome, answer, degree)
        return None if difference is None else f"running it in plain Python {difference}"

    for family in SPARSE:
        for seed in range(4):
            cloud = build(family, dim, seed, ratio=1.0, lifted=extrapolates(method))
            complaint = wrong_with(cloud)
            if complaint is not None:
                raise _broken(method, dim, f"compiled and plain Python must agree. {complaint}", cloud)


def check_solver_agrees(method: BoundaryInterpolator, dim: int) -> None:
    """The solver fills ghosts with the values of :func:`sphframe.boundary.operator.operator`."""
    from sphframe.testing.solver import check_solver_agrees as check  # most of sphframe is imported by it

    check(method, dim)


def check_writes_only_out(method: BoundaryInterpolator, dim: int) -> None:
    """The compiled function changes nothing but ``out``."""
    kernel = create("kernels", "gaussian")
    value = kernel.value_function()
    loop = weights_loop(method, kernel, dim)
    for seed, family in enumerate(("full support", "thin sheet", "spray", "at a particle", "collinear") * 2):
        cloud = build(family, dim, seed, ratio=1.0, lifted=extrapolates(method))
        n = len(cloud)
        inside = slice(16, 16 + n)
        members = np.zeros(n + 32, dtype=np.int64)
        members[inside] = np.arange(n)
        offsets = np.full((n + 32, dim), 7.25)
        distances, values, volumes, out = (np.full(n + 32, 7.25) for _ in range(4))
        lifts = cloud.lift[None, :].copy()
        loop(
            cloud.offsets, cloud.volumes, np.zeros((1, dim)), lifts, np.array([16, 16 + n]), members, cloud.support,
            1.0, offsets, distances, values, volumes, out, np.empty(1, dtype=np.int64),
        )  # fmt: skip
        expected = [value(float(r) * kernel.support / cloud.support) for r in cloud.distances]
        changed = [
            name
            for name, array, given in (
                ("offsets", offsets, cloud.offsets),
                ("distances", distances, cloud.distances),
                ("kernel_values", values, np.array(expected)),
                ("volumes", volumes, cloud.volumes),
            )
            if not np.allclose(array[inside], given, rtol=1e-9, atol=1e-12)
        ]
        if not np.array_equal(lifts[0], cloud.lift):
            changed.append("lift")
        if any(np.any(array[:16] != 7.25) or np.any(array[-16:] != 7.25) for array in (offsets, values, volumes, out)):
            changed.append("memory before or behind its arrays")
        if changed:
            raise _broken(
                method,
                dim,
                f"a weights function must write to out[0] .. out[n - 1] alone, but it changed {', '.join(changed)}",
                cloud,
            )


def check_no_allocation(method: BoundaryInterpolator, dim: int) -> None:
    """The compiled function allocates nothing on the heap."""
    kernel = create("kernels", "gaussian")
    weights = compile_part(method.point_weights(compiled_kernel(kernel, dim), dim))
    if not hasattr(weights, "inspect_llvm"):
        return  # compilation is switched off
    x, a = np.zeros((1, dim)), np.ones(1)
    weights(x, a, a, a, 2.0, np.zeros(dim), np.zeros(1))
    if any("NRT_MemInfo_alloc" in code for code in weights.inspect_llvm().values()):
        raise _broken(
            method,
            dim,
            "the compiled weights function allocates memory, for every point of every step: use scalars, out, or"
            " sphframe.local_array(size) instead of numpy arrays",
        )


def _evaluator(method: BoundaryInterpolator, dim: int, garbage: float = np.nan) -> Evaluate:
    try:
        return evaluator(method, dim, garbage=garbage)
    except Exception as error:
        raise BrokenPromiseError(
            f"{title(method)} in {dim}-D: the weights function cannot be made: {type(error).__name__}: {error}"
        ) from error


def _broken(method: BoundaryInterpolator, dim: int, complaint: str, cloud: Cloud | None = None) -> BrokenPromiseError:
    code = "" if cloud is None else f", for\n\n    cloud = {cloud!r}\n"
    return BrokenPromiseError(f"{title(method)} in {dim}-D: {complaint}{code}")


def _difference(method: BoundaryInterpolator, cloud: Cloud, before: Outcome, after: Outcome, degree: int) -> str | None:
    """Say how two answers that should be equal differ."""
    if not method.traits.continuous:
        r = np.sort(cloud.distances)
        if len(r) > 1 and r[1] - r[0] <= 1e-6 * cloud.support:
            return None  # two particles are nearest: the method may choose either
    if before.status != after.status:
        if condition(cloud, max(1, degree)) > 1e6:
            return None  # on the brink
        return f"changes the status from {_name(before)} to {_name(after)}"
    if len(before.weights) != len(after.weights):
        return None
    difference = float(np.max(np.abs(before.weights - after.weights)))
    if not difference <= _invariance_tolerance(cloud, before, degree):
        return f"changes a weight by {difference:.3g}"
    return None


def _monomials(dim: int, degree: int) -> list[tuple[NDArray[np.int64], str]]:
    found = []
    for a in range(dim):
        exponents = np.zeros(dim, dtype=np.int64)
        exponents[a] += 1
        found.append((exponents, "xyz"[a]))
        for b in range(a + 1 if degree == 2 else 0):
            product = exponents.copy()
            product[b] += 1
            found.append((product, f"{'xyz'[a]} {'xyz'[b]}"))
    return found


def _name(outcome: Outcome) -> str:
    return Status(outcome.status).name if outcome.status in tuple(Status) else str(outcome.status)


def _short(weights: Array) -> str:
    return f"{weights[:6].tolist()}{' ...' if len(weights) > 6 else ''}"
