"""Still water above a wedge on the bed."""

from collections.abc import Mapping
from typing import Any, ClassVar, final

from sphframe import Array, Case
from sphframe.cases import Benchmark, quantity, with_default
from sphframe_flows.solutions import variable
from sphframe_flows.still_water import Obstacle


@final
class HydrostaticWedge(Obstacle):
    """Still water above a wedge that stands on the bed of a tank: straight walls across the lattice, and sharp corners.

    Parts of the wall ``tank``: ``wedge``, on which the water presses down by rho g b (2 d - a) per metre of width, with
    the half base b and the height a, and its ``left`` face, with the horizontal force rho g (d^2 - (d - a)^2) / 2.

    Source: A. English et al. (2022), doi:10.1007/s40571-021-00403-3.
    """

    title: ClassVar[str] = "still water above a wedge"
    part: ClassVar[str] = "wedge"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "hydrostatic-wedge": Benchmark(
            "pressure",
            "Pressure at slopes across the lattice, and at sharp corners.",
            (0.04, 0.02),
            {"tank_length": 1.2, "until": 1.0, "guards": {"filling": "report"}},
        )
    }

    tank_length: float = quantity(2.4, "m", "length of the tank", gt=0)
    wedge_height: float = quantity(0.24, "m", "height a of the wedge's apex", gt=0)
    half_base: float = quantity(0.27733, "m", "half b of the wedge's base", gt=0)
    frame_interval: float = with_default(Case, "frame_interval", 0.1)

    @property
    def sizes(self) -> tuple[float, float, float]:
        """Half base and height, m, and area, m^2."""
        return self.half_base, self.wedge_height, self.half_base * self.wedge_height

    def outline(self) -> list[tuple[float, float]]:
        """Return the apex."""
        return [(0.0, self.wedge_height)]

    def _place(self, position: Array) -> tuple[str, tuple[str, Any, dict[str, str]]]:
        """Return the heights of the particles."""
        return "y", variable("y", position[:, 1], "m", "height")
