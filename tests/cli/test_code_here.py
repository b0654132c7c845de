"""A method and a case in a file of the working directory are found by ``module:attribute``, as the tutorial says."""

import os
import subprocess
import sys
from pathlib import Path

METHOD = """
from sphframe import HydrostaticTank
from sphframe_shepard import ImprovedShepard

class Tank(HydrostaticTank):
    pass

class Mine(ImprovedShepard):
    pass  # its loops are those of the default method, which are compiled for other tests as well
"""


def test_run_and_verify_find_a_module_in_the_working_directory(tmp_path: Path) -> None:
    (tmp_path / "of_mine.py").write_text(METHOD)
    start = "import sys; sys.path = [p for p in sys.path if p]; from sphframe.cli.app import main; sys.exit(main())"
    environment = {**os.environ, "PYTHONSAFEPATH": "1", "NO_COLOR": "1"}

    def sphframe(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-P", "-c", start, *arguments]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    absent = sphframe("verify", "of_mine:Absent")  # the module is found; this is faster than a whole verification
    assert absent.returncode == 2
    assert "has no attribute 'Absent'" in absent.stderr
    ran = sphframe(
        "run", "of_mine:Tank", "--set", "particle_spacing=0.05", "--until", "0.01", "--interpolator", "of_mine:Mine"
    )
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "Tank-Mine.nc").is_file()
