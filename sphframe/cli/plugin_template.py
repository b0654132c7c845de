"""CLI: the files of a new plugin, made from those in ``templates``, in which words such as @NAME@ stand for its own."""

import datetime
import re
from importlib.resources import files

import sphframe
from sphframe.registry import API_VERSION
from sphframe.registry.kinds import LABELS

LICENCES = ("BSD-3-Clause", "MIT", "none")
PARTS = ("seen", "assign", "force", "rate", "surface")
"""the functions of a wall treatment with which it can start"""
KINDS = {label.replace(" ", "-"): kind for kind, label in LABELS.items() if kind not in ("studies", "hooks", "devices")}
"""the kinds of components that can be started, with their kinds in the registry"""

_RUNS = {
    "interpolator": "sphframe run dam-break --interpolator {0}",
    "rigid-body": "sphframe show {0}",
    "case": "sphframe run {0}",
    "body-force": "sphframe run dam-break --set acceleration={0}",
}


def class_name(name: str) -> str:
    """Return the name of a plugin's class: ``mls-linear`` becomes ``MlsLinear``."""
    return "".join(word.capitalize() for word in name.split("-"))


def trial(name: str, kind: str) -> str:
    """Return a command that uses the component."""
    return _RUNS.get(kind, f"sphframe run dam-break --set {kind.replace('-', '_')}={{0}}").format(name)


def plugin_files(name: str, *, kind: str, part: str, licence: str, author: str) -> dict[str, str]:
    """Return the texts of the distribution's files by their paths in its folder; parameters as of ``new_plugin``."""
    package = f"sphframe_{name.replace('-', '_')}"
    major, minor, *_ = sphframe.__version__.split(".")
    escaped = author.replace("\\", "\\\\").replace('"', '\\"')
    words = {
        "NAME": name,
        "LABEL": LABELS[KINDS[kind]],
        "GROUP": KINDS[kind],
        "PACKAGE": package,
        "CLASS": class_name(name),
        "TRY": trial(name, kind),
        "LICENCE_LINES": "" if licence == "none" else f'license = "{licence}"\nlicense-files = ["LICENSE"]\n',
        "AUTHORS_LINE": f'authors = [{{ name = "{escaped}" }}]\n' if author else "",
        "OLDEST": f"{major}.{minor}",
        "NEXT": f"{major}.{int(minor) + 1}",
        "API": repr(API_VERSION),
        "YEAR": str(datetime.date.today().year),
        "AUTHOR": author or f"The authors of sphframe-{name}",
    }
    templates = {
        "pyproject.toml": "pyproject.toml",
        "README.md": "README.md",
        f"{package}/__init__.py": f"{kind}-{part}.py" if kind == "wall-treatment" else f"{kind}.py",
        "tests/test_conformance.py": "test_conformance.py",
        ".gitignore": "gitignore",
        **({} if licence == "none" else {"LICENSE": f"LICENSE-{licence}"}),
    }
    folder = files("sphframe.cli") / "templates"
    return {
        path: re.sub(
            r"@([A-Z_]+)@", lambda match: words[match[1]], (folder / f"{template}.in").read_text(encoding="utf-8")
        )
        for path, template in templates.items()
    }
