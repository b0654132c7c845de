"""Specialised loops: distinguished by their parts, found on disk, compiled again when a part changes."""

import subprocess
import sys
import types
from pathlib import Path

import numba
import numpy as np
import pytest

from sphframe.compiled import compile_part, fingerprint, specialise

SCALE = 2.0


def part(x):
    return SCALE * x


def template(values):
    for i in range(values.shape[0]):
        values[i] = PART(values[i]) + OFFSET  # noqa: F821


def power(exponent):
    def function(x):
        return x**exponent

    return function


def run(loop):
    values = np.array([3.0])
    loop(values)
    return values[0]


def test_parts_of_equal_name_are_distinguished():
    loops = [specialise(template, {"PART": power(k), "OFFSET": 1.0}, parallel=False) for k in (1, 2, 3)]
    assert [run(loop) for loop in loops] == [4.0, 10.0, 28.0]
    assert run(specialise(template, {"PART": power(2), "OFFSET": 5.0}, parallel=False)) == 14.0


def test_fingerprint_does_not_depend_on_where_packages_are_installed():
    def root(x):
        return np.sqrt(x)

    elsewhere = types.ModuleType("numpy")
    elsewhere.__file__, elsewhere.sqrt = "/another/environment/numpy/__init__.py", np.sqrt
    moved = types.FunctionType(root.__code__, {**root.__globals__, "np": elsewhere}, root.__name__)
    assert repr(elsewhere) != repr(np)
    assert fingerprint(moved) == fingerprint(root)


def test_equal_parts_give_the_same_loop():
    one = specialise(template, {"PART": power(2), "OFFSET": 1.0}, parallel=False)
    assert one is specialise(template, {"PART": power(2), "OFFSET": 1.0}, parallel=False)
    assert compile_part(power(2)) is compile_part(power(2))


def test_a_loop_for_one_thread_is_compiled_without_threads(monkeypatch):
    loops = []
    for threads in (1, 2, 1):
        monkeypatch.setattr(numba, "get_num_threads", lambda threads=threads: threads)
        loops.append(specialise(template, {"PART": power(3), "OFFSET": 0.0}))
    assert [loop.targetoptions["parallel"] for loop in loops] == [False, True, False]
    assert loops[0] is loops[2]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("def f(x): return x + 1", "def f(x): return x + 2"),
        ("def f(x): return x + 1", "def f(x): return x - 1"),
        ("K = 1\ndef f(x): return x + K", "K = 2\ndef f(x): return x + K"),
        ("K = (1, 2)\ndef f(x): return x + K[0]", "K = (1, 3)\ndef f(x): return x + K[0]"),
        ("def g(x): return x\ndef f(x): return g(x)", "def g(x): return -x\ndef f(x): return g(x)"),
        ("import math\ndef f(x): return math.sin(x)", "import math\ndef f(x): return math.cos(x)"),
        ("def f(x, k=1): return x + k", "def f(x, k=2): return x + k"),
    ],
)
def test_fingerprint_sees_every_change(first, second):
    prints = []
    for source in (first, second, first):
        scope = {"__name__": "plugin"}
        exec(source, scope)
        prints.append(fingerprint(scope["f"]))
    assert prints[0] != prints[1]
    assert prints[0] == prints[2]


HELPERS = {
    "a constant of a module": ("ALPHA = {}", "import h\ndef f(x): return h.ALPHA * x"),
    "a constant of a module in a module": ("import h\nALPHA = {}", "import h\ndef f(x): return h.h.ALPHA * x"),
    "a function of a module": (
        "import numba\n@numba.njit\ndef g(x): return {} * x",
        "import h\ndef f(x): return h.g(x)",
    ),
    "a ufunc": ("import numba\n@numba.vectorize\ndef g(x): return {} * x", "from h import g\ndef f(x): return g(x)"),
    "an intrinsic": (
        "from numba.extending import intrinsic\n@intrinsic\ndef g(context, x): return x(x), {}",
        "from h import g\ndef f(x): return g(x)",
    ),
    "a global of an inner function": (
        "ALPHA = {}",
        "from h import ALPHA\ndef f(x):\n  def inner(y): return ALPHA * y\n  return inner(x)",
    ),
    "an attribute of a class": ("class C:\n  ALPHA = {}", "from h import C\ndef f(x): return C.ALPHA * x"),
    "a keyword": ("", "def f(x, *, alpha={}): return alpha * x"),
}


@pytest.mark.parametrize("what", HELPERS)
def test_fingerprint_sees_what_is_reached_through(what, monkeypatch):
    prints = []
    for number in (2, 9, 2):
        for name, source in zip(("h", "plugin"), HELPERS[what], strict=True):
            module = types.ModuleType(name)
            monkeypatch.setitem(sys.modules, name, module)
            exec(source.replace("{}", str(number)), module.__dict__)
        prints.append(fingerprint(module.f))
    assert prints[0] != prints[1]
    assert prints[0] == prints[2]


@pytest.mark.parametrize("other", ["f", "g"])
def test_fingerprint_does_not_depend_on_docstrings(other):
    prints = []
    for docstring in ("Double it.", "Return twice the number."):
        scope = {"__name__": "plugin"}
        text = {"f": "One.", "g": "Two.", other: docstring}
        exec(f"def g(x):\n  '{text['g']}'\n  return x\ndef f(x):\n  '{text['f']}'\n  return 2 * g(x)", scope)
        prints.append(fingerprint(scope["f"]))
    assert prints[0] == prints[1]


PROGRAM = """
import numpy as np
import module
from sphframe.compiled import specialise
loop = specialise(module.template, {"PART": module.part}, parallel=False)
values = np.array([3.0])
loop(values)
print(values[0], sum(loop.stats.cache_hits.values()))
"""

MODULE = """
from plugin import part
def template(values):
    for i in range(values.shape[0]):
        values[i] = PART(values[i])
"""


def in_new_process(folder):
    result = subprocess.run([sys.executable, "-c", PROGRAM], cwd=folder, capture_output=True, text=True, check=True)
    value, hits = result.stdout.split()
    return float(value), int(hits)


def test_second_process_finds_the_loop_and_an_edited_part_makes_a_new_one(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "module.py").write_text(MODULE)

    def write(formula):
        (tmp_path / "plugin.py").write_text(f"def part(x):\n    return {formula}\n")

    def files():
        return sorted(path.name for path in (tmp_path / "cache").rglob("*.nb?"))

    write("x * x")
    assert in_new_process(tmp_path) == (9.0, 0)
    once = files()
    assert in_new_process(tmp_path) == (9.0, 1), "the second process must find the compiled loop"
    assert files() == once, "the cache must not grow when nothing changed"
    write("x + 1.0")
    assert in_new_process(tmp_path) == (4.0, 0), "an edited part must be compiled again"

    (tmp_path / "plugin.py").write_text(
        "import numba, h\n@numba.njit(cache=True)\ndef f(x): return h.ALPHA * x\ndef part(x): return f(x)\n"
    )
    for alpha in (2.0, 19.0):  # of other lengths: Python does not notice edits within a second that keep the size
        (tmp_path / "h.py").write_text(f"ALPHA = {alpha}\n")
        assert in_new_process(tmp_path) == (3.0 * alpha, 0), "a cached helper must not keep the constant of its module"
