"""Reproduction: the studies of many runs, as independent tasks on a cluster, and the report of what they show."""

from sphframe.reproduction.comparison import Comparison, compare
from sphframe.reproduction.engine import Progress
from sphframe.reproduction.reproduce import reproduce
from sphframe.reproduction.sections import SECTIONS, Section

__all__ = ["SECTIONS", "Comparison", "Progress", "Section", "compare", "reproduce"]
