"""Checks of runs on the device, in one process: ``python on_device.py CHECK ...``.

Numba decides at its import whether the device is simulated (``NUMBA_ENABLE_CUDASIM=1``).
"""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sphframe import Simulation
from sphframe.cases import Case, Custom, load_case
from sphframe.geometry import BoxRegion, BoxWall

DX = 0.1


def tank(dim: int = 2, walls: Sequence[BoxWall] = (), *, moves: bool = False, **options: Any) -> Custom:
    """A box of water, whose particles are out of place."""
    size = (0.6, 0.4, 0.4) if dim == 3 else (0.8, 0.5)
    water = (0.3, *size[1:]) if walls else size
    body = {"tank": {"name": "prescribed", "function": sway, "centre": (0.0, 0.0)}} if moves else {}
    wall = BoxWall(name="tank", lower=(0.0,) * dim, upper=(*size[:-1], size[-1] + 0.3), body="tank" if moves else None)
    return Custom(
        dimension=dim, particle_spacing=DX, walls=[wall, *walls], fluid=[BoxRegion(lower=(0.0,) * dim, upper=water)],
        bodies=body, domain=((-9.0,) * dim, (9.0,) * dim), time_step=1e-3, sound_speed=20.0, jitter=0.15, until=0.02,
        **options,
    )  # fmt: skip


def sway(time: float) -> Any:
    """Position, velocity and acceleration of a tank that begins to move and to turn."""
    return [0.1 * time, 0.0, 0.4 * time], [0.1, 0.0, 0.4], [0.0, 0.0, 0.0]


def assert_close(found: Any, expected: Any, scale: float | None = None) -> None:
    """To 1e-12 of ``scale``, or of the largest value."""
    scale = max(float(np.abs(expected).max(initial=0.0)), 1e-300) if scale is None else scale
    assert np.abs(np.subtract(found, expected)).max(initial=0.0) < 1e-12 * scale


def compare(steps: int = 2, case: Case | None = None, **options: Any) -> list[Simulation]:
    """Make ``steps`` on the processor and on the device."""
    case = tank(**options) if case is None else case
    runs = [Simulation(case, threads=1, device=device) for device in ("cpu", "cuda")]
    for run in runs:
        for _ in range(steps):
            run.advance()
    here, there = runs
    weight = 1e4  # N, of a cubic metre of water
    for one, other in ((here.fields(), there.fields()), (here.ghost_fields(), there.ghost_fields())):
        assert_close(other.position, one.position)
        assert_close(other.velocity, one.velocity, here.sound_speed)
        assert_close(other.density, one.density)
        assert_close(other.pressure, one.pressure, 1000.0 * here.sound_speed**2)
    for name, load in here.wall_loads().items():
        assert_close(there.wall_loads()[name].force, load.force, weight)
    assert_close(list(there.energies().values()), list(here.energies().values()))
    assert there.status_counts().tolist() == here.status_counts().tolist()
    return runs


def in_the_plane() -> None:
    """The default method, one with two calls of its weights and Runge-Kutta, and walls that do not attract."""
    compare(steps=3)
    compare(interpolator="adami", integrator="rk4")
    compare(tension="none", slip="no", kinematic_viscosity=0.01)


def with_other_methods() -> None:
    """Methods that solve systems of equations, and the mirror lift."""
    for method in ("mls-linear", "mls-quadratic", "mdbc", "sfdi"):
        compare(steps=1, interpolator=method)
    compare(interpolator="normalized", hydrostatic_lift="mirror")


def with_other_treatments() -> None:
    """Treatments with loops over walls of their own."""
    for treatment in ("adami-2012", "riemann-2017", "pair-mirror", "akinci-2012", "edge-integrals"):
        compare(steps=1, wall_treatment=treatment)


def in_space() -> None:
    """Three dimensions; particles that are behind a block are put back on it."""
    block = BoxWall(name="block", lower=(0.3, 0.0, 0.0), upper=(0.6, 0.4, 0.2))
    runs = compare(dim=3, steps=1, walls=[block])
    state, moves = runs[0].state(), np.random.default_rng(1).normal(size=(runs[0].fluid_count, 3))
    state["rows"][: len(moves), :3] += 0.2 * DX * moves
    counts = []
    for run in runs:
        run.restore(state)
        counts.append(run.system.put_back())
    assert counts[0] == counts[1] > 0
    assert_close(runs[1].system.host_rows, runs[0].system.host_rows)


def moving() -> None:
    """A tank that moves and turns, and periods."""
    compare(moves=True)
    compare(case=load_case("poiseuille", overrides={"particle_spacing": 0.1}))


def resumed() -> None:
    """A run that is resumed, after some particles were removed, has the same bits as one that is not."""
    case = tank()
    whole = Simulation(case, threads=1, device="cuda")
    for _ in range(4):
        whole.advance()
    whole.system.keep(np.arange(whole.fluid_count) % 9 != 4)
    whole.system.find_neighbours()
    state = whole.state()
    for _ in range(3):
        whole.advance()
    again = Simulation(case, threads=1, device="cuda")
    again.restore(state)
    for _ in range(3):
        again.advance()
    for one, other in zip(whole.fields(), again.fields(), strict=True):
        np.testing.assert_array_equal(one, other)


def against_plain_numpy() -> None:
    """Random scenes with walls at rest, moving and turning, against the delta-SPH step in plain NumPy of the tests."""
    sys.path.insert(0, str(Path(__file__).parents[3] / "tests"))
    from reference.test_plain import compare as compare_with_numpy

    options = Simulation.__init__.__kwdefaults__
    options["device"] = "cuda"
    compare_with_numpy(7, 2, "moving", slip="no")
    compare_with_numpy(8, 2, "box", hydrostatic_lift="mirror", interpolator="normalized", kinematic_viscosity=0.02)
    options["device"] = "cpu"


CHECKS = (in_the_plane, with_other_methods, with_other_treatments, in_space, moving, resumed, against_plain_numpy)

if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(name, flush=True)
        {check.__name__: check for check in CHECKS}[name]()
