"""Testing: the rank of a neighbourhood, which a method must recognise before it divides by what round-off left."""

import numpy as np

from sphframe.interfaces import BoundaryInterpolator
from sphframe.interfaces.traits import OK
from sphframe.testing.evaluation import Outcome, extrapolates
from sphframe.testing.interpolators.comparison import broken, evaluator_of, status_name
from sphframe.testing.neighbourhoods import FLAT, Cloud, flattened

THICKNESSES = (*(10.0**-k for k in range(2, 16)), 0.0)
"""of the neighbourhoods, over their length"""
_FLAT_TO_ROUND_OFF = 1e-13


def check_rank(method: BoundaryInterpolator, dim: int) -> None:
    """A neighbourhood that gets ever flatter is refused from some thickness on, and its weights come to a limit.

    The neighbours approach a line, a plane or a conic (quadric) by factors of ten, down to thickness 0. Whether the
    method refuses at a thickness, TOO_FEW or SINGULAR, or lowers its degree by itself, is free. But after a refusal no
    flatter neighbourhood may be OK, since only round-off can make it so; the refusal must not move by more than a
    factor of ten in thickness when the neighbourhood is rotated and its particles are renumbered; and the weights at
    thickness 0 must be those of :math:`10^{-13}`, whichever function computed them.
    """
    run = evaluator_of(method, dim)
    shapes = FLAT if method.traits.reproduces_degree == 2 else FLAT[:2]  # a circle determines a linear function
    for shape in shapes if dim == 2 else (*shapes, "line"):
        for seed in range(3):
            refusals = []
            for turn in range(3 if method.traits.rotation_invariant else 1):
                clouds = [
                    flattened(shape, dim, seed, thickness, turn=turn, lifted=extrapolates(method))
                    for thickness in THICKNESSES
                ]
                outcomes = [run(cloud) for cloud in clouds]
                first = next((k for k, outcome in enumerate(outcomes) if outcome.status != OK), len(outcomes))
                refusals.append(first)
                complaint, where = _first_complaint(outcomes, first)
                if complaint:
                    raise _failure(method, dim, shape, complaint, clouds[where])
            if max(refusals) - min(refusals) > 1:
                found = " or ".join(sorted({_thickness(first) for first in refusals}))
                complaint = f"the first thickness that is refused is {found}, as the neighbourhood is rotated"
                raise _failure(method, dim, shape, complaint, clouds[min(refusals)])


def _first_complaint(outcomes: list[Outcome], first: int) -> tuple[str | None, int]:
    """Return what is wrong with the ``outcomes`` by thickness, of which the ``first`` is refused, and where."""
    for k in range(first + 1, len(outcomes)):
        if outcomes[k].status == OK:
            refused = f"the thickness {THICKNESSES[first]:g} is refused with {status_name(outcomes[first])}"
            return f"{refused}, and {THICKNESSES[k]:g} is OK", k
    nearly = outcomes[THICKNESSES.index(_FLAT_TO_ROUND_OFF)]
    change = float(np.max(np.abs(nearly.weights - outcomes[-1].weights)))
    if not change <= 1e-6 * outcomes[-1].magnitude:
        return f"a weight changes by {change:.3g} from the thickness {_FLAT_TO_ROUND_OFF:g} to 0", len(outcomes) - 1
    return None, 0


def _thickness(first: int) -> str:
    return "none" if first == len(THICKNESSES) else f"{THICKNESSES[first]:g}"


def _failure(method: BoundaryInterpolator, dim: int, shape: str, complaint: str, cloud: Cloud) -> Exception:
    promise = f"the rank of neighbours that approach a {shape} must decide, not round-off"
    advice = "compare each pivot with the diagonal entry that it is left of, and refuse below a share such as 1e-8"
    return broken(method, dim, f"{promise}: {complaint}; {advice}", cloud)
