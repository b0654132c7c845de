"""Output: files that are replaced as a whole, so that no reader and no crash meets half of one."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path


def draft_path(path: Path) -> Path:
    """Return the name beside ``path`` under which its new content is written first."""
    return path.with_name(f".{path.name}.draft")


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
    draft = draft_path(path)
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
