"""The registry with small distributions: packages with metadata and entry points in a folder on the path."""

import importlib.metadata
import json
import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sphframe import errors, registry
from sphframe.interfaces import BoundaryInterpolator, Kernel
from sphframe.registry.kinds import DISTRIBUTIONS, INTERFACES
from sphframe.registry.nearest import nearest

NEAREST = """
    from dataclasses import dataclass
    from sphframe import BoundaryInterpolator, Traits

    @dataclass(frozen=True)
    class Nearest(BoundaryInterpolator):
        power: float = 2.0
        traits = Traits()

        def point_weights(self, kernel, dim):
            return None
"""
Install = Callable[..., Path]


@pytest.fixture
def alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is installed but what the test installs."""
    found = partial(importlib.metadata.distributions, path=[str(tmp_path / "installed")])
    monkeypatch.setattr("sphframe.registry.entries.metadata.distributions", found)
    registry.clear()


def entry(kind: str, name: str) -> registry.Entry:
    return next(e for e in registry.available(kind) if e.name == name)


def test_built_in_components_are_listed_and_made_like_any_other():
    assert entry("kernels", "gaussian").distribution == "sphframe"
    assert isinstance(registry.create("kernels", "gaussian"), Kernel)


def test_an_installed_plugin_is_listed_unloaded_and_made_when_asked_for(install: Install):
    install("near", {"near_one": NEAREST}, {"interpolators": {"near": "near_one:Nearest"}}, version="1.2")

    listed = entry("interpolators", "near")

    assert listed == registry.Entry("near", "interpolators", "near_one:Nearest", "near", "1.2", error=None)
    assert "near_one" not in sys.modules, "listing must load nothing"
    made = registry.create("interpolators", "near", power=3)
    assert isinstance(made, BoundaryInterpolator)
    assert made.power == 3.0  # type: ignore[attr-defined]


def test_a_plugin_installed_by_pip_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, install: Install):
    project = tmp_path / "project"
    (project / "near_pip").mkdir(parents=True)
    (project / "near_pip" / "__init__.py").write_text("from sphframe import Kernel as Kernel\nNUMBER = 7\n")
    (project / "pyproject.toml").write_text(
        '[build-system]\nrequires = ["hatchling"]\nbuild-backend = "hatchling.build"\n'
        '[project]\nname = "near-pip"\nversion = "0.3"\n'
        '[project.entry-points."sphframe.hooks"]\nnumber = "near_pip:NUMBER"\n'
    )
    options = ["--no-deps", "--no-build-isolation", "--no-index", "--target", str(tmp_path / "site"), str(project)]
    attempts = [
        subprocess.run([sys.executable, "-m", *tool, "install", *options], capture_output=True, text=True, check=False)
        for tool in (["pip"], ["uv", "pip"])
        if importlib.util.find_spec(tool[0])
    ]
    if all(attempt.returncode for attempt in attempts):
        pytest.skip(f"neither pip nor uv can install offline here: {[a.stderr[-300:] for a in attempts]}")
    monkeypatch.syspath_prepend(tmp_path / "site")
    registry.clear()

    assert entry("hooks", "number").version == "0.3"
    assert registry.load("hooks", "number") == 7


def test_a_component_is_also_had_by_its_address(install: Install):
    install("near", {"near_two": NEAREST})
    assert type(registry.create("interpolators", "near_two:Nearest")).__name__ == "Nearest"
    assert registry.find("interpolators", "near_two:Nearest").distribution == ""


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("no_such_module:Nearest", "No module named 'no_such_module'.*PYTHONPATH"),
        ("math:Nearest", "no attribute 'Nearest'"),
        ("math:pi", r"math:pi is not a subclass of sphframe.BoundaryInterpolator but 3.14"),
        ("sphframe.interfaces:BoundaryInterpolator", "does not define point_weights, traits"),
    ],
)
def test_a_wrong_address_is_refused(address: str, message: str):
    with pytest.raises(errors.BrokenPluginError, match=message):
        registry.load("interpolators", address)


def test_a_broken_plugin_stays_listed_with_its_error_and_breaks_nothing_else(install: Install):
    install("near", {"near_three": NEAREST}, {"interpolators": {"near": "near_three:Nearest"}})
    install("bad", {"bad_one": "raise RuntimeError('no luck')"}, {"interpolators": {"bad": "bad_one:Bad"}})

    assert entry("interpolators", "bad").error is None, "listing must load nothing"
    for _ in range(2):
        with pytest.raises(
            errors.BrokenPluginError, match=r"'bad' of bad 1.0 is broken: RuntimeError: no luck"
        ) as info:
            registry.load("interpolators", "bad")
        assert isinstance(info.value.__cause__, RuntimeError)
    assert "pip install --upgrade --force-reinstall bad" in str(info.value)
    assert entry("interpolators", "bad").error == "RuntimeError: no luck"
    assert registry.load("interpolators", "near").__name__ == "Nearest"
    assert entry("interpolators", "near").error is None


@pytest.mark.parametrize(
    ("source", "address", "message"),
    [
        ("import a_missing_library", "bad:Bad", "install what provides the module 'a_missing_library'"),
        ("from sphframe import Nonsense", "bad:Bad", "imports something that this version of sphframe does not have"),
        ("raise SystemExit(3)", "bad:Bad", "SystemExit: 3"),
        ("Bad = (", "bad:Bad", "SyntaxError"),
        ("Bad = 1", "bad:Good", "has no attribute 'Good'"),
        ("Bad = 1", "bad:Bad", "bad:Bad is not a subclass of sphframe.Kernel but 1"),
        ("Bad = 1", "bad", "entry point 'bad' is not of the form module:attribute"),
        (
            "from sphframe import Kernel\nclass Bad(Kernel):\n    def normalisation(self, dim): return 1.0",
            "bad:Bad",
            "does not define gradient_function, value_function of sphframe.Kernel",
        ),
        ("SPHFRAME_API = '1.0'", "bad:SPHFRAME_API", r"SPHFRAME_API = '1.0' must be a pair of whole numbers"),
    ],
)
def test_what_is_broken_is_said_with_its_remedy(install: Install, source: str, address: str, message: str):
    install("bad", {"bad": source}, {"kernels": {"bad": address}})
    with pytest.raises(errors.BrokenPluginError, match=message):
        registry.create("kernels", "bad")
    assert entry("kernels", "bad").error


def test_check_tries_everything_and_a_mended_plugin_is_no_longer_broken(install: Install):
    folder = install("bad", {"bad_two": "raise RuntimeError"}, {"hooks": {"bad": "bad_two:Bad", "good": "math:sin"}})
    by_name = {e.name: e.error for e in registry.check("hooks")}
    assert (by_name["bad"], by_name["good"]) == ("RuntimeError", None)

    (folder / "bad_two.py").write_text("Bad = 'fixed now'")
    registry.clear()

    assert registry.load("hooks", "bad") == "fixed now"
    assert entry("hooks", "bad").error is None


def test_two_distributions_that_claim_one_name_are_both_named(install: Install, tmp_path: Path):
    install("first", {"first_near": NEAREST}, {"interpolators": {"near": "first_near:Nearest"}})
    install("second", {"second_near": NEAREST}, {"interpolators": {"near": "second_near:Nearest", "mine": "math:pi"}})

    with pytest.raises(errors.ClashingPluginError, match=r"claimed by first 1.0 and by second 1.0; uninstall") as info:
        registry.create("interpolators", "near")

    assert "'first_near:Nearest' or 'second_near:Nearest'" in str(info.value)
    claims = [e for e in registry.available("interpolators") if e.name == "near"]
    assert [e.error for e in claims] == [
        "the name is also claimed by second 1.0",
        "the name is also claimed by first 1.0",
    ]
    assert not {"first_near", "second_near"} & set(sys.modules)
    assert registry.create("interpolators", "second_near:Nearest") is not None, "the remedy must work"
    assert registry.find("interpolators", "mine").distribution == "second", "other names of theirs are not affected"


def test_a_distribution_found_twice_on_the_path_does_not_clash_with_itself(install: Install, tmp_path: Path):
    install(
        "near-it", {"near_four": NEAREST}, {"interpolators": {"near": "near_four:Nearest"}}, folder=tmp_path / "old"
    )
    components = {"interpolators": {"near": "near_four:Nearest"}}
    install("Near_It", {"near_four": NEAREST}, components, version="2.0", folder=tmp_path / "new")
    assert entry("interpolators", "near").version == "2.0"
    assert registry.find("interpolators", "near").error is None


@pytest.mark.parametrize(
    ("version", "message"),
    [
        ("(0, 9)", r"version 0.9 of sphframe's plugin interface.* upgrade the plugin \(.*pip install --upgrade aged\)"),
        ("(1, 1)", r"version 1.1 .* offers 1.0: upgrade sphframe \(python -m pip install --upgrade sphframe\)"),
        ("(2, 0)", "upgrade sphframe"),
    ],
)
@pytest.mark.parametrize("rest", [NEAREST, "from sphframe import NameOfAnotherVersion"])
def test_a_plugin_for_another_version_says_which_side_to_upgrade(
    install: Install, version: str, message: str, rest: str
):
    modules = {"aged.__init__": f"SPHFRAME_API = {version}", "aged.method": rest}
    install("aged", modules, {"interpolators": {"aged": "aged.method:Nearest"}})
    with pytest.raises(errors.ApiVersionError, match=message):
        registry.load("interpolators", "aged")
    assert "upgrade" in str(entry("interpolators", "aged").error)


def test_a_plugin_for_this_version_is_loaded(install: Install):
    modules = {"dated.__init__": f"SPHFRAME_API = {registry.API_VERSION}", "dated.method": NEAREST}
    install("dated", modules, {"interpolators": {"dated": "dated.method:Nearest"}})
    assert registry.load("interpolators", "dated").__name__ == "Nearest"


@pytest.mark.usefixtures("alone")
class TestUnknownNames:
    def test_the_nearest_name_the_installed_and_the_broken_are_said(self, install: Install):
        install("near", {"near_five": NEAREST}, {"interpolators": {"nearest-point": "near_five:Nearest"}})
        install("bad", {"bad_five": "import a_missing_library"}, {"interpolators": {"bad": "bad_five:Bad"}})
        registry.check("interpolators")
        with pytest.raises(errors.UnknownComponentError) as info:
            registry.create("interpolators", "Nearest_Pont")
        message = str(info.value)
        assert "there is no interpolator 'Nearest_Pont'; did you mean 'nearest-point'?" in message
        assert "installed: nearest-point\n" in message
        assert "broken: bad (bad 1.0: ModuleNotFoundError: No module named 'a_missing_library')" in message
        assert "module:attribute" in message

    @pytest.mark.parametrize(
        ("kind", "name", "meant", "distribution"),
        [
            ("interpolators", "improved-shepard", "improved-shepard", "sphframe-shepard"),
            ("interpolators", "improved_shepherd", "improved-shepard", "sphframe-shepard"),
            ("interpolators", "normalised", "normalized", "sphframe-normalized"),
            ("interpolators", "SFDI", "sfdi", "sphframe-sfdi"),
            ("interpolators", "mls-quadratc", "mls-quadratic", "sphframe-mls"),
            ("cases", "solitary-wave-fixed-wal", "solitary-wave-fixed-wall", "sphframe-waves"),
            ("cases", "solitary-wave-movable-wall", "solitary-wave-movable-wall", "sphframe-waves"),
            ("rigid_bodies", "solitary-wave-paddle", "solitary-wave-paddle", "sphframe-waves"),
            ("rigid_bodies", "regular_wave_paddle", "regular-wave-paddle", "sphframe-waves"),
        ],
    )
    def test_what_the_project_offers_comes_with_its_pip_line(self, kind: str, name: str, meant: str, distribution: str):
        with pytest.raises(errors.UnknownComponentError) as info:
            registry.load(kind, name)
        message = str(info.value)
        assert f"{meant!r} is not installed; to get it: python -m pip install {distribution}\n" in message
        assert ("did you mean" in message) == (name != meant)
        assert "installed: none" in message

    def test_a_name_of_another_kind_is_recognised(self, install: Install):
        install("near", {}, {"kernels": {"near": "near:Near"}})
        with pytest.raises(errors.UnknownComponentError, match="'near' is a name among kernels"):
            registry.load("interpolators", "near")

    def test_nothing_alike_gives_no_advice(self):
        with pytest.raises(LookupError) as info:
            registry.load("interpolators", "zzzzzz")
        assert "did you mean" not in str(info.value)
        assert "pip" not in str(info.value)


def test_an_unknown_kind_is_refused_with_the_nearest():
    for function in (registry.available, lambda kind: registry.load(kind, "x"), registry.check):
        with pytest.raises(errors.InputError, match="did you mean 'interpolators'"):
            function("interpolator")


@pytest.mark.parametrize("text", ["[sphframe.kernels]\nnonsense without an equals sign\n", "\udcff[sphframe.kernels]"])
def test_malformed_metadata_breaks_nothing_else(install: Install, tmp_path: Path, text: str):
    folder = install("bad", {}, {})
    (folder / "bad-1.0.dist-info" / "entry_points.txt").write_bytes(text.encode(errors="surrogateescape"))
    registry.clear()
    with pytest.warns(errors.PluginWarning, match=r"components of bad are not listed.*--force-reinstall bad"):
        assert entry("kernels", "gaussian").distribution == "sphframe"


def test_importing_and_listing_load_no_plugin_and_nothing_heavy(install: Install):
    folder = install("near", {"near_six": NEAREST}, {"interpolators": {"near": "near_six:Nearest"}})
    program = (
        "import json, sys, sphframe\n"
        "first = sorted(sys.modules)\n"
        "from sphframe.registry import KINDS, available\n"
        "names = [e.name for kind in KINDS for e in available(kind)]\n"
        "print(json.dumps([first, sorted(sys.modules), names]))"
    )
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    result = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, env=environment
    )
    imported, listed, names = json.loads(result.stdout)
    assert {"near", "gaussian"} <= set(names)
    heavy = {"xarray", "pydantic", "matplotlib", "netCDF4", "numba", "scipy", "typer", "rich", "near_six"}
    assert not heavy & set(listed)
    assert [m for m in imported if m.startswith("sphframe")] == ["sphframe"]
    assert not [m for m in listed if m.startswith("sphframe_")]


@given(st.text(min_size=1, max_size=20), st.lists(st.text(max_size=20), max_size=8))
def test_a_name_among_the_candidates_is_its_own_nearest(name: str, others: list[str]):
    found = nearest(name, [*others, name])
    assert found is not None
    assert found.lower().replace("_", "-").replace(" ", "-") == name.lower().replace("_", "-").replace(" ", "-")


def test_the_distribution_of_each_component_of_this_project_is_known() -> None:
    """A name that is missing is answered by what to install."""
    for kind in registry.KINDS:
        for entry in registry.available(kind):
            if entry.distribution.startswith("sphframe-"):
                assert DISTRIBUTIONS[kind, entry.name] == entry.distribution


def test_every_entry_point_group_is_in_the_documentation_with_its_class():
    page = (Path(__file__).parents[2] / "docs" / "api" / "index.md").read_text(encoding="utf-8")
    for kind in registry.KINDS:
        (row,) = [line for line in page.splitlines() if line.startswith(f"| `sphframe.{kind}` |")]
        assert f"`{INTERFACES[kind]}`" in row if kind in INTERFACES else "hookimpl" in row
