"""__main__: ``python -m sphframe`` is the command ``sphframe``."""

from sphframe.cli import main

main()
