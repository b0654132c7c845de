"""Sensors: points and discs, wet and dry, at rest and carried by a body."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from sphframe import InputError, Simulation, load_case, run
from sphframe.cases import Custom, Gauge, Probe
from sphframe.interfaces import Motion
from sphframe.output.contents import sample_count
from sphframe.simulation.probes import Gauges, PressureProbes, Readings

DISC = Probe(name="disc", position=(0.0, 1.0), radius=0.2, tangent=(0.0, 1.0))
POINT = Probe(name="point", position=(0.5, 0.5))


def read(probes: PressureProbes, pressures, fillings=0.5) -> Readings:
    """What probes on walls, whose kernel is half within the wall, read."""
    count = len(probes.points)
    return probes.readings(np.broadcast_to(pressures, count), np.broadcast_to(fillings, count), np.full(count, 0.5))


def test_a_disc_averages_over_its_area():
    probes = PressureProbes([DISC, POINT], 2)
    average = read(probes, 100.0 + 3.0 * probes.points[:, 1] ** 2).pressure
    # the mean of z^2 over a disc of radius a centred at z0 is z0^2 + a^2/4
    assert average[0] == pytest.approx(100.0 + 3.0 * (1.0 + 0.2**2 / 4.0), rel=1e-3)
    assert average[1] == pytest.approx(100.75)


def test_negative_pressures_are_clipped_to_zero_at_a_disc_and_not_at_a_point():
    assert list(read(PressureProbes([DISC, POINT], 2), -5.0).pressure) == [0.0, -5.0]


def test_a_tangent_is_a_direction():
    long = DISC.model_copy(update={"tangent": (0.0, 7.0)})
    np.testing.assert_allclose(PressureProbes([long], 2).points, PressureProbes([DISC], 2).points, atol=1e-15)


def test_a_dry_probe_reads_nothing():
    probes = PressureProbes([DISC, POINT], 2)
    dry = read(probes, 7.0, 0.2)
    assert list(dry.wet) == [False, False]
    assert list(dry.pressure) == [0.0, 0.0]
    half = read(probes, 7.0, np.where(probes.points[:, 1] > 1.0, 0.0, 0.5))
    assert half.wet[0]
    assert 3.0 < half.pressure[0] < 4.5


def test_instruments_move_with_their_bodies():
    carried = PressureProbes([Probe(name="a", position=(2.0, 0.0), body="b"), POINT], 2, ["c", "b"])
    motions = [Motion(*np.zeros((3, 3))), Motion(np.array([0.1, 0.2, np.pi / 2]), *np.zeros((2, 3)))]
    centres = np.array([[0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_allclose(carried.present_points(motions, centres), [[1.1, 1.2], [0.5, 0.5]], atol=1e-15)
    gauges = Gauges([Gauge(name="g", position=(2.0,), body="b"), Gauge(name="h", position=(3.0,))],
                    np.zeros(2), np.ones(2), 0.5, ["c", "b"])  # fmt: skip
    np.testing.assert_allclose(np.unique(gauges.present_points(motions)[:, 0]), [2.1, 3.0])


@settings(max_examples=50)
@given(arrays(np.float64, (2, 8), elements=st.floats(0.0, 1.0).filter(lambda f: abs(f - 0.5) > 1e-3)))
def test_a_gauge_reads_the_highest_water_and_how_much_of_its_line_is_wet(fillings):
    two = [Gauge(name="a", position=(0.0,)), Gauge(name="b", position=(0.0,))]
    gauges = Gauges(two, np.zeros(2), np.full(2, 0.875), 0.125)
    heights, fine = gauges.points[:8, 1], np.linspace(0.0, 0.875, 70_001)
    for filling, elevation, depth in zip(fillings, *gauges.readings(fillings), strict=True):
        wet = np.interp(fine, heights, filling) >= 0.5
        assert depth == pytest.approx(0.875 * wet.mean(), abs=1e-4)
        if wet[-1] or not wet.any():
            assert np.isnan(elevation)
        else:
            assert elevation == pytest.approx(fine[wet].max(), abs=2e-5)


BOX = {"shape": "box", "lower": [0, 0], "upper": [0.6, 0.32]}


def tank(walls=None, **options) -> Custom:
    """A tank of 0.6 m with water 0.32 m deep."""
    outline = {"shape": "polygon", "name": "tank", "points": [[0, 0.6], [0, 0], [0.6, 0], [0.6, 0.6]]}
    common = {"particle_spacing": 0.04, "until": 0.2, "probe_interval": 0.01, "fluid": [BOX]}
    return Custom(**{**common, "walls": walls or [outline], **options})


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
class TestInATank:
    def test_a_probe_in_air_is_dry_and_one_in_a_corner_is_wet(self):
        places = {"bed": (0.3, 0), "corner": (0, 0), "inside": (0.3, 0.2), "waterline": (0.6, 0.3), "air": (0.3, 0.35),
                  "above": (0.6, 0.36), "far": (0.3, 0.55)}  # fmt: skip
        simulation = Simulation(tank(probes=[Probe(name=n, position=p) for n, p in places.items()]), threads=1)
        pressure, wet = simulation.probe_readings()
        assert dict(zip(places, wet, strict=True)) == {
            "bed": True, "corner": True, "inside": True, "waterline": True, "air": False, "above": False, "far": False,
        }  # fmt: skip
        assert list(pressure[-3:]) == [0.0, 0.0, 0.0]
        assert pressure[:3] == pytest.approx([3139.0, 3139.0, 1177.0], rel=0.02)

    def test_discs_read_the_same_for_any_length_of_their_tangent(self):
        discs = [Probe(name=str(k), position=(0.6, 0.28), radius=0.1, tangent=(0, k)) for k in (1.0, 0.2)]
        pressures = Simulation(tank(probes=discs), threads=1).probe_pressures()
        assert pressures[0] == pressures[1] > 0.0

    def test_a_probe_in_the_bed_of_a_lifted_tank_remains_at_its_pressure(self, tmp_path):
        s = np.linspace(0.0, 1.0, 41)
        lift = np.stack([s * 0.8, 0.0 * s, 0.06 * (10 * s**3 - 15 * s**4 + 6 * s**5)], axis=1)
        (tmp_path / "lift.txt").write_text("\n".join(" ".join(map(repr, row)) for row in lift.tolist()))
        walls = [{"shape": "polygon", "name": "tank", "body": "t", "points": [[0, 0.6], [0, 0], [0.6, 0], [0.6, 0.6]]}]
        case = tank(walls, until=0.8, bodies={"t": {"name": "displacement-series", "path": str(tmp_path / "lift.txt")}},
                    probes=[Probe(name="bed", position=(0.3, 0), body="t"), Probe(name="left", position=(0.3, 0))],
                    gauges=[Gauge(name="middle", position=(0.3,), body="t")])  # fmt: skip
        result = run(load_case(case), output=tmp_path / "run.nc", threads=1).dataset
        late = result.isel(probe_time=result.probe_time.values > 0.05)
        expected = 0.32 * 1000.0 * (9.81 + np.gradient(np.gradient(lift[:, 2], lift[:, 0]), lift[:, 0]))
        expected = np.interp(late.probe_time.values, lift[:, 0], expected)
        pressure = late.probe_pressure.sel(probe="bed").values
        smooth = np.convolve(pressure - expected, np.ones(9) / 9.0, "valid")
        assert np.abs(smooth).max() < 0.04 * 3139.0
        assert late.probe_wet.sel(probe="bed").values.all()
        assert list(result.probe_body.values) == [0, -1]
        assert not late.probe_wet.sel(probe="left").values[-1], "the probe at rest is below the lifted bed"

    def test_a_probe_of_an_unknown_body_is_refused(self):
        with pytest.raises(InputError, match="probe 'a' belongs to body 'b', which is not given; bodies: none"):
            load_case(tank(probes=[Probe(name="a", position=(0.3, 0), body="b")]))

    @pytest.mark.parametrize("options", [{}, {"probe_interval": 0.0123}, {"time_step": 1e-3, "probe_interval": 1e-3}])
    def test_a_complete_file_has_no_padding_for_any_reader(self, tmp_path, options):
        run(tank(until=0.05, **options), output=tmp_path / "run.nc", threads=1)
        with xr.open_dataset(tmp_path / "run.nc", decode_times=False) as dataset:
            times = dataset["probe_time"].values
            assert np.all(np.diff(times) > 0.0)
            assert dataset["mass"].sel(probe_time=0.0) > 0.0
            assert float(dataset["kinetic_energy"].interp(probe_time=0.02)) >= 0.0


@pytest.mark.parametrize(("until", "interval", "count"), [(1.0, 0.1, 11), (0.99, 0.1, 10), (20000.0, 1e-3, 20_000_001)])
def test_samples_are_counted_as_they_are_taken(until, interval, count):
    assert sample_count(until, interval, None) == count


def test_names_are_printed_as_they_are(tmp_path: Path):
    from typer.testing import CliRunner

    from sphframe.cli.app import app

    (tmp_path / "markup.toml").write_text(
        """
        particle_spacing = 0.04
        until = 0.02
        walls = [{shape = "box", name = "[bold]tank", lower = [0, 0], upper = [0.6, 0.6], open_faces = ["+y"]}]
        fluid = [{shape = "box", lower = [0, 0], upper = [0.6, 0.32]}]
        probes = [{name = "[/b]", position = [0.2, 0]}]
        """
    )
    arguments = ["run", str(tmp_path / "markup.toml"), "--output", str(tmp_path / "[red].nc"), "--threads", "1"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "peak at [/b]" in result.output
    assert "[red].nc" in result.output
