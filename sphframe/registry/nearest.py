"""Registry: find the name that is most similar to a misspelt one."""

import difflib
from collections.abc import Iterable


def nearest(name: str, candidates: Iterable[str]) -> str | None:
    """Return the candidate most similar to ``name``, ignoring case and hyphens, or None when none is similar.

    Examples
    --------
    >>> nearest("Improved_Shepherd", ["shepard", "improved-shepard"])
    'improved-shepard'
    >>> nearest("fourier", ["shepard", "improved-shepard"])
    """
    plain = {_plain(candidate): candidate for candidate in candidates}
    matches = difflib.get_close_matches(_plain(name), plain, n=1)
    return plain[matches[0]] if matches else None


def did_you_mean(name: str, candidates: Iterable[str]) -> str:
    """Return ``"; did you mean 'x'?"`` to end a sentence with, or a full stop."""
    match = nearest(name, candidates)
    return f"; did you mean {match!r}?" if match else "."


def _plain(name: str) -> str:
    return name.lower().replace("_", "-").replace(" ", "-")
