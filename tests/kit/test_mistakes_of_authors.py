"""Mistakes that authors of components make: each is refused with a message that names it and its place."""

import re
import types

import numpy as np
import pytest

from sphframe import (
    OK,
    BoundaryInterpolator,
    EquationOfState,
    EvaluationPoint,
    Kernel,
    RigidBody,
    Seen,
    Traits,
    WallContext,
    WallParts,
    WallTraits,
    WallTreatment,
    create,
    load_case,
    local_array,
)
from sphframe.boundary.operator import operator
from sphframe.boundary.trial import try_weights
from sphframe.boundary.wall_trial import checked_parts
from sphframe.cases.placement import placed_scene
from sphframe.compiled.explain import explained
from sphframe.errors import BrokenPluginError, InputError
from sphframe.kernels import compiled_kernel
from sphframe.output.checkpoint import _versions, changed_versions
from sphframe.output.provenance import _hash_of, code
from sphframe.simulation.components import loop_parts
from sphframe.testing import BrokenPromiseError, checks_of

GAUSSIAN = compiled_kernel(create("kernels", "gaussian"), 2)


def helper(x):
    return x * x


class Method(BoundaryInterpolator):
    traits = Traits()

    def __init__(self, weights, traits=None):
        self.weights = weights
        self.traits = traits or Traits()

    def point_weights(self, kernel, dim):
        return self.weights


def equal(offsets, distances, kernel_values, volumes, support, lift, out):
    for j in range(len(out)):
        out[j] = 1.0 / len(out)
    return OK


def no_status(offsets, distances, kernel_values, volumes, support, lift, out):
    for j in range(len(out)):
        out[j] = 1.0 / len(out)


def status_on_one_branch(offsets, distances, kernel_values, volumes, support, lift, out):
    if len(out) > 30:
        return None
    return equal(offsets, distances, kernel_values, volumes, support, lift, out)


def no_lift(offsets, distances, kernel_values, volumes, support, out):
    return OK


def sixty_four(offsets, distances, kernel_values, volumes, support, lift, out):
    kept = local_array(64)
    for j in range(len(out)):
        kept[j] = kernel_values[j]
    return equal(offsets, distances, kernel_values, volumes, support, lift, out)


def behind_out(offsets, distances, kernel_values, volumes, support, lift, out):
    for j in range(len(out) + 1):
        out[j] = 1.0 / len(out)
    return OK


@pytest.mark.parametrize(
    ("weights", "complaint"),
    [
        (None, r"returned None; expected a function of \(offsets, .* out\): is its last line"),
        (no_lift, r"no_lift\(.*test_mistakes.* line \d+\); expected .*too many positional"),
        (no_status, "1 neighbour in 2-D, return None; expected a status: end every branch with 'return OK'"),
        (status_on_one_branch, "255 neighbours in 2-D, return None"),
        (lambda *arguments: (1.0, 2.0), r"return \(1.0, 2.0\); expected a status"),
        (sixty_four, "255 neighbours in 2-D, reach beyond an array: index 64"),
        (behind_out, r"reach beyond an array.*out\[n - 1\]"),
    ],
)
def test_weights_are_tried_before_they_are_compiled(weights, complaint):
    with pytest.raises(BrokenPluginError, match=complaint):
        try_weights(Method(weights), GAUSSIAN, 2, 2.7)


def test_what_only_runs_compiled_is_not_refused():
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        raise RuntimeError("not in plain Python")

    assert "RuntimeError: not in plain Python" in try_weights(Method(weights), GAUSSIAN, 2, 1.3)
    assert try_weights(Method(equal), GAUSSIAN, 2, 1.3) is None
    for point in EvaluationPoint:
        lifted = Method(lambda *a, takes=point.takes_lift: int(np.any(a[5]) != takes), Traits(evaluation_point=point))
        assert try_weights(lifted, GAUSSIAN, 2, 1.3) is None


def test_local_arrays_have_a_largest_size():
    for size in (0, 9000):
        with pytest.raises(InputError, match=r"local_array\(\d+\): give a size from 1 to 8192"):
            local_array(size)


def test_the_operator_guards_the_margins_of_its_arrays():
    def weights(offsets, distances, kernel_values, volumes, support, lift, out):
        for j in range(out.shape[0] + 2):
            out[j] = 1.0 / out.shape[0]
        return OK

    with pytest.raises(BrokenPluginError, match="Method writes before or after its array 'out'"):
        operator(Method(weights), [0.0, 0.0], [[0.1, 0.0], [0.2, 0.0]], 1.0, smoothing_length=1.0)


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        ("helper(distances[0])", r"'helper'.*\(.*test_mistakes.*, line \d+\); decorate helper with numba.njit"),
        ("distances.shap[0]", "Unknown attribute 'shap'.*check the spelling"),
        ("local_array(9000)[0]", r"local_array\(9000\): give a size from 1 to 8192"),
        ("len(1.0)", r"there is no len\(float64\)"),
    ],
)
def test_a_failed_compilation_is_explained(call, complaint):
    scope = {"__name__": "test_mistakes", "helper": helper, "local_array": local_array}
    source = (
        f"def weights(offsets, distances, kernel_values, volumes, support, lift, out):\n  out[0] = {call}\n  return 0"
    )
    exec(compile(source, "test_mistakes.py", "exec"), scope)
    with pytest.raises(Exception, match="nopython") as caught:
        operator(Method(scope["weights"]), [0.0, 0.0], [[0.1, 0.0]], 1.0, smoothing_length=1.0)
    text = explained(caught.value)
    assert text.startswith("does not compile: ")
    assert re.search(complaint, text), text
    assert explained(ValueError("no")) is None


class HalfKernel(Kernel):
    support = 2.0

    def value_function(self):
        def value(q):
            1.0 - 0.5 * q

        return value

    def gradient_function(self):
        return lambda q: -0.5

    def normalisation(self, dim):
        return 1.0


class TwoArguments(EquationOfState):
    def pressure_function(self):
        return lambda rho, rho0: rho

    density_function = sound_speed_function = pressure_function


class Walls(WallTreatment):
    traits = WallTraits()

    def __init__(self, **functions):
        self.functions = functions

    def parts(self, context):
        return WallParts(**self.functions) if self.functions else None


def test_kernels_and_equations_of_state_are_checked():
    with pytest.raises(
        BrokenPluginError, match=r"HalfKernel.value_function: value \(.*returns None; expected a number"
    ):
        compiled_kernel(HalfKernel(), 2)
    with pytest.raises(BrokenPluginError, match=r"TwoArguments.pressure_function.*expected a function of \(variable"):
        loop_parts(GAUSSIAN, TwoArguments(), 2)
    for component, name in ((HalfKernel(), "compiles"), (TwoArguments(), "compiles")):
        first = checks_of(component)[0]
        assert first.name == name
        with pytest.raises(BrokenPluginError):
            first(component)


@pytest.mark.parametrize(
    ("functions", "complaint"),
    [
        ({}, "Walls.parts returned None; expected WallParts: end it with"),
        (
            {"seen": lambda fluid, wall, separation: None},
            r"expected a function of \(fluid, wall, separation, constants\)",
        ),
        ({"seen": lambda fluid, wall, separation, constants: 1.0}, "returns 1.0; expected a sphframe.Seen"),
        ({"assign": lambda fluid, wall, constants, velocity, viscous: None}, "expected pressure and share: a 'return'"),
        ({"force": lambda wall, separation, constants: 1.0}, "the three components"),
        ({"rate": lambda near, wall, constants: (near.offsets[0, 0], wall.normal[0])}, "expected a number"),
    ],
)
def test_functions_of_treatments_are_checked(functions, complaint):
    context = WallContext(GAUSSIAN, 2, None)
    with pytest.raises(BrokenPluginError, match=complaint):
        checked_parts(Walls(**functions), context)


def test_right_functions_of_treatments_pass():
    right = {
        "seen": lambda fluid, wall, separation, constants: Seen(wall.ny, *[0.0] * 6),
        "assign": lambda fluid, wall, constants, velocity, viscous: (fluid.pressure, 1.0),
        "rate": lambda near, wall, constants: wall.state * near.slopes[0],
    }
    for dim in (2, 3):
        context = WallContext(compiled_kernel(create("kernels", "wendland-c2"), dim), dim, None)
        assert checked_parts(Walls(**right), context).seen is right["seen"]


def test_an_edited_plugin_is_noticed_when_a_run_is_resumed(install):
    source = "from sphframe import Traits, create\nclass Mine(type(create('interpolators', 'shepard'))):\n    pass\n"
    folder = install("sphframe-mine", {"mine": source}, {"interpolators": {"mine": "mine:Mine"}})
    case = load_case("hydrostatic-tank", None, {"interpolator": "mine"})
    before = code(case)
    assert set(before) == {"code of mine"}
    assert code(case) == before
    with (folder / "mine.py").open("a") as file:
        file.write("ALPHA = 2\n")
    _hash_of.cache_clear()
    changed = changed_versions(types.SimpleNamespace(versions=_versions(case) | before), case)
    assert changed == [f"code of mine {before['code of mine']}, now {code(case)['code of mine']}"]
    assert code(load_case("hydrostatic-tank", None, {})).keys() == {"code of sphframe_shepard"}


def test_a_scene_and_a_motion_must_be_returned():
    with pytest.raises(BrokenPluginError, match="scene returned None; expected a Scene: end it with"):
        placed_scene(types.SimpleNamespace(scene=lambda: None))

    class Tuple(RigidBody):
        def motion(self, time, position, velocity, load):
            return position, velocity, load

    with pytest.raises(BrokenPromiseError, match=r"expected a sphframe\.Motion"):
        checks_of(Tuple())[0](Tuple())
