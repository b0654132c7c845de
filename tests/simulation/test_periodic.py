"""Periodic directions: what crosses the border, what is conserved, and that its place does not matter."""

import warnings

import numpy as np
import pytest

from sphframe import InputError, Simulation
from sphframe.cases import CaseWarning, Custom, check_case
from sphframe.geometry import BoxRegion, BoxWall, DifferenceRegion, PolygonWall
from sphframe.geometry.shapes import Box, Circle
from sphframe.geometry.walls import CircleWall, CurveWall

SPACING, LENGTH = 0.05, 1.0
COMMON = {  # the loops are those of the channels of sphframe-flows
    "particle_spacing": SPACING,
    "sound_speed": 10.0,
    "kinematic_viscosity": 0.01,
    "artificial_viscosity": 0.0,
    "slip": "no",
    "tension": "free",
    "until": 1.0,
    "depth": 1.0,
}
BED = PolygonWall(name="bed", points=[(0, 0), (LENGTH, 0)])
LID = PolygonWall(name="lid", points=[(0, 0.5), (LENGTH, 0.5)])


def without_walls(dim=2, **given):
    fluid = [BoxRegion(lower=(0.0,) * dim, upper=(LENGTH,) * dim)]
    given = {"dimension": dim, "gravity": 0.0, "walls": [], "fluid": fluid, "periodic": tuple("xyz"[:dim])} | given
    return Custom(**COMMON | given)


def channel(**given):
    fluid = [BoxRegion(lower=(0.0, 0.0), upper=(LENGTH, 0.5))]
    return Custom(**COMMON | {"walls": [BED, LID], "fluid": fluid, "periodic": ("x",)} | given)


ALONG = np.array([1.0, 0.0])


def stirred(case, shift=0.0, threads=1, steps=40, **options):
    """The simulation of a case whose fluid has got a velocity with the period of the domain, ``shift`` along x."""
    simulation = Simulation(case, threads=threads)
    rows, dim = simulation.system.rows[: simulation.fluid_count], case.dimension
    phase = 2.0 * np.pi * (rows[:, :dim] - shift * np.eye(dim)[0]) / LENGTH
    rows[:, dim : 2 * dim] = 0.6 + 0.5 * np.sin(phase + np.roll(phase, 1, axis=1) + np.arange(dim))
    simulation.system.evaluate(0.0)
    for _ in range(steps):
        simulation.advance()
    return simulation


def test_a_uniform_flow_goes_round_and_is_counted():
    simulation = Simulation(without_walls(time_step=2e-3), threads=1)
    start = simulation.fields().position
    simulation.system.rows[: simulation.fluid_count, 2:4] = velocity = np.array([7.0, -3.0])
    for _ in range(150):
        simulation.advance()
    fields, turns = simulation.fields(), simulation.turns()
    assert np.all((fields.position >= 0.0) & (fields.position <= LENGTH))
    assert turns.max() >= 2
    assert turns.min() <= -1
    assert np.allclose(fields.position + turns * LENGTH, start + 0.3 * velocity, atol=1e-12, rtol=0.0)
    assert np.allclose(fields.velocity, velocity, atol=1e-11, rtol=0.0)


@pytest.mark.parametrize("dim", [2, 3])
def test_momentum_is_conserved_without_walls(dim):
    case = without_walls(dim, particle_spacing=0.1 if dim == 3 else SPACING, smoothing_length_ratio=1.2, time_step=3e-3)
    simulation = stirred(case, steps=0)
    mass = simulation.masses()
    before = mass @ simulation.fields().velocity
    for _ in range(30):
        simulation.advance()
    velocity = simulation.fields().velocity
    assert simulation.turns().max() == 1
    assert np.allclose(mass @ velocity, before, atol=1e-12 * mass.sum(), rtol=0.0)
    assert np.ptp(velocity) > 0.1


def test_the_place_of_the_border_does_not_matter():
    """A flow between two walls, and the same flow moved by seven spacings, which cross the border elsewhere."""
    shift = 7.0 * SPACING
    one, other = (stirred(channel(), by) for by in (0.0, shift))
    here, there = one.fields(), other.fields()
    moved = (here.position + shift * ALONG) % [LENGTH, 10.0]
    offset = moved[:, None] - there.position[None, :]
    offset[..., 0] -= LENGTH * np.rint(offset[..., 0] / LENGTH)
    partner = np.linalg.norm(offset, axis=2).argmin(axis=1)
    assert np.linalg.norm(offset, axis=2).min(axis=1).max() < 1e-9
    assert np.allclose(here.velocity, there.velocity[partner], atol=1e-9, rtol=0.0)
    assert np.allclose(here.pressure, there.pressure[partner], atol=1e-4, rtol=0.0)
    loads = [simulation.wall_forces() for simulation in (one, other)]
    for wall, (reaction, by_pressure) in loads[0].items():
        assert np.allclose(reaction, loads[1][wall][0], rtol=1e-8), wall
        assert np.allclose(by_pressure, loads[1][wall][1], rtol=1e-8), wall
    points = np.array([[0.02, 0.2], [LENGTH - 0.01, 0.3]])
    assert np.allclose(one.sample(points), other.sample((points + shift * ALONG) % [LENGTH, 10.0]), rtol=1e-8)


@pytest.mark.parametrize("threads", [1, pytest.param(2, marks=pytest.mark.long)])
@pytest.mark.parametrize("make", [without_walls, channel])
def test_threads_and_a_saved_state_keep_the_bits(make, threads):
    one, *others = (stirred(make(), threads=count) for count in sorted({1, threads}))
    assert all(np.array_equal(one.system.rows, other.system.rows) for other in others)
    continued = Simulation(make(), threads=1)
    continued.restore(one.state())
    for _ in range(20):
        one.advance()
        continued.advance()
    assert np.array_equal(one.system.rows, continued.system.rows)
    assert np.array_equal(one.turns(), continued.turns())


def wavy_bed(place):
    """A bed that is a sine of period LENGTH, drawn with its crest at ``place``."""
    bed = CurveWall(name="bed", x="t", y=f"0.1*cos(2*pi*(t - {place}))", start=-0.25, stop=0.75)
    fluid = BoxRegion(lower=(0, 0.3), upper=(LENGTH, 0.6))
    return channel(walls=[bed], fluid=[fluid], smoothing_length_ratio=1.0, guards={"filling": "report"})


def test_ghosts_of_a_wall_that_crosses_the_border_repeat_themselves():
    volumes = []
    for place in (0.5, 0.0, 0.23):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CaseWarning)
            boundary = Simulation(wavy_bed(place), threads=1).boundary
        assert np.all((boundary.position[:, 0] >= -1e-6) & (boundary.position[:, 0] < LENGTH))
        copies = np.vstack([boundary.position + k * LENGTH * ALONG for k in (-1, 0, 1)])
        nearest = np.sort(np.linalg.norm(copies[:, None] - boundary.position[None], axis=2), axis=0)[1]
        assert nearest.min() > 0.6 * SPACING
        volumes.append(boundary.volume.sum())
    slope = 0.2 * np.pi * np.sin(2.0 * np.pi * np.linspace(0.0, 1.0, 1001)[:-1])
    assert np.allclose(volumes, 3.0 * SPACING * np.sqrt(1.0 + slope**2).mean(), rtol=2e-3)


def test_an_obstacle_on_the_border_feels_what_it_feels_in_the_middle():
    """Still water presses on a cylinder by Archimedes' force, wherever the border is."""
    forces = []
    for x in (0.5, 0.0):
        at = [x] if x > 0.0 else [0.0, LENGTH]
        circles = [Circle(centre=(place, 0.5), radius=0.25) for place in at]
        fluid = DifferenceRegion(of=Box(lower=(0, 0), upper=(LENGTH, 1.0)), minus=circles)
        walls = [
            PolygonWall(name="bed", points=[(0, 0), (LENGTH, 0)]),
            PolygonWall(name="lid", points=[(0, 1), (LENGTH, 1)]),
            CircleWall(name="cylinder", centre=(x, 0.5), radius=0.25),
        ]
        simulation = Simulation(
            channel(walls=walls, fluid=[fluid], particle_spacing=0.025, sound_speed=60.0), threads=1
        )
        assert simulation.particles_outside() == 0
        forces.append(np.concatenate(simulation.wall_forces()["cylinder"]))
    weight = 1000.0 * 9.81 * np.pi * 0.25**2
    assert np.allclose(forces[0], [0.0, weight, 0.0, weight], atol=0.02 * weight)
    assert np.allclose(forces[0], forces[1], atol=1e-3 * weight)


def test_a_box_between_two_open_faces_repeats_itself_in_three_dimensions():
    box = BoxWall(lower=(0, 0, 0), upper=(0.6, 0.6, 0.6), open_faces=["-y", "+y", "+z"])
    fluid = [BoxRegion(lower=(0, 0, 0), upper=(0.6, 0.6, 0.3))]
    case = Custom(
        dimension=3, particle_spacing=0.06, until=1.0, walls=[box], fluid=fluid, periodic=["y"],
        smoothing_length_ratio=1.2, domain=((-0.1, 0, -0.1), (0.7, 0.6, 1)),
    )  # fmt: skip
    simulation = Simulation(case, threads=1)
    for _ in range(20):
        simulation.advance()
    velocity = simulation.fields().velocity
    assert np.abs(velocity[:, 1]).max() < 1e-12
    force, _ = simulation.wall_forces()["wall"]
    assert force[2] == pytest.approx(-1000.0 * 9.81 * 0.6 * 0.6 * 0.3, rel=0.03)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"periodic": ["z"]}, r"periodic = \['z'\]: give each of \['x', 'y'\]"),
        ({"periodic": ["x", "x"]}, "at most once"),
        ({"domain": ((0, -1), (0.2, 2))}, "period 0.2 m along x is too short"),
        ({"walls": [], "periodic": []}, "no wall if it is periodic"),
        (
            {"walls": [PolygonWall(points=[(0, 0), (LENGTH, 0)], surface_velocity=(0, 1)), LID]},
            "surface_velocity .* is not along its surface at",
        ),
        (
            {"walls": [PolygonWall(points=[(0, 0), (LENGTH, 0)], surface_velocity=(0, 1, 0))]},
            "surface_velocity of wall 'wall' has 3 coordinates",
        ),
        (
            {
                "walls": [BED, LID, PolygonWall(points=[(0.5, 0), (0.5, 0.5)])],
                "fluid": [BoxRegion(lower=(x, 0), upper=(x + 0.5, 0.5)) for x in (0.0, 0.5)],
            },
            "thinner than the kernel's support",
        ),
        (
            {"walls": [PolygonWall(name="floor", points=[(-0.2, 0), (1.2, 0)]), LID]},
            "wall 'floor' extends over 1.4 m along x, more than the period of 1 m",
        ),
    ],
)
def test_what_cannot_repeat_itself_is_refused(given, message):
    with pytest.raises(InputError, match=message):
        check_case(channel(**given))
