from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sphframe_pair_mirror import PairMirror

from sphframe import FluidSide, Separation, WallSide
from sphframe.testing import parametrize_with_checks

numbers = st.floats(-100.0, 100.0)
vectors = st.tuples(numbers, numbers, numbers)


@parametrize_with_checks([PairMirror()])
def test_has_its_traits(treatment, check):
    check(treatment)


def seen(pressure, velocity, wall_velocity, separation, force=(0.0, 0.0, 0.0), **options):
    """What a particle sees of a wall particle."""
    names = ("wall_u", "wall_v", "wall_w", "bx", "by", "bz")
    given = dict(zip(names, (*wall_velocity, *force), strict=True))
    wall = WallSide(**{**dict.fromkeys(WallSide._fields, 0.0), **given})
    parts = PairMirror(**options).parts(SimpleNamespace(no_slip=True))
    r2 = float(np.dot(separation, separation))
    return parts.seen(FluidSide(pressure, 1000.0, *velocity), wall, Separation(*separation, r2), None)


@given(numbers, vectors, vectors, vectors)
def test_a_pair_does_the_work_of_its_force_on_a_wall_that_moves(pressure, velocity, wall_velocity, separation):
    """Per V_i V_G W'/r the fluid gains (p_i + p_G) x.u_i + p_i x.(u_G - u_i), the force times u_w."""
    found = seen(pressure, velocity, wall_velocity, separation, lift=False)
    x, u, w = (np.array(v) for v in (separation, velocity, wall_velocity))
    gained = found.pressure_sum * x @ u + pressure * x @ (np.array([found.u, found.v, found.w]) - u)
    assert gained == pytest.approx(found.pressure_sum * x @ w, abs=1e-8)
    assert found[1:4] == found[4:] == pytest.approx(tuple(2.0 * w - u), abs=1e-12)


@given(numbers, vectors, vectors)
def test_the_pressure_is_lifted_from_the_particle_to_the_wall_particle(pressure, separation, force):
    nothing = (0.0, 0.0, 0.0)
    expected = 2.0 * pressure + np.dot(force, separation)
    assert seen(pressure, nothing, nothing, separation, force).pressure_sum == pytest.approx(expected, abs=1e-9)
    assert seen(pressure, nothing, nothing, separation, force, lift=False).pressure_sum == 2.0 * pressure
