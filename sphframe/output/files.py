"""Output: files that are replaced as a whole, so that no reader and no crash meets half of one."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path


def draft_path(path: Path) -> Path:
    """Return the name beside ``path`` under which its new content is written first."""
    return path.with_name(f".{path.name}.draft")


def fresh_draft(path: Path) -> Path:
    """Create the draft of ``path``, empty, and return its name.

    What stands there is removed and never opened: it may be a link that somebody has put there, or a second name of
    ``path`` itself, left by a process that was killed.
    """
    draft = draft_path(path)
    draft.unlink(missing_ok=True)
    os.close(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    return draft


@contextlib.contextmanager
def replaced_as_a_whole(path: Path) -> Iterator[Path]:
    """Yield the name of a draft to write to; at the end sync it to the disk and rename it to ``path``.

    At any moment ``path`` holds either all of its old content or all of the new one. After an error the draft is
    removed and ``path`` is unchanged.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "table.csv"
    ...     with replaced_as_a_whole(path) as draft:
    ...         _ = draft.write_text("t,p\\n")
    ...     path.read_text(), len(list(path.parent.iterdir()))
    ('t,p\\n', 1)
    """
    draft = fresh_draft(path)
    try:
        yield draft
        descriptor = os.open(draft, os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
        draft.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            draft.unlink(missing_ok=True)
        raise
