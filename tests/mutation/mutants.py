"""Plant single wrong expressions in sphframe, and count how many the tests of their rooms notice.

    uv run python tests/mutation/mutants.py --seed 1 --count 20 physics boundary
    uv run python tests/mutation/mutants.py --only physics/momentum.py:35:12:0      # one mutant again

A mutant is a file with one change of its syntax tree: another operator, comparison or number, a negation left out, a
statement left out. It is planted in a copy of the repository, where the tests of its room run until the first fails. A
mutant that no test notices has survived; ``equivalents.toml`` lists those that change nothing, with the reason. Tests
that are slow or long are left out. Mutants share a cache of compiled loops: most are named by a hash of all code that
they call, and the others of the mutant's room are thrown away. At the end the tests that killed run without a mutant.
``SPHFRAME_MUTATION_CACHE`` names the folder of the copy and its cache, which is kept for the next call.
"""

import argparse
import ast
import copy
import itertools
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
ROOMS = {
    "physics": "reference physics kernels simulation/test_shifting.py simulation/test_open_boundaries.py"
    " ../plugins/sphframe-edge-integrals/tests",
    "boundary": "reference boundary physics simulation/test_tension.py simulation/test_simulation.py"
    " simulation/test_thin_walls.py simulation/test_saved_state.py",
    "neighbours": "neighbours reference simulation/test_periodic.py simulation/test_thin_walls.py",
    "simulation": "simulation robustness/test_guards.py robustness/test_resume.py robustness/test_limits.py reference",
    "bodies": "bodies reference simulation/test_body_force.py",
    "output": "output robustness/test_files.py",
    "geometry": "geometry boundary",
}
"""the tests of each room, the quickest and sharpest first"""
SWAPPED = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult, ast.Mod: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.MatMult: ast.Add, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd, ast.Lt: ast.GtE,
    ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot,
    ast.IsNot: ast.Is, ast.And: ast.Or, ast.Or: ast.And,
    ast.In: ast.NotIn, ast.NotIn: ast.In,  # codespell:ignore
}  # fmt: skip
KILLED, SURVIVED, UNDECIDED = "killed", "SURVIVED", "UNDECIDED"


class Mutant(NamedTuple):
    """Where a change is made: file below sphframe, line and column, which of those possible there, and the line."""

    file: str
    line: int
    column: int
    number: int
    old: str
    new: str
    text: str

    @property
    def key(self) -> str:
        """File, line, column and number."""
        return f"{self.file}:{self.line}:{self.column}:{self.number}"


def changes(node: ast.AST) -> Iterator[ast.AST | None]:
    """Return what may take the place of ``node``; None for a statement that is left out."""
    if isinstance(node, ast.BinOp | ast.AugAssign | ast.BoolOp) and type(node.op) in SWAPPED:
        changed = copy.deepcopy(node)
        changed.op = SWAPPED[type(node.op)]()  # type: ignore[assignment]
        yield changed
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in SWAPPED:
        changed = copy.deepcopy(node)
        changed.ops[0] = SWAPPED[type(node.ops[0])]()  # type: ignore[call-overload]
        yield changed
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield node.operand
    elif isinstance(node, ast.Constant) and type(node.value) is bool:
        yield ast.Constant(not node.value)
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
        yield ast.Constant(node.value + 1 if isinstance(node.value, int) else 1.5 * node.value or 1.0)
    elif isinstance(node, ast.IfExp):
        yield ast.IfExp(ast.UnaryOp(ast.Not(), node.test), node.body, node.orelse)
    if (
        isinstance(node, ast.AugAssign)
        or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call))
        or (isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript | ast.Attribute))
    ):
        yield None


def nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """Return the nodes that compute something; not those of annotations, errors, texts and decorators."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if not isinstance(child, ast.AST):
                continue
            if isinstance(child, ast.Raise | ast.JoinedStr | ast.Import | ast.ImportFrom | ast.Assert):
                continue
            yield child
            yield from nodes(child)


def replaced(source: str, node: ast.AST, new: ast.AST | None) -> str:
    """Return ``source`` with the text of ``node`` replaced."""
    lines = source.encode().splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))
    begin = starts[node.lineno - 1] + node.col_offset  # type: ignore[attr-defined]
    end = starts[node.end_lineno - 1] + node.end_col_offset  # type: ignore[attr-defined]
    text = "pass" if new is None else ast.unparse(new)
    if isinstance(new, ast.expr):
        text = f"({text})"
    whole = source.encode()
    return (whole[:begin] + text.encode() + whole[end:]).decode()


def mutants_of(file: str) -> Iterator[tuple[Mutant, str]]:
    """Return the mutants of a file, and their whole sources."""
    source = (ROOT / "sphframe" / file).read_text()
    seen: dict[tuple[int, int], int] = {}
    lines = source.splitlines()
    for node in nodes(ast.parse(source)):
        for new in changes(node):
            place = node.lineno, node.col_offset  # type: ignore[attr-defined]
            number = seen[place] = seen.get(place, -1) + 1
            old = " ".join(ast.unparse(node).split())
            yield (
                Mutant(
                    file,
                    *place,
                    number,
                    old,
                    "nothing" if new is None else ast.unparse(new),
                    lines[place[0] - 1].strip(),
                ),
                replaced(source, node, new),
            )


def chosen(rooms: list[str], seed: int, count: int, skip: int) -> list[tuple[Mutant, str]]:
    """Return ``count`` random mutants of each of ``rooms``, of one room after the other, without the first ``skip``."""
    found = []
    for room in rooms:
        files = sorted(str(p.relative_to(ROOT / "sphframe")) for p in (ROOT / "sphframe" / room).glob("*.py"))
        every = [mutant for file in files for mutant in mutants_of(file)]
        random.Random(f"{seed} {room}").shuffle(every)
        found.append(every[skip:count])
    return [mutant for row in itertools.zip_longest(*found) for mutant in row if mutant]


class Copy:
    """A copy of the repository in ``folder``, with a cache of its compiled loops."""

    def __init__(self, folder: Path) -> None:
        self.tree, self._folder, self._cache = folder / "tree", folder, folder / "cache"
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True,
            check=True, text=True,
        )  # fmt: skip
        for name in listed.stdout.rstrip("\0").split("\0"):
            source, target = ROOT / name, self.tree / name
            if source.is_file() and not (target.exists() and target.stat().st_mtime == source.stat().st_mtime):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, target)
        for room in ROOMS:
            self._forget(room)

    def verdict(self, mutant: Mutant, source: str, limit: float) -> tuple[str, str]:
        """Return whether the tests of the mutant's room notice it within ``limit``, s, and the first that does."""
        path, room = self.tree / "sphframe" / mutant.file, mutant.file.partition("/")[0]
        self._forget(room)
        original, stamp = path.read_text(), path.stat()
        try:
            path.write_text(source)
            code, output = self.run(self._in_order(mutant.file), limit)
        finally:
            path.write_text(original)
            os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
            self._forget(room)
        failed = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
        return (UNDECIDED if code is None else KILLED if code else SURVIVED), (failed or [output.strip()[-120:]])[0]

    def run(self, tests: list[str], limit: float | None) -> tuple[int | None, str]:
        """Run ``tests`` until the first fails; return the exit code, None if it took too long, and what they print."""
        environment = {
            **os.environ, "NUMBA_CACHE_DIR": str(self._cache), "OMP_WAIT_POLICY": "passive", "NUMBA_NUM_THREADS": "2",
            "PYTHONPATH": f"{self.tree}:{self.tree / HERE.relative_to(ROOT)}",
            "PYTHONPYCACHEPREFIX": str(self._folder / "byte-code"),
        }  # fmt: skip
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        command = [
            sys.executable, "-m", "pytest", "-x", "-q", "-p", "mutants", "-p", "no:cacheprovider", "-p", "no:xdist",
            "-p", "no:benchmark", "--tb=line", "-o", "addopts=--import-mode=importlib", "-m",
            "not slow and not long", *tests,
        ]  # fmt: skip
        try:
            done = subprocess.run(
                command, cwd=self.tree, env=environment, capture_output=True, text=True, timeout=limit, check=False
            )
        except subprocess.TimeoutExpired:
            return None, f"no answer within {limit:.0f} s"
        return done.returncode, done.stdout[-20000:]

    def _in_order(self, file: str) -> list[str]:
        """Return the files of tests of a room: first namesakes of ``file``, then those that name what it defines."""
        tree = ast.parse((self.tree / "sphframe" / file).read_text())
        names = [node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)]
        room, module = file.removesuffix(".py").split("/")
        named = re.compile(rf"\b({'|'.join([f'{room}.{module}', *names])})\b")
        paths = [self.tree / "tests" / path for path in ROOMS[room].split()]
        files = [test for path in paths for test in (sorted(path.glob("test_*.py")) if path.is_dir() else [path])]
        files.sort(key=lambda test: not named.search(test.read_text()))
        files.sort(key=lambda test: module not in test.stem)
        return list(map(str, files))

    def _forget(self, room: str) -> None:
        """Remove the compiled loops of a room that are not named by a hash of all that they call."""
        for index in self._cache.glob(f"{room}_*/*.nbi"):
            if not re.search("_[0-9a-f]{20}[sp]-", index.name):
                index.unlink()


def pytest_configure() -> None:
    """As a plugin of pytest: load a loop that is named by a hash of its code also if its file has changed elsewhere."""
    from numba.core import caching

    caching._SourceFileBackedLocatorMixin.get_source_stamp = lambda self: ""


def pytest_collection() -> None:
    """As a plugin of pytest: hypothesis stops at the first failure, with the same examples each time."""
    from hypothesis import HealthCheck, Phase, settings

    settings.register_profile(
        "first-failure", deadline=None, derandomize=True, database=None, phases=(Phase.explicit, Phase.generate),
        suppress_health_check=list(HealthCheck), report_multiple_bugs=False,
    )  # fmt: skip
    settings.load_profile("first-failure")


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(items: list[Any]) -> Iterator[None]:
    """As a plugin of pytest: keep the order in which files were named; another hook puts slow ones first."""
    place = {item: k for k, item in enumerate(items)}
    yield
    items.sort(key=place.__getitem__)


def main() -> None:
    """Run the mutants that are asked for, and print the score of each room."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rooms", nargs="*", help=f"of {', '.join(ROOMS)}; by default all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=10, help="random mutants of each room")
    parser.add_argument("--skip", type=int, default=0, help="leave out the first ones of each room, to go on")
    parser.add_argument("--limit", type=float, default=900.0, help="for the tests of one mutant, s")
    parser.add_argument("--only", action="append", default=[], help="key of a mutant, instead of random ones")
    options = parser.parse_args()
    if options.only:
        files = {key.partition(":")[0] for key in options.only}
        todo = [m for file in sorted(files) for m in mutants_of(file) if m[0].key in options.only]
    else:
        todo = chosen(options.rooms or list(ROOMS), options.seed, options.count, options.skip)
    equivalents = tomllib.loads((HERE / "equivalents.toml").read_text())
    folder = Path(os.environ.get("SPHFRAME_MUTATION_CACHE") or tempfile.mkdtemp(prefix="sphframe-mutants-"))
    place = Copy(folder)
    score: dict[str, list[str]] = {}
    killers = set()
    for mutant, source in todo:
        if {mutant.old, f"{mutant.old} in {mutant.text}"} & equivalents.get(mutant.file, {}).keys():
            print(f"equivalent {mutant.key} {mutant.old} -> {mutant.new}", flush=True)
            continue
        start = time.monotonic()
        verdict, by = place.verdict(mutant, source, options.limit)
        score.setdefault(mutant.file.partition("/")[0], []).append(verdict)
        if match := re.fullmatch(r"(?:FAILED|ERROR) (\S+?)(?:\[.*| .*)?", by):
            killers.add(match[1])
        seconds = time.monotonic() - start
        print(f"{verdict} {mutant.key} {mutant.old[:80]} -> {mutant.new[:80]}  {seconds:.0f} s {by[:160]}", flush=True)
    for room, verdicts in score.items():
        print(f"{room}: {verdicts.count(KILLED)} of {len(verdicts)} killed")
    if killers and place.run(sorted(killers), None)[0]:
        raise SystemExit("a test that killed a mutant fails without it too")


if __name__ == "__main__":
    main()
