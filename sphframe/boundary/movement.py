"""Boundary: ghosts and mirror points carried by rigid bodies.

::

    x = c + X + R (x0 - c),    u = U + omega x r,    a = A + alpha x r + omega x (omega x r),    r = x - c - X

with the body's centre c as drawn, its displacement X and its rotation R. The reflection matrices S turn with the body,
R S R^T.
"""

import math

import numba


@numba.njit(inline="always")
def _turned(x, y, cos, sin):  # type: ignore[no-untyped-def]
    """Return the vector (x, y) turned by an angle with the given cosine and sine."""
    return cos * x - sin * y, sin * x + cos * y


@numba.njit(inline="always")
def _cross(a, x, y, z):  # type: ignore[no-untyped-def]
    """Return the cross product of the last three of ``a`` (6,) with (x, y, z)."""
    return a[4] * z - a[5] * y, a[5] * x - a[3] * z, a[3] * y - a[4] * x


@numba.njit(cache=True, error_model="numpy")
def move_ghosts(  # type: ignore[no-untyped-def]
    drawn, drawn_mirror, drawn_reflection, ghost_body, centres, positions, velocities, accelerations, rotations,
    position, mirror, reflection, velocity, acceleration,
):  # fmt: skip
    """Write the last five arrays for ghosts whose ``ghost_body`` is not -1.

    ``positions``, ``velocities``, ``accelerations`` (bodies, 3 or 6) are generalised coordinates; ``rotations``
    (bodies, 3, 3) the rotation matrices in 3-D.
    """
    dim = drawn.shape[1]
    for g in range(drawn.shape[0]):
        b = ghost_body[g]
        if b < 0:
            continue
        if dim == 2:
            cos = math.cos(positions[b, 2])
            sin = math.sin(positions[b, 2])
            omega = velocities[b, 2]
            alpha = accelerations[b, 2]
            rx, ry = _turned(drawn[g, 0] - centres[b, 0], drawn[g, 1] - centres[b, 1], cos, sin)
            mx, my = _turned(drawn_mirror[g, 0] - centres[b, 0], drawn_mirror[g, 1] - centres[b, 1], cos, sin)
            position[g, 0] = centres[b, 0] + positions[b, 0] + rx
            position[g, 1] = centres[b, 1] + positions[b, 1] + ry
            mirror[g, 0] = centres[b, 0] + positions[b, 0] + mx
            mirror[g, 1] = centres[b, 1] + positions[b, 1] + my
            # the wall's kinematics are taken at the foot point, half-way between ghost and mirror point
            rx = 0.5 * (rx + mx)
            ry = 0.5 * (ry + my)
            velocity[g, 0] = velocities[b, 0] - omega * ry
            velocity[g, 1] = velocities[b, 1] + omega * rx
            acceleration[g, 0] = accelerations[b, 0] - alpha * ry - omega * omega * rx
            acceleration[g, 1] = accelerations[b, 1] + alpha * rx - omega * omega * ry
            sxx = drawn_reflection[g, 0, 0]
            sxy = drawn_reflection[g, 0, 1]
            syy = drawn_reflection[g, 1, 1]
            reflection[g, 0, 0] = cos * cos * sxx - 2.0 * cos * sin * sxy + sin * sin * syy
            reflection[g, 1, 1] = sin * sin * sxx + 2.0 * cos * sin * sxy + cos * cos * syy
            reflection[g, 0, 1] = cos * sin * (sxx - syy) + (cos * cos - sin * sin) * sxy
            reflection[g, 1, 0] = reflection[g, 0, 1]
        else:
            turn = rotations[b]
            for k in range(3):
                position[g, k] = centres[b, k] + positions[b, k]
                mirror[g, k] = centres[b, k] + positions[b, k]
                for m in range(3):
                    position[g, k] += turn[k, m] * (drawn[g, m] - centres[b, m])
                    mirror[g, k] += turn[k, m] * (drawn_mirror[g, m] - centres[b, m])
                for m in range(3):
                    total = 0.0
                    for p in range(3):
                        for q in range(3):
                            total += turn[k, p] * drawn_reflection[g, p, q] * turn[m, q]
                    reflection[g, k, m] = total
            rx = 0.5 * (position[g, 0] + mirror[g, 0]) - centres[b, 0] - positions[b, 0]
            ry = 0.5 * (position[g, 1] + mirror[g, 1]) - centres[b, 1] - positions[b, 1]
            rz = 0.5 * (position[g, 2] + mirror[g, 2]) - centres[b, 2] - positions[b, 2]
            ux, uy, uz = _cross(velocities[b], rx, ry, rz)
            ax, ay, az = _cross(accelerations[b], rx, ry, rz)
            cx, cy, cz = _cross(velocities[b], ux, uy, uz)
            velocity[g, 0] = velocities[b, 0] + ux
            velocity[g, 1] = velocities[b, 1] + uy
            velocity[g, 2] = velocities[b, 2] + uz
            acceleration[g, 0] = accelerations[b, 0] + ax + cx
            acceleration[g, 1] = accelerations[b, 1] + ay + cy
            acceleration[g, 2] = accelerations[b, 2] + az + cz
