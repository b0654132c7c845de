"""Geometry: the part of space that the fluid can reach, as bounded by walls of three dimensions.

Each wall is the surface of a solid. One that holds fluid at the start is a container; one outside of which all fluid is
is an obstacle. With the solids S_k of the walls, the fluid reaches the intersection of its containers without its
obstacles, as far as this is connected with fluid::

    domain = union over fluids of [intersection of containers S_k, without the union of obstacles S_k]

The set operations are those of the library manifold3d; libigl finds nearest points and what is inside.
"""

import atexit
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.errors import InputError
from sphframe.geometry.domain import OPEN
from sphframe.geometry.fill import fill
from sphframe.geometry.wall_solids import WallSolid, box_solid
from sphframe.geometry.walls import Wall

_ACROSS = 0.25
"""distance over the spacing by which a particle may lie on the wrong side of a wall, as chords replace curves"""


class Feet(NamedTuple):
    """Nearest points (n, 3) of a boundary, m; their distances (n,), positive outside the domain; triangles (n,)."""

    point: Array
    depth: Array
    triangle: IntArray


@dataclass(frozen=True)
class SolidDomain:
    """The space that the fluid can reach, continued far beyond open faces of walls.

    Attributes
    ----------
    surface
        its boundary, a closed ``trimesh.Trimesh`` whose triangles face out of the fluid.
    wall
        (t,) index of the wall of each triangle, ``OPEN`` where there is none.
    solid
        the rest of space, up to a distance, as a mesh.
    """

    surface: Any
    wall: IntArray
    solid: Any

    @cached_property
    def _arrays(self) -> tuple[Array, IntArray]:
        return np.array(self.surface.vertices, order="C"), np.array(self.surface.faces, np.int64, order="C")

    def contains(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 3), m, lies in the domain."""
        return _within(*self._arrays, points)

    def feet(self, points: Array) -> Feet:
        """Return the points of the boundary nearest to ``points`` (n, 3), m."""
        import igl

        if not len(points):
            return Feet(np.empty((0, 3)), np.empty(0), np.empty(0, np.int64))
        vertices, triangles = self._arrays
        squares, triangle, foot = igl.point_mesh_squared_distance(np.ascontiguousarray(points), vertices, triangles)
        distance = np.sqrt(squares)
        return Feet(foot, np.where(self.contains(points), -distance, distance), triangle)

    def chosen_feet(self, points: Array, lean: float) -> Feet:
        """Return nearest points of the boundary as :meth:`feet` does; of several, those in an oblique direction.

        This choice is made by points that are moved by ``lean`` (m), so that it does not depend on round-off. A chosen
        point is at most twice this distance further than the nearest one.
        """
        from trimesh.triangles import closest_point

        triangle = self.feet(points + lean * np.array([0.8, 0.5, 0.3])).triangle
        foot: Array = closest_point(self.surface.triangles[triangle], points)  # type: ignore[no-untyped-call]
        distance = np.linalg.norm(points - foot, axis=1)
        return Feet(foot, np.where(self.contains(points), -distance, distance), triangle)

    @cached_property
    def _tree(self) -> Any:
        import igl

        tree = igl.AABB()
        tree.init(*self._arrays)
        atexit.register(_forget_tree, weakref.ref(self))
        return tree

    @cached_property
    def _normals(self) -> Array:
        """Normals (t, 7, 3) of each triangle: of its face, its edges opposite to the corners, and of its corners.

        Those of edges and corners are sums over the triangles there, weighted by their angles: they tell on which side
        a point lies (J. A. Baerentzen and H. Aanaes (2005), doi:10.1109/TVCG.2005.49).
        """
        surface, faces = self.surface, self._arrays[1]
        edges = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
        _, number = np.unique(edges, axis=0, return_inverse=True)
        along_edges = np.zeros((number.max() + 1, 3))
        np.add.at(along_edges, number.ravel(), np.repeat(surface.face_normals, 3, axis=0))
        at_edges = along_edges[number.reshape(-1, 3)]
        return np.concatenate([surface.face_normals[:, None], at_edges, surface.vertex_normals[faces]], axis=1)

    def feet_behind(self, points: Array) -> tuple[BoolArray, Array]:
        """Return which of ``points`` (n, 3), m, lie behind a wall, and the nearest points (n, 3) of the boundary.

        It is faster than :meth:`feet`, much so for few points, and has no error of single precision.
        """
        vertices, faces = self._arrays
        squares, triangle, foot = self._tree.squared_distance(vertices, faces, np.ascontiguousarray(points))
        corner = vertices[faces[triangle]]
        across = np.cross(corner[:, [1, 2, 0]] - foot[:, None], corner[:, [2, 0, 1]] - foot[:, None])
        on = np.linalg.norm(across, axis=2)
        on = on < 1e-9 * on.sum(axis=1)[:, None]  # on the edge opposite to a corner
        place = np.where(
            on.sum(axis=1) == 2, 4 + np.argmin(on, axis=1), np.where(on.any(axis=1), 1 + on.argmax(axis=1), 0)
        )
        normal = self._normals[triangle, place]
        behind = np.einsum("ij,ij->i", points - foot, normal) > 0.0
        return behind & (self.wall[triangle] != OPEN) & (squares > 0.0), foot

    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 3), m, lies behind a wall: outside, and a wall is the nearest."""
        behind, foot = self.feet_behind(points)
        on_wall = 1e-9 * (1.0 + np.abs(points).max(initial=0.0))
        behind[behind] = np.linalg.norm(points[behind] - foot[behind], axis=1) > on_wall
        return behind


def _forget_tree(domain: weakref.ReferenceType[SolidDomain]) -> None:
    """Let the tree of a ``domain`` go before the interpreter ends, since libigl reports what is left then as a leak."""
    if (remaining := domain()) is not None:
        remaining.__dict__.pop("_tree", None)


class _Body(NamedTuple):
    """The solid of a wall as a manifold, the name of the wall, and which fluids (by index) it holds."""

    solid: Any
    name: str
    holds: BoolArray


def solid_domain(walls: Mapping[int, Wall], fluid: Sequence[Any], spacing: float) -> SolidDomain:
    """Return the domain within ``walls`` (by their indices) that the ``fluid`` can reach.

    Parameters
    ----------
    walls
        of three dimensions.
    fluid
        regions of fluid at the start.
    spacing
        of the particles, m. Curved walls are followed to a fiftieth of it.

    Raises
    ------
    InputError
        when a wall runs through the fluid, or fluid can reach both of its sides; with its name and the place.
    """
    import manifold3d

    positions = [fill(region, spacing).position for region in fluid]
    bounds = np.array([wall.bounds() for wall in walls.values()] + [(p.min(axis=0), p.max(axis=0)) for p in positions])
    lower, upper = bounds.min(axis=(0, 1)), bounds.max(axis=(0, 1))
    far = 100.0 * spacing + float(np.max(upper - lower))
    owners: dict[int, int] = {}
    bodies = []
    for index, wall in walls.items():
        shape = wall.solid(0.02 * spacing, far)
        holds = np.array([_holds(wall.name, shape, position, spacing) for position in positions])
        if shape.open.any() and not holds.any():
            raise InputError(
                f"wall {wall.name!r} has open faces, but no fluid is in it, so that it would be wet on both sides:"
                " close it, or draw fluid in it"
            )
        first = manifold3d.Manifold.reserve_ids(2)
        owners[first] = index
        bodies.append(_Body(_manifold(shape, first), wall.name, holds))
    frame = _manifold(box_solid(lower - 2.0 * far, upper + 2.0 * far, (), 0.0))
    cells = [
        (holds, _reached(frame, bodies, holds, positions))
        for holds in np.unique([[body.holds[k] for body in bodies] for k in range(len(positions))], axis=0)
    ]
    _check_apart(cells, bodies, spacing)
    wet = manifold3d.Manifold.batch_boolean([cell for _, cell in cells], manifold3d.OpType.Add)
    around = _manifold(box_solid(lower - 3.0 * far, upper + 3.0 * far, (), 0.0))
    surface, ids = _surface(wet)
    return SolidDomain(surface, np.array([owners.get(k, OPEN) for k in ids.tolist()]), _surface(around - wet)[0])


def _holds(name: str, shape: WallSolid, position: Array, spacing: float) -> bool:
    """Return whether the solid of a wall holds the particles at ``position`` (n, 3).

    Raises
    ------
    InputError
        when it holds a part of them.
    """
    import igl

    vertices, triangles = np.ascontiguousarray(shape.vertices), np.ascontiguousarray(shape.triangles, np.int64)
    inside = _within(vertices, triangles, position)
    holds = bool(2 * np.count_nonzero(inside) > len(position))
    wrong = position[inside != holds]
    if len(wrong):
        squares = igl.point_mesh_squared_distance(wrong, vertices, triangles)[0]
        worst = int(np.argmax(squares))
        if squares[worst] > (_ACROSS * spacing) ** 2:
            raise InputError(
                f"wall {name!r} runs through the fluid: {len(wrong)} particles lie on its other side, such as"
                f" {place_of(wrong[worst])}; draw the fluid within the walls, or cut the wall out of it with shape ="
                ' "difference"'
            )
    return holds


def _within(vertices: Array, triangles: IntArray, points: Array) -> BoolArray:
    """Return whether each of ``points`` (n, 3) lies within a closed surface."""
    import igl  # takes half a second to import, and only solids need it

    return np.asarray(igl.fast_winding_number(vertices, triangles, np.ascontiguousarray(points)) > 0.5)


def _reached(frame: Any, bodies: Sequence[_Body], holds: BoolArray, positions: Sequence[Array]) -> Any:
    """Return what the fluids within the bodies that it ``holds``, and in no others, can reach."""
    import manifold3d

    cell, here = frame, np.ones(len(positions), dtype=np.bool_)
    for body, container in zip(bodies, holds, strict=True):
        cell = cell ^ body.solid if container else cell - body.solid
        here &= body.holds == container
    parts = [part for part in cell.decompose() if part.volume() > 0.0]  # the others are the surfaces of cavities
    domains = [SolidDomain(_surface(part)[0], np.empty(0, np.int64), None) for part in parts]
    wet = [
        any(domain.contains(position).any() for position, in_here in zip(positions, here, strict=True) if in_here)
        for domain in domains
    ]
    reached = manifold3d.Manifold.batch_boolean(
        [part ^ cell for part, kept in zip(parts, wet, strict=True) if kept], manifold3d.OpType.Add
    )
    for part, kept in zip(parts, wet, strict=True):
        reached = reached if kept else reached - part
    return reached


def _check_apart(cells: Sequence[tuple[BoolArray, Any]], bodies: Sequence[_Body], spacing: float) -> None:
    """Check that no wall has fluid on both of its sides."""
    import igl

    for k, (holds, piece) in enumerate(cells):
        for other_holds, other in cells[:k]:
            if piece.min_gap(other, 2e-3 * spacing) > 1e-3 * spacing:
                continue
            one, two = _surface(piece)[0], _surface(other)[0]
            squares = igl.point_mesh_squared_distance(
                np.array(one.vertices), np.array(two.vertices), np.array(two.faces, np.int64)
            )[0]
            names = [body.name for body, a, b in zip(bodies, holds, other_holds, strict=True) if a != b]
            raise InputError(
                f"wall {names[0]!r} has fluid on both sides at {place_of(one.vertices[np.argmin(squares)])}"
                ": draw what is solid between them as a wall of its own"
            )


def place_of(point: Array) -> str:
    """Return the coordinates of a ``point`` (3,) as text."""
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"


def _manifold(shape: WallSolid, first: int | None = None) -> Any:
    """Return a solid for set operations; its triangles get the number ``first``, and open ones the next."""
    import manifold3d

    order = np.argsort(shape.open, kind="stable")
    closed = int(np.count_nonzero(~shape.open))
    runs = {}
    if first is not None:
        ends = [0, 3 * closed, 3 * len(order)] if closed < len(order) else [0, 3 * closed]
        runs = {
            "run_index": np.array(ends, np.uint64),
            "run_original_id": np.arange(first, first + len(ends) - 1, dtype=np.uint32),
        }
    solid = manifold3d.Manifold(manifold3d.Mesh64(shape.vertices, shape.triangles[order].astype(np.uint64), **runs))
    if solid.status() != manifold3d.Error.NoError:
        raise InputError(f"a wall is no surface of a solid: {solid.status().name}")
    return solid


def _surface(solid: Any) -> tuple[Any, IntArray]:
    """Return the surface of a manifold as a mesh of trimesh, and the number (t,) of each triangle's origin."""
    import trimesh

    mesh = solid.to_mesh64()
    ends = np.asarray(mesh.run_index, np.int64) // 3
    ids = np.repeat(np.asarray(mesh.run_original_id, np.int64), np.diff(ends))
    # copies, since views would keep the library's object, which it reports as a leak
    vertices, triangles = np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, np.int64)
    surface = trimesh.Trimesh(vertices, triangles, process=False)
    return surface, ids
