from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def fake(module_at: Callable[[Path], ModuleType]) -> ModuleType:
    """The module of the stand-in simulation."""
    return module_at(Path(__file__).with_name("fake_simulation.py"))
