"""A simulation that is restored is the one that was saved, in all that it holds."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from sphframe import Simulation
from sphframe.cases import Custom
from sphframe.geometry import BoxRegion, PolygonWall

COMPUTED = ("_start", "total", "_scratch", "_scalars", "_vectors", "system.lists.", "loops", "_pressure_is_current")
"""what is computed before it is read: scratch memory, and lists of neighbours within the same positions"""


def held(item: Any, name: str = "", seen: set[int] | None = None) -> Iterator[tuple[str, Any]]:
    """Walk over all arrays and numbers of an object of sphframe and of what it holds, with their places."""
    seen = set() if seen is None else seen
    if isinstance(item, np.ndarray | int | float):
        yield name, item
    elif isinstance(item, dict | list | tuple) and id(item) not in seen:
        seen.add(id(item))
        keys = item if isinstance(item, dict) else range(len(item))
        names = getattr(item, "_fields", keys)
        for key, label in zip(keys, names, strict=True):
            yield from held(item[key], f"{name}.{label}", seen)
    elif type(item).__module__.startswith("sphframe.") and hasattr(item, "__dict__") and id(item) not in seen:
        seen.add(id(item))
        for key, value in vars(item).items():
            yield from held(value, f"{name}.{key}", seen)


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
def test_all_that_a_simulation_holds_is_restored() -> None:
    case = Custom(
        particle_spacing=0.05, until=1.0, sound_speed=20.0, jitter=0.1, gravity=(1.0, -9.0), domain=((-9, -9), (9, 9)),
        walls=[
            PolygonWall(name="tank", points=[(0.0, 0.6), (0.0, 0.0), (0.4, 0.0), (0.5, 0.6)], body="tank"),
            PolygonWall(name="lid", points=[(-0.5, 2.0), (1.0, 2.0)]),
        ],
        fluid=[BoxRegion(lower=(0.0, 0.0), upper=(0.4, 0.25), velocity=(0.3, -0.2))],
        bodies={"tank": {"name": "free", "mass": 900.0, "inertia": 50.0, "centre": (0.3, 0.2),
                         "initial_velocity": (1.0, 2.0, 3.0)}},
    )  # fmt: skip
    run, other = Simulation(case, threads=1), Simulation(case, threads=1)
    for _ in range(25):
        run.advance()
    other.restore(run.state())
    one, two = dict(held(run)), dict(held(other))
    assert one.keys() == two.keys()
    changed = dict(held(Simulation(case, threads=1)))
    compared = [name for name in one if not any(part in name for part in (*COMPUTED, "_clock"))]
    for name in compared:
        assert np.array_equal(one[name], two[name], equal_nan=True), f"{name} is not restored"
    moved = [name for name in compared if not np.array_equal(one[name], changed[name], equal_nan=True)]
    for expected in ("rows", "gradient", "loads", "mirror", "driving", "bodies.position", "motions"):
        assert any(expected in name for name in moved), (
            f"the run has not changed its {expected}: the test shows nothing"
        )
