"""Walls that repel fluid particles by the force of Monaghan & Kajtar (2009), for sphframe."""

import math
from dataclasses import dataclass
from typing import Any

from sphframe import Separation, WallContext, WallGeometry, WallParts, WallSide, WallTraits, WallTreatment

__all__ = ["MonaghanKajtar"]

_NEAREST = 0.01
"""distance below which the force does not grow, in distances of wall particles"""


@dataclass(frozen=True)
class MonaghanKajtar(WallTreatment):
    """The particles of one row on the wall, closer together than the fluid's, repel fluid particles.

    With r the distance from the wall particle G to the fluid particle i, q = r/h, dx/beta the distance between wall
    particles and d the number of dimensions::

        a_i = K/beta^(d-1) Psi(q) (x_i - x_G)/r^2,    Psi(q) = 1.77/32 (1 + 5q/2 + 2 q^2) (2 - q)^5,  q < 2

    K = g H; without gravity or depth c0^2/400, which is g H for sphframe's default speed of sound. The sum over the row
    is nearly the same everywhere along a straight wall: at dx/2 before it, it varies by 18, 0.8 and 0.03 % around
    its mean for beta = 1, 2 and 3. With ``shifted = true`` r^2 is r max(r - dx/beta, dx/(100 beta)), singular one
    distance of wall particles before the wall. Nothing else acts between wall and fluid: free slip, no part in the
    continuity.

    Departs from the paper: the masses of wall and fluid particles are equal, so that 2 m_G/(m_i + m_G) = 1; the force
    does not grow any more where r < dx/(100 beta).

    Known failures: as every force that does not depend on the pressure, it holds still water at a distance that depends
    on the depth, and the sums of the first layers lack the half of their support behind the wall.

    Source: J. J. Monaghan, J. B. Kajtar (2009), doi:10.1016/j.cpc.2009.05.008; ``shifted`` as in A. Valizadeh, J. J.
    Monaghan (2015), doi:10.1016/j.jcp.2015.07.033.

    Attributes
    ----------
    strength
        K, m^2/s^2; by default g H.
    beta
        particle spacing over the distance of the wall particles.
    shifted
        whether the force is singular one distance of wall particles before the wall.
    """

    strength: float | None = None
    """K, m^2/s^2; by default g H"""
    beta: int = 3
    """particle spacing over the distance between wall particles"""
    shifted: bool = False
    """whether the force is singular at the distance of wall particles"""

    traits = WallTraits()
    geometry = WallGeometry.ROW

    def __post_init__(self) -> None:
        if self.strength is not None and not self.strength > 0.0:
            raise ValueError(f"strength must be a positive number (m^2/s^2) or be left out, got {self.strength!r}")
        if not self.beta >= 1:
            raise ValueError(f"beta must be at least 1, 3 in the paper, got {self.beta!r}")

    @property
    def row_spacing(self) -> float:
        """Distance between wall particles in particle spacings."""
        return 1.0 / self.beta

    def parts(self, context: WallContext) -> WallParts:
        """Return the force of a pair."""
        given, gap, shifted, nearest = self.strength or 0.0, 1.0 / self.beta, self.shifted, _NEAREST
        each = 1.77 / 32.0 / self.beta ** (context.dim - 1)

        def force(wall: WallSide, separation: Separation, constants: Any) -> tuple[float, float, float]:
            head = constants.gravity * constants.depth
            head = head if head > 0.0 else (0.05 * constants.sound_speed) ** 2
            strength = given if given > 0.0 else head
            apart = gap * constants.spacing
            r = max(math.sqrt(separation.r2), nearest * apart)
            q = min(r / constants.smoothing_length, 2.0)
            rest = (2.0 - q) * (2.0 - q)
            psi = each * (1.0 + q * (2.5 + 2.0 * q)) * rest * rest * (2.0 - q)
            r2 = r * max(r - apart, nearest * apart) if shifted else r * r
            factor = -strength * psi / r2
            return factor * separation.x, factor * separation.y, factor * separation.z

        return WallParts(force=force)
