"""CLI: ``sphframe new-plugin``."""

import builtins
import keyword
import re
from pathlib import Path

import sphframe
from sphframe.cli.plugin_template import KINDS, LICENCES, PARTS, class_name, plugin_files, trial
from sphframe.errors import InputError, OutputError
from sphframe.registry import available


def new_plugin_command(name: str, *, kind: str, part: str | None, folder: Path, licence: str, author: str) -> None:
    """Write a distribution with one component, and print the next commands."""
    root = new_plugin(name, kind=kind, part=part, folder=folder, licence=licence, author=author)
    print(f"written: {root}\n")
    print(f'  pip install -e "{root}[test]"')
    print(f"  sphframe verify {name}")
    print(f"  {trial(name, kind)}")


def new_plugin(
    name: str,
    *,
    kind: str = "interpolator",
    part: str | None = None,
    folder: Path = Path(),
    licence: str = "BSD-3-Clause",
    author: str = "",
) -> Path:
    """Write a complete distribution with one component that installs, verifies and runs at once.

    Parameters
    ----------
    name
        name of the component, as cases choose it: lower-case words joined by hyphens.
    kind
        :data:`~sphframe.cli.plugin_template.KINDS` names those known.
    part
        of a wall treatment, the function with which it starts, one of
        :data:`~sphframe.cli.plugin_template.PARTS`; by default ``seen``.
    folder
        where the distribution's folder ``sphframe-NAME`` is made.
    licence
        :data:`~sphframe.cli.plugin_template.LICENCES` names those known.
    author
        named in pyproject.toml and in the licence.

    Returns
    -------
    Path
        The distribution's folder.

    Raises
    ------
    InputError
        when the name is not of that form, is taken or cannot name a class; when kind, part or licence are
        unknown; or when the author is not one line of text.
    OutputError
        when the folder exists already, or cannot be written.
    """
    _check(name, kind, part, licence, author)
    root = folder / f"sphframe-{name}"
    if root.exists():
        raise OutputError(f"{root} exists already: choose another name or folder, or remove it")
    try:
        for path, text in plugin_files(name, kind=kind, part=part or PARTS[0], licence=licence, author=author).items():
            target = root / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write {root}: {error}") from error
    return root


def _check(name: str, kind: str, part: str | None, licence: str, author: str) -> None:
    if kind not in KINDS:
        raise InputError(f"unknown kind {kind!r}: choose {', '.join(KINDS)}")
    if part is not None and (kind != "wall-treatment" or part not in PARTS):
        raise InputError(
            f"--part {part} --kind {kind}: a wall treatment starts with one of {', '.join(PARTS)}; other kinds have no"
            f" parts"
        )
    _check_name(name, kind)
    if licence not in LICENCES:
        raise InputError(
            f"unknown licence {licence!r}: choose {', '.join(LICENCES)}; any other can be added afterwards"
        )
    if not author.isprintable() or author != author.strip():
        raise InputError(
            f"the author {author!r} is not one line of text: leave out line breaks, control characters and spaces at"
            f" the ends"
        )


def _check_name(name: str, kind: str) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", name):
        raise InputError(
            f"{name!r} is not a name for a component: use lower-case words joined by hyphens, as in mls-linear"
        )
    if name.startswith("sphframe-"):
        raise InputError(f"leave out the prefix: sphframe new-plugin {name.removeprefix('sphframe-')} --kind {kind}")
    taken = class_name(name)
    if keyword.iskeyword(taken) or hasattr(builtins, taken) or hasattr(sphframe, taken) or taken in _IMPORTED:
        raise InputError(
            f"the class of {name!r} would be called {taken}, which Python or sphframe uses already: choose another"
            f" name, such as my-{name}"
        )
    installed = [entry for group in KINDS.values() for entry in available(group)]
    for entry in installed:
        if entry.name == name:
            raise InputError(f"{entry.distribution} already offers {entry.title}: choose another name")
    for entry in installed:
        if entry.distribution.lower().replace("_", "-") == f"sphframe-{name}":
            raise InputError(f"a distribution {entry.distribution} is installed already: choose another name")


_IMPORTED = ("Any", "Callable", "ClassVar", "Literal", "BoxRegion", "BoxWall", "Probe", "Scene")
"""names in the templates that are neither Python's nor of sphframe itself"""
