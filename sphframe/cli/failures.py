"""CLI: every error leaves a command as a message and an exit code."""

import os
import sys
import traceback
import warnings
from typing import Any, final

import typer
from rich.text import Text
from typer.core import TyperGroup

from sphframe.console import log_console, visible
from sphframe.errors import SphframeError


@final
class Commands(TyperGroup):
    """The group of all commands: each error ends in a message and an exit code, never in a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command that the command line names."""
        with warnings.catch_warnings():
            warnings.showwarning = _print_warning  # type: ignore[assignment]
            try:
                return super().invoke(ctx)
            except (SphframeError, KeyboardInterrupt, MemoryError, OSError) as error:
                if os.environ.get("SPHFRAME_DEBUG") == "1":
                    raise
                raise typer.Exit(_report(error)) from None
            except (typer.Exit, typer.Abort, typer.TyperException):
                raise
            except Exception as error:
                if os.environ.get("SPHFRAME_DEBUG") == "1":
                    raise
                _print_defect(error)
                raise typer.Exit(1) from None


def _print_defect(error: Exception) -> None:
    *_, last = traceback.extract_tb(error.__traceback__)
    _print_error(
        f"{type(error).__name__}: {error} (raised in {last.filename}, line {last.lineno})\n"
        "this is a defect of sphframe or of a plugin, not a mistake in your input; set SPHFRAME_DEBUG=1 to see the"
        " traceback, and please report it"
    )


def _report(error: BaseException) -> int:
    """Print the error that ended a command; return its exit code."""
    if isinstance(error, SphframeError):
        _print_error(str(error))
        return error.exit_code
    if isinstance(error, KeyboardInterrupt):
        _print_error("interrupted")
        return 130
    if isinstance(error, BrokenPipeError):  # the reader of a pipe, such as head, has closed it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    if isinstance(error, MemoryError):
        _print_error("not enough memory; choose a larger particle_spacing, or fewer threads")
        return 2
    _print_error(str(error))
    return 2


def _print_error(message: str) -> None:
    first, *rest = visible(message).splitlines() or [""]
    console = log_console()
    console.print(Text.assemble(("error: ", "bold red"), first))
    for line in rest:
        console.print(Text(line))


def _print_warning(message: Warning | str, category: type[Warning], *_: Any) -> None:
    log_console().print(Text.assemble(("warning: ", "bold yellow"), visible(" ".join(str(message).split()))))
