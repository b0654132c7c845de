"""Documentation: draws the pictures of the gallery and of the README (``python docs/images/draw.py FOLDER``).

FOLDER receives the runs; one that is there is not repeated. Each picture is a file of a few colours.
"""

import io
import subprocess
import sys
from pathlib import Path
from typing import Any

from PIL import Image

from sphframe.analysis import plot_run
from sphframe.output import open_dataset

HERE = Path(__file__).parent
RUNS = {
    "dam-break.nc": "dam-break",
    "dam-break-mls-linear.nc": "dam-break --interpolator mls-linear --set particle_spacing=0.02",
    "floating-body.nc": "floating-body --set particle_spacing=0.03 --until 2",
    "solitary-wave-fixed-wall.nc": "solitary-wave-fixed-wall --set particle_spacing=0.025 --until 6",
    "dam-break-3d.nc": "dam-break-3d",
    "fine.nc": "dam-break-3d --set particle_spacing=0.0275 --until 0.9 --output fine.nc",
    "poiseuille.nc": "poiseuille --set particle_spacing=0.0625 --until 0.5",
}
"""the file of each run, and the arguments of ``sphframe run`` that make it"""
PICTURES: dict[str, tuple[str, dict[str, Any]]] = {
    "dam_break": ("dam-break.nc", {}),
    "gallery_speed": ("dam-break-mls-linear.nc", {"field": "speed", "times": [0.6, 1.5], "surface": True}),
    "gallery_floating_body": ("floating-body.nc", {}),
    "gallery_wave": ("solitary-wave-fixed-wall.nc", {}),
    "gallery_3d": ("dam-break-3d.nc", {"times": [0.4, 0.6, 0.9, 1.4]}),
    "gallery_oblique": ("fine.nc", {"field": "speed", "times": [0.4, 0.6, 0.75, 0.9], "oblique": True}),
    "gallery_surface": ("fine.nc", {"field": "speed", "times": [0.9], "oblique": True, "surface": True}),
    "gallery_exact": ("poiseuille.nc", {"field": "speed"}),
}
"""the run of each picture and how it is drawn"""


def draw(run: Path, picture: Path, **options: Any) -> None:
    """Draw a run as a small file."""
    drawing = io.BytesIO()
    with open_dataset(run) as dataset:
        plot_run(dataset, **options).savefig(drawing, format="png", dpi=110)
    image = Image.open(drawing).convert("RGB")
    small = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=2, dither=Image.Dither.NONE)
    if options.get("oblique") and options.get("surface"):  # where colours change so slowly that 256 of them show steps
        small = image.quantize(palette=small, dither=Image.Dither.FLOYDSTEINBERG)
    small.save(picture, optimize=True)
    print(picture, picture.stat().st_size)


if __name__ == "__main__":
    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(exist_ok=True)
    for file, arguments in RUNS.items():
        if not (folder / file).exists():
            subprocess.run([sys.executable, "-m", "sphframe", "run", *arguments.split()], cwd=folder, check=True)
    for name, (file, options) in PICTURES.items():
        draw(folder / file, HERE / f"{name}.png", **options)
