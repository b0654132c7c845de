"""Orders of convergence: fields, fits, what is measured of treatments, and wrong factors that must be found."""

import importlib
import inspect
import json
import math
import sys
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
import pytest

from sphframe import FixedGhosts, InputError, Order, Orders, create
from sphframe.cli.verify import verify as print_verification
from sphframe.testing import Fit, OrderReport, measure_order, verify_order
from sphframe.testing.junit import write_junit
from sphframe.testing.order_fields import DENSITY, GRAVITY, RADIUS, WALLS, gradient
from sphframe.testing.order_scenes import Beside

COARSE = (20, 28, 40)
STEP = 1e-5


def on_wall(name):
    """Points on a wall, and unit vectors along it."""
    s = np.linspace(0.05, 0.95, 7)
    if name == "straight":
        points = np.stack([s, 0.0 * s], axis=1)
    elif name == "circle":
        points = RADIUS * np.stack([np.cos(6.0 * s), np.sin(6.0 * s)], axis=1)
    else:
        points = np.stack([s, 0.05 * np.cos(2.0 * np.pi * s)], axis=1)
    normal = WALLS[name].normal(points)
    return points, normal, np.stack([normal[:, 1], -normal[:, 0]], axis=1)


def difference(field, points, direction):
    return (field(points + STEP * direction) - field(points - STEP * direction)) / (2.0 * STEP)


@pytest.mark.parametrize("name", WALLS)
def test_fields_meet_their_conditions_on_the_wall(name):
    wall = WALLS[name]
    points, normal, along = on_wall(name)
    np.testing.assert_allclose(wall.level(*points.T), 0.0, atol=1e-15)
    np.testing.assert_allclose(wall.no_slip(points), 0.0, atol=1e-14)
    assert np.abs(difference(wall.no_slip, points, normal)).max() > 0.5
    np.testing.assert_allclose((wall.slip(points) * normal).sum(axis=1), 0.0, atol=1e-14)
    slope = (difference(lambda p: wall.pressure(p)[:, None], points, normal)[:, 0],)
    np.testing.assert_allclose(slope[0], DENSITY * normal @ np.array(GRAVITY), atol=1e-4 * DENSITY)
    if name != "wavy":  # no stress: du_t/dn + du_n/dt = 0
        shear = (difference(wall.slip, points, normal) * along).sum(axis=1)
        shear += (difference(wall.slip, points, along) * normal).sum(axis=1)
        np.testing.assert_allclose(shear, 0.0, atol=1e-7)
    inside = points + 0.07 * normal
    for velocity in (wall.no_slip, wall.slip):
        x, y = (difference(velocity, inside, np.tile(axis, (7, 1)))[:, k] for k, axis in enumerate(np.eye(2)))
        np.testing.assert_allclose(x + y, 0.0, atol=1e-8)
    np.testing.assert_allclose(
        gradient(wall.level, inside)[:, 1],
        difference(lambda p: wall.level(*p.T), inside, np.array([0.0, 1.0])),
        atol=1e-8,
    )


def test_a_fit_finds_order_and_error():
    counts = np.array([20, 28, 40, 56])
    fit = Fit.of(counts, 0.3 * (32.0 / counts) ** 1.5)
    assert fit.order == pytest.approx(1.5)
    assert fit.error == pytest.approx(0.3)
    assert fit.spread < 1e-9
    noisy = Fit.of(counts, 0.3 * (32.0 / counts) ** 1.5 * np.array([1.1, 0.9, 1.1, 0.9]))
    assert abs(noisy.order - 1.5) < noisy.spread < 1.0
    assert Fit.of(counts, [0.0, 1e-12, 0.0, 0.0]).order == math.inf


def test_the_reference_is_the_sum_of_the_solver():
    """Where the treatment is exact, both differ by round-off: linear pressure in balance, and uniform velocity."""
    beside = Beside(FixedGhosts(), WALLS["straight"], 20, "no")
    sums = beside.arrange("lattice")

    def still(points):
        return DENSITY * (3.0 + points @ np.array(GRAVITY))

    found = beside.rates(pressure=still)[sums.chosen]
    scale = np.abs(sums.pressure_gradient(still)).max()
    np.testing.assert_allclose(-found[:, :2], sums.pressure_gradient(still), atol=1e-7 * scale)
    np.testing.assert_allclose(found[:, 3:], np.tile(DENSITY * np.array(GRAVITY), (len(found), 1)), rtol=1e-5)

    def shear(points):
        return np.stack([points[:, 1], 0.0 * points[:, 1]], axis=1)

    found = beside.rates(velocity=shear)[sums.chosen]
    np.testing.assert_allclose(found[:, :2] / DENSITY, sums.laplacian(shear), atol=1e-8)
    np.testing.assert_allclose(found[:, 2:3], sums.divergence(shear), atol=1e-9)


@pytest.mark.parametrize(
    ("name", "pressure", "viscosity", "shear"), [("fixed-ghosts", 2.0, 0.0, 2.0), ("mdbc-2022", 1.0, -1.0, 1.0)]
)
def test_orders_at_a_straight_wall(name, pressure, viscosity, shear):
    """Rules that are exact on shear are of second order in the flow, the velocity of the wall is of first."""
    treatment = create("wall_treatments", name)
    report = measure_order(treatment, walls=["straight"], arrangements=["lattice"], slips=["no"], counts=COARSE)
    assert report.failures() == []
    assert set(report.fits) == {"pressure", "divergence", "viscosity", "shear", "density_gradient"}
    found = [report.straight(operator).order for operator in ("pressure", "viscosity", "shear")]
    np.testing.assert_allclose(found, [pressure, viscosity, shear], atol=0.1)
    assert report.lowest("pressure") is None


def a_report(order, errors=(0.4, 0.2, 0.1), place=("straight", "lattice"), **promise):
    fits = {"pressure": {place: Fit.of((20, 40, 80), errors)}}
    return OrderReport("mine", "wall_treatments", (20, 40, 80), Orders(pressure=order), fits, **promise)


def test_promises_are_test_cases_in_junit(tmp_path):
    broken = OrderReport("lost", "wall_treatments", (20,), Orders(), {}, "cannot be made: no width")
    write_junit([a_report(Order(1, 0)), a_report(Order(2, 0)), broken], tmp_path / "orders.xml")
    suites = list(ElementTree.parse(tmp_path / "orders.xml").getroot())
    assert [(suite.get("tests"), suite.get("failures"), suite.get("errors")) for suite in suites] == [
        ("1", "0", "0"), ("1", "1", "0"), ("1", "0", "1"),
    ]  # fmt: skip
    assert suites[1].find("testcase").get("name") == "order of the pressure"
    assert suites[1].find(".//failure").get("message").endswith("2 is promised")


def test_a_promise_is_an_order_at_the_straight_wall_another_elsewhere_and_an_error():
    assert not a_report(Order(1, 0)).broken
    assert not a_report(None).broken
    (failure,) = a_report(Order(2, 0)).failures()
    assert failure == "pressure: order 1.00 +- 0.00 at the straight wall, lattice; 2 is promised"
    assert not a_report(Order(2, 1), place=("circle", "jittered")).broken
    assert a_report(Order(1, 2), place=("circle", "jittered")).broken
    assert not a_report(Order(1, None), errors=(0.1, 0.2, 0.4), place=("circle", "jittered")).broken
    assert not a_report(Order(1, 0, error=0.25)).broken
    for error in (0.2, 0.26):
        (failure,) = a_report(Order(1, 0, error=error)).failures()
        assert failure == f"pressure: error 0.25 at the straight wall with 32 spacings; {error} is promised"
    json.dumps(a_report(Order(2, 0)).as_data(), allow_nan=False)


def test_the_command_prints_a_table_and_fails_where_a_promise_does_not_hold(monkeypatch, capsys):
    reports = {"held": a_report(Order(1, 0)), "broken": a_report(Order(2, 0))}
    monkeypatch.setattr("sphframe.testing.verify_order", lambda names, progress=None: [reports[n] for n in names])
    assert print_verification(["held"], order=True) == 0
    assert "all 1 keep their promised orders" in capsys.readouterr().out
    assert print_verification(["held", "broken"], order=True, as_markdown=True) == 1
    printed = capsys.readouterr().out
    assert "| mine | measured | 1.00 ± 0.00 |" in printed
    assert "broken: mine: pressure: order 1.00" in printed
    assert print_verification(["broken"], order=True, as_json=True) == 1
    assert json.loads(capsys.readouterr().out)[0]["promised"]["pressure"]["straight"] == 2


@pytest.mark.long
def test_all_that_are_installed_keep_their_promised_orders():
    reports = list(verify_order())
    assert len(reports) > 20
    assert {report.name: report.failures() for report in reports if report.broken} == {}


def test_only_interpolators_and_treatments_have_orders():
    with pytest.raises(InputError, match="orders are those of interpolators and wall_treatments"):
        print_verification(["gaussian"], order=True)


@dataclass(frozen=True)
class Fault:
    """A treatment with one wrong term: ``right`` in its source becomes ``wrong``; ``slip`` with which it shows."""

    name: str
    right: str
    wrong: str
    slip: str = "no"
    options: tuple[tuple[str, str], ...] = ()


FAULTS = [
    Fault("fixed-ghosts", "wall.force[d] * (fluid.total", "0.9 * wall.force[d] * (fluid.total"),
    Fault("fixed-ghosts", "0.5 * (1.0 + slope) * wall", "0.45 * (1.0 + slope) * wall"),
    Fault("fixed-ghosts", "slope = wall.distance", "slope = 0.9 * wall.distance"),
    Fault("adami-2012", "pressure -= wall", "pressure -= 0.9 * wall"),
    Fault(
        "adami-2012",
        "velocity[d] = wall.velocity[d]\n                viscous",
        "velocity[d] = 0.9 * wall.velocity[d]\n                viscous",
    ),
    Fault("adami-2012", "wall.velocity[d] - fluid", "wall.velocity[d] - 0.9 * fluid"),
    Fault("akinci-2012", "Seen(2.0 * fluid", "Seen(1.8 * fluid"),
    Fault("mdbc-2022", "wall.velocity[d]\n                if not", "0.9 * wall.velocity[d]\n                if not"),
    Fault("mdbc-2025", "fluid.pressure + force", "fluid.pressure + 0.9 * force"),
    Fault("mdbc-2025", "sign * fluid", "0.9 * sign * fluid"),
    Fault("mdbc-2025", "+= normal * wall", "+= 0.9 * normal * wall", "free", options=(("velocity", "corrected"),)),
    Fault("hashemi-2012", "- force * along", "- 0.9 * force * along"),
    Fault("band-2018", "return pressure, 1.0", "return 0.9 * pressure, 1.0"),
    Fault("distance-ratio", "ratio * (fluid.u", "0.9 * ratio * (fluid.u"),
    Fault("edge-integrals", "2.0 * fluid.pressure +", "1.8 * fluid.pressure +"),
    Fault("edge-integrals", "rub = friction", "rub = 0.9 * friction"),
    Fault("edge-integrals", "-2.0 * across", "-1.8 * across", "free"),
    Fault("usaw-2013", "+ wall.pressure)", "+ 0.9 * wall.pressure)"),
    Fault("usaw-2013", "rub = friction", "rub = 0.9 * friction"),
    Fault("usaw-2013", "-across * edge", "-0.9 * across * edge", "free"),
    Fault("pair-mirror", "+ lift * higher", "+ 0.9 * lift * higher"),
    Fault("pair-mirror", "2.0 * wall.wall_u - fluid.u", "2.0 * wall.wall_u - 0.9 * fluid.u"),
    Fault("riemann-2017", "+ higher +", "+ 0.9 * higher +"),
    Fault("mirror-images", "wall.force[d] * wall", "0.9 * wall.force[d] * wall"),
    Fault("mirror-images", "reflected * (", "0.9 * reflected * (", "free"),
    Fault("dynamic-2007", "return equation_of_state(", "return 0.9 * equation_of_state("),
]


def faulty(fault, folder, monkeypatch):
    """Return the treatment of a module that is a copy but for one term."""
    right = create("wall_treatments", fault.name)
    source = inspect.getsource(sys.modules[type(right).__module__])
    assert source.count(fault.right) == 1, fault
    module = f"faulty_{FAULTS.index(fault)}"
    (folder / f"{module}.py").write_text(source.replace(fault.right, fault.wrong), encoding="utf-8")
    monkeypatch.syspath_prepend(folder)
    return getattr(importlib.import_module(module), type(right).__name__)(**dict(fault.options))


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param(fault, marks=[] if k < 2 else pytest.mark.long, id=f"{fault.name}-{k}")
        for k, fault in enumerate(FAULTS)
    ],
)
def test_a_wrong_factor_is_found(fault, tmp_path, monkeypatch):
    treatment = faulty(fault, tmp_path, monkeypatch)
    report = measure_order(treatment, walls=["straight"], arrangements=["lattice"], slips=[fault.slip])
    assert report.failures() != []
