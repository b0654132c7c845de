"""Simulation: the wall particles of a case at the start, and how they are filled from the fluid."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.filling import Filling, ImageFilling
from sphframe.cases import Case, Scene
from sphframe.compiled import specialise
from sphframe.errors import InputError
from sphframe.interfaces import EvaluationPoint, WallGeometry
from sphframe.particles import Columns, Periods
from sphframe.physics import LoopParameters, invert_pressure, uniform_and_linear
from sphframe.simulation.components import Components
from sphframe.simulation.filling_check import filling_by


def initial_boundary(case: Case, scene: Scene, components: Components, parameters: LoopParameters) -> Boundary:
    """Return the wall particles that the treatment needs.

    Raises
    ------
    InputError
        when a wall is too thin for the treatment.
    """
    interpolator, treatment = components.interpolator, components.wall_treatment
    in_row, of_images = (treatment.geometry is kind for kind in (WallGeometry.ROW, WallGeometry.IMAGES))
    if of_images and case.periodic:
        raise InputError(
            f"wall_treatment = {case.wall_treatment.name!r} makes images of the fluid, which is not possible in a case"
            ' with periodic directions: choose a treatment with ghosts, such as wall_treatment = "fixed-ghosts"'
        )
    boundary = Boundary(
        scene.walls,
        scene.bodies,
        EvaluationPoint.GHOST if interpolator is None else interpolator.traits.evaluation_point,
        fluid=scene.fluid,
        spacing=case.particle_spacing,
        support=parameters.support,
        no_slip=case.slip == "no" and not (of_images or components.walls.own_viscous_velocity),
        fade=case.tension == "none",
        row_spacing=treatment.row_spacing * case.particle_spacing if in_row else None,
        periods=Periods.of(case.periodic, scene.domain),
    )
    if in_row or of_images or components.walls.surface is not None:
        _check_thick(boundary)
    if case.tension == "none" and interpolator is not None:
        ghosts = boundary.position, boundary.volume, boundary.points
        boundary.full[:] = 1.0 - filling_by(*ghosts, components, parameters, boundary.sight, boundary.periods)
    return boundary


def _check_thick(boundary: Boundary) -> None:
    """Refuse thin walls for treatments that take the walls themselves, particles on them or images for ghosts."""
    if boundary.sight is not None:
        x, y = boundary.sight.ends[np.argmax(boundary.sight.thin), :2]
        raise InputError(
            f"the wall at ({x:.6g}, {y:.6g}) is thinner than the kernel's support, and with this wall treatment both of"
            " its sides would be felt; make it as thick as the support, or choose a treatment with ghosts behind walls,"
            ' such as wall_treatment = "fixed-ghosts"'
        )


def initial_filling(components: Components, **memory: Callable[..., Any]) -> Filling | ImageFilling:
    """Return the loop that fills the wall particles; ``memory``: how :class:`Filling` compiles it, and its scratch."""
    if components.wall_treatment.geometry is WallGeometry.IMAGES:
        return ImageFilling(components.parts, components.walls)
    return Filling(
        components.interpolator, components.compiled_kernel, components.parts, components.walls,
        velocity_interpolator=components.velocity_interpolator, **memory,
    )  # fmt: skip


def hydrostatic_densities(
    boundary: Boundary, position: Array, pressure: Array, components: Components, parameters: LoopParameters
) -> Array:
    """Return densities of ghosts (g,) in equilibrium with the nearest particle of the fluid; rho0 where it is far."""
    around, number = boundary.periods.with_copies(position, parameters.support)
    distance, nearest = cKDTree(around).query(boundary.position)
    weight = parameters.reference_density * uniform_and_linear(parameters, boundary.dim)[0]
    lift = np.einsum("gi,i->g", boundary.position - around[nearest], np.where(boundary.periods.repeats, 0.0, weight))
    nearest = number[nearest]
    columns = Columns.of(boundary.dim)
    rows = columns.zeros(boundary.count)
    found = np.maximum(pressure[nearest] + lift, 0.0)
    rows[:, columns.pressure] = np.where(distance > parameters.support, 0.0, found)
    specialise(invert_pressure, components.parts, parallel=False)(rows, boundary.count, parameters)
    return np.asarray(rows[:, columns.density])
