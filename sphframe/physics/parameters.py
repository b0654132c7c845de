"""Physics: the constants that the loops need, in one tuple that compiled functions can read."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from sphframe.interfaces import CompiledKernel
from sphframe.interfaces.body_force import gravity_vector


class LoopParameters(NamedTuple):
    """Constants of a run in the form in which the loops use them; d is the number of dimensions.

    Attributes
    ----------
    smoothing_length
        h, m.
    support
        cut-off radius R, m.
    kernel_scale
        sigma_d / h^d, m^-d.
    gradient_scale
        sigma_d / h^(d+2), m^-(d+2).
    reference_density
        rho0, kg/m^3.
    sound_speed
        c0, m/s.
    gravity
        magnitude g of gravity, m/s^2; ``force_x``, ``force_y``, ``force_z``: the force per mass at the origin,
        m/s^2, gravity included; the nine others: its gradient, 1/s^2, see :mod:`sphframe.physics.body_force`.
    diffusion
        delta h c0, m^2/s, factor of the density diffusion.
    viscosity
        Pa s, factor of pi_ij: alpha h c0 rho0, and 2 (d + 2) rho0 nu of the form of Monaghan and Gingold.
    friction
        2 rho0 nu of the form of Morris, Pa s.
    spacing
        particle spacing dx, m.
    depth
        greatest depth of still water, m.
    lowest_pressure, fading_pressure
        of wall particles, Pa: p_0, -inf where tension is free, and p_1, 0 without fading (`boundary/ghosts.py`).
    period_x, period_y, period_z
        length of each direction that repeats itself, m, else 0; ``per_period_x``,
        ``per_period_y``, ``per_period_z``: their inverses, else 0. Parallel loops take no tuples within tuples.
    """

    smoothing_length: float
    support: float
    kernel_scale: float
    gradient_scale: float
    reference_density: float
    sound_speed: float
    gravity: float
    diffusion: float
    viscosity: float
    friction: float
    spacing: float
    depth: float
    lowest_pressure: float = 0.0
    fading_pressure: float = 0.0
    period_x: float = 0.0
    period_y: float = 0.0
    period_z: float = 0.0
    per_period_x: float = 0.0
    per_period_y: float = 0.0
    per_period_z: float = 0.0
    force_x: float = 0.0
    force_y: float = 0.0
    force_z: float = 0.0
    force_xx: float = 0.0
    force_xy: float = 0.0
    force_xz: float = 0.0
    force_yx: float = 0.0
    force_yy: float = 0.0
    force_yz: float = 0.0
    force_zx: float = 0.0
    force_zy: float = 0.0
    force_zz: float = 0.0

    @classmethod
    def of(
        cls,
        kernel: CompiledKernel,
        dim: int,
        *,
        smoothing_length: float,
        reference_density: float,
        sound_speed: float,
        gravity: float | Sequence[float] = 0.0,
        density_diffusion: float = 0.0,
        artificial_viscosity: float = 0.0,
        kinematic_viscosity: float = 0.0,
        morris: bool = True,
        spacing: float = 0.0,
        depth: float = 0.0,
        period: Sequence[float] = (),
    ) -> "LoopParameters":
        """Return the constants for the dimensionless ``density_diffusion`` delta and ``artificial_viscosity`` alpha.

        ``kinematic_viscosity`` nu, m^2/s, has the form of Morris, or else of Monaghan and Gingold.
        """
        vector = gravity_vector(gravity, dim)
        length = [*map(float, period), 0.0, 0.0, 0.0]
        laminar = reference_density * kinematic_viscosity
        return cls(
            smoothing_length=float(smoothing_length),
            support=float(kernel.support * smoothing_length),
            kernel_scale=float(kernel.normalisation / smoothing_length**dim),
            gradient_scale=float(kernel.normalisation / smoothing_length ** (dim + 2)),
            reference_density=float(reference_density),
            sound_speed=float(sound_speed),
            gravity=math.hypot(*vector),
            diffusion=float(density_diffusion * smoothing_length * sound_speed),
            viscosity=float(artificial_viscosity * smoothing_length * sound_speed * reference_density)
            + (0.0 if morris else 2.0 * (dim + 2.0) * laminar),
            friction=2.0 * laminar if morris else 0.0,
            spacing=float(spacing),
            depth=float(depth),
            **{f"period_{axis}": x for axis, x in zip("xyz", length, strict=False)},
            **{f"per_period_{axis}": 1.0 / x if x > 0.0 else 0.0 for axis, x in zip("xyz", length, strict=False)},
            **dict(zip(("force_x", "force_y", "force_z"), vector.tolist(), strict=False)),
        )
