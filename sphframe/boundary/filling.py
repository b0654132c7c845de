"""Boundary: fills the ghosts from the fluid, or makes its images, by compiled loops, which need scratch memory."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.conjugate import make_conjugate
from sphframe.boundary.ghosts import Scratch, fill_ghosts
from sphframe.boundary.images import Images, make_images, most_images
from sphframe.boundary.trial import weights_functions
from sphframe.compiled import specialise
from sphframe.interfaces import (
    BoundaryInterpolator,
    CompiledKernel,
    EvaluationPoint,
    Interpolated,
    WallParts,
    WallPoint,
)
from sphframe.neighbours import NeighbourLists
from sphframe.physics import LoopParameters


class Filling:
    """Interpolates the fluid to the evaluation points and assigns velocity, pressure and density of the ghosts.

    Parameters
    ----------
    interpolator, kernel
        the method, None where the treatment needs none, and the kernel.
    parts
        the compiled parts of the loops, by name; ``walls`` the functions of the treatment.
    velocity_interpolator
        another method for the velocities.
    compile_loop
        makes the loops, as :func:`~sphframe.compiled.specialise` does; ``make_scratch`` their memory.
    """

    def __init__(
        self,
        interpolator: BoundaryInterpolator | None,
        kernel: CompiledKernel,
        parts: Mapping[str, Any],
        walls: WallParts,
        *,
        velocity_interpolator: BoundaryInterpolator | None = None,
        compile_loop: Callable[..., Callable[..., None]] = specialise,
        make_scratch: Callable[[int, int], Scratch] = Scratch.of,
    ) -> None:
        self._dim: int = parts["DIM"]
        bound = {
            **parts,
            "INTERPOLATES": interpolator is not None,
            "ASSIGN": walls.assign or _at_rest,
            "VELOCITIES": walls.uses_velocity,
        }
        if interpolator is not None:
            point = interpolator.traits.evaluation_point
            bound["EXTRAPOLATED"] = point is EvaluationPoint.EXTRAPOLATED
            bound["DIRECTED"] = point is EvaluationPoint.DIRECTED
            independent = interpolator.traits.kernel_independent and point is EvaluationPoint.MIRROR
            bound["BY_KERNEL"] = not independent or velocity_interpolator is not None
            bound["WEIGHTS"], bound["FALLBACK"] = weights_functions(interpolator, kernel, self._dim)
        if velocity_interpolator is not None:
            bound["SEPARATE"] = True
            functions = weights_functions(velocity_interpolator, kernel, self._dim)
            bound["VELOCITY_WEIGHTS"], bound["VELOCITY_FALLBACK"] = functions
        self._fill = compile_loop(fill_ghosts, bound)
        self._make_conjugate = compile_loop(make_conjugate, parts) if walls.conjugate else None
        self._make_scratch = make_scratch
        self._scratch = make_scratch(8, self._dim)

    def __call__(self, rows: Array, lists: NeighbourLists, boundary: Boundary, parameters: LoopParameters) -> None:
        """Fill the ghosts of ``boundary`` near the fluid in ``rows`` (n + g, width), and set their statuses."""
        if lists.points.shape[1] > self._scratch.members.shape[1]:
            self._scratch = self._make_scratch(lists.points.shape[1], self._dim)
        around = lists.points, lists.point_counts
        of_boundary = boundary.points, boundary.lifts, boundary.arrays, parameters, self._scratch, boundary.statuses
        self._fill(rows, lists.fluid_count, lists.near, *around, *of_boundary)
        if len(lists.left):
            nothing = np.zeros(len(lists.left), np.uint32)
            self._fill(rows, lists.fluid_count, lists.left, lists.points, nothing, *of_boundary)
            lists.left = lists.near[:0]
        if self._make_conjugate is not None:
            self._make_conjugate(
                rows, lists.fluid_count, lists.near, *around, boundary.reflection, boundary.velocity, parameters
            )  # fmt: skip


class ImageFilling:
    """Makes the images of the fluid in the walls, which take the place of ghosts; arguments as of :class:`Filling`."""

    def __init__(self, parts: Mapping[str, Any], walls: WallParts) -> None:
        self._dim: int = parts["DIM"]
        bound = {"SLOTS": most_images(self._dim), "ASSIGN": walls.assign or _at_rest}
        self._make = specialise(make_images, {**parts, **bound})

    def __call__(self, rows: Array, lists: NeighbourLists, boundary: Boundary, parameters: LoopParameters) -> None:
        """Make the images of the fluid in ``rows`` (n + g, width) in ``boundary``."""
        if len(boundary.images.counts) != lists.fluid_count:
            boundary.images = Images.of(lists.fluid_count, self._dim)
        self._make(
            rows, lists.fluid_count, lists.fluid, lists.fluid_counts, lists.ghost_counts, boundary.foot,
            boundary.arrays, parameters, *boundary.images,
        )  # fmt: skip


def _at_rest(
    fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Array, viscous_velocity: Array
) -> tuple[float, float]:
    """Assign the velocity of the wall and no pressure, for treatments that assign nothing."""
    for d in range(velocity.shape[0]):
        velocity[d] = wall.velocity[d]
    return 0.0, 1.0
