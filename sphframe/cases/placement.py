"""Cases: the scene of a case, whose bodies have taken gravity and the shape of their walls from it."""

from dataclasses import replace

from sphframe.cases.case import Case
from sphframe.cases.scene import Scene
from sphframe.errors import InputError
from sphframe.geometry import solid_within
from sphframe.interfaces import RigidBody, Surroundings


def placed_scene(case: Case) -> Scene:
    """Return the scene of ``case``, with each of its bodies :meth:`~sphframe.RigidBody.placed`.

    Raises
    ------
    InputError: when a body contradicts the case; the message names the body.
    """
    scene = case.scene()
    return replace(scene, bodies={name: _placed(case, scene, name) for name in scene.bodies})


def _placed(case: Case, scene: Scene, name: str) -> RigidBody:
    solid = solid_within([wall for wall in scene.walls if wall.body == name])
    try:
        return scene.bodies[name].placed(Surroundings(case.dimension, case.gravity, solid))
    except ValueError as error:  # an InputError is one
        raise InputError(f"body {name!r}: {error}") from error
