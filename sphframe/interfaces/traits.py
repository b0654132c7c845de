"""Interfaces: what an interpolation method guarantees, and the status that it returns.

A method declares its properties as :class:`Traits`, and the verification suite tests each of them. For each evaluation
point a method returns a :class:`Status`, since it must not raise inside a compiled loop; a run counts the statuses.
"""

import enum
from dataclasses import dataclass

from sphframe.interfaces.order import NOTHING, Orders


class Status(enum.IntEnum):
    """Result of the interpolation to one evaluation point; compiled functions use integers of the same names."""

    OK = 0
    DRY = 1
    TOO_FEW = 2
    SINGULAR = 3

    @property
    def advice(self) -> str:
        """What the status means and what to do about it."""
        return _ADVICE[self]


_ADVICE = {
    Status.OK: "the method's own weights were used",
    Status.DRY: "no fluid within the support: pressure 0 (free surface); expected away from the fluid",
    Status.TOO_FEW: "fewer neighbours than the method needs: its fallback was used; expected in spray and thin sheets",
    Status.SINGULAR: (
        "the positions of the neighbours make the method's equations ill-conditioned (for example, all on one line):"
        " its fallback was used; expected in thin sheets, elsewhere refine the particle spacing or choose a lower order"
    ),
}

OK, DRY, TOO_FEW, SINGULAR = map(int, (Status.OK, Status.DRY, Status.TOO_FEW, Status.SINGULAR))


class EvaluationPoint(enum.StrEnum):
    """Where a method evaluates the field of a ghost particle."""

    MIRROR = "mirror"
    """at the mirror point inside the fluid; the framework adds the hydrostatic lift from there to the ghost"""
    GHOST = "ghost"
    """at the ghost particle itself (Adami et al. 2012)"""
    EXTRAPOLATED = "extrapolated"
    """at the mirror point, extrapolated along ``lift`` to the ghost by the weights themselves (mDBC)"""
    DIRECTED = "directed"
    """at the ghost particle itself; ``lift`` is the wall's unit normal there, out of the fluid (Hashemi et al. 2012)"""

    @property
    def at_ghost(self) -> bool:
        """Whether it is the ghost particle itself, not its mirror point."""
        return self in (EvaluationPoint.GHOST, EvaluationPoint.DIRECTED)

    @property
    def takes_lift(self) -> bool:
        """Whether the weights depend on ``lift``."""
        return self in (EvaluationPoint.EXTRAPOLATED, EvaluationPoint.DIRECTED)


@dataclass(frozen=True, kw_only=True)
class Traits:
    """Properties that an interpolation method, value(r) = sum_j Phi_j f_j, guarantees; each is tested.

    Attributes
    ----------
    partition_of_unity
        sum_j Phi_j = 1 wherever the status is not DRY.
    non_negative
        Phi_j >= 0.
    range_restricted
        min f <= value <= max f.
    reproduces_degree
        the highest polynomial degree reproduced exactly when the status is OK.
    fewest_points
        neighbours needed for status OK in 2-D and in 3-D (in general position).
    interpolates_particles
        at the position of a particle the value is that of the particle.
    rotation_invariant
        rotating the cloud leaves the weights unchanged.
    volume_independent
        the weights do not depend on the particles' volumes.
    kernel_independent
        the weights depend on the cut-off radius, but not on the kernel.
    kernel_gradient
        the weights depend on the derivative of the kernel.
    continuous
        the weights are continuous in the evaluation point.
    jumps_at_cut_off
        but for particles that enter or leave the support, whose weight begins with a jump.
    dimensions
        numbers of dimensions in which it works.
    evaluation_point
        where the field of a ghost particle is evaluated.
    order
        orders of convergence near walls, of fixed ghosts to which the method interpolates.
    """

    partition_of_unity: bool = True
    non_negative: bool = False
    range_restricted: bool = False
    reproduces_degree: int = 0
    fewest_points: tuple[int, int] = (1, 1)
    interpolates_particles: bool = False
    rotation_invariant: bool = True
    volume_independent: bool = False
    kernel_independent: bool = False
    kernel_gradient: bool = False
    continuous: bool = True
    jumps_at_cut_off: bool = False
    dimensions: tuple[int, ...] = (2, 3)
    evaluation_point: EvaluationPoint = EvaluationPoint.MIRROR
    order: Orders = NOTHING
