"""Neighbours: what a particle sees past thin walls.

A particle sees another one if no side of a thin wall is on the straight line between them. It sees a ghost if the first
side of any wall that this line enters from the fluid is one of the ghost's own chart
(:mod:`sphframe.geometry.charts`); behind thick walls it also sees ghosts where the line enters no side.

A thin wall that stands on a thick one, and moves otherwise, such as a gate on a bed, is continued into it. A line that
has entered the bed and then crosses the continuation sees the ghosts of the gate: those of the bed are filled from the
fluid on the other side there. If there is a gap s between gate and bed, this holds in the share 1 - s/dx.

A line that passes the end of a wall without thickness at the distance s, between the two particles, is stopped in the
share 1/2 - s/dx (s < 0 where it meets the wall), between 0 and 1, and one that cuts a corner of a thin solid at the
distance s in the share s/dx. What one particle does not see of another one, it sees of ghosts in its place. With shares
of 0 and 1 alone, sums near these ends would jump by a whole particle when the lists are made again.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.compiled import LANES, threaded

WHOLE = 128
"""share in which a neighbour is seen if nothing hides it; shares are bytes, and at most 1.5"""


class Sight(NamedTuple):
    """Sides of walls at present, and the charts of ghosts.

    ``ends`` (k, 4): x, y of start and end of each side, m, the fluid on its left; ``smooth`` (k, 2): dx where the start
    and the end of a side are ends of a line, -dx where they are corners of a thin solid, else 0; ``chart`` (k,);
    ``thin`` (k,), whether it hides particles; ``beyond`` (k,): 1 or -1 where it only continues a thin wall beyond the
    end or the start of a side, else 0; ``body`` (k,), -1 at rest; ``spacing``, m. ``ghost_chart`` (g,); ``ghost_thin``
    (g,), whether a ghost is seen only through its chart.
    """

    ends: Array
    smooth: Array
    chart: IntArray
    thin: BoolArray
    beyond: IntArray
    body: IntArray
    spacing: float
    ghost_chart: IntArray
    ghost_thin: BoolArray


@numba.njit(error_model="numpy", forceinline=True)
def _area(ax, ay, bx, by, cx, cy):  # type: ignore[no-untyped-def]
    """Return twice the area of a triangle, positive where c lies on the left of the line from a to b."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@numba.njit(error_model="numpy", forceinline=True)
def _left(px, py, qx, qy, x, y, smooth):  # type: ignore[no-untyped-def]
    """Return 1 where a point lies on the left of the line from p to q, else 0; with ``smooth`` > 0, over that width.

    The width is measured from what lies between p and q. A line through the common point of two sides that continue
    each other crosses exactly one of them.
    """
    area = _area(px, py, qx, qy, x, y)
    if smooth <= 0.0:
        return 1.0 if area > 0.0 else 0.0
    ux, uy = qx - px, qy - py
    along = min(max(((x - px) * ux + (y - py) * uy) / (ux * ux + uy * uy), 0.0), 1.0)
    distance = math.hypot(x - px - along * ux, y - py - along * uy)
    return min(max(0.5 + math.copysign(distance, area) / smooth, 0.0), 1.0)


@numba.njit(error_model="numpy")
def _crossed(px, py, qx, qy, k, sight):  # type: ignore[no-untyped-def]
    """Return the share of the line from p to q that crosses side ``k``, and where; negative where it comes out."""
    ax, ay, bx, by = sight.ends[k]
    before = _area(ax, ay, bx, by, px, py)
    behind = _area(ax, ay, bx, by, qx, qy)
    if (before > 0.0 and behind < 0.0) or (before < 0.0 and behind > 0.0):
        share = abs(
            _left(px, py, qx, qy, ax, ay, sight.smooth[k, 0]) - _left(px, py, qx, qy, bx, by, sight.smooth[k, 1])
        )
        return share if before > 0.0 else -share, before / (before - behind)
    return 0.0, math.inf


@numba.njit(error_model="numpy", forceinline=True)
def _depth(px, py, qx, qy, k, sight):  # type: ignore[no-untyped-def]
    """Return the distance of the line from p to q from the corners of side ``k``, over that where it is stopped."""
    depth = 1.0
    length = math.hypot(qx - px, qy - py)
    for e in range(2):
        if sight.smooth[k, e] < 0.0:
            area = _area(px, py, qx, qy, sight.ends[k, 2 * e], sight.ends[k, 2 * e + 1])
            depth = min(depth, abs(area) / (-sight.smooth[k, e] * length))
    return depth


@numba.njit(error_model="numpy")
def _stopped(px, py, qx, qy, k, near, count, sight):  # type: ignore[no-untyped-def]
    """Return the share of the line from p to q that side ``k`` stops, and where, as a share of the line."""
    share, place = _crossed(px, py, qx, qy, k, sight)
    if share <= 0.0 or sight.beyond[k] != 0:
        return 0.0, math.inf
    if sight.thin[k]:
        leaves = math.inf
        last = -1
        for m in range(count):
            back, where = _crossed(px, py, qx, qy, near[m], sight)
            if back < 0.0 and sight.beyond[near[m]] == 0 and where > place + 1e-9 and where < leaves:
                leaves = where
                last = near[m]
        if last >= 0:
            share *= min(_depth(px, py, qx, qy, k, sight), _depth(px, py, qx, qy, last, sight))
    return share, place


@numba.njit(error_model="numpy")
def share_of_fluid(px, py, qx, qy, near, count, sight):  # type: ignore[no-untyped-def]
    """Return the share in which two points see each other past ``count`` sides; the same for both orders of them."""
    if qx < px or (qx == px and qy < py):
        px, py, qx, qy = qx, qy, px, py
    seen = 1.0
    for k in range(count):
        if sight.thin[near[k]]:
            seen -= _stopped(px, py, qx, qy, near[k], near, count, sight)[0]
    return max(seen, 0.0)


@numba.njit(error_model="numpy", forceinline=True)
def _continues(k, wall, sight):  # type: ignore[no-untyped-def]
    """Whether side ``k`` belongs to a thin wall, or its continuation, that may reach into the side ``wall``."""
    return (sight.thin[k] or sight.beyond[k] != 0) and sight.body[k] != sight.body[wall]


@numba.njit(error_model="numpy", forceinline=True)
def _closed(k, wall, sight):  # type: ignore[no-untyped-def]
    """Return the share in which side ``k`` of a thin wall, or its continuation, counts behind the side ``wall``."""
    if sight.beyond[k] == 0:
        return 1.0
    ax, ay, bx, by = sight.ends[wall]
    x, y, further_x, further_y = sight.ends[k]
    if sight.beyond[k] < 0:
        x, y, further_x, further_y = further_x, further_y, x, y
    height = _area(ax, ay, bx, by, x, y)
    steepness = height - _area(ax, ay, bx, by, further_x, further_y)
    if steepness <= 0.0:
        return 0.0
    gap = height / steepness * math.hypot(further_x - x, further_y - y)
    return min(max(1.0 - gap / sight.spacing, 0.0), 1.0)


@numba.njit(error_model="numpy")
def _before(px, py, qx, qy, wall, near, count, sight):  # type: ignore[no-untyped-def]
    """Return the share of a ghost at q, behind the side ``wall``, that lies before the thin walls that continue there.

    Its length along the wall is cut, or extended, to where these walls are.
    """
    ax, ay, bx, by = sight.ends[wall]
    wall_length = math.hypot(bx - ax, by - ay)
    least = 1e-6 * sight.spacing
    changed = 0.0
    for k in range(count):
        side = near[k]
        if not _continues(side, wall, sight):
            continue
        cx, cy, ex, ey = sight.ends[side]
        length = math.hypot(ex - cx, ey - cy)
        before = _area(cx, cy, ex, ey, qx, qy) / (length * sight.spacing)
        front = _area(cx, cy, ex, ey, px, py) / (length * sight.spacing)
        if front <= 0.0 or before > 1.0 - 1e-3:
            continue
        share = before / (before - front) if before < -1e-3 else 0.0  # where the line to p crosses the wall
        x, y = qx + share * (px - qx), qy + share * (py - qy)
        along = ((x - cx) * (ex - cx) + (y - cy) * (ey - cy)) / length
        if along < -least or along > length + least or _area(ax, ay, bx, by, x, y) > least * wall_length:
            continue
        change = _closed(side, wall, sight) * (before - 0.5 if before > -1e-3 else -1.0)
        if abs(change) > abs(changed):
            changed = change
    return 1.0 + changed


@numba.njit(error_model="numpy")
def _behind(px, py, qx, qy, wall, entered, g, near, count, sight):  # type: ignore[no-untyped-def]
    """Return the share of ghost ``g`` of a thin wall, at q, that is seen through the side ``wall`` of another wall."""
    first = math.inf
    closed = 0.0
    for k in range(count):
        side = near[k]
        if _continues(side, wall, sight):
            share, place = _crossed(px, py, qx, qy, side, sight)
            if share > 0.0 and entered - 1e-9 < place < first:
                first = place
                closed = _closed(side, wall, sight) if sight.chart[side] == sight.ghost_chart[g] else 0.0
    return closed


@numba.njit(error_model="numpy")
def share_of_ghost(px, py, qx, qy, g, near, count, sight):  # type: ignore[no-untyped-def]
    """Return the share in which a particle at p sees ghost ``g`` at q: what the sides of its chart stop of the line.

    Sides stop the line in their order. ``near`` is a list of ``count`` sides.
    """
    seen = 0.0
    left = 1.0
    last = -1.0
    while left > 0.0:
        first = math.inf
        share = 0.0
        side = -1
        for k in range(count):
            stopped, place = _stopped(px, py, qx, qy, near[k], near, count, sight)
            if stopped > 0.0 and last < place < first:
                first = place
                share = stopped
                side = near[k]
        if first == math.inf:
            break
        seen_there = 1.0 if sight.chart[side] == sight.ghost_chart[g] else 0.0
        if not sight.thin[side]:
            if seen_there > 0.0:
                seen_there = _before(px, py, qx, qy, side, near, count, sight)
            else:
                seen_there = _behind(px, py, qx, qy, side, first, g, near, count, sight)
        seen += seen_there * min(share, left)
        left -= share
        last = first
    return 1.0 if left == 1.0 and not sight.ghost_thin[g] else seen


@numba.njit(error_model="numpy")
def _sides_near(x0, x1, y0, y1, radius, sight, near):  # type: ignore[no-untyped-def]
    """List the sides that may hide what is within ``radius`` of a box; -1 if no thin one is within twice that distance.

    Returns their number. An end hides what lies within half a spacing of it, too.
    """
    reach = radius + sight.spacing
    count = 0
    any_thin = False
    for k in range(sight.ends.shape[0]):
        end = sight.ends[k]
        gap_x = max(min(end[0], end[2]) - x1, x0 - max(end[0], end[2]))
        gap_y = max(min(end[1], end[3]) - y1, y0 - max(end[1], end[3]))
        gap = max(gap_x, gap_y)
        if gap < 2.0 * radius:
            any_thin = any_thin or sight.thin[k]
            if gap < reach:
                near[count] = k
                count += 1
    return count if any_thin else -1


@threaded
def share_lists(rows, n, radius, lists, counts, ghost_counts, shares, sight):  # type: ignore[no-untyped-def]
    """Write in which ``shares`` (clusters, capacity, LANES) the particles of clusters see the entries of their lists.

    Entries that none of them sees are taken out of the lists.
    """
    for c in numba.prange(counts.shape[0]):
        first = c * LANES
        last = min(first + LANES, n)
        x0 = x1 = rows[first, 0]
        y0 = y1 = rows[first, 1]
        for i in range(first + 1, last):
            x0 = min(x0, rows[i, 0])
            x1 = max(x1, rows[i, 0])
            y0 = min(y0, rows[i, 1])
            y1 = max(y1, rows[i, 1])
        near = np.empty(sight.ends.shape[0], np.int64)
        count = _sides_near(x0, x1, y0, y1, radius, sight, near)
        fluid = counts[c]
        both = fluid + ghost_counts[c]
        if count < 0:
            for k in range(both):
                for a in range(LANES):
                    shares[c, k, a] = WHOLE
            continue
        kept = 0
        fluid_kept = 0
        for k in range(both):
            j = lists[c, k]
            any_seen = False
            for i in range(first, last):
                if k < fluid:
                    share = share_of_fluid(rows[i, 0], rows[i, 1], rows[j, 0], rows[j, 1], near, count, sight)
                else:
                    share = share_of_ghost(rows[i, 0], rows[i, 1], rows[j, 0], rows[j, 1], j - n, near, count, sight)
                shares[c, kept, i - first] = int(WHOLE * share + 0.5)
                any_seen = any_seen or shares[c, kept, i - first] > 0
            lists[c, kept] = j
            if any_seen:
                kept += 1
                fluid_kept += 1 if k < fluid else 0
        counts[c] = fluid_kept
        ghost_counts[c] = kept - fluid_kept


@threaded
def share_points(points, rows, numbers, n, radius, lists, counts, shares, sight):  # type: ignore[no-untyped-def]
    """Write in which ``shares`` (k, capacity) ``points`` (k, 2) see the entries of their lists of fluid and ghosts.

    ``numbers`` (rows,): those of the rows; from ``n`` on they are ghosts.
    """
    for p in numba.prange(points.shape[0]):
        x, y = points[p, 0], points[p, 1]
        near = np.empty(sight.ends.shape[0], np.int64)
        count = _sides_near(x, x, y, y, radius, sight, near)
        for k in range(counts[p]):
            j = lists[p, k]
            shares[p, k] = 1.0
            if count >= 0 and numbers[j] < n:
                shares[p, k] = share_of_fluid(x, y, rows[j, 0], rows[j, 1], near, count, sight)
            elif count >= 0:
                shares[p, k] = share_of_ghost(x, y, rows[j, 0], rows[j, 1], numbers[j] - n, near, count, sight)


@threaded
def keep_seen(points, rows, radius, lists, counts, ghosts, sight):  # type: ignore[no-untyped-def]
    """Take the particles out of the ``lists`` of ``points`` (k, 2) of which half or more is hidden from them.

    Points where ``ghosts`` (k,) are, behind their walls, see the particles that see them; other points have none.
    """
    for p in numba.prange(points.shape[0]):
        x, y = points[p, 0], points[p, 1]
        near = np.empty(sight.ends.shape[0], np.int64)
        count = _sides_near(x, x, y, y, radius, sight, near)
        kept = 0
        for k in range(counts[p]):
            j = lists[p, k]
            lists[p, kept] = j
            if count < 0:
                share = 1.0
            elif ghosts.shape[0] > 0:
                share = share_of_ghost(rows[j, 0], rows[j, 1], x, y, ghosts[p], near, count, sight)
            else:
                share = share_of_fluid(x, y, rows[j, 0], rows[j, 1], near, count, sight)
            kept += 1 if share > 0.5 else 0
        counts[p] = kept
