"""The tutorials for plugin authors, executed as written, outside of this repository."""

import ast
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
BLOCK = re.compile(r"^```(bash|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class Reader:
    """Executes the blocks of a tutorial in ``folder``."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.output = ""
        self.site = folder / "site"
        self.site.mkdir()
        self.environment = {**os.environ, "PYTHONPATH": str(self.site), "COLUMNS": "200", "NO_COLOR": "1"}
        self.environment["NUMBA_NUM_THREADS"] = "1"  # loops compile in half the time

    def bash(self, block: str) -> None:
        self.output = ""
        for line in block.splitlines():
            command, _, comment = line.partition("  # exits with ")
            first, *arguments = shlex.split(command)
            if first == "cd":
                self.folder = self.folder / arguments[0]
            elif (first, *arguments) == ("pip", "install", "-e", "."):
                self.install()
            else:
                module = {"sphframe": "sphframe", "pytest": "pytest"}[first]
                done = subprocess.run(
                    [sys.executable, "-m", module, *arguments],
                    cwd=self.folder, env=self.environment, capture_output=True, text=True,
                )  # fmt: skip
                self.output += done.stdout + done.stderr
                assert done.returncode == int(comment or 0), f"{line}\n{self.output}"

    def install(self) -> None:
        """Do what an editable install by pip does, without a network."""
        project = tomllib.loads((self.folder / "pyproject.toml").read_text())["project"]
        info = self.site / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
        )
        (info / "entry_points.txt").write_text(
            "".join(
                f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in points.items())
                for group, points in project["entry-points"].items()
            )
        )
        self.environment["PYTHONPATH"] += os.pathsep + str(self.folder)

    def python(self, block: str) -> None:
        title, _, code = block.partition("\n")
        if not title.startswith("# "):
            (self.folder / "look.py").write_text(block)
            done = subprocess.run(
                [sys.executable, "look.py"], cwd=self.folder, env=self.environment, capture_output=True, text=True
            )
            assert done.returncode == 0, done.stderr
        elif title.endswith("the line of the traits"):
            path = self.folder / title[2:].partition(",")[0]
            path.write_text(re.sub(r"^    traits = .*\n", code, path.read_text(), flags=re.MULTILINE))
        else:
            (self.folder / title[2:]).write_text(code)

    def text(self, block: str) -> None:
        seen = " ".join(self.output.split())
        for line in block.splitlines():
            assert " ".join(line.split()) in seen, f"the tutorial shows {line!r}, but the output is\n{self.output}"


def read(name: str, folder: Path) -> Reader:
    reader = Reader(folder)
    for language, block in BLOCK.findall((DOCS / name).read_text()):
        getattr(reader, language)(block)
    return reader


@pytest.mark.long
def test_the_tutorial_works_as_written(tmp_path: Path) -> None:
    reader = read("tutorial_plugin.md", tmp_path)
    assert (reader.folder / "dam-break-franke-little.nc").exists()
    shutil.rmtree(reader.folder)


@pytest.mark.long
def test_the_tutorial_of_wall_treatments_works_as_written(tmp_path: Path) -> None:
    reader = read("tutorial_treatment.md", tmp_path)
    assert (reader.folder / "density-walls.nc").exists()


def test_a_treatment_of_each_class_has_under_30_lines() -> None:
    parts = set()
    for language, block in BLOCK.findall((DOCS / "tutorial_treatment.md").read_text()):
        for node in ast.parse(block).body if language == "python" else ():
            if isinstance(node, ast.ClassDef) and node.bases:
                assert node.end_lineno is not None
                assert node.end_lineno - node.lineno + 1 < 30, node.name
                parts |= {f.name for f in ast.walk(node) if isinstance(f, ast.FunctionDef)}
    assert {"assign", "seen", "force", "rate", "surface"} <= parts
