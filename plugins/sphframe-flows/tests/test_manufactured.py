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
noslip-box,grad,0.13,0.07,0.1203133810133,-0.05958892950192,1.013,1.0025325,0.3263947420044,0.270878929152,3.994606862392e-5
noslip-box,zero,0.13,0.07,0.1203133810133,-0.05958892950192,1.447826061276,1.003619565153,-0.4448071530972,-0.1072992284017,-0.000136272999021
noslip-box,grad,0.5,0.04,0.370944,0,1.135,1.0028375,1.157479714885,0.295238883666,0.0004822272
noslip-box,zero,0.5,0.04,0.370944,0,1.0,1.0025,-0.9155727790364,0.04594625150976,-0.001445207216844
noslip-box,grad,0.71,0.93,-0.3987506598869,0.06157109763504,1.5822,1.0039555,0.3771436701807,0.02747962025023,-0.001116685714267
noslip-box,zero,0.71,0.93,-0.3987506598869,0.06157109763504,1.299073133585,1.003247682834,0.4141330847478,-0.1167836988086,-0.001175170303158
noslip-box,grad,0.37,0.61,-0.4777612822382,-0.5762537801093,1.1813,1.00295325,3.239852569292,-2.475772388843,-0.001072739537078
noslip-box,zero,0.37,0.61,-0.4777612822382,-0.5762537801093,0.9327354747483,1.002331838687,3.054030574781,-3.245819738531,0.0002623326228797
freeslip-box,grad,0.13,0.07,0.3875832834391,-0.2002019688534,1.013,1.0025325,1.386150308966,0.6941300658858,0.00012734528448
freeslip-box,zero,0.13,0.07,0.3875832834391,-0.2002019688534,1.447826061276,1.003619565153,0.6149484138646,0.3159519083321,-0.0004325186636093
freeslip-box,grad,0.5,0.04,0.9921147013145,0,1.135,1.0028375,0.7143642673346,0.6399337934258,0.001289749111709
freeslip-box,zero,0.5,0.04,0.9921147013145,0,1.0,1.0025,-1.358688226587,0.3906411612696,-0.003865303998114
freeslip-box,grad,0.71,0.93,-0.7711255211074,0.1337015313587,1.5822,1.0039555,-0.5032903493392,-0.2888195928297,-0.002146521109172
freeslip-box,zero,0.71,0.93,-0.7711255211074,0.1337015313587,1.299073133585,1.003247682834,-0.4663009347721,-0.4330829118885,-0.002264925214585
freeslip-box,grad,0.37,0.61,-0.3108782931997,-0.373668812729,1.1813,1.00295325,1.75670875294,-0.8905672713706,-0.0006974289456616
freeslip-box,zero,0.37,0.61,-0.3108782931997,-0.373668812729,0.9327354747483,1.002331838687,1.570886758429,-1.660614621059,0.0001687941149852
shearslip-box,grad,0.13,0.07,0.389064,-0.192696,1.013,1.0025325,1.329335852264,0.7579872721281,0.0001291758
shearslip-box,zero,0.13,0.07,0.389064,-0.192696,1.447826061276,1.003619565153,0.5581339571619,0.3798091145744,-0.000440673494873
shearslip-box,grad,0.5,0.04,0.92,0,1.135,1.0028375,0.518528674885,0.5319166321563,0.001196
shearslip-box,zero,0.5,0.04,0.92,0,1.0,1.0025,-1.554523819036,0.282624,-0.003584343295743
shearslip-box,grad,0.71,0.93,-0.708296,0.109368,1.5822,1.0039555,-0.03312643130472,-0.1732941132606,-0.0019835554
shearslip-box,zero,0.71,0.93,-0.708296,0.109368,1.299073133585,1.003247682834,0.003862983262448,-0.3175574323194,-0.002087440871651
shearslip-box,grad,0.37,0.61,-0.205128,-0.247416,1.1813,1.00295325,1.181327069253,-0.2625531328892,-0.0004605834
shearslip-box,zero,0.37,0.61,-0.205128,-0.247416,0.9327354747483,1.002331838687,0.9955050747422,-1.032600482577,0.0001126331669531
noslip-disc,grad,0.45,0.02,-0.02403984,0.531135396,1.10575,1.002764375,-0.2266573232279,1.290380790487,0.00027111784425
noslip-disc,zero,0.45,0.02,-0.02403984,0.531135396,1.49239,1.003730975,-0.4022456179379,1.03013487604,-6.488249196e-5
noslip-disc,grad,-0.21,0.4,-0.25527744,-0.14329062,0.98005,1.002450125,-0.2630757365844,-0.4120130038321,4.399572375e-5
noslip-disc,zero,-0.21,0.4,-0.25527744,-0.14329062,0.770722,1.001926805,0.6605394167108,0.02808420037624,-0.00070456654224
noslip-disc,grad,0.1,-0.3,0.8712,0.1914,0.99,1.002475,0.2250530444749,2.864767755525,-8.4975e-5
noslip-disc,zero,0.1,-0.3,0.8712,0.1914,1.13,1.002825,1.53138012726,2.934553154977,0.0028017
noslip-disc,grad,-0.05,0.08,-0.32249536,-0.457328124,0.99925,1.002498125,1.784148950275,-1.609313853921,3.664539175e-5
noslip-disc,zero,-0.05,0.08,-0.32249536,-0.457328124,0.92589,1.002314725,3.262924162892,-1.56841310149,-0.00120523729744
stressfree-disc,grad,0.45,0.02,-0.0413717472,0.89190247608,1.10575,1.002764375,-1.391376180759,0.2054892507913,0.000454117633515
stressfree-disc,zero,0.45,0.02,-0.0413717472,0.89190247608,1.49239,1.003730975,-1.566964475469,-0.05475666365531,-0.0001096658492328
stressfree-disc,grad,-0.21,0.4,-0.3536733312,-0.2235643956,0.98005,1.002450125,0.5172319611036,-0.3184657150511,6.7527487125e-5
stressfree-disc,zero,-0.21,0.4,-0.3536733312,-0.2235643956,0.770722,1.001926805,1.440847114399,0.1216314891572,-0.0009971755107552
stressfree-disc,grad,0.1,-0.3,0.450576,0.002772,0.99,1.002475,0.2786942291149,0.8598365696051,-5.59755e-5
stressfree-disc,zero,0.1,-0.3,0.450576,0.002772,1.13,1.002825,1.5850213119,0.9296219690572,0.001420146
stressfree-disc,grad,-0.05,0.08,-0.0889193088,-0.32573753352,0.99925,1.002498125,0.3771565953197,-0.2900223054449,2.2581578565e-5
stressfree-disc,zero,-0.05,0.08,-0.0889193088,-0.32573753352,0.92589,1.002314725,1.855931807936,-0.2491215530137,-0.0003402970173792
noslip-wave,grad,0.13,0.12,0.03556282044507,-0.03143799327042,1.01625,1.002540625,0.1172269920111,0.2981921840934,1.178366580496e-5
noslip-wave,grad,0.5,-0.05,0.315,0,1.1125,1.00278125,1.13213940744,0.7120312981642,0.0003740625
noslip-wave,grad,0.71,0.93,-0.2215627022032,0.05145093616712,1.5822,1.0039555,0.8007333987222,0.1580671327449,-0.0006051777318735
noslip-wave,grad,0.37,0.5,-0.09832718984712,-0.8839732615234,1.16095,1.002902375,3.206150039735,-1.802713862666,-0.0005612447777176
tangent-wave,grad,0.13,0.12,0.3290190407984,-0.2908570878521,1.01625,1.002540625,1.146593494993,-0.3102993587416,0.0001090197676033
tangent-wave,grad,0.5,-0.05,1.0,0,1.1125,1.00278125,0.4736825703512,4.912694695489,0.0011875
tangent-wave,grad,0.71,0.93,-0.6991836667301,0.1623633122737,1.5822,1.0039555,-0.6137137475107,-0.2888319265075,-0.001909754581377
tangent-wave,grad,0.37,0.5,-0.06282462729646,-0.5648009546657,1.16095,1.002902375,1.68667751357,-0.3049399909217,-0.0003585986138424
"""
"""field, pressure, x, y, u, v, p, rho, f (2) and S for rho0 = 1, c0 = 20; nu = 0.01, or 0 without viscosity.

The closed forms are those of SymPy, evaluated by mpmath with 30 digits."""


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
    np.testing.assert_allclose(found, [u, v, p, density, fx, fy], rtol=1e-11, atol=1e-14)
    np.testing.assert_allclose(given.density_rate(points, 0.0), rate, rtol=1e-11, atol=1e-14)


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
    energy = result.dataset["kinetic_energy"].values
    np.testing.assert_allclose(energy, ManufacturedFlow().exact(result.dataset)["kinetic_energy"].values, rtol=0.05)
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
    system._driving.sources = None
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
