"""Cases: the scene and the body force of a case, which have taken from it what they depend on."""

from dataclasses import replace

from sphframe.cases.case import Case
from sphframe.cases.scene import Scene
from sphframe.errors import BrokenPluginError, InputError, PluginError
from sphframe.geometry import solid_within
from sphframe.interfaces import BodyForce, RigidBody, Surroundings


def placed_scene(case: Case) -> Scene:
    """Return the scene of ``case``, with each of its bodies :meth:`~sphframe.RigidBody.placed`.

    Raises
    ------
    InputError
        when a body contradicts the case; the message names the body.
    BrokenPluginError
        when the case returns no scene.
    """
    scene = case.scene()
    if not isinstance(scene, Scene):
        hint = ": end it with 'return Scene(...)'" if scene is None else ""
        raise BrokenPluginError(f"{type(case).__name__}.scene returned {scene!r:.80}; expected a Scene{hint}")
    return replace(scene, bodies={name: _placed(case, scene, name) for name in scene.bodies})


def placed_force(case: Case) -> BodyForce | None:
    """Return the body force of the ``acceleration`` of ``case``; None where there is none.

    Raises
    ------
    InputError, PluginError
        when it cannot be made, or contradicts the case.
    """
    chosen = case.acceleration
    if chosen.name == "uniform" and not any(chosen.options.get("vector", ())):
        return None
    try:
        force: BodyForce = chosen.create("body_forces").placed(case.dimension, case.gravity_vector)
    except PluginError:
        raise
    except ValueError as error:  # an InputError is one
        raise InputError(f"acceleration: {error}") from error
    return force


def _placed(case: Case, scene: Scene, name: str) -> RigidBody:
    solid = solid_within([wall for wall in scene.walls if wall.body == name])
    try:
        return scene.bodies[name].placed(Surroundings(case.dimension, case.gravity, solid))
    except ValueError as error:  # an InputError is one
        raise InputError(f"body {name!r}: {error}") from error
