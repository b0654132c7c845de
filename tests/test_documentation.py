"""The documentation builds without a warning and names every command and every public name."""

import importlib
import inspect
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import typer.main

from sphframe.boundary.operator import operator
from sphframe.cases import Custom, load_case, parameters_of
from sphframe.cli.app import app
from sphframe.cli.values import read_assignments
from sphframe.geometry import SHAPES
from sphframe.interfaces import EvaluationPoint
from sphframe.registry import available, create, load
from sphframe.testing import ghost_responses

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("sphinx")
    folder = tmp_path_factory.mktemp("site")
    quicker = ["-D", "toc_object_entries=0"]  # names in the tables of contents take a third of the time
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-d", f"{folder}-trees", *quicker]
    stored = {**os.environ, "SPHFRAME_DOCS_NOTEBOOKS": "off"}  # their outputs, as they are stored
    arguments = [*command, str(DOCS), str(folder)]
    done = subprocess.run(arguments, env=stored, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.long
@pytest.mark.parametrize("path", sorted((DOCS / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebooks_run(path: Path) -> None:
    client, formats = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    notebook = formats.read(path, as_version=4)
    assert any("image/png" in out.get("data", {}) for cell in notebook.cells for out in cell.get("outputs", []))
    client.NotebookClient(notebook, timeout=None, startup_timeout=1800).execute()


@pytest.mark.slow
@pytest.mark.parametrize(
    "module",
    [
        "sphframe",
        "sphframe.analysis",
        "sphframe.cases",
        "sphframe.devices",
        "sphframe.geometry",
        "sphframe.interfaces",
        "sphframe.studies",
        "sphframe.testing",
    ],
)
def test_every_public_name_is_documented(site: Path, module: str) -> None:
    page = "".join(page.read_text(encoding="utf-8") for page in (site / "api").glob("*.html"))
    public = importlib.import_module(module).__all__
    homes = {module, "sphframe", "sphframe.interfaces"}  # what these offer themselves is documented once, there
    missing = [name for name in public if not any(f'id="{home}.{name}"' in page for home in homes)]
    assert not missing


@pytest.mark.slow
def test_internal_links_lead_somewhere(site: Path) -> None:
    pages = {page.relative_to(site).as_posix(): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    for name, text in pages.items():
        for page, anchor in re.findall(r'href="([\w./-]*)#([^"]+)"', text):
            target = os.path.normpath(Path(name).parent / page) if page else name
            assert target in pages, f"{name} links to {target}"
            assert f'id="{anchor}"' in pages[target] or not anchor, f"{name} links to {target}#{anchor}"


def test_every_command_has_a_how_to_with_all_its_options() -> None:
    introduction, *sections = re.split(r"^## ", (DOCS / "commands.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    how_tos = {title: text for title, _, text in (section.partition("\n") for section in sections)}
    assert sorted(how_tos) == sorted(COMMANDS)
    for name, command in COMMANDS.items():
        assert f"    sphframe {name}" in how_tos[name], f"no example of {name}"
        options = [option for parameter in command.params for option in parameter.opts if option.startswith("--")]
        missing = [
            option for option in options if f"{option}`" not in how_tos[name] and f"{option} " not in how_tos[name]
        ]
        assert missing in ([], ["--help"]), f"the how-to of {name} is silent about {missing}"
    for option in ("--install-completion", "--show-completion", "--version", "--help"):
        assert option in introduction


def command_lines() -> list[str]:
    """All calls of sphframe in code blocks of the README and the documentation, except those of the tutorial."""
    pages = {ROOT / "README.md", *DOCS.rglob("*.md")} - {DOCS / "tutorial_plugin.md"}
    line = re.compile(r"^ {4}(?:uv run )?(sphframe [a-z].*?)(?: +# .*)?$", flags=re.MULTILINE)
    texts = [re.sub(r" \\\n\s*", " ", page.read_text(encoding="utf-8")) for page in pages]
    return sorted({call for text in texts for call in line.findall(text)})


@pytest.mark.parametrize("line", command_lines())
def test_commands_in_the_docs_are_understood(line: str) -> None:
    name, *arguments = shlex.split(line)[1:]
    context = COMMANDS[name].make_context(name, list(arguments))  # raises where an option or a value is not known
    given = context.params
    if name in ("run", "compare", "show") and any(entry.name == arguments[0] for entry in available("cases")):
        parameters = read_assignments(given.get("assignments") or [], {"interpolator": given.get("interpolator")})
        if name == "compare":
            parameters.pop("particle_spacing", None)
            for method in given["interpolators"].replace("my-method", "normalized").split(","):
                treats = any(entry.name == method for entry in available("wall_treatments"))
                create("wall_treatments" if treats else "interpolators", method)
        load_case(arguments[0], given["preset"], parameters)


@pytest.mark.parametrize("path", sorted((DOCS / "shapes").glob("*.toml")), ids=lambda path: path.stem)
def test_cases_of_the_gallery_of_shapes_can_be_run(path: Path) -> None:
    load_case(path)
    assert path.with_suffix(".png").is_file(), "draw it by python docs/shapes/draw.py"
    assert path.stem in SHAPES


def test_every_key_option_and_name_of_the_tables_has_a_meaning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(str(DOCS))
    importlib.import_module("tables").write(tmp_path)
    pages = {page.stem: page.read_text(encoding="utf-8") for page in tmp_path.glob("*.md")}
    lines = [line for page in pages.values() for line in page.splitlines() if line.startswith("|")]
    assert not [line for line in lines if line.endswith("|  |")]
    for parameter in parameters_of(Custom):
        assert f"| `{parameter.name}` |" in pages["case"]
    for name, model in SHAPES.items():
        section = pages["shapes"].partition(f"## {name}\n")[2].partition("\n## ")[0]
        assert section
        assert all(f"| `{field}` |" in section for field, info in model.model_fields.items() if info.is_required())
    for kind in ("interpolators", "wall_treatments", "kernels", "rigid_bodies", "body_forces", "integrators", "cases"):
        assert all(f"| `{entry.name}` |" in pages[kind] for entry in available(kind))


def test_the_pages_need_no_network(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert not re.findall(r"<(?:script|img|link)[^>]*(?:src|href)=\"(?:https?:)?//[^\"]*\"", text), page
        assert text.count('class="math"') == text.count('<svg role="img"'), f"{page}: an equation is not drawn"


METHODS = [entry.name for entry in available("interpolators") if (ROOT / "plugins" / entry.distribution).is_dir()]


def rows(page: str, count: int) -> dict[str, list[str]]:
    """The rows of the table with ``count`` columns, by the method in the first."""
    lines = (DOCS / page).read_text(encoding="utf-8").splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("| `")]
    return {row[0].strip("`"): row[1:] for row in cells if len(row) == count}


@pytest.mark.slow
@pytest.mark.parametrize("name", METHODS)
def test_every_method_has_a_page_with_its_equation_and_source(site: Path, name: str) -> None:
    page = (site / "theory" / f"{name}.html").read_text(encoding="utf-8")
    assert '<div class="math"><svg' in page
    assert "https://doi.org/10." in page
    for part in ("Properties.", "Limits.", "Departs from the paper.", "Source."):
        assert f"<strong>{part}</strong>" in page
    options = inspect.signature(load("interpolators", name)).parameters
    text = (DOCS / "theory" / f"{name}.md").read_text(encoding="utf-8")
    assert not [option for option in options if f"`{option}`" not in text]


def test_the_table_of_promises_is_that_of_the_traits() -> None:
    table = rows("methods.md", 8)
    assert sorted(table) == METHODS
    for name, row in table.items():
        t = create("interpolators", name).traits
        flags = [t.interpolates_particles, t.continuous, t.volume_independent]
        words = ["yes" if flag else "no" for flag in [t.non_negative, *flags]]
        fewest = f"{t.fewest_points[0]}, {t.fewest_points[1]}"
        assert row == [str(t.reproduces_degree), words[0], fewest, *words[1:], t.evaluation_point.value], name
        assert t.rotation_invariant


@pytest.mark.long
def test_the_errors_and_gains_in_the_docs_are_those_of_the_code() -> None:
    table = rows("methods.md", 4)
    assert sorted(table) == METHODS
    spacing = 0.01
    x, y = np.meshgrid(np.arange(0.0, 0.795, spacing) + 0.005, np.arange(0.0, 0.075, spacing) + 0.005)
    disorder = np.random.default_rng(1).uniform(-0.1, 0.1, (x.size, 2)) * spacing
    water = np.column_stack([x.ravel(), y.ravel()]) + disorder
    for name, row in table.items():
        method = create("interpolators", name)
        where = method.traits.evaluation_point
        found = []
        for depth in (0.5, 1.5, 2.5):
            mirror = np.column_stack([np.linspace(0.2, 0.6, 401), np.full(401, depth * spacing)])
            ghost = mirror * [1.0, -1.0]
            points, volumes = ghost if where is EvaluationPoint.GHOST else mirror, np.full(len(water), spacing**2)
            lift = ghost - mirror if where is EvaluationPoint.EXTRAPOLATED else None
            matrix, _ = operator(method, points, water, volumes, smoothing_length=1.3 * spacing, lift=lift)
            dense, height = matrix.toarray(), mirror[:, 1] if where is EvaluationPoint.MIRROR else ghost[:, 1]
            noise, outlier = np.sqrt(np.sum(dense**2, axis=1)), np.abs(dense).max(axis=1)
            found.append([np.mean((height - dense @ water[:, 1]) / spacing), np.mean(noise), np.mean(outlier)])
        for cell, values in zip(row, np.array(found).T, strict=True):
            assert [float(number) for number in cell.split("/")] == pytest.approx(values.tolist(), abs=0.006), name
        made = [[one.error, one.noise, one.outlier] for one in ghost_responses(method)]
        np.testing.assert_allclose(made, found, rtol=1e-6, atol=1e-6)
