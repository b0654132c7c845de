"""Studies: sets of runs as independent tasks on a cluster, and reports of what they show."""

from sphframe.analysis.drawing import draw_particles, draw_walls
from sphframe.analysis.figures import new_figure
from sphframe.studies.chapter import Cell, Chapter, Claim, Picture, Table, Verdict
from sphframe.studies.comparison import Comparison, compare
from sphframe.studies.drawing import colour, picture, thinned, tidy
from sphframe.studies.engine import Progress
from sphframe.studies.league import League, rank
from sphframe.studies.measurement import CostTask
from sphframe.studies.reproduce import reproduce
from sphframe.studies.section import Section, run_task
from sphframe.studies.series import Reference, ended, fallback_share
from sphframe.studies.study import Study, installed_study
from sphframe.studies.tasks import RunTask, Task, wall_boundary

__all__ = [
    "Cell",
    "Chapter",
    "Claim",
    "Comparison",
    "CostTask",
    "League",
    "Picture",
    "Progress",
    "Reference",
    "RunTask",
    "Section",
    "Study",
    "Table",
    "Task",
    "Verdict",
    "colour",
    "compare",
    "draw_particles",
    "draw_walls",
    "ended",
    "fallback_share",
    "installed_study",
    "new_figure",
    "picture",
    "rank",
    "reproduce",
    "run_task",
    "thinned",
    "tidy",
    "wall_boundary",
]
