"""Simulation: whether the memory of this machine suffices, found before anything is allocated."""

from pathlib import Path

import numpy as np

from sphframe.cases import Case, Scene
from sphframe.errors import InputError

LEAST_BYTES = {2: 400.0, 3: 1400.0}
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
    free, per_volume = free_memory(), LEAST_BYTES[dim] / spacing**dim
    if per_volume * sum(float(np.prod(np.subtract(*region.bounds()[::-1]))) for region in scene.fluid) < free:
        return  # even if each region filled the box around it
    shapes = [region.geometry(region.coarse) for region in scene.fluid]
    needed = per_volume * sum(shape.area if dim == 2 else shape.volume for shape in shapes)
    if needed > free:
        fitting = spacing * (needed / free) ** (1.0 / dim)
        raise InputError(
            f"particle_spacing = {spacing:g} m gives {needed / LEAST_BYTES[dim]:.2g} particles, which need"
            f" {needed / 1e9:.3g} GB of memory or more, but only {free / 1e9:.3g} GB are free: choose a spacing above"
            f" {fitting:.2g} m, or free memory"
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
