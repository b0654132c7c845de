"""Negative pressure at walls: films under a ceiling, contact lines of still water, and suction in a closed box."""

import numpy as np
import pytest

from sphframe import Simulation, load_case
from sphframe.cases.custom import Custom

SPACING, GRAVITY = 0.02, 9.81


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


@pytest.mark.parametrize("treatment", ["fixed-ghosts", "pair-mirror"])
@pytest.mark.parametrize("layers", [1, 2, 4])
def test_a_film_under_a_ceiling_falls_freely(treatment, layers):
    fluid = {"lower": (0.3, 0.6 - layers * SPACING), "upper": (0.7, 0.6), "pressure": 0.0}
    simulation = box((1.0, 0.6), fluid, tension="none", wall_treatment=treatment, guards={"filling": "report"})
    while simulation.time < 0.02:
        simulation.advance()
    fields = simulation.fields()
    middle = np.abs(fields.position[:, 0] - 0.5) < 0.1
    np.testing.assert_allclose(fields.velocity[middle, 1], -GRAVITY * simulation.time, rtol=0.02)


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
