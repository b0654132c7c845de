"""Interfaces: contracts between the rooms, and the classes that authors of components subclass.

At run time no module imports another room, except ``representation`` and, in the method ``operator``, ``boundary``.
"""

from sphframe.interfaces.body_force import BodyForce
from sphframe.interfaces.boundary_interpolator import BoundaryInterpolator, WeightsFunction
from sphframe.interfaces.equation_of_state import EquationOfState
from sphframe.interfaces.integrator import Integrator, System
from sphframe.interfaces.kernel import CompiledKernel, Kernel
from sphframe.interfaces.order import Order, Orders
from sphframe.interfaces.rigid_body import Motion, RigidBody, Solid, Surroundings
from sphframe.interfaces.run_view import Fields, ResumableRun, RunView, WallLoad
from sphframe.interfaces.traits import DRY, OK, SINGULAR, TOO_FEW, EvaluationPoint, Status, Traits
from sphframe.interfaces.wall_treatment import (
    AssignFunction,
    Edge,
    FluidSide,
    ForceFunction,
    Interpolated,
    Neighbours,
    RateFunction,
    Seen,
    SeenFunction,
    Separation,
    SurfaceFunction,
    WallContext,
    WallGeometry,
    WallParts,
    WallPoint,
    WallSide,
    WallTraits,
    WallTreatment,
)

__all__ = [name for name in dir() if name[0].isupper()]  # without the modules
