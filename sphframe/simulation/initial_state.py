"""Simulation: the system at the start of a case: particles on their lattice, ghosts, and the pressure at rest."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.ghosts import PRESSED
from sphframe.boundary.wall_states import WallStates
from sphframe.cases import Case, Scene
from sphframe.compiled import LANES, specialise
from sphframe.geometry import fill, panels_of
from sphframe.interfaces import WallGeometry
from sphframe.particles import Columns, Periods
from sphframe.physics import LoopParameters, invert_pressure
from sphframe.simulation.body_contact import FREQUENCY, BodyContacts
from sphframe.simulation.components import Components
from sphframe.simulation.driving import Driving
from sphframe.simulation.filling_check import WallFilling, check_filling, filling_beside_walls
from sphframe.simulation.initial_walls import hydrostatic_densities, initial_boundary, initial_filling
from sphframe.simulation.light_bodies import check_weights
from sphframe.simulation.open_channel import OpenChannel
from sphframe.simulation.rate_loops import RateLoops
from sphframe.simulation.rest_state import pressure_at_depth, still_levels
from sphframe.simulation.shifting import Shifting
from sphframe.simulation.system import FluidSystem


def loop_parameters(case: Case, scene: Scene, components: Components) -> LoopParameters:
    """Return the parameters of the loops for ``case``, whose ``scene`` gives the depth of water."""
    parameters = LoopParameters.of(
        components.compiled_kernel,
        case.dimension,
        smoothing_length=case.smoothing_length_ratio * case.particle_spacing,
        reference_density=case.reference_density,
        sound_speed=case.reference_sound_speed(scene.depth),
        gravity=case.gravity,
        density_diffusion=case.density_diffusion,
        artificial_viscosity=case.artificial_viscosity,
        kinematic_viscosity=case.kinematic_viscosity,
        morris=case.viscosity_model == "morris",
        spacing=case.particle_spacing,
        depth=scene.depth,
        period=Periods.of(case.periodic, scene.domain).length.tolist(),
    )
    lowest = {"none": 0.0, "bounded": case.lowest_pressure, "free": -math.inf}[case.tension]
    fading = PRESSED * parameters.reference_density * parameters.sound_speed**2 if case.tension == "none" else 0.0
    return parameters._replace(lowest_pressure=lowest, fading_pressure=fading)


@dataclass(frozen=True)
class Drawn:
    """Walls and fluid as drawn: ``position`` (n, dim), m, and ``volume`` (n,) of particles of the ``region`` (n,)."""

    boundary: Boundary
    position: Array
    volume: Array
    region: IntArray
    _filling: Callable[[], WallFilling]

    @cached_property
    def filling(self) -> WallFilling:
        """How fluid and ghosts fill the kernel beside the walls."""
        return self._filling()


def drawn(case: Case, scene: Scene, components: Components, parameters: LoopParameters) -> Drawn:
    """Return ghosts and particles of ``scene``."""
    spacing = case.particle_spacing
    fills = [fill(region, spacing) for region in scene.fluid]
    position = np.vstack([filled.position for filled in fills])
    if case.jitter > 0.0:
        position += case.jitter * spacing * np.random.default_rng(case.seed).uniform(-1.0, 1.0, position.shape)
    volume = np.concatenate([filled.volume for filled in fills])
    boundary = initial_boundary(case, scene, components, parameters)
    region = np.repeat(np.arange(len(fills)), [len(filled.volume) for filled in fills])
    beside_walls = partial(filling_beside_walls, boundary, position, volume, spacing, components, parameters)
    return Drawn(boundary, position, volume, region, beside_walls)


def initial_system(
    case: Case, scene: Scene, components: Components, parameters: LoopParameters, kind: type[FluidSystem] = FluidSystem
) -> FluidSystem:
    """Return the system of ``scene`` at time 0, with its neighbour lists built and all rates computed.

    ``kind`` says where it is computed.

    Raises
    ------
    InputError
        when a body is too light, or fluid and ghosts leave empty space beside walls.
    """
    dim, spacing = case.dimension, case.particle_spacing
    start = drawn(case, scene, components, parameters)
    if components.wall_treatment.geometry is not WallGeometry.ROW:
        check_filling(start.filling, scene.walls, refuse=case.guards.filling == "stop")
    boundary, position, members = start.boundary, start.position, start.region
    of_images = components.wall_treatment.geometry is WallGeometry.IMAGES
    half_edge = spacing if of_images else 0.0  # a particle has images in all walls within the support
    if components.walls.surface is not None:
        half_edge = 0.5 * components.wall_treatment.row_spacing * spacing
    lists = kind.lists_type(
        dim, len(position), boundary.count, parameters.support, kind.lists_type.SKIN * parameters.support,
        cluster=LANES, width=2.0 * spacing, sight=boundary.sight, periods=boundary.periods,
        walls_move=bool(boundary.bodies), half_edge=half_edge,
    )  # fmt: skip
    pressure = _initial_pressure(case, scene, components, parameters, boundary, position, members)
    rows = _initial_rows(position, start.volume, pressure, boundary, components, parameters)
    channel = OpenChannel.of_case(case, scene, parameters, position, components.parts)
    if channel is not None:
        rows[: len(position), Columns.of(dim).velocity] = channel.initial_velocity(position)
    for index, region in enumerate(scene.fluid):
        if region.velocity is not None:
            rows[: len(position)][members == index, Columns.of(dim).velocity] = region.velocity
    if scene.initial_velocity is not None:
        rows[: len(position), Columns.of(dim).velocity] = scene.initial_velocity(position)
    if components.walls.rate is not None:
        boundary.wall_state[:] = hydrostatic_densities(boundary, position, pressure, components, parameters)
    contacts = _contacts(scene, boundary, position, spacing, parameters)
    parts = {**components.parts, "MASKED": boundary.sides is not None}
    loops = RateLoops(
        parts, components.compiled_kernel, components.walls, attracts=case.tension != "none",
        images=of_images,
        shifting=Shifting.of_case(case, components.wall_treatment, parts), compile_loop=kind.specialise,
    )  # fmt: skip
    states = WallStates(boundary, components.walls.rate, components.parts)
    filling = initial_filling(components, compile_loop=kind.specialise, make_scratch=kind.make_scratch)
    driving = Driving(parameters, dim, components.body_force, scene.sources)
    system = kind(rows, boundary, filling, lists, loops, states, parts, parameters, contacts, driving, channel)
    system.make_room(components.integrator.memory)
    system.move_walls(0.0)
    system.find_neighbours()
    system.evaluate(0.0)
    return system


def _initial_pressure(
    case: Case,
    scene: Scene,
    components: Components,
    parameters: LoopParameters,
    boundary: Boundary,
    position: Array,
    members: IntArray,
) -> Array:
    """Return the pressure (n,) of the fluid at the start, Pa, at ``position`` in the regions ``members`` (n,)."""
    if scene.initial_pressure is not None:
        return scene.initial_pressure(position)
    regions = [position[members == index] for index in range(len(scene.fluid))]
    levels = still_levels(scene, regions, case.particle_spacing, boundary.groups, case.upward)
    depth = levels[members] - position @ case.upward
    pressure = pressure_at_depth(
        depth,
        components.parts["DENSITY"],
        parameters.reference_density,
        parameters.sound_speed,
        float(np.linalg.norm(case.pressing_gravity)),
    )
    for index, region in enumerate(scene.fluid):
        if region.pressure is not None:
            pressure[members == index] = region.pressure
    return pressure


def _contacts(
    scene: Scene, boundary: Boundary, position: Array, spacing: float, parameters: LoopParameters
) -> BodyContacts:
    """Return the contacts of the bodies, which are checked to be heavy enough for the fluid at ``position``."""
    panels = panels_of(boundary.groups, spacing)
    if scene.bodies:
        check_weights(boundary, panels, position, spacing, parameters.reference_density)
    frequency = FREQUENCY * parameters.sound_speed / parameters.smoothing_length
    return BodyContacts(boundary, scene.walls, panels, spacing=spacing, frequency=frequency)


def _initial_rows(
    position: Array,
    volumes: Array,
    pressure: Array,
    boundary: Boundary,
    components: Components,
    parameters: LoopParameters,
) -> Array:
    """Return the packed rows of fluid particles with densities from ``pressure``, and of all ghosts."""
    columns, n = Columns.of(boundary.dim), len(position)
    rho0 = parameters.reference_density
    rows = columns.zeros(n + boundary.count)
    rows[:n, columns.position] = position
    rows[:n, columns.pressure] = pressure
    specialise(invert_pressure, components.parts, parallel=False)(rows, n, parameters)
    rows[:n, columns.volume] = volumes
    rows[:n, columns.mass] = rows[:n, columns.density] * volumes
    rows[n:, columns.density] = rho0
    rows[n:, columns.volume] = boundary.volume
    rows[n:, columns.mass] = rho0 * boundary.volume
    rows[n:, columns.position] = boundary.position
    return rows
