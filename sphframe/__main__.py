"""__main__: the command ``sphframe``, also as ``python -m sphframe``."""

import contextlib
import io
import os
import sys


def main() -> None:
    """Run the command line; raises SystemExit with 0, 1 (a defect), 2 (input, files), 3 (a run went wrong) or 130."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # characters that the terminal does not know are written as codes
            stream.reconfigure(errors="backslashreplace")
    try:
        from sphframe.cli import main as run_command_line  # takes a moment, in which Ctrl-C may come

        run_command_line()
    except KeyboardInterrupt:
        with contextlib.suppress(OSError):
            print("error: interrupted", file=sys.stderr)
        raise SystemExit(130) from None
    finally:
        with contextlib.suppress(ValueError, AttributeError):  # a stream that is closed or absent
            try:
                sys.stderr.flush()
            except OSError:  # a log that cannot be written any more must not change the exit code
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())


if __name__ == "__main__":
    main()
