"""Simulation: whether the memory of this machine suffices, found before anything is allocated."""

from pathlib import Path

from sphframe.cases import Case, Scene
from sphframe.errors import InputError

LEAST_BYTES = {2: 400.0, 3: 2000.0}
"""lowest memory per particle that was measured, by dimension"""
_CONTAINER = Path("/sys/fs/cgroup")


def check_memory(case: Case, scene: Scene) -> None:
    """Raise an error if the particles of ``scene`` alone need more memory than is free.

    Raises
    ------
    InputError
        they do; the message says which spacing fits.
    """
    dim, spacing = case.dimension, case.particle_spacing
    shapes = [region.geometry(region.coarse) for region in scene.fluid]
    count = sum(shape.area if dim == 2 else shape.volume for shape in shapes) / spacing**dim
    needed, free = LEAST_BYTES[dim] * count, free_memory()
    if needed > free:
        fitting = spacing * (needed / free) ** (1.0 / dim)
        raise InputError(
            f"particle_spacing = {spacing:g} m gives {count:.2g} particles, which need {needed / 1e9:.3g} GB of memory"
            f" or more, but only {free / 1e9:.3g} GB are free: choose a spacing above {fitting:.2g} m, or free memory"
        )


def free_memory() -> float:
    """Return the bytes that this process may still use: those of the machine, or of its container."""
    import psutil

    free = float(psutil.virtual_memory().available)
    try:
        limit, used = ((_CONTAINER / f"memory.{name}").read_text().strip() for name in ("max", "current"))
        return min(free, float(limit) - float(used)) if limit != "max" else free
    except (OSError, ValueError):  # no control groups here
        return free
