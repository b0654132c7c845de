import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sphframe.cases import load_case
from sphframe.errors import PluginError, PluginWarning
from sphframe.hooks import Events, hook_manager, hookimpl
from sphframe.interfaces import ResumableRun, RunView
from sphframe.simulation import Simulation

EVENTS = ["run_started", "step_completed", "probes_due", "frame_due", "run_finished", "run_failed"]
LISTENER = """
    from sphframe import hookimpl

    heard = []

    @hookimpl
    def sphframe_step_completed(simulation):
        heard.append(simulation)

    class Listener:
        @hookimpl
        def sphframe_run_finished(self):
            heard.append("finished")
"""
Install = Callable[..., Path]


class Recorder:
    def __init__(self, heard: list[Any]) -> None:
        self.heard = heard

    @hookimpl
    def sphframe_step_completed(self, simulation: Any) -> None:
        self.heard.append(simulation)

    @hookimpl
    def sphframe_run_failed(self, error: BaseException) -> None:
        self.heard.append(error)


def test_every_listener_receives_every_event_in_the_given_order():
    heard: list[Any] = []

    class Second(Recorder):
        @hookimpl
        def sphframe_step_completed(self, simulation: Any) -> None:
            self.heard.append("second")

    manager = hook_manager([Recorder(heard), Second(heard)])
    assert {name for name in vars(manager.hook) if name.startswith("sphframe_")} == {f"sphframe_{e}" for e in EVENTS}
    manager.hook.sphframe_run_started(simulation="run")
    manager.hook.sphframe_step_completed(simulation="run")
    error = ValueError()
    manager.hook.sphframe_run_failed(simulation="run", error=error)
    assert heard == ["run", "second", error, error]


def test_a_simulation_has_every_member_that_listeners_may_use():
    simulation = Simulation(load_case("hydrostatic-tank", overrides={"particle_spacing": 0.03}), threads=1)
    assert isinstance(simulation, RunView)
    assert isinstance(simulation, ResumableRun)


def test_every_event_is_documented():
    events = {name: f for name, f in vars(Events).items() if name.startswith("sphframe_")}
    for name, function in events.items():
        assert function.__doc__, f"{name} needs a docstring"
        assert list(inspect.signature(function).parameters)[:2] == ["self", "simulation"]


def test_installed_modules_and_classes_listen(install: Install):
    modules = {"listener_one": LISTENER, "listener_home.inner": LISTENER}
    modules["listener_home.__init__"] = "from listener_home import inner as inner"
    install("listen", modules, {"hooks": {"class": "listener_one:Listener", "module": "listener_home:inner"}})
    manager = hook_manager()
    manager.hook.sphframe_step_completed(simulation="run")
    manager.hook.sphframe_run_finished(simulation="run")

    import listener_home.inner  # type: ignore[import-not-found]
    import listener_one  # type: ignore[import-not-found]

    assert listener_one.heard == ["finished"]
    assert listener_home.inner.heard == ["run"]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("raise RuntimeError('no luck')", "hook 'bad' of bad-listener 1.0 is broken: RuntimeError: no luck"),
        (
            "from sphframe import hookimpl\nclass Bad:\n    @hookimpl\n    def sphframe_step_finished(self): pass",
            "hook 'bad' of bad-listener 1.0 cannot be registered: .*unknown hook 'sphframe_step_finished'",
        ),
        (
            "from sphframe import hookimpl\nclass Bad:\n    @hookimpl\n    def sphframe_run_failed(self, cause): pass",
            "cannot be registered: .*sphframe_run_failed",
        ),
        ("class Bad:\n    def __init__(self): raise OSError('no display')", "hook 'bad' .* no display"),
    ],
)
def test_a_broken_installed_listener_is_left_out_with_a_warning(install: Install, source: str, message: str):
    components = {"hooks": {"bad": "bad_listener:Bad", "good": "listener_two:Listener"}}
    install("bad-listener", {"bad_listener": source, "listener_two": LISTENER}, components)
    with pytest.warns(PluginWarning, match=f"(?s)the run goes on without a plugin: .*{message}"):
        manager = hook_manager()
    manager.hook.sphframe_run_finished(simulation="run")

    import listener_two  # type: ignore[import-not-found]

    assert listener_two.heard == ["finished"]
    assert len(manager.get_plugins()) == 1


def test_a_wrong_listener_of_the_caller_is_an_error():
    class Wrong:
        @hookimpl
        def sphframe_step_finished(self) -> None:
            pass

    with pytest.raises(PluginError, match=r"hook plugin .*Wrong.* unknown hook 'sphframe_step_finished'"):
        hook_manager([Wrong()])
