"""CLI: the command ``sphframe``; it parses, calls the library and prints."""

from sphframe.cli.app import main

__all__ = ["main"]
