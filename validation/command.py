"""The command line that the validation cases share."""

import argparse
from pathlib import Path

from sphframe.studies import Study, reproduce


def carry_out(study: Study) -> None:
    """Carry out ``study`` with the options of the command line, and print where its report is."""
    parser = argparse.ArgumentParser(description=study.title)
    parser.add_argument("--output", type=Path, required=True, help="folder for the runs, the report and its figures")
    parser.add_argument("--reference", type=Path, help="folder of reference series, which are not part of sphframe")
    parser.add_argument("--only", nargs="+", default=(), metavar="SECTION", help="sections; all by default")
    parser.add_argument("--workers", type=int, help="number of processes; by default one per core")
    parser.add_argument("--quick", action="store_true", help="run at a coarse resolution, for a test")
    print(reproduce(study, **vars(parser.parse_args())))
