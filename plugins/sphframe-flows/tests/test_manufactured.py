"""Manufactured flows: values by computer algebra, sources against finite differences, and a coarse run."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sphframe_flows import ManufacturedFlow
from sphframe_flows.jets import Jet, cosine, sine
from sphframe_flows.manufactured_fields import FIELDS, RADIUS, Manufactured

from sphframe import InputError, run
from sphframe.analysis import summary
from sphframe.simulation.simulation import Simulation

VALUES = """
noslip-box,grad,0.13,0.07,0.12031338,-0.05958893,1.013,1.0025325,0.32639474,0.27087893,3.9946069e-05
noslip-box,zero,0.13,0.07,0.12031338,-0.05958893,1.4478261,1.0036196,-0.44480715,-0.10729923,-0.000136273
noslip-box,grad,0.5,0.04,0.370944,0,1.135,1.0028375,1.1574797,0.29523888,0.0004822272
noslip-box,zero,0.5,0.04,0.370944,0,1,1.0025,-0.91557278,0.045946252,-0.0014452072
noslip-box,grad,0.71,0.93,-0.39875066,0.061571098,1.5822,1.0039555,0.37714367,0.02747962,-0.0011166857
noslip-box,zero,0.71,0.93,-0.39875066,0.061571098,1.2990731,1.0032477,0.41413308,-0.1167837,-0.0011751703
noslip-box,grad,0.37,0.61,-0.47776128,-0.57625378,1.1813,1.0029533,3.2398526,-2.4757724,-0.0010727395
noslip-box,zero,0.37,0.61,-0.47776128,-0.57625378,0.93273547,1.0023318,3.0540306,-3.2458197,0.00026233262
freeslip-box,grad,0.13,0.07,0.38758328,-0.20020197,1.013,1.0025325,1.3861503,0.69413007,0.00012734528
freeslip-box,zero,0.13,0.07,0.38758328,-0.20020197,1.4478261,1.0036196,0.61494841,0.31595191,-0.00043251866
freeslip-box,grad,0.5,0.04,0.9921147,-7.6744472e-18,1.135,1.0028375,0.71436427,0.63993379,0.0012897491
freeslip-box,zero,0.5,0.04,0.9921147,-7.6744472e-18,1,1.0025,-1.3586882,0.39064116,-0.003865304
freeslip-box,grad,0.71,0.93,-0.77112552,0.13370153,1.5822,1.0039555,-0.50329035,-0.28881959,-0.0021465211
freeslip-box,zero,0.71,0.93,-0.77112552,0.13370153,1.2990731,1.0032477,-0.46630093,-0.43308291,-0.0022649252
freeslip-box,grad,0.37,0.61,-0.31087829,-0.37366881,1.1813,1.0029533,1.7567088,-0.89056727,-0.00069742895
freeslip-box,zero,0.37,0.61,-0.31087829,-0.37366881,0.93273547,1.0023318,1.5708868,-1.6606146,0.00016879411
shearslip-box,grad,0.13,0.07,0.389064,-0.192696,1.013,1.0025325,1.3293359,0.75798727,0.0001291758
shearslip-box,zero,0.13,0.07,0.389064,-0.192696,1.4478261,1.0036196,0.55813396,0.37980911,-0.00044067349
shearslip-box,grad,0.5,0.04,0.92,0,1.135,1.0028375,0.51852867,0.53191663,0.001196
shearslip-box,zero,0.5,0.04,0.92,0,1,1.0025,-1.5545238,0.282624,-0.0035843433
shearslip-box,grad,0.71,0.93,-0.708296,0.109368,1.5822,1.0039555,-0.033126431,-0.17329411,-0.0019835554
shearslip-box,zero,0.71,0.93,-0.708296,0.109368,1.2990731,1.0032477,0.0038629833,-0.31755743,-0.0020874409
shearslip-box,grad,0.37,0.61,-0.205128,-0.247416,1.1813,1.0029533,1.1813271,-0.26255313,-0.0004605834
shearslip-box,zero,0.37,0.61,-0.205128,-0.247416,0.93273547,1.0023318,0.99550507,-1.0326005,0.00011263317
noslip-disc,grad,0.45,0.02,-0.02403984,0.5311354,1.10575,1.0027644,-0.22665732,1.2903808,0.00027111784
noslip-disc,zero,0.45,0.02,-0.02403984,0.5311354,1.49239,1.003731,-0.40224562,1.0301349,-6.4882492e-05
noslip-disc,grad,-0.21,0.4,-0.25527744,-0.14329062,0.98005,1.0024501,-0.26307574,-0.412013,4.3995724e-05
noslip-disc,zero,-0.21,0.4,-0.25527744,-0.14329062,0.770722,1.0019268,0.66053942,0.0280842,-0.00070456654
noslip-disc,grad,0.1,-0.3,0.8712,0.1914,0.99,1.002475,0.22505304,2.8647678,-8.4975e-05
noslip-disc,zero,0.1,-0.3,0.8712,0.1914,1.13,1.002825,1.5313801,2.9345532,0.0028017
noslip-disc,grad,-0.05,0.08,-0.32249536,-0.45732812,0.99925,1.0024981,1.784149,-1.6093139,3.6645392e-05
noslip-disc,zero,-0.05,0.08,-0.32249536,-0.45732812,0.92589,1.0023147,3.2629242,-1.5684131,-0.0012052373
stressfree-disc,grad,0.45,0.02,-0.041371747,0.89190248,1.10575,1.0027644,-1.3913762,0.20548925,0.00045411763
stressfree-disc,zero,0.45,0.02,-0.041371747,0.89190248,1.49239,1.003731,-1.5669645,-0.054756664,-0.00010966585
stressfree-disc,grad,-0.21,0.4,-0.35367333,-0.2235644,0.98005,1.0024501,0.51723196,-0.31846572,6.7527487e-05
stressfree-disc,zero,-0.21,0.4,-0.35367333,-0.2235644,0.770722,1.0019268,1.4408471,0.12163149,-0.00099717551
stressfree-disc,grad,0.1,-0.3,0.450576,0.002772,0.99,1.002475,0.27869423,0.85983657,-5.59755e-05
stressfree-disc,zero,0.1,-0.3,0.450576,0.002772,1.13,1.002825,1.5850213,0.92962197,0.001420146
stressfree-disc,grad,-0.05,0.08,-0.088919309,-0.32573753,0.99925,1.0024981,0.3771566,-0.29002231,2.2581579e-05
stressfree-disc,zero,-0.05,0.08,-0.088919309,-0.32573753,0.92589,1.0023147,1.8559318,-0.24912155,-0.00034029702
noslip-wave,grad,0.13,0.12,0.03556282,-0.031437993,1.01625,1.0025406,0.11722699,0.29819218,1.1783666e-05
noslip-wave,grad,0.5,-0.05,0.315,-2.8631434e-17,1.1125,1.0027812,1.1321394,0.7120313,0.0003740625
noslip-wave,grad,0.71,0.93,-0.2215627,0.051450936,1.5822,1.0039555,0.8007334,0.15806713,-0.00060517773
noslip-wave,grad,0.37,0.5,-0.09832719,-0.88397326,1.16095,1.0029024,3.20615,-1.8027139,-0.00056124478
tangent-wave,grad,0.13,0.12,0.32901904,-0.29085709,1.01625,1.0025406,1.1465935,-0.31029936,0.00010901977
tangent-wave,grad,0.5,-0.05,1,-9.089344e-17,1.1125,1.0027812,0.47368257,4.9126947,0.0011875
tangent-wave,grad,0.71,0.93,-0.69918367,0.16236331,1.5822,1.0039555,-0.61371375,-0.28883193,-0.0019097546
tangent-wave,grad,0.37,0.5,-0.062824627,-0.56480095,1.16095,1.0029024,1.6866775,-0.30493999,-0.00035859861
"""
"""field, pressure, x, y, u, v, p, rho, f (2) and S for rho0 = 1, c0 = 20; nu = 0.01, or 0 without viscosity"""


def flow(name: str, pressure: str, decay: float = 0.0) -> Manufactured:
    field = FIELDS[name]
    return Manufactured(field, pressure == "grad", 1.0, 20.0, 0.01 if field.viscous else 0.0, decay)


@pytest.mark.parametrize("line", VALUES.split(), ids=lambda line: ",".join(line.split(",")[:4]))
def test_values_are_those_of_computer_algebra(line: str) -> None:
    name, pressure, *numbers = line.split(",")
    x, y, u, v, p, density, fx, fy, rate = map(float, numbers)
    given, points = flow(name, pressure), np.array([[x, y]])
    state = given.state(points, 0.0)
    found = [*state.velocity[0], state.pressure[0], 1.0 + state.pressure[0] / 400.0, *given.force(points, 0.0)[0]]
    np.testing.assert_allclose(found, [u, v, p, density, fx, fy], rtol=5.1e-8, atol=1e-12)  # rounded to 8 digits
    np.testing.assert_allclose(given.density_rate(points, 0.0), rate, rtol=1e-7, atol=1e-12)


@pytest.mark.parametrize("name", FIELDS)
def test_sources_are_what_the_equations_lack(name: str) -> None:
    """By central differences in space and time, of a flow that decays."""
    given = flow(name, "grad" if FIELDS[name].zero is None else "zero", decay=0.7)
    points, time, step = np.array([[0.31, 0.22], [0.12, 0.37], [-0.2, 0.3]]), 0.4, 1e-4
    if FIELDS[name].domain != "disc":
        points = np.abs(points)

    def of(at: np.ndarray, when: float) -> np.ndarray:
        state = given.state(at, when)
        return np.column_stack([state.velocity, state.pressure])

    now = of(points, time)
    rate = (of(points, time + step) - of(points, time - step)) / (2.0 * step)
    aside = [(of(points + step * e, time), of(points - step * e, time)) for e in np.eye(2)]
    slope = [(ahead - behind) / (2.0 * step) for ahead, behind in aside]
    bend = sum((ahead - 2.0 * now + behind) / step**2 for ahead, behind in aside)
    total = rate + now[:, :1] * slope[0] + now[:, 1:2] * slope[1]
    np.testing.assert_allclose(slope[0][:, 0] + slope[1][:, 1], 0.0, atol=1e-6)
    pressed = np.column_stack([slope[0][:, 2], slope[1][:, 2]]) / (1.0 + now[:, 2:] / 400.0)
    force = total[:, :2] + pressed - given.viscosity * bend[:, :2]
    np.testing.assert_allclose(given.force(points, time), force, atol=1e-5)
    np.testing.assert_allclose(given.density_rate(points, time), total[:, 2] / 400.0, atol=1e-8)
    np.testing.assert_allclose(given.wall_force(points, time), np.column_stack([s[:, 2] for s in slope]), atol=1e-7)


@pytest.mark.parametrize("name", [name for name in FIELDS if name != "periodic"])
def test_flows_meet_the_conditions_of_their_walls(name: str) -> None:
    s = np.linspace(0.1, 0.9, 9)
    if FIELDS[name].domain == "disc":
        points = RADIUS * np.column_stack([np.cos(7.0 * s), np.sin(7.0 * s)])
        normal = points / RADIUS
    else:
        waves = FIELDS[name].domain == "wave"
        points = np.column_stack([s, 0.1 * np.cos(2.0 * np.pi * s) if waves else 0.0 * s])
        normal = np.column_stack([-0.2 * np.pi * np.sin(2.0 * np.pi * s) if waves else 0.0 * s, -1.0 + 0.0 * s])
    given = flow(name, "zero")
    state = given.state(points, 0.0)
    np.testing.assert_allclose((state.velocity * normal).sum(axis=1), 0.0, atol=1e-14)
    if not FIELDS[name].slips:
        np.testing.assert_allclose(state.velocity, 0.0, atol=1e-14)
    if FIELDS[name].zero is not None:
        np.testing.assert_allclose((state.pressure_gradient * normal).sum(axis=1), 0.0, atol=1e-14)


def test_jets_are_taylor_polynomials() -> None:
    points = np.random.default_rng(5).uniform(size=(6, 2))
    x, y = Jet.variables(points)
    a, b = points.T
    jet = 2.0 - sine(3.0 * x) * y**3 + cosine(x * y)
    np.testing.assert_allclose(jet.value, 2.0 - np.sin(3.0 * a) * b**3 + np.cos(a * b))
    np.testing.assert_allclose(
        jet.derivative(1, 2), -18.0 * np.cos(3.0 * a) * b - 2.0 * a * np.cos(a * b) * 1.0 + a * (a * b * np.sin(a * b))
    )


def test_a_coarse_run_stays_near_the_flow(tmp_path: Path) -> None:
    result = run("manufactured", particle_spacing=0.05, until=0.1, output=tmp_path / "flow.nc", threads=1)
    found = summary(result.dataset)["errors"]
    assert found["velocity"] < 0.06, found  # sound of the start moves the pressure by as much as it varies
    assert abs(found["mean_pressure"]) < 0.3, found
    assert ManufacturedFlow().norms(result.dataset)["velocity"].values[0] == pytest.approx(0.0, abs=1e-12)


def test_sources_are_added_to_the_rates_of_the_solver() -> None:
    case = ManufacturedFlow(particle_spacing=0.05, pressure="gradient")
    simulation = Simulation(case, threads=1)
    system, columns, n, given = simulation.system, simulation.columns, simulation.fluid_count, case.solution
    position = system.rows[:n, columns.position].copy()
    found = system.rates.copy()
    pushed = given.wall_force(system.boundary.foot, 0.0)
    np.testing.assert_array_equal(system.boundary.driving, pushed)
    system._driving._sources = None
    system.evaluate(0.0)
    np.testing.assert_array_equal(system.boundary.driving, pushed)  # walls at rest are not moved again
    found -= system.rates
    np.testing.assert_allclose(found[:, columns.velocity], given.force(position, 0.0), atol=1e-12)
    np.testing.assert_allclose(found[:, columns.density], given.density_rate(position, 0.0), atol=1e-12)
    inside = np.abs(position - 0.5).max(axis=1) < 0.25
    after = system.rates + found
    density = system.rows[:n, columns.density]
    inertia = given.force(position, 0.0) - given.state(position, 0.0).pressure_gradient / density[:, None]
    laplacian = np.square(after[:, columns.velocity] - inertia)[inside].mean() ** 0.5
    assert laplacian < 0.1 * np.square(inertia[inside]).mean() ** 0.5  # Du/Dt but for nu lap u and errors of dx^2


@pytest.mark.parametrize("given", [{"field": "noslip-wave", "pressure": "zero"}, {"periodic": ["x"]}])
def test_contradictions_are_refused(given: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"no pressure without normal gradient|contradicts field"):
        ManufacturedFlow(**given).scene()
