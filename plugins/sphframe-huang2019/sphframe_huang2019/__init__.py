"""Huang et al. (2019), Water 11, 1110, as a study of sphframe."""

from sphframe_huang2019.study import Huang2019

__all__ = ["Huang2019"]
