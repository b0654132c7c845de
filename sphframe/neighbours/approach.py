"""Neighbours: a bound on the relative displacement of near particles, which decides when lists are rebuilt.

Particles that move together stay each other's neighbours, however fast they move.
"""

import math

import numba
import numpy as np

from sphframe.compiled import local_array, threaded_if_long


@threaded_if_long
def relative_displacement(rows, reference, dim, origin, edge, shape, boxes):  # type: ignore[no-untyped-def]
    """Return a bound, m, on the relative displacement of any two particles that were less than ``edge`` apart.

    Displacements are measured from ``reference`` (n, dim). Space is divided into cubes of side ``edge``; the bound is
    the largest diagonal of the box that holds the displacements in a cube and in the cubes around it.
    ``shape`` (3,) is the number of cubes from ``origin`` (dim,) on, with one more on all sides. ``boxes`` (parts,
    cubes or more, 6) is scratch: the smallest displacements of the particles of each part, and the smallest of their
    negatives.
    The result does not depend on the number of parts.
    """
    n = reference.shape[0]
    parts = boxes.shape[0]
    scale = 1.0 / edge
    for part in numba.prange(parts):
        box = boxes[part]
        box[:] = math.inf
        last = np.uint64(0)
        least = local_array(6)
        least[:] = math.inf
        for i in range(np.uint64(part * n // parts), np.uint64((part + 1) * n // parts)):
            cube = 0
            for k in range(dim):
                cube = cube * shape[k] + int((reference[i, k] - origin[k]) * scale) + 1
            if np.uint64(cube) != last:  # most particles lie in the cube of the previous particle
                for q in range(6):
                    box[last, q] = least[q]
                last = np.uint64(cube)
                for q in range(6):
                    least[q] = box[last, q]
            for k in range(dim):
                moved = rows[i, k] - reference[i, k]
                least[k] = min(least[k], moved)
                least[3 + k] = min(least[3 + k], -moved)
        for q in range(6):
            box[last, q] = least[q]
    row = shape[dim - 1]
    layer = shape[1] * row if dim == 3 else 0
    largest = 0.0
    for cube in numba.prange(boxes.shape[1]):
        occupied = False
        for part in range(parts):
            occupied = occupied or boxes[part, cube, 0] < math.inf
        if not occupied:
            continue
        least = local_array(6)
        least[:] = math.inf
        for a in range(2 if dim == 3 else 1):  # each pair of cubes is visited once, from one of the two
            for b in range(-1 if dim == 3 else 0, 2):
                for near in range(np.uint64(cube + a * layer + b * row - 1), np.uint64(cube + a * layer + b * row + 2)):
                    for part in range(parts):
                        for q in range(6):
                            least[q] = min(least[q], boxes[part, near, q])
        diagonal2 = 0.0
        for k in range(dim):
            diagonal2 += (least[k] + least[3 + k]) ** 2
        largest = max(largest, diagonal2)
    return math.sqrt(largest)
