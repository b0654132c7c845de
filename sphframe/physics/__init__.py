"""Physics: one term of the equations per file."""

from sphframe.physics.density_gradient import density_gradient
from sphframe.physics.pressure import update_pressure
from sphframe.physics.rates import fluid_rates
from sphframe.physics.sampling import sample_points
from sphframe.physics.wall_force import wall_reaction

__all__ = ["density_gradient", "fluid_rates", "sample_points", "update_pressure", "wall_reaction"]
