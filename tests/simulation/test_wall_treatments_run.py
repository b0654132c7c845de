"""Every wall treatment runs with the same bits on any number of threads, and continues from a state to the bit."""

import numba
import numpy as np
import pytest

from sphframe import Simulation, available, load_case

TREATMENTS = [entry.name for entry in available("wall_treatments")]
SMALL = {
    "particle_spacing": 0.06, "until": 1.0, "slip": "no", "frame_interval": 1.0, "probe_interval": 1.0,
    "hydrostatic_lift": "balanced", "tension": "free", "kinematic_viscosity": 1e-3,
}  # fmt: skip


def started(treatment, integrator, threads):
    given = {**SMALL, "wall_treatment": treatment, "integrator": integrator}
    return Simulation(load_case("dam-break", None, given), threads=threads)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("treatment", "integrator"),
    [*((name, "symplectic") for name in TREATMENTS), ("pair-mirror", "rk4"), ("dynamic-2007", "rk4")],
)
def test_runs_continue_to_the_bit_on_any_number_of_threads(treatment, integrator):
    one, two = started(treatment, integrator, 1), started(treatment, integrator, numba.config.NUMBA_NUM_THREADS)
    for _ in range(15):
        one.advance()
    for _ in range(10):
        two.advance()
    again = started(treatment, integrator, 1)
    again.restore(two.state())
    for _ in range(5):
        two.advance()
        again.advance()
    for name, value in one.state().items():
        if name != "clocks":
            np.testing.assert_array_equal(two.state()[name], value, err_msg=name)
            np.testing.assert_array_equal(again.state()[name], value, err_msg=name)
