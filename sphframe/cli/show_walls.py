"""CLI: ``sphframe show --walls``."""

from pathlib import Path

from sphframe.analysis import plot_walls
from sphframe.cases import load_case


def show_walls_command(name: str, preset: str | None, output: Path | None) -> None:
    """Draw the walls of a case with its ghosts, mirror points and fluid, and how these fill the kernel."""
    target = output or Path(f"{Path(name).stem}-walls.png")
    plot_walls(load_case(name, preset), target)
    print(f"wrote {target}")
