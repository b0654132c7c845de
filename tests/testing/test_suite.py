"""The verification suite: clouds, evaluation, decorator, pytest plugin, report."""

import json
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st

from sphframe import OK, Status, available, create
from sphframe.cli.verify import verify as print_verification
from sphframe.errors import UnknownComponentError
from sphframe.testing import (
    FAMILIES,
    Cloud,
    catalogue,
    checks_of,
    clouds,
    evaluate,
    parametrize_with_checks,
    proof,
    verify,
)
from sphframe.testing.neighbourhoods import build, condition, magnification
from sphframe.testing.proof import smallest

METHODS = {
    "improved-shepard": [True, True, True, 0, True, True, True, True, (1, 1), "mirror"],
    "shepard": [True, True, True, 0, True, True, True, True, (1, 1), "mirror"],
    "normalized": [True, True, True, 0, False, True, False, True, (1, 1), "mirror"],
    "sfdi": [True, False, False, 1, False, True, True, False, (3, 4), "mirror"],
    "mls-linear": [True, False, False, 1, False, True, False, True, (3, 4), "mirror"],
    "mls-quadratic": [True, False, False, 2, False, True, False, True, (6, 10), "mirror"],
    "mdbc": [True, False, False, 1, False, True, False, True, (3, 4), "extrapolated"],
    "adami": [True, True, True, 0, False, True, False, True, (1, 1), "ghost"],
}
"""sum is one, positive, in range, degree, at particles, rotation, volumes, continuous, fewest points, where"""


@pytest.mark.parametrize("name", METHODS)
def test_declared_traits_are_those_of_the_literature(name):
    t = create("interpolators", name).traits
    assert [
        t.partition_of_unity, t.non_negative, t.range_restricted, t.reproduces_degree, t.interpolates_particles,
        t.rotation_invariant, t.volume_independent, t.continuous, t.fewest_points, t.evaluation_point,
    ] == METHODS[name]  # fmt: skip


def test_printed_sfdi_has_neither_linear_exactness_nor_rotation_invariance():
    traits = create("interpolators", "sfdi", form="printed").traits
    assert (traits.reproduces_degree, traits.rotation_invariant, traits.fewest_points) == (0, False, (2, 2))


@settings(deadline=None, max_examples=60)
@given(st.data())
def test_clouds_are_valid_neighbourhoods(data):
    dim = data.draw(st.sampled_from((2, 3)))
    cloud = data.draw(clouds(dim, lifted=data.draw(st.booleans())))
    assert cloud.dim == dim
    assert len(cloud) >= 1
    assert np.all(cloud.distances < cloud.support)
    assert np.all(cloud.volumes > 0.0)
    assert np.all(np.isfinite(cloud.offsets))


@pytest.mark.parametrize("dim", [2, 3])
def test_families_have_the_property_in_their_name(dim):
    of = {family: [build(family, dim, seed) for seed in range(8)] for family in FAMILIES}
    assert all(len(cloud) <= 6 for cloud in of["spray"])
    assert all((cloud.distances == 0.0).any() for cloud in of["at a particle"])
    assert all((cloud.distances > 0.99 * cloud.support).any() for cloud in of["at the cut-off"])
    assert all(cloud.volumes.max() > 50 * cloud.volumes.min() for cloud in of["varied volumes"])
    assert all(condition(cloud, 1) > 1e12 for cloud in of["collinear"])
    assert all(condition(cloud, 2) > 1e12 for cloud in of["conic"] if len(cloud) < 15)
    assert all(condition(cloud, 1) < 1e3 for cloud in of["full support"])
    assert any(len(np.unique(cloud.offsets, axis=0)) < len(cloud) for cloud in of["coincident"])


def test_spacings_reach_from_micrometres_to_kilometres():
    for exponent in (-6, 3):
        found = find(clouds(2), lambda cloud, e=exponent: 10.0**e < cloud.support < 10.0 ** (e + 1))
        assert found.support < 10.0 ** (exponent + 1)


def test_the_repr_of_a_cloud_is_code():
    cloud = catalogue(2, ("spray",), lifted=True)[3]
    again = eval(repr(cloud), {"Cloud": Cloud})
    assert np.array_equal(again.offsets, cloud.offsets)
    assert np.array_equal(again.lift, cloud.lift)
    assert (again.support, again.volumes.tolist()) == (cloud.support, cloud.volumes.tolist())


def test_reduction_of_a_cloud_keeps_the_failure_and_rounds_other_numbers():
    def near_three(cloud):
        return "three" if np.sum(cloud.distances < 0.5 * cloud.support) >= 3 else None

    cloud = smallest(build("full support", 2, 1, spacing=0.01), near_three)
    assert len(cloud) == 3
    assert cloud.support == pytest.approx(3.0)
    assert np.array_equal(cloud.offsets, np.round(cloud.offsets, 1))


def test_evaluate_returns_weights_and_status():
    cloud = Cloud([[1.0, 0.0], [0.0, 1.0]], volumes=[1.0, 1.0], support=3.0)
    outcome = evaluate(create("interpolators", "shepard"), cloud)
    assert outcome.weights.tolist() == [0.5, 0.5]
    assert outcome.status == OK
    assert evaluate(create("interpolators", "mls-linear"), cloud).status == Status.TOO_FEW


def test_ids_of_tests_name_component_and_check():
    @parametrize_with_checks(
        [create("interpolators", "sfdi", form="printed")], expected_failed_checks={"compiles": "why"}
    )
    def prove(method, check):
        pass

    (mark,) = prove.pytestmark
    ids = [case.id for case in mark.args[1]]
    assert "SFDI(form='printed', amplification=None)-partition_of_unity-2d" in ids
    assert not any("linear_reproduction" in name for name in ids)
    assert [case.id.rpartition("-")[0].rpartition("-")[2] for case in mark.args[1] if case.marks] == ["compiles"] * 2


def test_expected_failures_may_depend_on_the_component_and_must_exist():
    methods = [create("interpolators", name) for name in ("shepard", "normalized")]

    def expected(method):
        return {"continuity-3d": "jumps"} if method == methods[0] else {}

    @parametrize_with_checks(methods, expected_failed_checks=expected)
    def prove(method, check):
        pass

    (mark,) = prove.pytestmark
    (marked,) = [case for case in mark.args[1] if case.marks]
    assert marked.values[0] == methods[0]
    assert marked.marks[0].kwargs == {"reason": "jumps", "strict": True}
    with pytest.raises(ValueError, match="no component has the checks continuous"):
        parametrize_with_checks(methods, expected_failed_checks={"continuous": "misspelt"})


def test_a_test_function_needs_two_arguments():
    with pytest.raises(TypeError, match="takes two arguments"):
        parametrize_with_checks([])(lambda method: None)


def test_checks_of_undeclared_traits_are_optional():
    method = create("interpolators", "normalized")
    names = {check.name for check in checks_of(method, promised_only=False)}
    assert names - {check.name for check in checks_of(method)} == {
        "linear_reproduction", "quadratic_reproduction", "interpolates_particles", "volume_independence",
    }  # fmt: skip


@pytest.fixture
def few_clouds(monkeypatch):
    """Make the checks with every tenth cloud of the catalogue; the tests of the plugins make them with all."""
    monkeypatch.setattr(proof, "catalogue", lambda *given, **options: catalogue(*given, **options)[::10])


def test_verification_of_a_method_prints_a_table(few_clouds, capsys):
    assert print_verification(["shepard"]) == 0
    shown = capsys.readouterr().out
    assert "all 1 have their declared traits" in shown
    cells = shown.splitlines()[1].split()
    assert cells[1:11] == ["yes", "yes", "yes", "-", "-", "yes", "yes", "yes", "yes", "yes"]
    assert " ".join(cells[11:]) == "0.69 / 0.62 0.66 / 0.60"


def test_a_violated_trait_exits_with_one(few_clouds, install, capsys):
    source = """
        from sphframe import OK, BoundaryInterpolator, Traits

        class Doubtful(BoundaryInterpolator):
            traits = Traits(non_negative=True)

            def point_weights(self, kernel, dim):
                def weights(offsets, distances, kernel_values, volumes, support, lift, out):
                    for j in range(len(out)):
                        out[j] = 2.0 / len(out)
                    return OK
                return weights
    """
    install("sphframe-doubtful", {"doubtful": source}, {"interpolators": {"doubtful": "doubtful:Doubtful"}})
    assert print_verification(["doubtful:Doubtful"], as_json=True) == 1
    (report,) = json.loads(capsys.readouterr().out)
    assert report["broken"]
    assert report["properties"]["partition_of_unity"] == "broken"
    assert report["properties"]["volume_independence"] == "held"
    assert report["properties"]["linear_reproduction"] == "absent"
    assert any("sum to 2" in check["failure"] for check in report["checks"] if check["failure"])


def test_components_that_cannot_be_created_are_reported():
    (report,) = verify(["improved-shepard[mu=-1]"])
    assert report.broken
    assert "mu must be a positive number" in report.error


def test_unknown_names_are_explained():
    with pytest.raises(UnknownComponentError, match="shepard"):
        list(verify(["shephard"]))


def test_every_form_of_a_method_is_verified_by_default():
    from sphframe.testing.verification import _installed

    labels = [label for _, label, _, _ in _installed("interpolators")]
    assert {"sfdi", "sfdi[form=printed]", "mls-linear"} <= set(labels)


def test_installed_plugins_can_be_hidden(no_installed_plugins):
    assert available("interpolators") == []
    assert "gaussian" in [entry.name for entry in available("kernels")]


def test_importing_the_suite_compiles_nothing():
    code = (
        "import sphframe.testing, sys; assert 'numba' not in sys.modules;"
        " from sphframe.testing import checks_of, clouds, parametrize_with_checks, verify;"
        " from numba.core.dispatcher import Dispatcher; import gc;"
        " compiled = [f for f in gc.get_objects() if isinstance(f, Dispatcher) and f.signatures"
        " and f.__module__.startswith('sphframe')]; assert not compiled, compiled"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_magnification_increases_with_extrapolation():
    square = np.array([[x, y] for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)])
    inside = Cloud(square, np.ones(9), 3.0)
    assert magnification(inside, 1) == pytest.approx(1.0)
    two = Cloud([[1.0, -0.5], [1.0, 0.5], [2.0, -0.5], [2.0, 0.5]], np.ones(4), 30.0)  # weights nearly equal
    assert magnification(two, 1) == pytest.approx(3.0, rel=0.05)  # 2 f(1) - f(2)
    assert magnification(two, 1, at_ghost=True) == magnification(two, 1), "the ghost is at the point"
    lifted = Cloud(two.offsets, np.ones(4), 30.0, lift=[-1.0, 0.0])
    assert magnification(lifted, 1, at_ghost=True) == pytest.approx(5.0, rel=0.05)  # 3 f(1) - 2 f(2)
    assert magnification(two, 1) < magnification(Cloud(two.offsets + np.array([1.0, 0.0]), np.ones(4), 30.0), 1)
