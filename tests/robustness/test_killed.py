"""A run that is killed repeatedly at random moments ends with the same bits as an uninterrupted run."""

import random
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
import xarray as xr

from sphframe import open_dataset, run
from sphframe.cases import Custom

pytestmark = [
    pytest.mark.long,
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning"),
    pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL and fork are POSIX"),
]
KILLS = 8


@pytest.mark.parametrize("case", ["flume", "channel"])
def test_killed_again_and_again_it_ends_with_the_same_bits(case: str, small: ModuleType, tmp_path: Path) -> None:
    undisturbed = run(Custom(**small.PLANE[case]), output=tmp_path / "whole.nc", threads=1)
    folder = tmp_path / "killed"
    folder.mkdir()
    steps, output = folder / "steps.txt", folder / "run.nc"
    generator = random.Random(20190511)
    moments = []

    with subprocess.Popen(
        [sys.executable, "-W", "ignore", str(Path(small.__file__))],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as server:
        assert server.stdin is not None
        assert server.stdout is not None

        def run_and_die(steps: int, delay: float) -> str:
            print(case, steps, delay, folder, file=server.stdin, flush=True)
            return server.stdout.readline().strip()

        for attempt in range(KILLS):
            if attempt % 7 == 6:  # while it sets up, or opens its files
                ended = run_and_die(0, generator.uniform(0.0, 0.5))
            else:
                ended = run_and_die(generator.randint(1, 60), generator.uniform(0.0, 0.005))
            assert ended == "killed", f"attempt {attempt}: the case is too short for this test"
            moments.append(check_readable(output))
        assert run_and_die(-1, 0.0) == "complete"
        server.stdin.close()

    assert len({moment for moment in moments if moment}) > 5, f"too few different moments: {moments}"
    with open_dataset(output) as resumed:
        small.assert_same_bits(undisturbed.dataset, resumed)
        assert resumed.attrs["completed"] == "yes"
    assert sorted(file.name for file in folder.glob("run*")) == ["run.nc"]
    check_recomputed(steps, small.CHECKPOINT_INTERVAL, float(undisturbed.dataset.time_step.max()))


def check_readable(output: Path) -> int:
    """Open the output of a killed run with xarray and with sphframe; return the number of samples."""
    if not output.exists():
        return 0
    with xr.open_dataset(output) as dataset:
        dataset.load()
    with open_dataset(output) as dataset:
        dataset.load()
        assert dataset.attrs["run_status"] == "running"
        present = dataset["position"].notnull().all("space")
        assert ((dataset["density"] > 0.0) == present).all()
        return dataset.sizes["probe_time"]


def check_recomputed(steps: Path, interval: float, time_step: float) -> None:
    """Each resumed run starts at most one interval, plus the step that passes it, before the end of the last run."""
    reached, starts = 0.0, 0
    for line in steps.read_text().splitlines():
        word, _, value = line.rpartition(" ")
        if word == "start":
            starts += 1
            assert reached - float(value) <= interval + 2.0 * time_step, f"recomputed {reached - float(value):g} s"
            reached = float(value)
        else:
            reached = float(value)
    assert starts >= KILLS // 2
