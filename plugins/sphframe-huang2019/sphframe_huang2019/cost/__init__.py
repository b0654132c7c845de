"""The cost of the methods: Table 1 and the speed-ups of Figs. 4, 9 and 12 of the paper."""

from sphframe_huang2019.cost.section import SECTION

__all__ = ["SECTION"]
