"""Physics: one term of the equations per file."""

from sphframe.physics.body_force import uniform_and_linear, with_body_force
from sphframe.physics.parameters import LoopParameters
from sphframe.physics.pressure import invert_pressure, update_pressure
from sphframe.physics.rates import fluid_sums
from sphframe.physics.sampling import sample_points
from sphframe.physics.surface_sums import surface_reaction, surface_sums
from sphframe.physics.wall_force import wall_reaction
from sphframe.physics.wall_pair import make_seen, make_surface
from sphframe.physics.wall_sums import wall_sums
