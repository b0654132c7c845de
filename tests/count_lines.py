"""Count lines of code without docstrings and blank lines, per room: ``python tests/count_lines.py``."""

import ast
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "sphframe"
AROUND = ("analysis", "benchmark", "cli", "studies", "testing")
"""rooms that use the core; all other rooms belong to it"""


def code_lines(path: Path) -> int:
    """Return the number of lines of code; a text that stands alone, such as a docstring, is no code."""
    text = path.read_text(encoding="utf-8")
    prose: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            prose.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return sum(bool(line.strip()) and number not in prose for number, line in enumerate(text.splitlines(), start=1))


def lines_of_rooms() -> dict[str, int]:
    """Return the number of lines of code of each room of sphframe."""
    rooms: dict[str, int] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        room = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        rooms[room] = rooms.get(room, 0) + code_lines(path)
    return rooms


def core_lines() -> int:
    """Return the number of lines of code of the core."""
    return sum(lines for room, lines in lines_of_rooms().items() if room not in AROUND)


if __name__ == "__main__":
    for name, lines in lines_of_rooms().items():
        print(f"{lines:6d}  {name}{'' if name in AROUND else '  (core)'}")
    print(f"{core_lines():6d}  core")
