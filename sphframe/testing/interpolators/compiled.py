"""Testing: the compiled weights function of an interpolation method: results, memory, agreement with plain Python."""

import numpy as np

from sphframe.boundary.operator import MARGIN
from sphframe.boundary.trial import try_weights
from sphframe.compiled import compile_part
from sphframe.compiled.explain import explained
from sphframe.errors import BrokenPluginError
from sphframe.interfaces import BoundaryInterpolator
from sphframe.interfaces.traits import OK
from sphframe.kernels import compiled_kernel
from sphframe.registry import create
from sphframe.testing.evaluation import extrapolates, plain_evaluator, point_loop, title
from sphframe.testing.interpolators.comparison import (
    CLEAR,
    broken,
    degree_of,
    difference_between,
    evaluator_of,
    invariance_tolerance,
    shortened,
)
from sphframe.testing.neighbourhoods import SPARSE, Cloud, build
from sphframe.testing.proof import BrokenPromiseError, prove


def check_compiles(method: BoundaryInterpolator, dim: int) -> None:
    """The weights function is one of seven arguments, compiles, stays within its arrays and returns a number.

    It is tried in plain Python first, with as many neighbours as there are for h = 3 dx in 2-D (1.4 dx in 3-D).
    """
    cloud = build("full support", dim, seed=0)
    raised = None
    try:
        raised = try_weights(method, compiled_kernel(create("kernels", "gaussian"), dim), dim, 2.7 if dim == 2 else 1.3)
        evaluator_of(method, dim)(cloud)
    except BrokenPromiseError:
        raise
    except BrokenPluginError as error:
        raise BrokenPromiseError(f"{title(method)} in {dim}-D: {error}") from error
    except Exception as error:
        if raised:
            raise BrokenPromiseError(f"{title(method)} in {dim}-D: {raised}") from error
        failed = explained(error) or (
            f"the compiled weights function raises {type(error).__name__}: {error}.\n"
            "A weights function must not raise: return SINGULAR or TOO_FEW"
        )
        raise BrokenPromiseError(f"{title(method)} in {dim}-D: {failed}") from error


def check_repeatable(method: BoundaryInterpolator, dim: int) -> None:
    """The same cloud gets the same weights, whatever ``out`` held before and whatever was computed in between.

    The weights may differ by round-off: compiled loops check at run time whether their arrays lie far enough apart in
    memory to be vectorised, and fused multiply-adds round differently in the vectorised and the scalar loop.
    """
    run, again, degree = evaluator_of(method, dim), evaluator_of(method, dim, garbage=1e30), degree_of(method)
    other = build("full support", dim, seed=99)

    def wrong_with(cloud: Cloud) -> str | None:
        first = run(cloud)
        run(other)
        second = again(cloud)
        difference = np.max(np.abs(first.weights - second.weights))
        if first.status != second.status or not difference <= invariance_tolerance(cloud, first, degree):
            return (
                f"out full of NaN gives {shortened(first.weights)}, out full of 1e30 gives"
                f" {shortened(second.weights)}: set every entry of out before it is read, and keep no state"
            )
        return None

    prove(method, dim, "the same neighbourhood must get the same weights", wrong_with)


def check_plain_python_agrees(method: BoundaryInterpolator, dim: int) -> None:
    """The compiled function and the plain Python one give the same weights and status."""
    run, degree = evaluator_of(method, dim), degree_of(method)
    plain = plain_evaluator(method, dim)

    def wrong_with(cloud: Cloud) -> str | None:
        cloud = cloud.clear_of_cut_off(CLEAR)
        outcome = run(cloud)
        try:
            answer = plain(cloud)
        except Exception as error:
            return f"in plain Python it raises {type(error).__name__}: {error}"
        if answer.status != OK and answer.status == outcome.status:
            return None
        difference = difference_between(method, cloud, outcome, answer, degree)
        return None if difference is None else f"running it in plain Python {difference}"

    for family in SPARSE:
        for seed in range(4):
            cloud = build(family, dim, seed, ratio=1.0, lifted=extrapolates(method))
            complaint = wrong_with(cloud)
            if complaint is not None:
                raise broken(method, dim, f"compiled and plain Python must agree. {complaint}", cloud)


def check_writes_only_out(method: BoundaryInterpolator, dim: int) -> None:
    """The compiled function changes nothing but ``out``."""
    kernel = create("kernels", "gaussian")
    value = kernel.value_function()
    loop = point_loop(method, dim, kernel)
    for seed, family in enumerate(("full support", "thin sheet", "spray", "at a particle", "collinear") * 2):
        cloud = build(family, dim, seed, ratio=1.0, lifted=extrapolates(method))
        given = cloud.lift.copy()
        _, work = loop(cloud, np.nan)
        scale = kernel.normalisation(dim) / (cloud.support / kernel.support) ** dim
        expected = [scale * value(float(r) * kernel.support / cloud.support) for r in cloud.distances]
        inside = slice(MARGIN, -MARGIN)
        changed = [
            name
            for name, array, wanted in (
                ("offsets", work.offsets, cloud.offsets),
                ("distances", work.distances, cloud.distances),
                ("kernel_values", work.kernel_values, np.array(expected)),
                ("volumes", work.volumes, cloud.volumes),
            )
            if not np.allclose(array[inside], wanted, rtol=1e-9, atol=1e-12)
        ]
        if not np.array_equal(given, cloud.lift):
            changed.append("lift")
        changed += [f"memory before or after {name}" for name in work.touched()]
        if changed:
            raise broken(
                method,
                dim,
                f"a weights function must write only to out[0] .. out[n - 1], but it changed {', '.join(changed)}",
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
        raise broken(
            method,
            dim,
            "the compiled weights function allocates memory for every point in every step: use scalars, out, or"
            " sphframe.local_array(size) instead of numpy arrays",
        )
