"""Mirror images have their traits, and sums near walls are those of the doubled cloud of particles."""

import itertools

import numpy as np
import pytest
from sphframe_mirror_images import MirrorImages

from sphframe import Simulation, create
from sphframe.cases.custom import Custom
from sphframe.testing import parametrize_with_checks

SPACING = 0.01


@parametrize_with_checks([MirrorImages()])
def test_has_its_traits(treatment, check):
    check(treatment)


def box(dim, across, **parameters):
    """A closed box of water, that many spacings wide, whose particles have been moved at random."""
    size = (across * SPACING,) * dim
    shape = {"shape": "box", "lower": (0.0,) * dim, "upper": size}
    simulation = Simulation(
        Custom(
            dimension=dim, particle_spacing=SPACING, smoothing_length_ratio=1.0, sound_speed=20.0,
            density_diffusion=0.0, kinematic_viscosity=1e-3, tension="free", walls=[shape],
            fluid=[shape], until=1.0, frame_interval=1.0, probe_interval=1.0, wall_treatment="mirror-images",
            **parameters,
        ),
        threads=1,
    )  # fmt: skip
    random = np.random.default_rng(5)
    system, c = simulation.system, simulation.columns
    rows = system.rows[: simulation.fluid_count]
    rows[:, c.position] += SPACING * random.uniform(-0.4, 0.4, (len(rows), dim))
    rows[0, c.position.start] = 1e-6 * SPACING  # on a wall; at 0, the direction to its own image is round-off
    rows[:, c.velocity] = random.normal(size=(len(rows), dim))
    rows[:, c.density] = 1000.0 + random.uniform(0.0, 5.0, len(rows))
    system.find_neighbours()
    system.evaluate(0.0)
    return simulation


@pytest.mark.parametrize(
    ("dim", "slip", "across"),
    [
        *((2, "free", 7), (2, "no", 7), (3, "no", 7), (2, "free", 4), (3, "no", 4)),
        pytest.param(3, "free", 7, marks=pytest.mark.long),
    ],
)
def test_rates_in_a_box_are_those_of_the_cloud_repeated_by_reflection(dim, slip, across):
    """The cloud is repeated in each direction, once on either side; a fluid particle sees all of it as fluid.

    The support is 3 spacings: in a box of four, particles in the middle have images in all walls.
    """
    simulation = box(dim, across, slip=slip)
    c, n = simulation.columns, simulation.fluid_count
    rows, rates, parameters = simulation.system.rows[:n], simulation.system.rates, simulation.system.parameters
    x, u, p, volume, density = (rows[:, k] for k in (c.position, c.velocity, c.pressure, c.volume, c.density))
    h, length = parameters.smoothing_length, across * SPACING
    compression, force = np.zeros(n), np.zeros((n, dim))
    for copy in itertools.product((-1, 0, 1), repeat=dim):
        reversed_ = np.array(copy) != 0
        image = np.where(reversed_, np.array(copy) * length + length - x, x)
        velocity = np.where(reversed_ if slip == "free" else np.any(reversed_), -u, u)
        pressure = p - 1000.0 * 9.81 * (image - x)[:, -1]
        offset = image[None] - x[:, None]
        r = np.linalg.norm(offset, axis=2)
        sigma = create("kernels", "gaussian").normalisation(dim)
        slope = np.where(r < 3.0 * h, -2.0 * sigma * np.exp(-np.square(r / h)), 0.0) / h ** (dim + 2)  # W'(r)/r
        weight = slope * volume
        np.fill_diagonal(weight, 0.0 if not np.any(reversed_) else weight.diagonal())
        relative = velocity[None] - u[:, None]
        approach = np.einsum("ijk,ijk->ij", relative, offset)
        compression -= np.einsum("ij,ij->i", weight, approach)
        pi = parameters.viscosity * approach / np.maximum(r, 1e-9) ** 2 - (p[:, None] + pressure[None])
        force -= np.einsum("ij,ijk->ik", weight * pi, offset)
        force -= np.einsum("ij,ijk->ik", weight * parameters.friction, relative)
    found = rates[:, c.velocity] + np.eye(dim)[-1] * 9.81
    np.testing.assert_allclose(rates[:, c.density], -density * compression, atol=1e-9 * 1e5)
    np.testing.assert_allclose(found, force / density[:, None], atol=1e-9 * np.abs(found).max())
