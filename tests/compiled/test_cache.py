"""The cache of compiled loops where nothing can be written, and where it is damaged or full."""

import errno
import os
import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
import pytest
from numba.core import caching

from sphframe.compiled import cache

SOURCE = "import numba\n\n@numba.njit(cache=True)\ndef twice(x):\n    return 2 * x\n"


@pytest.mark.parametrize(
    ("pattern", "damage"), [("loops.*nbi", b""), ("loops.*nbc", b"\x80\x04K"), ("loops.*nbi", b"\0" * 200)]
)
def test_a_damaged_cache_is_replaced(
    module_at: Callable[[Path], ModuleType],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    pattern: str,
    damage: bytes,
) -> None:
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "loops.py").write_text(SOURCE)
    assert module_at(tmp_path / "loops.py").twice(3) == 6
    files = list((tmp_path / "cache").rglob(pattern))
    assert files
    for file in files:
        file.write_bytes(damage)
    with pytest.warns(RuntimeWarning, match=f"{re.escape(str(tmp_path / 'cache'))}.* are damaged"):
        assert module_at(tmp_path / "loops.py").twice(3) == 6
    sound = module_at(tmp_path / "loops.py").twice
    assert sound(3) == 6
    assert sum(sound.stats.cache_hits.values()) == 1, "it is sound again"


def test_a_full_disk_does_not_stop_a_process(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    @numba.njit(cache=True)
    def thrice(x: float) -> float:
        return 3.0 * x

    monkeypatch.setattr(caching.IndexDataCacheFile, "save", full)
    with pytest.warns(RuntimeWarning, match=r"cannot be written to \(No space left on device\).*NUMBA_CACHE_DIR"):
        assert thrice(2.0) == 6.0


def test_where_no_folder_can_be_written_to_there_is_a_temporary_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(self: Any) -> None:
        raise PermissionError

    own = [one for one in caching.CacheImpl._locator_classes if one is not cache.TemporaryLocator]
    for locator in own:
        monkeypatch.setattr(locator, "ensure_cache_path", refused)
    cache.temporary_cache.cache_clear()
    cache._warn.cache_clear()
    with pytest.warns(RuntimeWarning, match="set NUMBA_CACHE_DIR"):

        @numba.njit(cache=True)
        def fourfold(x: float) -> float:
            return 4.0 * x

    assert fourfold(2.0) == 8.0
    assert list(Path(cache.temporary_cache()).rglob("*fourfold*.nbc"))
