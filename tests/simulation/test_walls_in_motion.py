"""Walls that stand, move and float, with water around them."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from sphframe.bodies import Prescribed
from sphframe.cases import Case, Gauge, Probe, Scene
from sphframe.cases.floating_body import FloatingBody
from sphframe.geometry import BoxWall, PolygonRegion, PolygonWall
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


def test_tank_swung_with_no_net_change_returns_to_rest() -> None:
    span, way = 3.0, 0.1

    def there_and_back(t: float) -> tuple[Any, Any, Any]:
        s = min(t / span, 1.0)
        p = np.polynomial.Polynomial([0, 0, 0, 0, 1, -4, 6, -4, 1]) * 256.0 * way  # 256 s^4 (1 - s)^4
        values = [p(s), p.deriv()(s) / span, p.deriv(2)(s) / span**2]
        if t > span:
            values = [0.0, 0.0, 0.0]
        return tuple((value, 0.0, 0.0) for value in values)  # type: ignore[return-value]

    simulation = Simulation(TankInMotion(motion=there_and_back), threads=1)
    start = simulation.fields().position
    fastest = 0.0
    while simulation.time < 3.6:
        simulation.advance()
        fastest = max(fastest, simulation.energies()["kinetic"])
    assert simulation.energies()["kinetic"] < 0.01 * fastest
    assert np.abs(np.mean(simulation.fields().position - start, axis=0)).max() < 0.25 * 0.02
    assert simulation.particles_outside() == 0


@pytest.mark.slow
def test_floating_box_finds_archimedes_draught() -> None:
    case = FloatingBody(
        depth=0.3, tank_length=0.8, box_length=0.24, box_height=0.16, particle_spacing=0.01, initial_draught=0.06
    )
    simulation = Simulation(case, threads=1)
    draughts = []
    while simulation.time < 3.0:
        simulation.advance()
        if simulation.time > 1.5 and simulation.step % 20 == 0:
            bottom = 0.3 - 0.06 + simulation.body_motions()["box"].position[1]
            draughts.append(float(np.mean(simulation.gauge_elevations())) - bottom)
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
