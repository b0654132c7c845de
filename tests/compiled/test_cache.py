"""The cache of compiled loops where nothing can be written."""

import os
from pathlib import Path

import numba
import pytest

from sphframe.compiled.cache import prefer_writable_cache


def test_a_cache_is_found_where_package_and_home_are_read_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "a file" / "home"))
    prefer_writable_cache(tmp_path)
    assert not numba.config.CACHE_DIR, "the package can be written to"
    (tmp_path / "a file").write_text("")
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path)
    with pytest.warns(RuntimeWarning, match="set NUMBA_CACHE_DIR"):
        prefer_writable_cache(tmp_path)
    folder = Path(numba.config.CACHE_DIR)
    assert (folder / "..").resolve() != tmp_path
    assert folder.is_dir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    prefer_writable_cache(tmp_path)
    assert not numba.config.CACHE_DIR, "the home can be written to"
