"""Hooks: the events of a run, which any number of listeners receive.

A listener is any object, class or module with functions marked by :data:`hookimpl`; the progress bar and the NetCDF
writer are listeners. A listener that is declared in the entry-point group ``sphframe.hooks`` receives the events of
every run::

    from sphframe import hookimpl

    @hookimpl
    def sphframe_step_completed(simulation):
        print(simulation.step, simulation.time)

Every listener, built-in or installed, receives the running simulation as a
:class:`~sphframe.interfaces.RunView`: its time, step, fields, probes, forces and counts, all read-only.
"""

import inspect
import warnings
from collections.abc import Iterable

import pluggy

from sphframe.errors import PluginError, PluginWarning
from sphframe.interfaces import RunView
from sphframe.registry import Entry, available, load

hookspec = pluggy.HookspecMarker("sphframe")
hookimpl = pluggy.HookimplMarker("sphframe")
"""marks a function as a listener to the event of its name; the function may omit arguments that it does not need"""


class Events:
    """The events of a run, in the order in which they happen."""

    @hookspec
    def sphframe_run_started(self, simulation: RunView) -> None:
        """Called at the start of a run: the initial state is complete, no step has been made."""

    @hookspec
    def sphframe_step_completed(self, simulation: RunView) -> None:
        """Called after each time step. It is called often, so it must return quickly."""

    @hookspec
    def sphframe_probes_due(self, simulation: RunView) -> None:
        """Called when probes, energies and diagnostics are sampled, the first time at the start."""

    @hookspec
    def sphframe_frame_due(self, simulation: RunView) -> None:
        """Called when all particles are stored, the first time at the start."""

    @hookspec
    def sphframe_run_finished(self, simulation: RunView) -> None:
        """Called at the regular end of a run."""

    @hookspec
    def sphframe_run_failed(self, simulation: RunView, error: BaseException) -> None:
        """Called when ``error``, or an interruption by the user, ends a run. Close open files here."""


def hook_manager(plugins: Iterable[object] = ()) -> pluggy.PluginManager:
    """Return the manager that passes events to ``plugins`` and to all installed hook plugins.

    ``hook_manager(...).hook.sphframe_run_started(simulation=simulation)`` passes one event to all of them. An installed
    hook plugin that cannot be used is left out with a :class:`~sphframe.errors.PluginWarning`.

    Parameters
    ----------
    plugins
        listeners of the caller; they are called in this order and before the installed ones.

    Raises
    ------
    PluginError
        when one of ``plugins`` is not a valid listener.
    """
    manager = pluggy.PluginManager("sphframe")
    manager.add_hookspecs(Events)
    for entry in available("hooks"):
        try:
            _register(manager, load("hooks", entry.name), entry)
        except PluginError as error:
            warnings.warn(f"the run goes on without a plugin: {error}", PluginWarning, stacklevel=2)
    for plugin in reversed(list(plugins)):  # pluggy calls the last registered first
        _register(manager, plugin, None)
    return manager


def _register(manager: pluggy.PluginManager, plugin: object, entry: Entry | None) -> None:
    label = entry.label if entry else f"hook plugin {plugin!r:.80}"
    listener = None
    try:
        listener = plugin() if inspect.isclass(plugin) else plugin
        manager.register(listener)
        manager.check_pending()
    except Exception as error:
        if listener is not None and manager.is_registered(listener):
            manager.unregister(listener)
        raise PluginError(f"{label} cannot be registered: {type(error).__name__}: {error}") from error
