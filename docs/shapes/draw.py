"""Documentation: draws each case of this folder as it starts, one picture a shape (``python docs/shapes/draw.py``)."""

import io
from pathlib import Path
from typing import Any

from PIL import Image

from sphframe.analysis import plot_walls
from sphframe.cases import load_case

HERE = Path(__file__).parent


def draw(name: str, picture: Path, **options: Any) -> None:
    """Draw the case ``name`` as a small file."""
    drawing = io.BytesIO()
    plot_walls(load_case(HERE / f"{name}.toml"), **options).savefig(drawing, format="png", dpi=75)
    Image.open(drawing).convert("RGB").quantize(160).save(picture, optimize=True)
    print(picture)


if __name__ == "__main__":
    for path in sorted(HERE.glob("*.toml")):
        draw(path.stem, path.with_suffix(".png"), numbers=False)
    draw("ellipse", HERE.parent / "images/shapes_filling.png")
