"""Boundary: ghosts, mirror points and feet carried by rigid bodies.

::

    x = c + X + R (x0 - c),    u = U + omega x r,    a = A + alpha x r + omega x (omega x r),    r = x - c - X

with the body's centre c as drawn, its displacement X and its rotation R. The reflection matrices S turn with the body,
R S R^T, and so do the normals, R n.
"""

import math

import numba


@numba.njit(error_model="numpy", forceinline=True)
def _turned(x, y, cos, sin):  # type: ignore[no-untyped-def]
    """Return the vector (x, y) turned by an angle with the given cosine and sine."""
    return cos * x - sin * y, sin * x + cos * y


@numba.njit(error_model="numpy", forceinline=True)
def _cross(a, x, y, z):  # type: ignore[no-untyped-def]
    """Return the cross product of the last three of ``a`` (6,) with (x, y, z)."""
    return a[4] * z - a[5] * y, a[5] * x - a[3] * z, a[3] * y - a[4] * x


@numba.njit(cache=True, error_model="numpy")
def move_ghosts(  # type: ignore[no-untyped-def]
    drawn, drawn_reflection, ghost_body, centres, positions, velocities, accelerations, rotations,
    position, mirror, foot, normal, reflection, velocity, acceleration,
):  # fmt: skip
    """Write the last seven arrays for ghosts whose ``ghost_body`` is not -1; ``drawn`` are :class:`GhostPoints`.

    ``positions``, ``velocities``, ``accelerations`` (bodies, 3 or 6) are generalised coordinates; ``rotations``
    (bodies, 3, 3) the rotation matrices in 3-D. Velocity and acceleration are those of the wall at the foot.
    """
    dim = position.shape[1]
    for g in range(position.shape[0]):
        b = ghost_body[g]
        if b < 0:
            continue
        if dim == 2:
            cos = math.cos(positions[b, 2])
            sin = math.sin(positions[b, 2])
            omega = velocities[b, 2]
            alpha = accelerations[b, 2]
            rx, ry = _turned(drawn.position[g, 0] - centres[b, 0], drawn.position[g, 1] - centres[b, 1], cos, sin)
            mx, my = _turned(drawn.mirror[g, 0] - centres[b, 0], drawn.mirror[g, 1] - centres[b, 1], cos, sin)
            fx, fy = _turned(drawn.foot[g, 0] - centres[b, 0], drawn.foot[g, 1] - centres[b, 1], cos, sin)
            position[g, 0] = centres[b, 0] + positions[b, 0] + rx
            position[g, 1] = centres[b, 1] + positions[b, 1] + ry
            mirror[g, 0] = centres[b, 0] + positions[b, 0] + mx
            mirror[g, 1] = centres[b, 1] + positions[b, 1] + my
            foot[g, 0] = centres[b, 0] + positions[b, 0] + fx
            foot[g, 1] = centres[b, 1] + positions[b, 1] + fy
            normal[g, 0], normal[g, 1] = _turned(drawn.normal[g, 0], drawn.normal[g, 1], cos, sin)
            velocity[g, 0] = velocities[b, 0] - omega * fy
            velocity[g, 1] = velocities[b, 1] + omega * fx
            acceleration[g, 0] = accelerations[b, 0] - alpha * fy - omega * omega * fx
            acceleration[g, 1] = accelerations[b, 1] + alpha * fx - omega * omega * fy
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
                foot[g, k] = centres[b, k] + positions[b, k]
                normal[g, k] = 0.0
                for m in range(3):
                    position[g, k] += turn[k, m] * (drawn.position[g, m] - centres[b, m])
                    mirror[g, k] += turn[k, m] * (drawn.mirror[g, m] - centres[b, m])
                    foot[g, k] += turn[k, m] * (drawn.foot[g, m] - centres[b, m])
                    normal[g, k] += turn[k, m] * drawn.normal[g, m]
                for m in range(3):
                    total = 0.0
                    for p in range(3):
                        for q in range(3):
                            total += turn[k, p] * drawn_reflection[g, p, q] * turn[m, q]
                    reflection[g, k, m] = total
            rx = foot[g, 0] - centres[b, 0] - positions[b, 0]
            ry = foot[g, 1] - centres[b, 1] - positions[b, 1]
            rz = foot[g, 2] - centres[b, 2] - positions[b, 2]
            ux, uy, uz = _cross(velocities[b], rx, ry, rz)
            ax, ay, az = _cross(accelerations[b], rx, ry, rz)
            cx, cy, cz = _cross(velocities[b], ux, uy, uz)
            velocity[g, 0] = velocities[b, 0] + ux
            velocity[g, 1] = velocities[b, 1] + uy
            velocity[g, 2] = velocities[b, 2] + uz
            acceleration[g, 0] = accelerations[b, 0] + ax + cx
            acceleration[g, 1] = accelerations[b, 1] + ay + cy
            acceleration[g, 2] = accelerations[b, 2] + az + cz
