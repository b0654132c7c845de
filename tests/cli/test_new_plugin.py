"""``sphframe new-plugin`` writes a distribution that installs, verifies and runs at once."""

import ast
import os
import subprocess
import sys
import tomllib

import pytest

from sphframe import InputError, OutputError, WallContext, available, create
from sphframe.cli.new_plugin import new_plugin
from sphframe.cli.plugin_template import KINDS, LICENCES, PARTS
from sphframe.kernels import compiled_kernel
from sphframe.testing import checks_of


@pytest.fixture
def made(tmp_path, install):
    """The component of a new plugin, installed as pip does in editable mode."""

    def make(name, **options):
        root = new_plugin(name, folder=tmp_path, **options)
        project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
        components = {group.removeprefix("sphframe."): names for group, names in project["entry-points"].items()}
        install(project["name"], {}, components, folder=root)
        (kind,) = components
        return root, create(kind, name)

    return make


def test_it_declares_exactly_the_traits_that_it_has(made):
    _, method = made("gauss-width")
    for check in checks_of(method, promised_only=False):
        if check.dim == 2 and check.name != "solver_agrees":
            held = True
            try:
                check(method)
            except AssertionError:
                held = False
            assert held == check.promised, check.name


@pytest.mark.parametrize("kind", ["kernel", "equation-of-state", "integrator", "rigid-body", "body-force", "case"])
def test_every_kind_is_listed_and_has_what_its_checks_ask_for(made, kind):
    root, component = made("scaffolded", kind=kind)
    assert "scaffolded" in [entry.name for entry in available(KINDS[kind])]
    checks = [check for check in checks_of(component) if check.name != "starts"]  # of a case: compiles the solver
    assert checks
    for check in checks:
        check(component)
    if kind == "case":
        assert component.scene().depth == 0.3
    assert f"The {kind.replace('-', ' ')} `scaffolded`" in (root / "README.md").read_text()


@pytest.mark.parametrize("part", PARTS)
def test_a_wall_treatment_starts_with_one_function(made, part):
    root, treatment = made("scaffolded", kind="wall-treatment", part=part)
    assert "scaffolded" in [entry.name for entry in available("wall_treatments")]
    kernel = compiled_kernel(create("kernels", "gaussian"), 2)
    pressure = create("equations_of_state", "linear").pressure_function()
    parts = treatment.parts(WallContext(kernel, 2, create("interpolators", "shepard"), pressure=pressure))
    assert getattr(parts, part) is not None
    module = ast.parse((root / "sphframe_scaffolded" / "__init__.py").read_text())
    (written,) = (node for node in module.body if isinstance(node, ast.ClassDef))
    assert written.name == "Scaffolded"
    assert written.end_lineno - written.lineno < 40


def test_it_is_complete(made):
    root, method = made("two-words", author='Ada "A." Lovelace', licence="MIT")
    assert sorted(path.name for path in root.iterdir() if not path.name.endswith(".dist-info")) == [
        ".gitignore", "LICENSE", "README.md", "pyproject.toml", "sphframe_two_words", "tests",
    ]  # fmt: skip
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    assert project["authors"] == [{"name": 'Ada "A." Lovelace'}]
    assert project["license"] == "MIT"
    assert "@" not in "".join(p.read_text() for p in root.rglob("*.py")).replace("@dataclass", "").replace("@param", "")
    assert type(method).__name__ == "TwoWords"
    with pytest.raises(InputError, match="width must be positive"):
        create("interpolators", "two-words", width=-1.0)
    collected = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", "tests"],
        cwd=root, env={**os.environ, "PYTHONPATH": str(root)}, capture_output=True, text=True,
    )  # fmt: skip
    assert "TwoWords(width=0.3)-partition_of_unity-2d" in collected.stdout


@pytest.mark.parametrize("licence", LICENCES)
def test_licences(tmp_path, licence):
    root = new_plugin("licensed", folder=tmp_path, licence=licence)
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    assert project.get("license") == (None if licence == "none" else licence)
    assert (root / "LICENSE").exists() == (licence != "none")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Mine", "lower-case words joined by hyphens"),
        ("my_method", "lower-case words joined by hyphens"),
        ("2nd", "lower-case words joined by hyphens"),
        ("sphframe-mine", "leave out the prefix: sphframe new-plugin mine"),
        ("shepard", "sphframe-shepard already offers interpolator 'shepard'"),
        ("gaussian", "sphframe already offers kernel 'gaussian'"),
        ("mls", "a distribution sphframe-mls is installed already"),
        ("none", "would be called None, which Python or sphframe uses already: choose another name, such as my-none"),
        ("true", "would be called True"),
        ("false", "would be called False"),
        ("exception", "would be called Exception"),
        ("kernel", "would be called Kernel"),
        ("any", "would be called Any"),
    ],
)
def test_invalid_names(tmp_path, name, message):
    with pytest.raises(InputError, match=message):
        new_plugin(name, folder=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_an_existing_folder_is_left_alone(tmp_path):
    new_plugin("mine", folder=tmp_path)
    (tmp_path / "sphframe-mine" / "README.md").write_text("changed")
    with pytest.raises(OutputError, match="exists already"):
        new_plugin("mine", folder=tmp_path)
    assert (tmp_path / "sphframe-mine" / "README.md").read_text() == "changed"


def test_an_unknown_licence(tmp_path):
    with pytest.raises(InputError, match="choose BSD-3-Clause, MIT, none"):
        new_plugin("mine", folder=tmp_path, licence="WTFPL")


@pytest.mark.parametrize("author", ["Ada\nLovelace", "Ada\tLovelace", "Ada\u2028Lovelace", " Ada", "Ada\x00"])
def test_an_author_is_one_line_of_text(tmp_path, author):
    with pytest.raises(InputError, match="is not one line of text"):
        new_plugin("mine", folder=tmp_path, author=author)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"kind": "walls"}, "unknown kind 'walls': choose interpolator, wall-treatment, kernel"),
        ({"kind": "study"}, "unknown kind 'study'"),
        ({"kind": "kernel", "part": "seen"}, "--part seen --kind kernel: a wall treatment starts with one of seen"),
        ({"kind": "wall-treatment", "part": "fill"}, "one of seen, assign, force, rate, surface"),
    ],
)
def test_unknown_kinds_and_parts(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        new_plugin("mine", folder=tmp_path, **options)
    assert list(tmp_path.iterdir()) == []


def test_no_name_that_a_template_imports_can_become_a_class(tmp_path):
    """The check of names knows all that the templates import."""
    for kind in KINDS:
        for part in PARTS if kind == "wall-treatment" else (None,):
            root = new_plugin(f"of-{kind}-{part}".lower().replace("none", "no"), kind=kind, part=part, folder=tmp_path)
            (module,) = root.glob("sphframe_*/__init__.py")
            imports = [node for node in ast.parse(module.read_text()).body if isinstance(node, ast.ImportFrom)]
            for name in [alias.name for node in imports for alias in node.names if alias.name.isalpha()]:
                if name.capitalize() == name:
                    with pytest.raises(InputError, match="would be called"):
                        new_plugin(name.lower(), kind=kind, folder=tmp_path)
                elif name[0].isupper() and not name.isupper():
                    hyphenated = "".join(f"-{c.lower()}" if c.isupper() else c for c in name).lstrip("-")
                    with pytest.raises(InputError, match="would be called"):
                        new_plugin(hyphenated, kind=kind, folder=tmp_path)
