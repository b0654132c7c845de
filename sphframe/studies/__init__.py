"""Studies: the studies of many runs, as independent tasks on a cluster, and the report of what they show."""

from sphframe.studies.comparison import Comparison, compare
from sphframe.studies.engine import Progress
from sphframe.studies.reproduce import reproduce
from sphframe.studies.sections import SECTIONS, Section

__all__ = ["SECTIONS", "Comparison", "Progress", "Section", "compare", "reproduce"]
