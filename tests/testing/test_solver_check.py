"""The check of the solver against the operator: velocities of ghosts, at the ghost and with two statuses."""

from dataclasses import replace

import numpy as np
import pytest

from sphframe import OK, SINGULAR, BoundaryInterpolator, EvaluationPoint, Traits, create
from sphframe.testing import BrokenPromiseError
from sphframe.testing.interpolators.solver import _filled_pool, check_shear, check_solver_agrees

MDBC = type(create("interpolators", "mdbc"))


class AtGhost(MDBC):
    """The first-order weights without a lift, at the ghost itself."""

    traits = replace(MDBC.traits, evaluation_point=EvaluationPoint.GHOST)


class Concealed(MDBC):
    """The same without a word about linear fields."""

    traits = Traits(evaluation_point=EvaluationPoint.GHOST)


class OnlyLifted(BoundaryInterpolator):
    """Equal weights, of which there are none without a lift."""

    traits = Traits(evaluation_point=EvaluationPoint.EXTRAPOLATED)

    def point_weights(self, kernel, dim):
        def weights(offsets, distances, kernel_values, volumes, support, lift, out):
            n = distances.shape[0]
            for j in range(n):
                out[j] = 1.0 / n
            return SINGULAR if lift[0] == 0.0 and lift[1] == 0.0 else OK

        return weights


def test_velocities_at_the_ghost_are_reversed_once():
    check_solver_agrees(AtGhost(), 2)
    check_shear(AtGhost(), 2)
    boundary, rows = _filled_pool(AtGhost(), 0.013, shear=True)
    ghosts = rows[len(rows) - boundary.count :]
    first = np.abs(ghosts[:, :2] - [0.045, -0.005]).max(axis=1) < 1e-9
    assert -0.03 < ghosts[first, 2].item() < -0.003
    with pytest.raises(BrokenPromiseError, match="along with the flow"):
        check_shear(Concealed(), 2)


def test_velocities_take_the_fallback_where_the_second_status_says_so():
    check_solver_agrees(OnlyLifted(), 2)
