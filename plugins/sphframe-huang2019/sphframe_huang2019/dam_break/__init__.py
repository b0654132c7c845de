"""The dam break, section 4.2 of the paper, Figs. 5 to 8."""

from sphframe_huang2019.dam_break.section import SECTION

__all__ = ["SECTION"]
