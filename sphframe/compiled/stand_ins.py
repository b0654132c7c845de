"""Compiled: the global names that loop templates use, until :func:`specialise` binds the parts of a run to them.

A template imports the names that it uses; it runs only after ``specialise`` has bound all of them. The values here are
for readers and type checkers.
"""

from typing import Any, NoReturn

from sphframe.interfaces import (
    AssignFunction,
    ForceFunction,
    RateFunction,
    SeenFunction,
    SurfaceFunction,
    WeightsFunction,
)
from sphframe.interfaces.edge_integrals import EdgeFunction, ScalarFunction
from sphframe.interfaces.equation_of_state import StateFunction
from sphframe.particles import Columns


def _not_bound(*_: Any) -> NoReturn:
    """Raise: the template was called without ``specialise``."""
    raise NotImplementedError("a loop template runs only when specialise() has bound its parts")


DIM = 2
"""number of dimensions, 2 or 3"""
COLUMNS = Columns.of(DIM)
"""the columns of a row in that many dimensions"""
MORRIS = False
"""whether the laminar viscosity is that of Morris"""
SUPPORT = 3.0
"""cut-off radius of the kernel in smoothing lengths, R/h"""
VALUE: ScalarFunction = _not_bound
"""w(q) of the kernel"""
GRADIENT: ScalarFunction = _not_bound
"""w'(q)/q of the kernel, as a function of q^2"""
EDGE_INTEGRALS: EdgeFunction = _not_bound
"""c, w0, w1 of the kernel over a straight edge, as a function of z, a, b"""
PRESSURE: StateFunction = _not_bound
"""the equation of state, p(rho, rho0, c0)"""
DENSITY: StateFunction = _not_bound
"""its inverse, rho(p, rho0, c0)"""
PERIODIC = False
"""whether directions repeat themselves, so that distances are those of the nearest copies"""
MASKED = False
"""whether thin walls hide neighbours, wholly or in part (:mod:`sphframe.neighbours.sight`)"""
SLOTS = 8
"""most images of a particle (:mod:`sphframe.boundary.images`)"""
WEIGHTS: WeightsFunction = _not_bound
"""weights of the interpolation method at one evaluation point"""
FALLBACK: WeightsFunction = _not_bound
"""weights used where the method has none"""
ASSIGN: AssignFunction = _not_bound
"""what the treatment assigns to a wall particle"""
SEEN: SeenFunction = _not_bound
"""what a fluid particle sees of a wall particle"""
FORCE: ForceFunction = _not_bound
"""acceleration of a fluid particle by a wall particle"""
RATE: RateFunction = _not_bound
"""rate of the state of a wall particle"""
SURFACE: SurfaceFunction = _not_bound
"""force and divergence of an edge of a wall at a fluid particle"""
