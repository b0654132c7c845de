"""Geometry: triangle meshes from files, repaired where there is only one way to do it."""

import hashlib
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from sphframe.input_files import content_of


def digest(path: Path) -> str:
    """Return the SHA-256 of a file.

    Raises
    ------
    ValueError
        when it cannot be read.
    """
    try:
        return hashlib.sha256(content_of(path)).hexdigest()
    except OSError as error:
        raise ValueError(f"cannot read the mesh {path}: {(error.strerror or str(error)).lower()}") from None


@lru_cache(maxsize=8)
def closed_mesh(path: Path, sha256: str) -> Any:
    """Return the mesh in ``path``, whose hash is ``sha256``, closed, without degenerate triangles, normals outwards.

    Raises
    ------
    ValueError
        when the file holds no mesh, or a mesh that has holes or edges that three or more triangles share.
    """
    import trimesh  # takes a second to import

    try:
        mesh = trimesh.load_mesh(path, process=False)
        mesh.merge_vertices(merge_tex=True, merge_norm=True)
    except Exception as error:  # readers of formats raise errors of many kinds
        raise ValueError(f"{path} is not a mesh that can be read (STL, OBJ or PLY): {error}") from None
    triangles = np.flatnonzero(mesh.nondegenerate_faces() & mesh.unique_faces())
    mesh.update_faces(triangles)
    mesh.remove_unreferenced_vertices()
    if mesh.is_empty:
        raise ValueError(f"{path} holds no triangle with an area; export the surface of a solid")
    edges, shared = np.unique(mesh.edges_sorted, axis=0, return_inverse=True)
    counts = np.bincount(shared.ravel(), minlength=len(edges))
    wrong = np.unique(triangles[mesh.edges_face[counts[shared.ravel()] != 2]])
    if len(wrong):
        place = np.array2string(
            mesh.vertices[mesh.edges_sorted[counts[shared.ravel()] != 2][0]].mean(axis=0), precision=6
        )
        named = ", ".join(map(str, wrong[:10])) + (", ..." if len(wrong) > 10 else "")
        raise ValueError(
            f"{path} is not closed: {len(wrong)} of its triangles (counted from 0: {named}; the first edge at {place})"
            " have an edge that is not shared by exactly two; fill the holes and take out inner walls"
        )
    trimesh.repair.fix_normals(mesh, multibody=True)  # type: ignore[no-untyped-call]
    if not (mesh.is_winding_consistent and mesh.volume > 0.0):
        raise ValueError(
            f"{path}: its triangles cannot be turned so that all face outwards; it is no surface of a solid"
        )
    return mesh
