"""Testing: a pytest plugin, active wherever sphframe is installed together with pytest.

It registers two hypothesis profiles, ``sphframe-quick`` and ``sphframe-thorough``, for ``--hypothesis-profile``, and a
fixture that hides installed plugins.
"""

from collections.abc import Iterator

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Register the hypothesis profiles if hypothesis is installed."""
    try:
        from hypothesis import settings
    except ImportError:
        return
    settings.register_profile("sphframe-quick", max_examples=10, deadline=None)
    settings.register_profile("sphframe-thorough", max_examples=2000, deadline=None)


@pytest.fixture
def no_installed_plugins(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Hide all installed plugins for one test; only the components of sphframe itself are available."""
    from sphframe import registry

    with monkeypatch.context() as patch:
        registry.clear()
        _hide(patch)
        yield
    registry.clear()


def _hide(patch: pytest.MonkeyPatch) -> None:
    from importlib import metadata

    everything = metadata.distributions

    def own() -> list[metadata.Distribution]:
        return [d for d in everything() if d.metadata["Name"] == "sphframe"]

    patch.setattr(metadata, "distributions", own)
