"""At each frame the weights of some ghosts are checked, of all in turn, with all their neighbours."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csr_array

from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns, Periods
from sphframe.simulation import guards


@pytest.mark.parametrize("periodic", [False, True])
def test_all_ghosts_are_checked_in_turn(monkeypatch: pytest.MonkeyPatch, periodic: bool) -> None:
    random, columns, fluid, ghosts = np.random.default_rng(4), Columns.of(2), 60, 40
    rows = columns.zeros(fluid + ghosts)
    rows[:, :2] = random.uniform(0.0, 1.0, (fluid + ghosts, 2))
    points = random.uniform(0.0, 1.5, (ghosts, 2))
    periods = Periods.of("x" if periodic else "", ((0.0, 0.0), (1.0, 1.0)))
    lists = NeighbourLists(2, fluid, ghosts, support=0.2, skin=0.02, periods=periods)
    rows[:fluid] = rows[:fluid][lists.sort(rows)]
    lists.build(rows, points)
    boundary = SimpleNamespace(points=points, periods=periods, lift_of_weights=None)
    parameters = SimpleNamespace(support=0.2, smoothing_length=0.1)
    system: Any = SimpleNamespace(
        boundary=boundary, columns=columns, lists=lists, host_rows=rows, parameters=parameters
    )
    checked: dict[tuple[float, ...], int] = {}

    def seen(method: Any, at: Any, positions: Any, volumes: Any, near: Any, *others: Any) -> Any:
        starts, members = near
        assert len(at) <= 6
        for k, point in enumerate(at):
            offset = positions[members[starts[k] : starts[k + 1]]] - point
            assert (np.linalg.norm(offset, axis=1) < 0.2).all()
            checked[tuple(point.round(9))] = len(offset)
        return csr_array((len(at), len(positions))), np.full(len(at), guards.Status.DRY)

    monkeypatch.setattr(guards, "SAMPLED", 6)
    monkeypatch.setattr(guards, "operator_of", seen)
    method: Any = SimpleNamespace(traits=SimpleNamespace(non_negative=True, partition_of_unity=True))
    for turn in range(-(-len(lists.near) // 6)):
        guards.check_traits(system, method, None, None, turn)  # type: ignore[arg-type]
    for point in periods.wrapped(points):
        offset = rows[:fluid, :2] - point
        if periodic:
            offset[:, 0] -= np.rint(offset[:, 0])
        expected = int((np.linalg.norm(offset, axis=1) < 0.2).sum())
        assert checked.get(tuple(point.round(9)), 0) == expected
