"""Wall treatments continue from a state to the bit; in long tests all of them, on any number of threads.

Without tension, none holds water up: films under a ceiling fall, contact lines stay, nothing hangs on walls. All these
cases have the parameters of ``SMALL``, so that the loops of a treatment are compiled once; the viscosity is that of
water, which the films do not feel. Those of one treatment of each class run here, the others are long tests.
"""

import numba
import numpy as np
import pytest

from sphframe import Simulation, available, create, load_case
from sphframe.cases.custom import Custom

TREATMENTS = [entry.name for entry in available("wall_treatments")]
SMALL = {
    "particle_spacing": 0.06, "until": 3.0, "slip": "no", "frame_interval": 1.0, "probe_interval": 1.0,
    "hydrostatic_lift": "balanced", "tension": "none", "kinematic_viscosity": 1e-6,
}  # fmt: skip
REPELLING = ("lennard-jones", "monaghan-kajtar-2009")
"""forces of these do not depend on the pressure: they never attract, and repel whatever is within their range"""


MOST = numba.config.NUMBA_NUM_THREADS
CLASSES = ("fixed-ghosts", "dynamic-2007", "mirror-images", "pair-mirror")
"""treatments whose walls are ghosts that are filled, particles with a state, images, and seen by each pair"""
PLAIN, FREE, IN_SPACE = {}, {"tension": "free"}, {"dimension": 3}
VARIANTS = [
    *((name, PLAIN) for name in TREATMENTS),
    *((name, IN_SPACE) for name in ("fixed-ghosts", "dynamic-2007", "lennard-jones", "mirror-images", "pair-mirror")),
    *((name, FREE) for name in ("fixed-ghosts", "edge-integrals", "mirror-images", "pair-mirror")),
    *((name, {"slip": "free"}) for name in ("fixed-ghosts", "mdbc-2025", "riemann-2017", "usaw-2013")),
    ({"name": "akinci-2012", "row": True}, PLAIN),
    ({"name": "distance-ratio", "continuity": "ratio", "cap": 1.5}, PLAIN),
    ({"name": "dynamic-2007", "diffusion": 0.1}, PLAIN),
    ({"name": "fixed-ghosts", "continuity": "free-slip"}, PLAIN),
    ({"name": "lennard-jones", "steep": True, "strength": 0.01}, PLAIN),
    ({"name": "mdbc-2025", "velocity": "corrected"}, PLAIN),
    ({"name": "monaghan-kajtar-2009", "shifted": True}, PLAIN),
    ({"name": "pair-mirror", "lift": False}, PLAIN),
    ({"name": "riemann-2017", "limiter": 0.0}, PLAIN),
]
"""all treatments, their options that change a loop, and some in 3-D, with another tension or with free slip"""


def described(value):
    if value == {}:
        return "default"
    return ",".join(f"{key}={v}" for key, v in value.items()) if isinstance(value, dict) else None


def started(treatment, integrator, threads, changes):
    given = {**SMALL, "wall_treatment": treatment, "integrator": integrator, **changes}
    return Simulation(load_case("dam-break", None, given), threads=threads)


def run_and_continue(treatment, integrator, threads, changes):
    one, two = (started(treatment, integrator, count, changes) for count in (1, threads))
    for _ in range(15):
        one.advance()
    for _ in range(10):
        two.advance()
    again = started(treatment, integrator, 1, changes)
    again.restore(two.state())
    for _ in range(5):
        two.advance()
        again.advance()
    for name, value in one.state().items():
        if name != "clocks":
            np.testing.assert_array_equal(two.state()[name], value, err_msg=name)
            np.testing.assert_array_equal(again.state()[name], value, err_msg=name)


@pytest.mark.slow
@pytest.mark.parametrize("treatment", CLASSES)
@pytest.mark.parametrize("integrator", ["symplectic", "rk4"])
def test_runs_continue_to_the_bit(treatment, integrator):
    run_and_continue(treatment, integrator, 1, PLAIN)


@pytest.mark.long
@pytest.mark.parametrize(("treatment", "changes"), VARIANTS, ids=described)
def test_threads_do_not_change_the_bits_of_any_treatment(treatment, changes):
    run_and_continue(treatment, "symplectic", MOST, changes)


def in_classes(treatments):
    """The parameters of a test that is long for treatments which are not named in CLASSES."""
    return [pytest.param(name, marks=[] if name in CLASSES else pytest.mark.long) for name in treatments]


@pytest.mark.parametrize("treatment", in_classes(name for name in TREATMENTS if name not in REPELLING))
def test_films_and_a_drop_under_a_ceiling_fall_freely(treatment):
    spacing, gravity = 0.02, 9.81
    films = [
        {"shape": "box", "lower": (0.4 * n - 0.2, 0.6 - n * spacing), "upper": (0.4 * n + 0.1, 0.6), "pressure": 0.0}
        for n in (1, 2, 3, 4)
    ]
    drop = {"shape": "circle", "centre": (2.0, 0.5), "radius": 0.1, "pressure": 0.0}
    given = {**SMALL, "particle_spacing": spacing, "wall_treatment": treatment}
    walls = [{"shape": "box", "lower": (0.0, 0.0), "upper": (2.3, 0.6)}]
    case = Custom(**given, sound_speed=20.0, walls=walls, fluid=[*films, drop], guards={"filling": "report"})
    simulation = Simulation(case, threads=1)
    while simulation.time < 0.02:
        simulation.advance()
    np.testing.assert_allclose(simulation.fields().velocity[:, 1], -gravity * simulation.time, rtol=0.02)


STILL = [name for name in TREATMENTS if create("wall_treatments", name).traits.exact_hydrostatic]


@pytest.mark.parametrize("treatment", in_classes(STILL))
def test_the_contact_line_of_still_water_stays_flat(treatment):
    given = {**SMALL, "particle_spacing": 0.03, "wall_treatment": treatment}
    simulation = Simulation(load_case("hydrostatic-tank", None, given), threads=1)
    start = simulation.fields().position
    top = start[:, 1] > start[:, 1].max() - 0.01
    while simulation.time < 0.2:
        simulation.advance()
    moved = np.abs(simulation.fields().position[top] - start[top])
    assert moved.max() < 0.1 * 0.03


@pytest.mark.parametrize("treatment", CLASSES)
def test_nothing_hangs_on_walls_after_a_dam_break(treatment):
    """validation/wall_treatments has all treatments.

    What has stayed at a wall for 0.1 s has water below it, within a cone of 45 degrees, at t sqrt(g/H) = 10."""
    simulation = Simulation(load_case("dam-break", None, {**SMALL, "wall_treatment": treatment}), threads=1)
    spacing, (width, height), places = 0.06, (5.366 * 0.6, 1.8), []
    for end in (2.38, 2.48):
        while simulation.time < end:
            simulation.advance()
        places.append(simulation.fields().position)
    before, after = places
    distance = np.minimum(np.minimum(after[:, 0], width - after[:, 0]), height - after[:, 1])
    held = (np.linalg.norm(after - before, axis=1) < 0.5 * spacing) & (distance < 1.5 * spacing)
    lower = after[held, None, 1] - after[:, 1]
    aside = np.abs(after[held, None, 0] - after[:, 0])
    supported = np.any((lower > 0.0) & (lower < 3.0 * spacing) & (aside < lower), axis=1)
    np.testing.assert_array_less(after[held][~supported, 1], 1.5 * spacing)
    assert simulation.particles_outside() == 0
