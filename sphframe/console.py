"""Console: the console on which commands and runs report what they do, and which never ends a run."""

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import Any

from rich.console import Console


class _Lenient:
    """A text stream that ignores what cannot be written: the reader of a log may be gone, or its disk full."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        with _ignored_failures(self._stream):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        with _ignored_failures(self._stream):
            self._stream.flush()


@contextlib.contextmanager
def _ignored_failures(stream: Any) -> Iterator[None]:
    """Ignore failures to write to ``stream``; if its reader is gone, write nowhere from then on."""
    try:
        yield
    except BrokenPipeError:
        with contextlib.suppress(OSError, ValueError, AttributeError):  # a stream without a descriptor
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, stream.fileno())
            os.close(nowhere)
    except (OSError, ValueError):  # a full disk, or a stream that has been closed
        pass


def log_console() -> Console:
    """Return a console that writes plain texts to the standard error stream, and ignores failures to do so."""
    return _plain(sys.stderr)


def result_console() -> Console:
    """Return a console for what a finished run reports on the standard output stream, with the same leniency."""
    return _plain(sys.stdout)


def visible(text: str) -> str:
    r"""Return ``text`` with characters that would control the terminal, or have no form, written as their codes.

    >>> visible("\x1b[31mred")
    '\\x1b[31mred'
    """
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)


class _Plain(Console):
    def print(self, *objects: Any, **options: Any) -> None:
        super().print(*(visible(one) if isinstance(one, str) else one for one in objects), **options)


def _plain(stream: Any) -> Console:
    lenient: Any = _Lenient(stream) if stream is not None else None
    return _Plain(file=lenient, stderr=stream is sys.stderr, markup=False, highlight=False, emoji=False, soft_wrap=True)
