"""A body that follows a file: what is between the lines, how the file is read, and which copy of it a run uses."""

import hashlib
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sphframe import InputError, hookimpl, load_case, resume, run
from sphframe.bodies import DisplacementSeries
from sphframe.cases import written
from sphframe.geometry import to_world
from sphframe.interfaces import RigidBody
from sphframe.testing import checks_of

NOTHING = np.zeros(3)
RAMP = "0 0\n0.1 0\n0.2 0\n0.3 0\n0.5 0.1\n0.9 0.1\n1.0 0.1\n"
"""at rest, 0.1 m in 0.2 s, at rest"""


def series(text: str, **options: Any) -> DisplacementSeries:
    return DisplacementSeries(contents=text, **options)


def at(body: RigidBody, time: float, column: int = 0) -> tuple[float, float, float]:
    motion = body.motion(time, NOTHING, NOTHING, NOTHING)
    return float(motion.position[column]), float(motion.velocity[column]), float(motion.acceleration[column])


@pytest.mark.parametrize("interpolation", ["monotone", "linear"])
def test_a_ramp_stays_within_its_data_and_rests_where_they_rest(interpolation: str) -> None:
    body = series(RAMP, interpolation=interpolation)
    times = np.linspace(-0.2, 1.2, 2801)
    x = np.array([at(body, time) for time in times])
    assert x[:, 0].min() >= -1e-15
    assert x[:, 0].max() <= 0.1 + 1e-15
    assert np.all(np.diff(x[:, 0]) >= -1e-15)
    rests = (times < 0.3 - 1e-9) | (times > 0.5 + 1e-9)
    assert np.all(x[rests, 1:] == 0.0)
    assert x[times == 0.0, 0] == 0.0
    assert at(body, 0.4)[0] == pytest.approx(0.05, abs=1e-12)


def test_series_never_go_beyond_two_neighbouring_values() -> None:
    rng = np.random.default_rng(3)
    time, x = np.cumsum(rng.uniform(0.01, 1.0, 30)), rng.normal(size=30)
    for interpolation in ("monotone", "linear"):
        body = series("\n".join(f"{t!r} {v!r}" for t, v in zip(time.tolist(), x.tolist(), strict=True)),
                      interpolation=interpolation)  # fmt: skip
        for k in range(29):
            between = [at(body, t)[0] + x[0] for t in np.linspace(time[k], time[k + 1], 50)]
            low, high = sorted((x[k], x[k + 1]))
            assert min(between) >= low - 1e-12
            assert max(between) <= high + 1e-12


def test_monotone_slopes_are_those_of_fritsch_and_butland() -> None:
    body = series("0 0\n1 1\n3 2\n4 6\n")
    w1, w2 = 2 * 2 + 1, 2 + 2 * 1  # of the steps 1 and 2, whose slopes are 1 and 1/2
    assert at(body, 1.0)[1] == pytest.approx((w1 + w2) / (w1 / 1.0 + w2 / 0.5), rel=1e-12)
    assert at(body, 0.0)[1] == 0.0
    assert at(body, 4.0) == pytest.approx((6.0, 0.0, 0.0))


def test_a_dense_series_has_the_motion_that_was_sampled() -> None:
    s = np.linspace(0.0, 1.0, 201)
    rows = np.stack([2.0 * s, 0.1 * (10 * s**3 - 15 * s**4 + 6 * s**5)], axis=1)
    body = series("\n".join(f"{time!r},{x!r}" for time, x in rows.tolist()))
    for time in np.linspace(0.0, 2.0, 77):
        s = time / 2.0
        x, u, a = at(body, time)
        assert x == pytest.approx(0.1 * (10 * s**3 - 15 * s**4 + 6 * s**5), abs=1e-6)
        assert u == pytest.approx(0.05 * (30 * s**2 - 60 * s**3 + 30 * s**4), abs=2e-4)
        assert a == pytest.approx(0.025 * (60 * s - 180 * s**2 + 120 * s**3), abs=0.02)


@pytest.mark.parametrize("interpolation", ["monotone", "linear"])
def test_series_keep_the_promises_of_the_interface(interpolation: str) -> None:
    body = series("\n".join(f"{0.07 * k:.2f} {0.02 * k**2} {0.01 * k} {0.03 * k}" for k in range(60)),
                  interpolation=interpolation, columns={"time": "s", "x": "m", "y": "m", "angle": "rad"})  # fmt: skip
    for check in checks_of(body):
        check(body)


def test_columns_and_units_are_those_that_the_file_or_the_case_declares() -> None:
    numbers = "0 10 5 90\n1000 20 6 180\n"
    units = {"time": "ms", "y": "mm", "x": "cm", "angle": "deg"}
    for body in (
        series(numbers, columns=units),
        series("# of the laboratory\n# time (ms), y (mm), x (cm), angle (deg)\n" + numbers),
    ):
        end = body.motion(1.0, NOTHING, NOTHING, NOTHING).position
        assert end == pytest.approx([0.01, 0.01, np.pi / 2])
    assert at(series("0,1\n1,3\n"), 1.0)[0] == 2.0
    assert at(series("0;1;1\n1;3;7\n"), 1.0, 1)[0] == 6.0


@pytest.mark.parametrize("column", ["x", "y", "z", "rx", "ry", "rz"])
def test_each_column_is_its_own_coordinate_in_space(column: str) -> None:
    body = series("0 0\n1 2\n", columns={"time": "s", column: "rad" if column[0] == "r" else "m"})
    moved = body.motion(1.0, *np.zeros((3, 6))).position
    point = to_world(np.array([[3.0, 5.0, 7.0]]), moved, np.zeros(3))[0]
    axis = "xyz".index(column[-1])
    expected = np.array([3.0, 5.0, 7.0])
    if column[0] == "r":
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turned = (expected[i] + 1j * expected[j]) * np.exp(2j)
        expected[[i, j]] = turned.real, turned.imag
    else:
        expected[axis] += 2.0
    assert point == pytest.approx(expected)


def test_a_series_turns_about_the_origin_by_default() -> None:
    body = series("# time (s), angle (deg)\n0 0\n1 90\n")
    turned = to_world(
        np.array([[3.0, 5.0]]), body.motion(1.0, NOTHING, NOTHING, NOTHING).position, np.array(body.centre)
    )
    assert turned[0] == pytest.approx([-5.0, 3.0])


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("0,0", {}, "1 lines of numbers; a motion needs 2"),
        ("time,x\n1,2\n", {}, "line 1: could not convert.*put '#' before"),
        ("0 0\n1 1 1\n", {}, "line 2: 3 columns; expected 2"),
        ("0,0\n0,1\n", {}, "must increase"),
        ("0,0\n1,nan\n", {}, "not finite"),
        ("0 0 0 0\n1 1 1 1\n", {}, r"4 columns and does not say what they hold.*# time \(s\)"),
        ("0,0 0,0\n0,1 0,05\n", {}, "line 1: '0,0 0,0' has commas within its columns.*decimal points"),
        ("0,0;0,0\n0,1;0,05\n", {}, "decimal points"),
        ("# time (s), x (inch)\n0 0\n1 1\n", {}, "unit 'inch' of column 'x' is not known; choose one of m, cm, mm"),
        ("0 0\n1 1\n", {"columns": {"time": "s", "way": "m"}}, "column 'way' is not known"),
        ("0 0\n1 1\n", {"columns": {"time": "s"}}, "2 columns of numbers, but the declared ones are time"),
        ("0 0 0\n1 1 1\n", {"columns": {"time": "s", "angle": "rad", "z": "m"}}, "two dimensions"),
        ("0 0\n1 1\n", {"interpolation": "spline"}, "'monotone' or 'linear'"),
    ],
)
def test_bad_series_are_refused(text: str, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        series(text, **options)


def test_a_series_needs_a_file_that_can_be_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the series"):
        DisplacementSeries(tmp_path / "absent.csv")
    with pytest.raises(InputError, match="needs a path"):
        DisplacementSeries()


def test_a_byte_order_mark_is_read(tmp_path: Path) -> None:
    (tmp_path / "series.txt").write_bytes(b"\xef\xbb\xbf" + RAMP.encode())
    assert at(DisplacementSeries(tmp_path / "series.txt"), 1.0)[0] == 0.1


CASE = """
particle_spacing = 0.04
until = 0.06
probe_interval = 0.01
[[walls]]
shape = "polygon"
name = "tank"
body = "t"
points = [[0, 0.6], [0, 0], [0.6, 0], [0.6, 0.6]]
[bodies.t]
name = "displacement-series"
path = "motion.txt"
[[fluid]]
shape = "box"
lower = [0, 0]
upper = [0.6, 0.4]
"""


@pytest.fixture
def case_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A case file whose motion file lies beside it, seen from another folder that has one of the same name."""
    for folder, way in (("there", 1e-3), ("here", 2e-3)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "motion.txt").write_text(f"0 0\n0.02 {way}\n0.06 {way}\n")
    (tmp_path / "there" / "case.toml").write_text(CASE)
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path / "there" / "case.toml"


def last_displacement(dataset: Any) -> float:
    return float(dataset["body_position"].values[-1, 0, 0])


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
class TestTheFileOfACase:
    def test_it_is_looked_for_beside_the_case_file_first(self, case_file: Path) -> None:
        assert at(load_case(case_file).scene().bodies["t"], 1.0)[0] == 1e-3
        (case_file.parent / "motion.txt").unlink()
        assert at(load_case(case_file).scene().bodies["t"], 1.0)[0] == 2e-3

    def test_it_is_kept_with_the_case_so_that_a_repeated_run_moves_as_the_first(self, case_file: Path) -> None:
        first = run(case_file, output="first.nc", threads=1)
        for folder in (Path(), case_file.parent):
            (folder / "motion.txt").unlink()
        again = run("first.nc", output="again.nc", threads=1)
        assert last_displacement(again.dataset) == last_displacement(first.dataset) == pytest.approx(1e-3, abs=1e-15)
        long = "#" * 200 + "\n0 0\n1 1"
        shown = written(load_case("first.nc", overrides={"bodies.t.contents": long}).bodies["t"])
        assert f"208 characters, sha256 {hashlib.sha256(long.encode()).hexdigest()[:16]}" in shown
        assert "###" not in shown

    def test_a_run_is_resumed_with_the_copy_that_it_began_with(self, case_file: Path) -> None:
        class Interrupting:
            @hookimpl
            def sphframe_step_completed(self, simulation: Any) -> None:
                if simulation.step == 3:
                    os.kill(os.getpid(), signal.SIGINT)

        with pytest.raises(KeyboardInterrupt):
            run(case_file, output="run.nc", threads=1, hooks=[Interrupting()])
        (case_file.parent / "motion.txt").write_text("0 0\n0.02 5e-3\n0.06 5e-3\n")
        with pytest.raises(InputError, match="begun with other parameters"):
            resume("run.nc", case=load_case(case_file), threads=1)
        assert last_displacement(resume("run.nc", threads=1).dataset) == pytest.approx(1e-3, abs=1e-15)
