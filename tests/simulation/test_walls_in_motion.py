"""Walls that stand, move and float, with water around them."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from sphframe.bodies import Prescribed
from sphframe.cases import Case, Gauge, Probe, Scene
from sphframe.cases.floating_body import FloatingBody
from sphframe.geometry import BoxWall, Circle, PolygonRegion, PolygonWall, moments
from sphframe.geometry.regions import DifferenceRegion
from sphframe.geometry.walls import CircleWall
from sphframe.simulation import Simulation

Array = NDArray[np.float64]


def run(simulation: Simulation, until: float) -> None:
    while simulation.time < until:
        simulation.advance()


class TankInMotion(Case):
    """A tank that moves as a whole; its water starts with the surface tilted by ``tilt``."""

    particle_spacing: float = 0.02
    until: float = 10.0
    frame_interval: float = 1.0
    probe_interval: float = 0.1
    tilt: float = 0.0
    motion: Any = None

    def scene(self) -> Scene:
        length, depth = 0.6, 0.3
        rise = 0.5 * length * self.tilt

        def pressure(position: Array) -> Array:
            surface = depth + rise - self.tilt * position[:, 0]
            return 9810.0 * np.maximum(surface - position[:, 1], 0.0)

        return Scene(
            walls=(BoxWall(name="tank", lower=(0, 0), upper=(length, 0.6), open_faces=("+y",), body="tank"),),
            fluid=(PolygonRegion(points=((0, 0), (length, 0), (length, depth - rise), (0, depth + rise))),),
            depth=depth,
            domain=((-1.0, -0.1), (4.0, 1.2)),
            bodies={"tank": Prescribed(self.motion)},
            initial_pressure=pressure,
        )


def test_accelerated_tank_keeps_a_tilted_hydrostatic_field() -> None:
    a = 0.15 * 9.81
    case = TankInMotion(tilt=0.15, motion=lambda t: ((0.5 * a * t * t, 0, 0), (a * t, 0, 0), (a, 0, 0)))
    simulation = Simulation(case, threads=1)
    errors = []
    while simulation.time < 0.6:
        simulation.advance()
        if simulation.time > 0.2 and simulation.step % 10 == 0:
            along = np.linspace(0.0, 0.6, 7)
            points = np.stack([along + 0.5 * a * simulation.time**2, np.zeros(7)], axis=1)
            exact = 9810.0 * (0.3 + 0.15 * (0.3 - along))
            errors.append((simulation.sample(points)[0] - exact) / (9810.0 * 0.3))
    assert np.abs(np.mean(errors, axis=0)).max() < 0.02
    assert simulation.particles_outside() == 0


@pytest.mark.long
def test_tank_swung_with_no_net_change_returns_to_rest() -> None:
    span, way = 3.0, 0.1

    def there_and_back(t: float) -> tuple[Any, Any, Any]:
        s = min(t / span, 1.0)
        p = np.polynomial.Polynomial([0, 0, 0, 0, 1, -4, 6, -4, 1]) * 256.0 * way  # 256 s^4 (1 - s)^4
        values = [p(s), p.deriv()(s) / span, p.deriv(2)(s) / span**2]
        if t > span:
            values = [0.0, 0.0, 0.0]
        return tuple((value, 0.0, 0.0) for value in values)  # type: ignore[return-value]

    simulation = Simulation(TankInMotion(motion=there_and_back, particle_spacing=0.03), threads=1)
    start = simulation.fields().position
    fastest = 0.0
    while simulation.time < 3.6:
        simulation.advance()
        fastest = max(fastest, simulation.energies()["kinetic"])
    assert simulation.energies()["kinetic"] < 0.01 * fastest
    assert np.abs(np.mean(simulation.fields().position - start, axis=0)).max() < 0.25 * 0.02
    assert simulation.particles_outside() == 0


def test_floating_box_finds_archimedes_draught() -> None:
    case = FloatingBody(
        depth=0.3, tank_length=0.8, box_length=0.24, box_height=0.16, particle_spacing=0.0267, initial_draught=0.06
    )
    simulation = Simulation(case, threads=1)
    draughts = []
    while simulation.time < 3.0:
        simulation.advance()
        if simulation.time > 1.5 and simulation.step % 20 == 0:
            bottom = 0.3 - 0.06 + simulation.body_motions()["box"].position[1]
            draughts.append(float(np.mean(simulation.gauge_readings().elevation)) - bottom)
    assert np.mean(draughts) == pytest.approx(0.08, abs=0.005)
    assert abs(simulation.body_motions()["box"].position[2]) < 0.02
    assert simulation.particles_outside() == 0


def test_box_with_a_draught_of_one_particle_is_steady() -> None:
    case = FloatingBody(
        depth=0.2, tank_length=0.6, box_length=0.24, density_ratio=0.05, initial_draught=0.01, particle_spacing=0.01
    )
    simulation = Simulation(case, threads=1)
    for _ in range(300):
        simulation.advance()
        assert np.abs(simulation.body_motions()["box"].acceleration[:2]).max() < 9.81
    assert np.abs(simulation.body_motions()["box"].position[:2]).max() < 0.005


class StepTank(Case):
    """Water falls over a step with a convex corner into a pit with concave ones."""

    particle_spacing: float = 0.02
    until: float = 1.0
    frame_interval: float = 1.0
    probe_interval: float = 0.1

    def scene(self) -> Scene:
        points = ((0, 0.8), (0, 0.3), (0.4, 0.3), (0.5, 0.0), (1.0, 0.0), (1.3, 1.5))
        return Scene(
            walls=(PolygonWall(name="tank", points=points),),
            fluid=(PolygonRegion(points=((0, 0.3), (0.38, 0.3), (0.38, 0.6), (0, 0.6))),),
            depth=0.3,
            domain=((-0.02, -0.02), (1.4, 2.0)),
            probes=(Probe(name="pit", position=(0.75, 0.0)),),
            gauges=(Gauge(name="pit", position=(0.75,)),),
        )


def test_sharp_corners_do_not_leak() -> None:
    simulation = Simulation(StepTank(guards={"density": "count"}), threads=1)
    run(simulation, 0.7)
    assert simulation.particles_outside() == 0


class Annulus(Case):
    """Fluid between a cylinder of radius 0.1 m that moves and a fixed one of 0.2 m, without gravity, under pressure."""

    particle_spacing: float = 0.01
    until: float = 10.0
    frame_interval: float = 1.0
    probe_interval: float = 0.1
    gravity: float = 0.0
    sound_speed: float = 10.0
    motion: Any = None

    def scene(self) -> Scene:
        inner, outer = Circle(centre=(0, 0), radius=0.1), Circle(centre=(0, 0), radius=0.2)
        return Scene(
            walls=(
                CircleWall(name="inner", centre=(0, 0), radius=0.1, body="cylinder"),
                CircleWall(name="outer", centre=(0, 0), radius=0.2),
            ),
            fluid=(DifferenceRegion(of=outer, minus=(inner,)),),
            depth=0.4,
            domain=((-0.3, -0.3), (0.3, 0.3)),
            bodies={"cylinder": Prescribed(self.motion)},
            initial_pressure=lambda position: np.full(len(position), 400.0),
        )


@pytest.mark.long
def test_added_mass_of_a_cylinder_in_an_annulus() -> None:
    """F = -C rho pi r^2 a with C = (R^2 + r^2)/(R^2 - r^2) on the inner cylinder, 2 R^2/(R^2 - r^2) on the outer one.

    In potential flow. All momentum of the fluid is that of the forces on walls, to round-off, and so is its moment.
    """
    amplitude, omega = 0.005, 8.0
    period = 2.0 * np.pi / omega

    def motion(t: float) -> tuple[Any, Any, Any]:
        """A sine that grows in the first period, so that no sound is excited."""
        s = min(t / period, 1.0)
        r, r1 = s**3 * (10 - 15 * s + 6 * s * s), 30 * s * s * (1 - s) ** 2 / period
        r2 = 60 * s * (1 - 3 * s + 2 * s * s) / period**2
        sine, cosine = np.sin(omega * t), np.cos(omega * t)
        parts = r * sine, r1 * sine + r * omega * cosine, (r2 - r * omega**2) * sine + 2 * r1 * omega * cosine
        return tuple((amplitude * part, 0.0, 0.0) for part in parts)  # type: ignore[return-value]

    simulation = Simulation(Annulus(motion=motion), threads=1)
    system, columns, series = simulation.system, simulation.columns, []
    while simulation.time < 2.0 * period:
        simulation.advance()
        if simulation.time > period and simulation.step % 5 == 0:
            loads = simulation.wall_loads()
            series.append([simulation.time, loads["inner"].force[0], loads["outer"].force[0]])
    time, inner, outer = np.array(series).T
    waves = np.column_stack([-(omega**2) * np.sin(omega * time), omega * np.cos(omega * time), np.ones(len(time))])
    scale = 1000.0 * np.pi * 0.1**2 * amplitude
    added = [-np.linalg.lstsq(waves, force, rcond=None)[0] / scale for force in (inner, outer)]
    assert added[0][0] == pytest.approx(5.0 / 3.0, rel=0.05)
    assert added[1][0] == pytest.approx(-8.0 / 3.0, rel=0.05)
    assert abs(added[0][1]) < 0.05 * omega  # without viscosity, no force in phase with the velocity

    system.evaluate(simulation.time)
    system.update_loads()
    rows = system.rows[: simulation.fluid_count]
    forces = rows[:, columns.mass, None] * system.rates[:, 2:4]
    arms = system.references()
    np.testing.assert_allclose(forces.sum(axis=0), -system.loads[:, :2].sum(axis=0), atol=1e-11 * np.abs(forces).sum())
    about_origin = system.loads[:, 2].sum() + moments(arms, system.loads[:, :2]).sum()
    torque = moments(rows[:, columns.position], forces)
    assert torque.sum() == pytest.approx(-about_origin, abs=1e-11 * np.abs(torque).sum())


class Drum(Case):
    """A half-full drum of radius 0.15 m that turns about its axis with 4 rad/s, without slip."""

    particle_spacing: float = 0.01
    until: float = 10.0
    frame_interval: float = 1.0
    probe_interval: float = 0.1
    slip: Any = "no"

    def scene(self) -> Scene:
        disc = Circle(centre=(0, 0), radius=0.15)
        above = PolygonRegion(points=((-1, 0), (1, 0), (1, 1), (-1, 1)))
        return Scene(
            walls=(CircleWall(name="drum", centre=(0, 0), radius=0.15, body="drum"),),
            fluid=(DifferenceRegion(of=disc, minus=(above,)),),
            depth=0.15,
            domain=((-0.3, -0.3), (0.3, 0.3)),
            bodies={"drum": Prescribed(lambda t: ((0, 0, 4 * t), (0, 0, 4.0), (0, 0, 0)))},
        )


def test_a_turning_drum_conserves_mass_and_angular_momentum() -> None:
    simulation = Simulation(Drum(), threads=1)
    system, columns, count = simulation.system, simulation.columns, simulation.fluid_count
    mass = system.rows[:count, columns.mass].sum()
    times, momenta, torques, farthest = [], [], [], 0.0
    while simulation.time < 0.3:
        simulation.advance()
        rows = system.rows[:count]
        position, momentum = rows[:, columns.position], rows[:, columns.mass, None] * rows[:, columns.velocity]
        weight = np.array([[0.0, -9.81]]) * rows[:, columns.mass, None]
        times.append(simulation.time)
        farthest = max(farthest, np.hypot(*position.T).max())
        momenta.append(moments(position, momentum).sum())
        torques.append(moments(position, weight).sum() - simulation.wall_loads()["drum"].moment[0])
    assert farthest < 0.15 + 0.02 * 0.01, "nothing is behind the wall, up to its chords"
    assert simulation.fluid_count == count
    assert system.rows[:count, columns.mass].sum() == pytest.approx(mass, rel=1e-14)
    gained = momenta[-1] - momenta[0]
    assert gained > 0.02 * mass * 0.15**2 * 4.0, "the drum drags the water along"
    assert gained == pytest.approx(np.trapezoid(torques, times), rel=0.02)
