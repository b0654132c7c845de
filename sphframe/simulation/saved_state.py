"""Simulation: checks that a saved state belongs to a simulation before it is restored."""

import numpy as np

from sphframe.arrays import Array, Arrays
from sphframe.errors import InputError

_PER_FLUID_PARTICLE = {"ids", "rates", "gradient", "turns", "channel.waiting"}


def check_saved_state(
    saved: Arrays, own: Arrays, particle_count: int, ghost_count: int, lower: Array, upper: Array
) -> None:
    """Compare the arrays of a ``saved`` state with a simulation's ``own``, by name.

    Parameters
    ----------
    particle_count, ghost_count
        largest numbers of fluid particles and ghosts.
    lower, upper
        (dim,) corners of the domain, m.

    Raises
    ------
    InputError
        when names or shapes are those of another case, or numbers cannot be those of particles in the domain.
    """
    count = len(saved.get("ids", ()))
    expected = {name: array.shape for name, array in own.items()}
    expected["rows"] = (count + ghost_count, *expected["rows"][1:])
    for name, shape in expected.items():
        if name in _PER_FLUID_PARTICLE or name.endswith(".fluid"):
            expected[name] = (count, *shape[1:])
    if {name: array.shape for name, array in saved.items()} != expected or not 0 < count <= particle_count:
        raise InputError("the saved state belongs to another case: its particles, walls or bodies differ")
    ids, position = saved["ids"], saved["lists.fluid"]
    finite = all(np.all(np.isfinite(array)) for array in saved.values())
    numbered = ids.min() >= 0 and ids.max() < particle_count and len(np.unique(ids)) == count
    if not (finite and numbered and np.all((position >= lower) & (position <= upper))):
        raise InputError("the saved state is damaged: its numbers are not those of particles in the domain")
