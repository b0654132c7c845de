"""Interfaces: the orders of convergence that treatments of walls and interpolation methods promise."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Order:
    """A promised order p of an operator near walls: its error is of O(dx^p).

    Attributes
    ----------
    straight
        p at a straight wall half a spacing from the first layer of a square lattice.
    anywhere
        p also at circular and wavy walls, on a jittered lattice, and on one nearer to the wall or farther away;
        None where nothing is promised.
    error
        the error at the straight wall with 32 spacings over the length of the fields, see
        :mod:`sphframe.testing.order`; it is held to 1 %. An order cannot show a wrong factor in a rule that does not
        converge.
    """

    straight: float
    anywhere: float | None
    error: float | None = None


@dataclass(frozen=True, kw_only=True)
class Orders:
    """The promised orders of all operators; None where nothing is promised.

    Attributes
    ----------
    pressure
        the pressure gradient, where the normal gradient of the pressure balances the force b.
    divergence, viscosity
        divergence and viscous force, Laplacian over nu, of a flow with no slip.
    shear
        the velocity far from the wall that the error of the viscosity causes, the integral of distance times error.
    slip_divergence, slip_viscosity
        divergence and viscous force of a flow that slips along the wall without stress.
    """

    pressure: Order | None = None
    divergence: Order | None = None
    viscosity: Order | None = None
    shear: Order | None = None
    slip_divergence: Order | None = None
    slip_viscosity: Order | None = None


NOTHING = Orders()
