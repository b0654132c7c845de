"""Files without end, more particles than memory, and clients of the page that stay silent."""

import errno
import math
import os
import sys
from pathlib import Path
from typing import Any

import psutil
import pytest

from sphframe import InputError, Simulation
from sphframe.cases import load_case
from sphframe.input_files import content_of, text_of
from sphframe.simulation import memory


@pytest.mark.skipif(sys.platform == "win32", reason="devices and pipes are POSIX")
def test_only_regular_files_of_bounded_size_are_read(tmp_path: Path) -> None:
    (tmp_path / "text").write_bytes(b"\xef\xbb\xbf1\r\n2")
    assert text_of(tmp_path / "text") == "1\n2"
    os.mkfifo(tmp_path / "pipe")
    with (tmp_path / "large").open("wb") as file:
        file.truncate(10**12)  # takes no space
    for path, number in ((Path("/dev/zero"), errno.EINVAL), (tmp_path / "pipe", errno.EINVAL)):
        with pytest.raises(OSError, match="it is no regular file") as caught:
            content_of(path)
        assert caught.value.errno == number
    with pytest.raises(OSError, match="larger than 500 MB"):
        content_of(tmp_path / "large")
    (tmp_path / "case.toml").symlink_to("/dev/zero")
    with pytest.raises(InputError, match=r"cannot read the case file .*: it is no regular file"):
        load_case(tmp_path / "case.toml")


@pytest.mark.parametrize("container", [False, True])
def test_more_particles_than_memory_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, container: bool
) -> None:
    case = load_case("dam-break", overrides={"particle_spacing": 0.0005})
    enough, little = 10**12, 200_000_000
    real: Any = psutil.virtual_memory()
    monkeypatch.setattr(psutil, "virtual_memory", lambda: real._replace(available=enough if container else little))
    monkeypatch.setattr(memory, "_CONTAINER", tmp_path)
    if container:
        (tmp_path / "memory.max").write_text(f"{3 * little}\n")
        (tmp_path / "memory.current").write_text(f"{2 * little}\n")
    with pytest.raises(
        InputError, match=r"particles, which need .* GB of memory or more, but only 0\.2 GB are free"
    ) as found:
        Simulation(case, threads=1)
    spacing = math.sqrt(memory.LEAST_BYTES[2] * 1.2 * 0.6 / little)  # with which the column fits exactly
    assert f"choose a spacing above {spacing:.2g} m" in str(found.value)
