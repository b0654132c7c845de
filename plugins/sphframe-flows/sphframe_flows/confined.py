"""Viscous flow along walls, without gravity and without a free surface."""

from typing import Literal

from sphframe import Case
from sphframe.cases import Component, ExactCase, downward_gravity, with_default


class ConfinedFlow(ExactCase):
    """A case with no slip whose fluid fills its vessel: particles are shifted, and pressures may be negative.

    With no slip, ghosts take the velocity of free slip in the continuity: the reversed tangential velocity would stand
    for fluid that flows in or out along the wall.
    """

    gravity: float = downward_gravity(0.0)
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    shifting: float = with_default(Case, "shifting", 1.0)
    slip: Literal["free", "no"] = with_default(Case, "slip", "no")
    wall_treatment: Component = with_default(
        Case, "wall_treatment", Component(name="fixed-ghosts", options={"continuity": "free-slip"})
    )
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
