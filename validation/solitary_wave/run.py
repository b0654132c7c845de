"""Solitary waves on walls: ``python -m validation.solitary_wave.run --output FOLDER --reference FOLDER``."""

from collections.abc import Sequence

from sphframe import studies
from validation.command import carry_out
from validation.solitary_wave import leaning_wall, movable_wall, vertical_wall


class SolitaryWaves(studies.Study):
    """Solitary waves on a vertical, a leaning and a movable wall."""

    title = "Validation: solitary waves on fixed and movable seawalls"
    source = (
        "Cases of sections 4.3 and 4.4 of Huang et al., Water 11 (2019) 1110, doi:10.3390/w11051110; the vertical wall"
        " is compared with exact solitary waves of potential flow (Clamond and Dutykh 2013,"
        " doi:10.1016/j.compfluid.2013.05.010)."
    )

    def sections(self) -> Sequence[studies.Section]:
        """Return the sections of the three walls."""
        return [vertical_wall.SECTION, leaning_wall.SECTION, movable_wall.SECTION]


if __name__ == "__main__":
    carry_out(SolitaryWaves())
