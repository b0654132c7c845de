"""Walls that repel fluid particles by the force of Lennard-Jones, Monaghan (1994), for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import Separation, WallContext, WallGeometry, WallParts, WallSide, WallTraits, WallTreatment

__all__ = ["LennardJones"]

_NEAREST = 0.01
"""distance below which the force does not grow, in particle spacings"""


@dataclass(frozen=True)
class LennardJones(WallTreatment):
    """Each particle of one row on the wall repels the fluid particles that are nearer than the particle spacing r0.

    With r the distance from the wall particle G to the fluid particle i::

        a_i = D [(r0/r)^4 - (r0/r)^2] (x_i - x_G)/r^2,   r < r0;      D = 5 g H

    or, with ``steep = true``, the exponents 12 and 6. Nothing else acts between wall and fluid: free slip, no part in
    the continuity. H is the greatest depth of still water; without gravity or depth, g H is taken as c0^2/400, its
    value for sphframe's default speed of sound.

    Departs from the paper: the force does not grow any more where r < r0/100.

    Known failures: the pressure does not reach the wall, so that still water does not rest but rattles on it; the sums
    of the first layers lack the half of their support behind the wall; the row is felt as bumps (J. J. Monaghan, J. B.
    Kajtar (2009), doi:10.1016/j.cpc.2009.05.008).

    Source: J. J. Monaghan (1994), doi:10.1006/jcph.1994.1034; D between g H and 10 g H.

    Attributes
    ----------
    strength
        D, m^2/s^2; by default 5 g H.
    steep
        exponents 12 and 6 instead of 4 and 2.
    """

    strength: float | None = None
    """D, m^2/s^2; by default 5 g H"""
    steep: bool = False
    """whether the exponents are 12 and 6 in place of 4 and 2"""

    traits = WallTraits()
    geometry = WallGeometry.ROW
    row_spacing = 0.5

    def __post_init__(self) -> None:
        if self.strength is not None and not self.strength > 0.0:
            raise ValueError(f"strength must be a positive number (m^2/s^2) or be left out, got {self.strength!r}")

    def parts(self, context: WallContext) -> WallParts:
        """Return the force of a pair."""
        given, steep, nearest = self.strength or 0.0, self.steep, _NEAREST

        def force(wall: WallSide, separation: Separation, constants: Any) -> tuple[float, float, float]:
            head = constants.gravity * constants.depth
            head = head if head > 0.0 else (0.05 * constants.sound_speed) ** 2
            strength = given if given > 0.0 else 5.0 * head
            r0 = constants.spacing
            r2 = max(separation.r2, (nearest * r0) ** 2)
            s = r0 * r0 / r2
            if steep:
                s = s * s * s
            factor = -strength * max(s * s - s, 0.0) / r2  # not positive, and 0 from r0 on
            return factor * separation.x, factor * separation.y, factor * separation.z

        return WallParts(force=force)
