from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

pytest.importorskip("distributed")


@pytest.fixture(scope="session")
def tiny(module_at: Callable[[Path], ModuleType]) -> ModuleType:
    """The module of the tiny study."""
    return module_at(Path(__file__).with_name("tiny.py"))


@pytest.fixture(scope="session")
def cluster() -> Iterator[str]:
    """The address of a scheduler with one worker, in a thread of this process: quick to start."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address="127.0.0.1:0") as made:
        yield made.scheduler_address
