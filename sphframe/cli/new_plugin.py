"""CLI: ``sphframe new-plugin``."""

import re
from pathlib import Path

from sphframe.cli.plugin_template import LICENCES, plugin_files
from sphframe.errors import InputError, OutputError
from sphframe.registry import available


def new_plugin_command(name: str, *, folder: Path, licence: str, author: str) -> None:
    """Write a distribution with one interpolation method, and print the next commands."""
    root = new_plugin(name, folder=folder, licence=licence, author=author)
    print(f"written: {root}\n")
    print(f'  pip install -e "{root}[test]"')
    print(f"  sphframe verify {name}")
    print(f"  sphframe run dam-break --interpolator {name}")


def new_plugin(name: str, *, folder: Path = Path(), licence: str = "BSD-3-Clause", author: str = "") -> Path:
    """Write a complete distribution with one interpolation method that installs, verifies and runs at once.

    Parameters
    ----------
    name: name of the method, as given to ``--interpolator``: lower-case words joined by hyphens.
    folder: where the distribution's folder ``sphframe-NAME`` is made.
    licence: :data:`~sphframe.cli.plugin_template.LICENCES` names those known.
    author: named in pyproject.toml and in the licence.

    Returns
    -------
    The distribution's folder.

    Raises
    ------
    InputError: when the name is not of that form or is taken, or the licence is unknown.
    OutputError: when the folder exists already, or cannot be written.
    """
    _check_name(name)
    if licence not in LICENCES:
        raise InputError(
            f"unknown licence {licence!r}: choose {', '.join(LICENCES)}; any other can be added afterwards"
        )
    root = folder / f"sphframe-{name}"
    if root.exists():
        raise OutputError(f"{root} exists already: choose another name or folder, or remove it")
    try:
        for path, text in plugin_files(name, licence=licence, author=author).items():
            target = root / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write {root}: {error}") from error
    return root


def _check_name(name: str) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", name):
        raise InputError(
            f"{name!r} is not a name for a method: use lower-case words joined by hyphens, as in mls-linear"
        )
    if name.startswith("sphframe-"):
        raise InputError(f"leave out the prefix: sphframe new-plugin {name.removeprefix('sphframe-')}")
    for entry in available("interpolators"):
        if entry.name == name:
            raise InputError(f"{entry.distribution} already offers a method called {name!r}: choose another name")
