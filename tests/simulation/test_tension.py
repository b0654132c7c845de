"""Negative pressure at walls: contact lines of still water, and suction in a closed box; films: see treatments."""

import numpy as np
import pytest

from sphframe import Simulation, load_case
from sphframe.cases.custom import Custom

SPACING = 0.02


def box(upper, fluid, **parameters):
    """A closed box from the origin to ``upper``, with one region of ``fluid``."""
    return Simulation(
        Custom(
            particle_spacing=SPACING, sound_speed=20.0, until=1.0, frame_interval=1.0, probe_interval=1.0,
            walls=[{"shape": "box", "lower": (0.0, 0.0), "upper": upper}], fluid=[{"shape": "box", **fluid}],
            **parameters,
        ),
        threads=1,
    )  # fmt: skip


def test_the_contact_line_of_still_water_stays_where_it_is():
    speeds = {}
    for tension in ("none", "bounded"):
        given = {"particle_spacing": 0.03, "until": 0.2, "tension": tension}
        simulation = Simulation(load_case("hydrostatic-tank", None, given), threads=1)
        fastest = 0.0
        while simulation.time < 0.15:
            simulation.advance()
            fastest = max(fastest, float(np.abs(simulation.fields().velocity).max()))
        speeds[tension] = fastest
    assert speeds["none"] < 0.01
    assert speeds["bounded"] > 2.0 * speeds["none"]


@pytest.mark.parametrize(("tension", "kept"), [("free", True), ("bounded", False)])
def test_suction_in_a_closed_box(tension, kept):
    fluid = {"lower": (0.0, 0.0), "upper": (0.4, 0.4), "pressure": -2000.0}
    simulation = box((0.4, 0.4), fluid, tension=tension, gravity=0.0)
    while simulation.time < 0.02:
        simulation.advance()
    pressure = simulation.fields().pressure
    assert bool(np.all(np.abs(pressure + 2000.0) < 20.0)) == kept


def test_walls_bear_the_pressure_of_a_particle_in_a_corner():
    # nothing else fills its kernel, so that its ghosts lie above the surface, but 20 kPa are not those of a surface
    fluid = {"lower": (0.0, 0.0), "upper": (SPACING, SPACING), "pressure": 20e3}
    simulation = box((0.4, 0.4), fluid, tension="none", gravity=0.0)
    for _ in range(5):
        simulation.advance()
    assert simulation.fluid_count == 1
    assert np.all(simulation.fields().velocity > 0.1)


def test_corner_ghosts_within_reach_count_whole_under_still_water():
    """Also for a method at the ghost, whose filling there depends on the ghosts around it."""
    for method in ("improved-shepard", "adami"):
        given = {"particle_spacing": 0.03, "until": 0.1, "tension": "none", "interpolator": method}
        simulation = Simulation(load_case("hydrostatic-tank", None, given), threads=1)
        boundary, columns, fluid = simulation.system.boundary, simulation.columns, simulation.fields().position
        distance = np.linalg.norm(boundary.position[:, None] - fluid, axis=2).min(axis=1)
        reached = (distance < 3.7 * 0.03) & (boundary.position[:, 1] < 0.0)
        share = simulation.system.rows[simulation.fluid_count :, columns.volume] / boundary.volume
        corners = reached & ((boundary.position[:, 0] < 0.0) & (boundary.position[:, 1] < -0.06))
        assert corners.any()
        np.testing.assert_allclose(share[reached], 1.0, err_msg=method)
