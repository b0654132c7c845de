"""Testing: search for a cloud on which a method lacks a property, and its reduction to a small one.

A property is a function that takes a cloud and returns what is wrong with the method on it, or None. It is evaluated
on the fixed catalogue and then on clouds that hypothesis draws. From a cloud on which it fails, particles are removed
and numbers are rounded for as long as it still fails.
"""

from collections.abc import Callable

import numpy as np
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Flaky

from sphframe.interfaces import BoundaryInterpolator
from sphframe.testing.evaluation import KERNEL, KERNELS, extrapolates, title
from sphframe.testing.neighbourhoods import ALL, Cloud, catalogue
from sphframe.testing.strategies import clouds

Property = Callable[[Cloud], str | None]


class BrokenPromiseError(AssertionError):
    """A component violates its declared traits; the message says which one, how, and on which cloud."""


def require(condition: bool, message: str) -> None:
    """Raise a BrokenPromiseError with the ``message`` unless the ``condition`` holds."""
    if not condition:
        raise BrokenPromiseError(message)


class _FoundError(Exception):
    pass


def prove(
    method: BoundaryInterpolator,
    dim: int,
    promise: str,
    wrong_with: Property,
    families: tuple[str, ...] = ALL,
    *,
    drawn: bool = True,
) -> None:
    """Search for a cloud of ``families`` for which ``wrong_with`` returns a complaint.

    Without ``drawn``, only the catalogue is searched.

    Raises
    ------
    BrokenPromiseError
        when there is one, with the complaint about the smallest such cloud, and the cloud as code.
    """
    lifted = extrapolates(method)
    for cloud in catalogue(dim, families, lifted=lifted):
        if wrong_with(cloud) is not None:
            raise _failure(method, dim, promise, wrong_with, cloud) from None

    if KERNEL.get() != KERNELS[0] or not drawn:
        return  # the search is made with the first kernel only

    # the catalogue finds most errors: a quarter of the examples of the profile in force suffices
    default = settings.default.max_examples if settings.default else 100

    # no shrinking: a smaller seed does not give a smaller cloud; smallest() reduces it
    @settings(
        max_examples=max(10, default // 4),
        deadline=None,
        phases=(Phase.explicit, Phase.generate),
        database=None,
        report_multiple_bugs=False,
        suppress_health_check=list(HealthCheck),
    )
    @given(clouds(dim, families, lifted=lifted))
    def search(cloud: Cloud) -> None:
        if wrong_with(cloud) is not None:
            found.append(cloud)
            raise _FoundError

    found: list[Cloud] = []
    try:
        search()
    except (_FoundError, Flaky):  # flaky: wrong once, and not in the second evaluation
        raise _failure(method, dim, promise, wrong_with, found[0]) from None


def smallest(cloud: Cloud, wrong_with: Property) -> Cloud:
    """Return the cloud with fewer particles and rounder numbers for which ``wrong_with`` still complains."""

    def attempt(candidate: Cloud) -> bool:
        nonlocal cloud
        valid = len(candidate) > 0 and bool(np.all(candidate.distances < candidate.support))
        if valid and wrong_with(candidate) is not None:
            cloud = candidate
            return True
        return False

    size = max(1, len(cloud) // 2)
    while size >= 1:  # remove a half, a quarter, ..., one particle, for as long as particles can be removed
        removed = False
        first = 0
        while first < len(cloud) and len(cloud) > 1:
            index = np.arange(len(cloud))
            if attempt(cloud.members(index[(index < first) | (index >= first + size)])):
                removed = True
            else:
                first += size
        if not removed:
            size //= 2
    attempt(cloud.scaled(3.0 / cloud.support))
    attempt(cloud.changed(volumes=np.ones(len(cloud))))
    attempt(cloud.changed(lift=np.zeros(cloud.dim)))
    for digits in (0, 1, 2, 3, 6):
        if attempt(cloud.changed(np.round(cloud.offsets, digits) + 0.0)):
            break
    for digits in (1, 2, 3):
        if attempt(cloud.changed(lift=np.round(cloud.lift, digits) + 0.0)):
            break
    return cloud


def _failure(
    method: BoundaryInterpolator, dim: int, promise: str, wrong_with: Property, cloud: Cloud
) -> BrokenPromiseError:
    cloud = smallest(cloud, wrong_with)
    complaint = wrong_with(cloud) or "It failed once, and not in a second evaluation: the method keeps a state"
    return BrokenPromiseError(
        f"{title(method)} in {dim}-D: {promise}. {complaint}.\n"
        f"The smallest cloud found, as code:\n\n"
        f"    from sphframe.testing import Cloud, evaluate\n\n"
        f"    cloud = {cloud!r}\n"
        f"    print(evaluate(method, cloud))\n"
    )
