from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sphframe_mdbc import MDBC
from sphframe_mdbc.walls import MDBC2022, MDBC2025

from sphframe import OK, TOO_FEW, InputError, Interpolated, WallPoint, create
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([MDBC()])
def test_has_its_traits(method, check):
    check(method)


@pytest.mark.long
@parametrize_with_checks([MDBC2022(), MDBC2025(), MDBC2025("corrected")])
def test_walls_have_their_traits(treatment, check):
    check(treatment)


@pytest.mark.parametrize(("kind", "name"), [("interpolators", "mdbc"), ("wall_treatments", "mdbc-2022")])
def test_an_amplification_below_one_is_refused(kind, name):
    with pytest.raises(InputError, match="amplification must be a number of at least 1"):
        create(kind, name, amplification=0.5)


class Scene:
    """A wall particle whose mirror point is at the origin, and a linear pressure with dp/dn = b.n."""

    def __init__(self, seed, dim):
        random = np.random.default_rng(seed)
        self.dim = dim
        self.normal = random.normal(size=dim)
        self.normal /= np.linalg.norm(self.normal)
        self.lift = random.uniform(0.01, 0.2) * self.normal  # to the wall particle
        self.force, along = 1e4 * random.normal(size=(2, dim))
        self.gradient = along + ((self.force - along) @ self.normal) * self.normal
        self.fluid, self.wall = random.normal(size=(2, dim))

    def assigned(self, treatment, pressure, *, no_slip=True, neighbours=5, status=OK, extrapolated=False, offset=0.0):
        """Pressure, share, velocity for the continuity and for the viscosity."""
        velocity, viscous = np.full((2, self.dim), np.nan)
        fluid = Interpolated(status, neighbours, 1.0, pressure, extrapolated, offset * self.fluid, self.fluid)
        wall = WallPoint(
            self.normal, 0.5 * self.lift @ self.normal, 0.5 * self.lift @ self.normal, self.lift, -np.eye(self.dim),
            self.wall, self.force, 0.0, np.zeros(self.dim), 0,
        )  # fmt: skip
        assign = treatment.parts(SimpleNamespace(dim=self.dim, no_slip=no_slip)).assign
        return *assign(fluid, wall, None, velocity, viscous), velocity, viscous


scenes = st.builds(Scene, st.integers(0, 2**32 - 1), st.sampled_from([2, 3]))


@given(scene=scenes)
def test_walls_of_2025_lift_the_pressure_along_the_normal_alone(scene):
    """Exact for every linear pressure with dp/dn = b.n, whatever its gradient along the wall."""
    pressure, share, velocity, _ = scene.assigned(MDBC2025(), 300.0)
    assert pressure == pytest.approx(300.0 + scene.gradient @ scene.lift, abs=1e-9)
    assert (share, velocity.tolist()) == (1.0, scene.wall.tolist())
    assert scene.assigned(MDBC2025(), 0.0, neighbours=0)[:2] == (0.0, 0.0)


@given(scene=scenes, no_slip=st.booleans(), rule=st.sampled_from(["published", "corrected"]))
def test_walls_of_2025_reverse_the_velocity_along_the_wall_and_keep_their_own_normal_one(scene, no_slip, rule):
    viscous, n = scene.assigned(MDBC2025(rule), 0.0, no_slip=no_slip)[3], scene.normal
    assert viscous @ n == pytest.approx(scene.wall @ n, abs=1e-13)
    expected = 2.0 * scene.wall - scene.fluid if no_slip else scene.fluid
    assert viscous - (viscous @ n) * n == pytest.approx(expected - (expected @ n) * n, abs=1e-13)


@given(scene=scenes, offset=st.floats(-0.1, 0.1))
def test_walls_of_2022_are_lifted_where_their_gradient_does_not_exist(scene, offset):
    """The average of water at rest, whose mean position is not the mirror point, is lifted from there."""
    pressure, share, velocity, _ = scene.assigned(MDBC2022(), 300.0, extrapolated=True)
    assert (pressure, share, velocity.tolist()) == (300.0, 1.0, scene.wall.tolist())
    average = 300.0 + scene.force @ (offset * scene.fluid)
    pressure = scene.assigned(MDBC2022(), average, status=TOO_FEW, offset=offset)[0]
    assert pressure == pytest.approx(300.0 + scene.force @ scene.lift, abs=1e-8)
