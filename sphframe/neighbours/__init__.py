"""Neighbours: who sees whom."""

from sphframe.neighbours.lists import NeighbourLists

__all__ = ["NeighbourLists"]
