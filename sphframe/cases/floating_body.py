"""Cases: a box that floats."""

from typing import ClassVar, Literal

from sphframe.bodies import Free
from sphframe.cases.case import Case
from sphframe.cases.parameters import Derived, downward_gravity, quantity, with_default
from sphframe.cases.scene import Gauge, Scene
from sphframe.geometry import PolygonRegion, PolygonWall


class FloatingBody(Case):
    """A rectangular box floats in the middle of a tank, free to move and to rotate, in two dimensions.

    By Archimedes it floats with the draught T = (its density over the water's) times its height. Released at another
    draught it heaves about this equilibrium. Gauges ``left`` and ``right`` stand half-way between box and walls; the
    box is the body ``box``, ``body_position`` its displacement from where it was drawn.
    """

    title: ClassVar[str] = "box afloat in a tank"

    dimension: Literal[2] = quantity(2, "1", "dimension of space; free bodies are two-dimensional")
    gravity: float = downward_gravity()
    depth: float = quantity(0.4, "m", "depth of the water when the box is at its initial draught", gt=0)
    tank_length: float = quantity(1.2, "m", "length of the tank", gt=0)
    tank_height: float = quantity(Derived("1.5 depth", lambda case: 1.5 * case.depth), "m", "height of the walls", gt=0)
    box_length: float = quantity(0.4, "m", "length of the box", gt=0)
    box_height: float = quantity(0.2, "m", "height of the box", gt=0)
    density_ratio: float = quantity(0.5, "1", "density of the box over that of the water", gt=0, lt=1)
    initial_draught: float = quantity(
        Derived("density_ratio box_height", lambda case: case.density_ratio * case.box_height),
        "m",
        "draught at the start",
        gt=0,
    )
    particle_spacing: float = with_default(Case, "particle_spacing", 0.01)
    until: float = with_default(Case, "until", 4.0)
    frame_interval: float = with_default(Case, "frame_interval", 0.05)
    probe_interval: float = with_default(Case, "probe_interval", 0.005)

    def box_mass(self) -> float:
        """Return the mass of the box, kg per metre of width."""
        return self.density_ratio * self.reference_density * self.box_length * self.box_height

    def scene(self) -> Scene:
        """Draw tank, box and water around the box."""
        length, depth = self.tank_length, self.depth
        left, right = 0.5 * (length - self.box_length), 0.5 * (length + self.box_length)
        bottom = depth - self.initial_draught
        top = bottom + self.box_height
        mass = self.box_mass()
        box = Free(
            mass=mass,
            inertia=mass * (self.box_length**2 + self.box_height**2) / 12.0,
            centre=(0.5 * length, 0.5 * (bottom + top)),
            gravity=self.gravity,
        )
        tank = ((0.0, self.tank_height), (0.0, 0.0), (length, 0.0), (length, self.tank_height))
        hull = ((left, bottom), (left, top), (right, top), (right, bottom))
        water = (
            (0.0, 0.0), (length, 0.0), (length, depth), (right, depth), (right, bottom), (left, bottom), (left, depth),
            (0.0, depth),
        )  # fmt: skip
        return Scene(
            walls=(
                PolygonWall(name="tank", points=tank),
                PolygonWall(name="box", points=hull, closed=True, body="box"),
            ),
            fluid=(PolygonRegion(points=water),),
            depth=depth,
            domain=(
                (-self.particle_spacing, -self.particle_spacing),
                (length + self.particle_spacing, 2.0 * self.tank_height),
            ),
            gauges=(Gauge(name="left", position=(0.5 * left,)), Gauge(name="right", position=(length - 0.5 * left,))),
            bodies={"box": box},
        )
