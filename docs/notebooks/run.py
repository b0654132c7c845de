"""Documentation: runs the notebooks of this folder and keeps their outputs (``python docs/notebooks/run.py``)."""

import base64
import io
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient
from PIL import Image

HERE = Path(__file__).parent


def small(picture: str) -> str:
    """Return a PNG picture, base64, as a small file."""
    stream = io.BytesIO()
    image: Any = Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB")
    image.thumbnail((1000, 2000))
    image.quantize(160).save(stream, format="png", optimize=True)
    return base64.b64encode(stream.getvalue()).decode()


if __name__ == "__main__":
    for path in sorted(HERE.glob("*.ipynb")):
        notebook: Any = nbformat.read(path, as_version=4)
        NotebookClient(notebook, timeout=None, record_timing=False).execute()
        for cell in notebook.cells:
            for output in cell.get("outputs", []):
                if "image/png" in output.get("data", {}):
                    output["data"]["image/png"] = small(output["data"]["image/png"])
        nbformat.write(notebook, path)
        print(path)
