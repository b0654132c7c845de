"""Claims of the paper on costs."""

from collections.abc import Mapping

from sphframe.studies import Claim
from sphframe_huang2019.cost.medians import Medians
from sphframe_huang2019.cost.published import GROWTH, SPEED_UPS
from sphframe_huang2019.variants import PAPER

__all__ = ["claims"]

LABELS = {v.method: v.label for v in PAPER}


def claims(
    figures: Mapping[str, Mapping[str, Medians]], growth: Mapping[str, float], disturbed: str | None
) -> list[Claim]:
    """Judge the claims; ``disturbed``, if not None, is the reason why none of them can be checked."""
    judged = [
        *(_on_growth(method, power, growth[LABELS[method]]) for method, power in GROWTH.items()),
        *(
            _on_a_step(figure, method, factor, figures[figure][LABELS[method]])
            for figure, factors in SPEED_UPS.items()
            for method, factor in factors.items()
        ),
        _conclusion({method: figures["Fig. 9"][label] for method, label in LABELS.items()}),
    ]
    if disturbed is None:
        return judged
    return [Claim.open(c.where, c.statement, c.published, disturbed, c.measured) for c in judged]


def _on_growth(method: str, power: int, measured: float) -> Claim:
    grows = "linearly with" if power == 1 else "with the square of"
    reason = "Exponent of the time of the interpolation alone; judged by 0.35."
    if power == 2:
        reason += " One pass over the neighbours adds up a matrix of fixed size."
    return Claim.judged(
        "Table 1",
        f"The work of {method} grows {grows} the number of neighbours.",
        f"power {power}",
        f"power {measured:.2f}",
        abs(measured - power) < 0.35,
        reason,
    )


def _on_a_step(figure: str, method: str, factor: float, found: Medians) -> Claim:
    reason = "Judged by 20 % of the whole step's ratio."
    if method == "normalized":
        reason += (
            " A normalised average takes fewer operations per neighbour than improved Shepard's exponential and powers,"
            " so that it cannot be slower."
        )
    else:
        reason += " Compiled, the interpolation is cheap with each method, and only a part of a step."
    return Claim.judged(
        figure,
        f"A step is {factor:g} times faster with improved Shepard than with {method}.",
        f"{factor:g}",
        f"{found.step_ratio:.2f}, interpolation alone {found.fill_ratio:.2f}",
        abs(found.step_ratio / factor - 1.0) < 0.2,
        reason,
    )


def _conclusion(found: Mapping[str, Medians]) -> Claim:
    shepard, quadratic = found["improved-shepard"], found["mls-quadratic"]
    return Claim.judged(
        "Conclusions",
        "Improved Shepard is much cheaper than MLS and SFDI.",
        "seen in the figures",
        "interpolation alone over improved Shepard: "
        + ", ".join(f"{method} {one.fill_ratio:.2f}" for method, one in found.items()),
        min(found[method].fill_ratio for method in ("sfdi", "mls-linear", "mls-quadratic")) > 1.2,
        f"Judged by 20 % of the interpolation alone; of a whole step, {1e3 * shepard.step:.2f} ms, MLS quadratic adds"
        f" {100.0 * (quadratic.step_ratio - 1.0):.0f} %.",
    )
