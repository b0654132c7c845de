"""Boundary: mirror images of the fluid particles in the walls, which take the place of ghosts.

A ghost stands for the reflection S of its face, edge or corner about its foot c. With it a fluid particle j has

    x' = c + S (x_j - c),    m = (x_j + x')/2,    V' = V_j

where m is the point of the plane, line or corner next to the particle. An image counts where m lies on the wall itself:
its own foot is the nearest one, and at most 0.8 dx away. Of several images by nearly the same reflection, as behind
curved walls, the one whose foot is nearest to m counts; those 2 R apart are images in opposite corners. Behind edges
and corners of walls at right angles, particles also have images of images, since S is the product of the reflections
there.

The neighbours of a particle's images are among its own: two particles before a wall are nearer to each other than each
is to the image of the other. The loops over walls therefore run over the lists of fluid neighbours.
"""

from typing import NamedTuple

import numba
import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.compiled import LANES, local_array
from sphframe.compiled.stand_ins import ASSIGN, COLUMNS, DENSITY, DIM, SLOTS
from sphframe.interfaces import Interpolated, WallPoint
from sphframe.interfaces.traits import OK
from sphframe.particles import Columns

_FARTHEST = 0.8
"""largest distance of m from the nearest foot, dx"""


def most_images(dim: int) -> int:
    """Return how many images a particle can have: in the faces, edges and corners of a box less wide than the support.

    Examples
    --------
    >>> most_images(2), most_images(3)
    (8, 26)
    """
    return int(3**dim) - 1


class Images(NamedTuple):
    """Images of fluid particles: ``counts`` (n,) of each; those of particle j are SLOTS j, SLOTS j + 1, ..

    SLOTS: :func:`most_images`. ``rows`` (SLOTS n, width) are packed as those of particles; ``ghost`` (SLOTS n,) is that
    whose reflection is used.
    """

    rows: Array
    counts: IntArray
    ghost: IntArray

    @classmethod
    def of(cls, particles: int, dim: int) -> "Images":
        """Return memory for the images of a number of ``particles``."""
        size = most_images(dim) * particles
        return cls(np.empty((size, Columns.of(dim).width)), np.zeros(particles, np.int64), np.zeros(size, np.int64))


@numba.njit(error_model="numpy", forceinline=True)
def _alike(walls, g, o, dim):  # type: ignore[no-untyped-def]
    """Whether two ghosts stand for nearly the same reflection: by less than 30 degrees, on the same side."""
    same = 0.0
    along = 0.0
    for d in range(dim):
        along += walls.normal[g, d] * walls.normal[o, d]
        for e in range(dim):
            same += walls.reflection[g, d, e] * walls.reflection[o, d, e]
    return same > dim - 1.0 and along > -0.1


@numba.njit(error_model="numpy", forceinline=True)
def _is_face(walls, g, dim):  # type: ignore[no-untyped-def]
    """Whether a ghost stands for the reflection in a face, which reverses one direction."""
    trace = 0.0
    for d in range(dim):
        trace += walls.reflection[g, d, d]
    return trace > dim - 3.0


def make_images(  # type: ignore[no-untyped-def]
    rows, n, lists, fluid_counts, ghost_counts, feet, walls, parameters, image_rows, counts, image_ghosts
):
    """Make the images of the first ``n`` particles in ``rows`` and assign their pressures and velocities.

    ``feet`` (g, dim) of the ghosts, m; ``walls``: :class:`~sphframe.boundary.wall_arrays.WallArrays`. The last three
    are the arrays of :class:`Images`: what a parallel loop writes to an array within a tuple is lost.
    """
    farthest = (_FARTHEST * parameters.spacing) ** 2
    equal = 1e-6 * parameters.spacing**2
    deepest = 4.0 * parameters.support * parameters.support
    for c in numba.prange(fluid_counts.shape[0]):
        misses = local_array(SLOTS)
        nothing, lift, unused = local_array(DIM), local_array(DIM), local_array(DIM)
        for d in range(DIM):
            nothing[d] = 0.0
        first, last = fluid_counts[c], fluid_counts[c] + ghost_counts[c]
        for i in range(c * LANES, min((c + 1) * LANES, n)):
            count = 0
            for k in range(first, last):
                g = lists[c, k] - n
                before = 0.0
                far = 0.0
                miss = 0.0
                for d in range(DIM):
                    before += (feet[g, d] - rows[i, d]) * walls.normal[g, d]
                    lift[d] = feet[g, d] - rows[i, d]
                    for e in range(DIM):
                        lift[d] += walls.reflection[g, d, e] * (rows[i, e] - feet[g, e])
                    far += lift[d] ** 2
                    miss += (rows[i, d] + 0.5 * lift[d] - feet[g, d]) ** 2
                if before < -1e-9 * parameters.spacing or far > deepest or miss > farthest:
                    continue
                place = count
                for s in range(count):
                    apart = 0.0
                    for d in range(DIM):
                        apart += (rows[i, d] + lift[d] - image_rows[SLOTS * i + s, d]) ** 2
                    if apart < deepest and _alike(walls, g, image_ghosts[SLOTS * i + s], DIM):
                        place = s if miss < misses[s] - equal else SLOTS
                if place < SLOTS:
                    misses[place] = miss
                    image_ghosts[SLOTS * i + place] = g
                    for d in range(DIM):
                        image_rows[SLOTS * i + place, d] = rows[i, d] + lift[d]
                    count += 1 if place == count else 0

            kept = 0
            for s in range(count):
                g = image_ghosts[SLOTS * i + s]
                on_wall = True
                if _is_face(walls, g, DIM):
                    for k in range(first, last):
                        o = lists[c, k] - n
                        if _is_face(walls, o, DIM) and not _alike(walls, g, o, DIM):
                            nearer = 0.0
                            for d in range(DIM):
                                nearer += (0.5 * (image_rows[SLOTS * i + s, d] + rows[i, d]) - feet[o, d]) ** 2
                            on_wall = on_wall and nearer > misses[s] - equal
                if not on_wall:
                    continue
                row = SLOTS * i + kept
                image_ghosts[row] = g
                far = 0.0
                for d in range(DIM):
                    image_rows[row, d] = image_rows[SLOTS * i + s, d]
                    lift[d] = image_rows[row, d] - rows[i, d]
                    far += lift[d] ** 2
                half = 0.5 * far**0.5
                velocity = image_rows[row, COLUMNS.u : COLUMNS.u + DIM]
                source = Interpolated(
                    OK, 1, 1.0, rows[i, COLUMNS.pressure], False, nothing, rows[i, COLUMNS.u : COLUMNS.u + DIM]
                )
                wall = WallPoint(
                    walls.normal[g], half, half, lift, walls.reflection[g], walls.velocity[g], walls.force[g], 0.0,
                    image_rows[row, :DIM], walls.number[g],
                )  # fmt: skip
                pressure, share = ASSIGN(source, wall, parameters, velocity, unused)
                pressure = max(pressure, parameters.lowest_pressure)
                image_rows[row, COLUMNS.volume] = share * rows[i, COLUMNS.volume]
                image_rows[row, COLUMNS.density] = DENSITY(
                    pressure, parameters.reference_density, parameters.sound_speed
                )
                image_rows[row, COLUMNS.pressure] = pressure
                kept += 1
            counts[i] = kept
