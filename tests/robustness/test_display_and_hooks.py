"""A display that fails never ends a run, and an error that leaves a sound state leaves a checkpoint."""

import errno
import io
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from sphframe import InputError, open_dataset, resume, run
from sphframe.cli.run import run_command

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
PARAMETERS = {"particle_spacing": 0.03, "tank_length": 0.3, "until": 0.05}


class Broken(io.StringIO):
    """A stream to which nothing can be written any more."""

    def __init__(self, error: Exception, *, terminal: bool) -> None:
        super().__init__()
        self.error, self.terminal, self.tried = error, terminal, 0

    def isatty(self) -> bool:
        return self.terminal

    def write(self, text: str) -> int:
        self.tried += 1
        raise self.error


@pytest.mark.parametrize(
    ("error", "terminal"),
    [
        (BrokenPipeError(errno.EPIPE, "closed"), True),
        (OSError(errno.ENOSPC, "full"), False),
        (ValueError("closed file"), True),
    ],
)
def test_a_run_goes_on_without_its_display(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception, terminal: bool
) -> None:
    stream = Broken(error, terminal=terminal)
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(sys, "stdout", stream)
    path = tmp_path / "run.nc"
    run_command(
        "hydrostatic-tank", preset=None, overrides=PARAMETERS, threads=1, device="cpu", output=path,
        overwrite=False, checkpoint_every=60.0, checkpoint_interval=None,
    )  # fmt: skip
    assert stream.tried > 5
    assert sorted(file.name for file in tmp_path.iterdir()) == ["run.nc", "run.png"]
    with open_dataset(path) as dataset:
        assert dataset.attrs["completed"] == "yes"


@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "a log is full"), ZeroDivisionError("one"), InputError("no")])
def test_an_error_of_a_hook_leaves_a_checkpoint(small: ModuleType, tmp_path: Path, error: Exception) -> None:
    path = tmp_path / "run.nc"

    def fail(simulation: Any) -> None:
        raise error

    with pytest.raises(type(error)) as caught:
        run("hydrostatic-tank", output=path, threads=1, hooks=[small.At(7, fail)], **PARAMETERS)
    assert any("sphframe.resume" in note for note in caught.value.__notes__)
    assert not any("removed when Python ends" in note for note in caught.value.__notes__)
    whole = run("hydrostatic-tank", output=tmp_path / "whole.nc", threads=1, **PARAMETERS)
    small.assert_same_bits(whole.dataset, resume(path, threads=1).dataset)


def test_files_that_will_not_stay_are_named_as_such(small: ModuleType) -> None:
    def interrupt(simulation: Any) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as caught:
        run("hydrostatic-tank", threads=1, hooks=[small.At(3, interrupt)], **PARAMETERS)
    assert "removed when Python ends: copy them, or give output=FILE" in caught.value.__notes__[-1]
