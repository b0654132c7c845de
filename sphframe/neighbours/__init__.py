"""Neighbours: who sees whom."""

from sphframe.neighbours.cells import put_in_order
from sphframe.neighbours.lists import NeighbourLists

__all__ = ["NeighbourLists", "put_in_order"]
