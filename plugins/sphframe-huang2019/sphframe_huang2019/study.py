"""The study: its title, its source, and its sections in the order of the paper."""

from collections.abc import Sequence

from sphframe.studies import Section, Study
from sphframe_huang2019 import cost, dam_break, fixed_wall, hydrostatic_tank, movable_wall

__all__ = ["Huang2019"]


class Huang2019(Study):
    """The runs, figures and claims of Huang et al. (2019), doi:10.3390/w11051110."""

    title = "Huang et al. (2019), Water 11, 1110, reproduced"
    source = (
        "X. Huang, W. Chen, Z. Hu, X. Zheng, S. Jin, X. Zhang: Application Research of an Efficient and Stable Boundary"
        " Processing Method for the SPH Method. Water 11 (2019) 1110, doi:10.3390/w11051110. Every run of the paper's"
        " sections was repeated with each method that the paper compares, with its mirror lift, and with this"
        " project's own variants beside them. What the paper prints wrongly or does not give is decided in the"
        " documentation of the cases and methods."
    )

    def sections(self) -> Sequence[Section]:
        """Return the sections: still water, dam break, fixed wall, movable wall, cost."""
        return tuple(part.SECTION for part in (hydrostatic_tank, dam_break, fixed_wall, movable_wall, cost))
