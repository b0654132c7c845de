"""The built-in cases: what they draw and what they measure."""

import math

import numpy as np
import pytest

from sphframe.cases import Case, Fields
from sphframe.cases.dam_break import DamBreak, connected_extent
from sphframe.cases.hydrostatic_tank import HydrostaticTank
from sphframe.errors import InputError
from sphframe.geometry import fill, wall_groups


def still(position: np.ndarray) -> Fields:
    rest = np.zeros(len(position))
    return Fields(position, np.zeros_like(position), rest, rest)


@pytest.mark.parametrize("case", [HydrostaticTank, DamBreak])
@pytest.mark.parametrize("dimension", [2, 3])
def test_scene_is_consistent(case: type[Case], dimension: int) -> None:
    made = case(dimension=dimension, particle_spacing=0.05)
    scene = made.scene()
    lower, upper = np.array(scene.domain)
    for region in scene.fluid:
        position = fill(region, made.particle_spacing).position
        assert position.shape[1] == dimension
        assert np.all((position > lower) & (position < upper))
        groups = wall_groups(scene.walls, scene.fluid, made.particle_spacing)
        assert not any(group.behind(position).any() for _, group in groups)
    for probe in scene.probes:
        assert len(probe.position) == dimension


@pytest.mark.parametrize(
    ("case", "preset", "particles"), [(HydrostaticTank, "paper", 3000), (DamBreak, "paper", 45_000)]
)
def test_paper_preset_has_the_paper_s_particles(case: type[Case], preset: str, particles: int) -> None:
    made = case(**case.presets[preset])
    assert sum(len(fill(region, made.particle_spacing).position) for region in made.scene().fluid) == particles
    assert made.time_step == 1e-4
    assert made.hydrostatic_lift == "mirror"
    assert made.ghost_velocity == "interpolated"
    assert made.smoothing_length_ratio == 1.3


def test_tank_probes_have_the_paper_s_rest_pressures() -> None:
    tank = HydrostaticTank()
    pressures = [1000.0 * 9.81 * (tank.water_depth - probe.position[1]) for probe in tank.scene().probes]
    assert pressures == pytest.approx([2943.0, 1962.0, 981.0, 490.5])


def test_dam_break_scales_with_the_water_height() -> None:
    case = DamBreak(water_height=0.3)
    assert (case.water_length, case.tank_length) == pytest.approx((0.6, 5.366 * 0.3))
    assert case.until * math.sqrt(9.81 / 0.3) == pytest.approx(7.0)
    assert DamBreak(water_height=0.3, water_length=0.5).water_length == 0.5


def test_sensor_is_buchner_s() -> None:
    sensor = DamBreak().scene().probes[0]
    assert sensor.name == "P1"
    assert sensor.position == pytest.approx((3.2196, 0.160))
    assert sensor.radius == pytest.approx(0.045)
    assert sensor.tangent == (0.0, 1.0)


def test_initial_pressure_is_the_series() -> None:
    scene = DamBreak().scene()
    assert scene.initial_pressure is not None
    pressure = scene.initial_pressure(np.array([[0.0, 0.3], [1.2, 0.1]]))
    assert pressure / (1000.0 * 9.81 * 0.6) == pytest.approx([0.45155, 0.0], abs=1e-4)
    width_does_not_matter = DamBreak(dimension=3).scene().initial_pressure
    assert width_does_not_matter is not None
    assert width_does_not_matter(np.array([[0.0, 0.1, 0.3], [1.2, 0.2, 0.1]])) == pytest.approx(pressure)


@pytest.mark.parametrize("dimension", [2, 3])
def test_diagnostics_start_as_the_column(dimension: int) -> None:
    case = DamBreak(dimension=dimension, particle_spacing=0.05)
    scene = case.scene()
    fluid = still(fill(scene.fluid[0], case.particle_spacing).position)
    measured = {diagnostic.name: diagnostic.function(fluid) for diagnostic in scene.diagnostics}
    assert measured == pytest.approx({"front_position": 1.2, "column_height": 0.6})


def test_a_splash_drop_is_not_the_front() -> None:
    case = DamBreak(particle_spacing=0.02)
    scene = case.scene()
    front = next(d.function for d in scene.diagnostics if d.name == "front_position")
    column = fill(scene.fluid[0], case.particle_spacing).position
    a_drop_ahead = np.vstack([column, [[1.6, 0.01], [2.9, 0.01]]])
    assert front(still(a_drop_ahead)) == pytest.approx(1.2)
    a_drop_above = np.vstack([column, [[1.21, 0.4], [1.4, 0.3]]])
    assert front(still(a_drop_above)) == pytest.approx(1.2)
    a_tongue = np.vstack([column, [[1.2 + 0.03 * k, 0.01] for k in range(1, 5)]])
    assert front(still(a_tongue)) == pytest.approx(1.2 + 0.12 + 0.01)


def test_connected_extent_of_nothing_is_zero() -> None:
    assert connected_extent(np.array([]), gap=0.1) == 0.0
    assert connected_extent(np.array([0.5, 0.6]), gap=0.1) == 0.0


def test_derived_defaults_are_recorded_but_not_counted_as_given() -> None:
    case = DamBreak(water_height=0.5)
    assert case.model_dump()["water_length"] == 1.0
    assert case.model_dump(exclude_unset=True) == {"water_height": 0.5}


def test_made_in_python_a_wrong_parameter_is_an_input_error() -> None:
    with pytest.raises(InputError, match=r"water_heigth is not a parameter; did you mean 'water_height'"):
        DamBreak(water_heigth=0.5)


def test_smoothing_length_follows_the_dimension() -> None:
    assert HydrostaticTank().smoothing_length_ratio == 1.3
    assert HydrostaticTank(dimension=3).smoothing_length_ratio == 1.1
