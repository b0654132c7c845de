"""Input files: a file that a user names is read whole, but only if it is one and not without end."""

import errno
from pathlib import Path

LARGEST = 500_000_000
"""bytes"""


def content_of(path: Path) -> bytes:
    """Return the bytes of a regular file.

    Raises
    ------
    OSError
        it cannot be read, is a device, a pipe or a folder, or is larger than 500 MB.
    """
    if path.stat().st_size > LARGEST:
        raise OSError(errno.EFBIG, f"it is larger than {LARGEST / 1e6:g} MB")
    if not path.is_file() and not path.is_dir():
        raise OSError(errno.EINVAL, "it is no regular file")
    return path.read_bytes()


def text_of(path: Path) -> str:
    """Return the text of a file in UTF-8, with or without a byte-order mark; errors are those of :func:`content_of`.

    Raises
    ------
    UnicodeDecodeError
        it is not a text in UTF-8.
    """
    return content_of(path).decode("utf-8-sig").replace("\r\n", "\n")
