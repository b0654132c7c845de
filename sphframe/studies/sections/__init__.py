"""Studies: the sections of the paper, each a set of runs and the chapter that they make."""

from sphframe.studies.sections import cost, dam_break, fixed_wall, hydrostatic_tank, movable_wall
from sphframe.studies.sections.section import Section

__all__ = ["SECTIONS", "Section"]

SECTIONS = {
    module.SECTION.name: module.SECTION for module in (hydrostatic_tank, dam_break, fixed_wall, movable_wall, cost)
}
"""by name, in the order of the paper"""
