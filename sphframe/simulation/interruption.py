"""Simulation: Ctrl-C and SIGTERM take effect at the end of a step, where the state can be saved."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class Interruption:
    """Whether the run was asked to stop."""

    def __init__(self) -> None:
        self._asked = False

    def ask(self, number: int, frame: Any) -> None:
        """Handle a signal: record the first; the second interrupts at once."""
        if self._asked:
            raise KeyboardInterrupt
        self._asked = True

    def raise_if_asked(self) -> None:
        """Raise KeyboardInterrupt if a signal has arrived."""
        if self._asked:
            raise KeyboardInterrupt


@contextmanager
def deferred_interruption() -> Iterator[Interruption]:
    """Defer SIGINT and SIGTERM until :meth:`Interruption.raise_if_asked` is called.

    A second signal interrupts at once. Signals that already have a handler are not deferred. Outside the main thread,
    where Python allows no handlers, nothing is deferred.
    """
    interruption = Interruption()
    before = {}
    if threading.current_thread() is threading.main_thread():
        for number, default in ((signal.SIGINT, signal.default_int_handler), (signal.SIGTERM, signal.SIG_DFL)):
            if signal.getsignal(number) is default:
                before[number] = signal.signal(number, interruption.ask)
    try:
        yield interruption
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
