"""Specialised loops: distinguished by their parts, found on disk, compiled again when a part changes."""

import subprocess
import sys
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
