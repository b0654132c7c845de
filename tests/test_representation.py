"""How cases, runs, methods and listings are shown: in one line, and in a notebook as a short table."""

from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

import pytest

import sphframe
from sphframe.cases import Case
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, Traits, WeightsFunction


class Shown(HTMLParser):
    """The cells of all tables, and the elements; fails where an element is left open."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[str] = []
        self.cells: list[str] = []
        self.text = ""
        self.feed(html)
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        self.elements.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data
        if self.open and self.open[-1] in ("td", "th"):
            self.cells.append(data)


def shown(thing: object) -> Shown:
    return Shown(thing._repr_html_())  # type: ignore[attr-defined]


def beside(cells: list[str], name: str) -> str:
    return cells[cells.index(name) + 1]


def test_case() -> None:
    case = sphframe.load_case("dam-break", overrides={"particle_spacing": 0.02, "interpolator": "mls-linear"})
    assert repr(case) == "DamBreak(particle_spacing=0.02, interpolator='mls-linear')"
    assert eval(repr(case), {"DamBreak": type(case)}) == case
    page = shown(case)
    assert "DamBreak: dam break against a vertical wall" in page.text
    assert beside(page.cells, "water_height") == "0.6"
    assert beside(page.cells, "interpolator") == "mls-linear"
    main, _, others = case._repr_html_().partition("<details>")
    assert "gravity" not in main
    assert "gravity" in others
    assert page.elements.count("td") == 4 * len(type(case).model_fields), "every parameter once"


def test_options_of_a_component_are_shown() -> None:
    case = sphframe.load_case("dam-break", overrides={"interpolator": {"name": "sfdi", "form": "printed"}})
    assert repr(case) == "DamBreak(interpolator={'name': 'sfdi', 'form': 'printed'})"
    assert eval(repr(case), {"DamBreak": type(case)}) == case


def test_run(tmp_path: Path) -> None:
    case = {"particle_spacing": 0.03, "until": 0.002, "courant_number": 0.3}
    run = sphframe.run("hydrostatic-tank", output=tmp_path / "tank.nc", threads=1, **case)
    assert repr(run) == (
        "Run(hydrostatic-tank, improved-shepard interpolation, balanced lift, 330 particles of 0.03 m, 2-D, 0.002 s in"
        f" 1 frames, {tmp_path / 'tank.nc'})"
    )
    page = run._repr_html_()
    assert "<td>improved-shepard interpolation, balanced lift</td>" in page
    assert "probe_pressure" in page, "the dataset shows itself below"
    run.dataset.close()


@dataclass(frozen=True)
class Odd(BoundaryInterpolator):
    """f < 1 & <script>alert(1)</script>.

    The rest is not shown.
    """

    power: float = 2.0
    name: str = "<b>bold</b>"
    traits = Traits(non_negative=True, fewest_points=(3, 4))

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        raise NotImplementedError


def test_method() -> None:
    page = shown(Odd())
    assert "script" not in page.elements
    assert page.elements.count("b") == 1, "the title's own"
    assert "Odd(power=2.0, name='<b>bold</b>')" in page.text
    assert "f < 1 & <script>alert(1)</script>." in page.text
    assert "not shown" not in page.text
    assert beside(page.cells, "non negative") == "yes"
    assert beside(page.cells, "range restricted") == "no"
    assert beside(page.cells, "fewest points") == "(3, 4)"
    assert beside(page.cells, "reproduces degree") == "0"
    assert beside(page.cells, "evaluation point") == "mirror"


@pytest.mark.parametrize("name", ["improved-shepard", "sfdi", "mdbc"])
def test_methods_of_this_project(name: str) -> None:
    method = sphframe.create("interpolators", name)
    page = shown(method)
    assert repr(method) in page.text
    assert "trait" in page.cells


def test_listing(install) -> None:  # type: ignore[no-untyped-def]
    install("broken", {"broken_method": "import nothing_like_it"}, {"interpolators": {"broken": "broken_method:X"}})
    with pytest.raises(sphframe.PluginError):
        sphframe.create("interpolators", "broken")
    listing = sphframe.available("interpolators")
    lines = repr(listing).splitlines()
    assert len(lines) == len(listing)
    assert "improved-shepard  sphframe-shepard 0.1.0" in lines
    broken = next(line for line in lines if line.startswith("broken  broken 1.0  "))
    assert "nothing_like_it" in broken
    page = shown(listing)
    assert page.cells[:3] == ["name", "from", "error"]
    assert beside(page.cells, "improved-shepard") == "sphframe-shepard 0.1.0"
    assert repr(sphframe.available("hooks")) == "nothing is installed"


def test_every_built_in_case_shows_itself() -> None:
    for entry in sphframe.available("cases"):
        if entry.name != "custom":
            case = sphframe.load_case(entry.name)
            assert isinstance(case, Case)
            assert shown(case).cells
