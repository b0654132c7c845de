"""Plant single wrong expressions in sphframe, and count how many the tests of their rooms notice.

    uv run python tests/mutation/mutants.py --seed 1 --count 20 physics boundary
    uv run python tests/mutation/mutants.py --only physics/momentum.py:35:12:0      # one mutant again

A mutant is a file with one change of its syntax tree: another operator, comparison or number, a negation left out, a
statement left out. It is planted in a copy of the repository, where the tests of its room run until the first fails. A
mutant that no test notices has survived; ``equivalents.toml`` lists those that change nothing, with the reason. Tests
that are slow or long are left out. Each mutant starts from a cache of loops that the unchanged code has compiled, and
what it compiles is thrown away: Numba does not notice a change in a function that a cached one calls from another file.
``SPHFRAME_MUTATION_CACHE`` names the folder of the copy and its caches, which is kept for the next call.
"""

import argparse
import ast
import copy
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
from typing import NamedTuple

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
ROOMS = {
    "physics": "reference physics kernels simulation/test_shifting.py simulation/test_open_boundaries.py"
    " ../plugins/sphframe-edge-integrals/tests",
    "boundary": "reference boundary physics simulation/test_tension.py simulation/test_simulation.py"
    " simulation/test_thin_walls.py",
    "neighbours": "neighbours reference simulation/test_periodic.py simulation/test_thin_walls.py",
    "simulation": "reference simulation robustness/test_guards.py robustness/test_resume.py robustness/test_limits.py",
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
KILLED, SURVIVED = "killed", "SURVIVED"


class Mutant(NamedTuple):
    """Where a change is made: file below sphframe, line and column, and which of those that are possible there."""

    file: str
    line: int
    column: int
    number: int
    old: str
    new: str

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
    for node in nodes(ast.parse(source)):
        for new in changes(node):
            place = node.lineno, node.col_offset  # type: ignore[attr-defined]
            number = seen[place] = seen.get(place, -1) + 1
            old = " ".join(ast.unparse(node).split())
            yield (
                Mutant(file, *place, number, old, "nothing" if new is None else ast.unparse(new)),
                replaced(source, node, new),
            )


def chosen(rooms: list[str], seed: int, count: int) -> list[tuple[Mutant, str]]:
    """Return ``count`` random mutants of each of ``rooms``."""
    found = []
    for room in rooms:
        files = sorted(str(p.relative_to(ROOT / "sphframe")) for p in (ROOT / "sphframe" / room).glob("*.py"))
        every = [mutant for file in files for mutant in mutants_of(file)]
        found += random.Random(f"{seed} {room}").sample(every, min(count, len(every)))
    return found


class Copy:
    """A copy of the repository in ``folder``, with the loops that its unchanged code compiles."""

    def __init__(self, folder: Path) -> None:
        self.tree, self._caches = folder / "tree", folder
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True,
            check=True, text=True,
        )  # fmt: skip
        for name in listed.stdout.rstrip("\0").split("\0"):
            source, target = ROOT / name, self.tree / name
            if source.is_file() and not (target.exists() and target.stat().st_mtime == source.stat().st_mtime):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, target)

    def warm(self, room: str) -> float:
        """Run the tests of a room on the unchanged code, which must pass; return the time it took, s."""
        start = time.monotonic()
        code, output = self._run(room, self._caches / "cache", None)
        if code:
            raise SystemExit(f"the tests of {room} fail without any mutant:\n{output}")
        return time.monotonic() - start

    def verdict(self, mutant: Mutant, source: str, limit: float) -> tuple[str, str]:
        """Return whether the tests of the mutant's room notice it, and the first that does."""
        path, cache = self.tree / "sphframe" / mutant.file, self._caches / "cache-of-mutant"
        shutil.rmtree(cache, ignore_errors=True)
        shutil.copytree(self._caches / "cache", cache, copy_function=os.link)
        for index in cache.glob(f"{mutant.file.partition('/')[0]}_*/*.nbi"):
            if not re.search("_[0-9a-f]{20}[sp]-", index.name):  # it is not named by all that it calls
                index.unlink()
        original, stamp = path.read_text(), path.stat()
        try:
            path.write_text(source)
            code, output = self._run(mutant.file.partition("/")[0], cache, limit)
        finally:
            path.write_text(original)
            os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
        failed = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
        return (KILLED if code else SURVIVED), (failed or [output.strip()[-120:]])[0][:160]

    def _run(self, room: str, cache: Path, limit: float | None) -> tuple[int, str]:
        tests = [f"tests/{path}" for path in ROOMS[room].split()]
        environment = {
            **os.environ, "NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": f"{self.tree}:{HERE}",
            "OMP_WAIT_POLICY": "passive", "PYTHONDONTWRITEBYTECODE": "1",
        }  # fmt: skip
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
            return 1, "it took too long"
        return done.returncode, done.stdout[-20000:]


def pytest_collection() -> None:
    """As a plugin of pytest: hypothesis stops at the first failure, with the same examples each time."""
    from hypothesis import HealthCheck, Phase, settings

    settings.register_profile(
        "first-failure", deadline=None, derandomize=True, database=None, phases=(Phase.explicit, Phase.generate),
        suppress_health_check=list(HealthCheck), report_multiple_bugs=False,
    )  # fmt: skip
    settings.load_profile("first-failure")


def main() -> None:
    """Run the mutants that are asked for, and print the score of each room."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rooms", nargs="*", help=f"of {', '.join(ROOMS)}; by default all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=10, help="random mutants of each room")
    parser.add_argument("--only", action="append", default=[], help="key of a mutant, instead of random ones")
    options = parser.parse_args()
    if options.only:
        files = {key.partition(":")[0] for key in options.only}
        todo = [m for file in sorted(files) for m in mutants_of(file) if m[0].key in options.only]
    else:
        todo = chosen(options.rooms or list(ROOMS), options.seed, options.count)
    equivalents = tomllib.loads((HERE / "equivalents.toml").read_text())
    folder = Path(os.environ.get("SPHFRAME_MUTATION_CACHE") or tempfile.mkdtemp(prefix="sphframe-mutants-"))
    place = Copy(folder)
    limits: dict[str, float] = {}
    score: dict[str, list[str]] = {}
    for mutant, source in todo:
        room = mutant.file.partition("/")[0]
        if mutant.old in equivalents.get(mutant.file, {}):
            print(f"equivalent {mutant.key} {mutant.old} -> {mutant.new}", flush=True)
            continue
        if room not in limits:
            limits[room] = 5.0 * place.warm(room) + 120.0
        verdict, by = place.verdict(mutant, source, limits[room])
        score.setdefault(room, []).append(verdict)
        print(f"{verdict} {mutant.key} {mutant.old[:80]} -> {mutant.new[:80]}   {by}", flush=True)
    for room, verdicts in score.items():
        print(f"{room}: {verdicts.count(KILLED)} of {len(verdicts)} killed")


if __name__ == "__main__":
    main()
