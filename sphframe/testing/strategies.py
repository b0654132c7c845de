"""Testing: hypothesis strategies for tests of one's own components."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from hypothesis import strategies as st

from sphframe.arrays import Array
from sphframe.interfaces import Kernel
from sphframe.testing.neighbourhoods import ALL, FLAT, Cloud, build, flattened

if TYPE_CHECKING:
    from sphframe.testing.integrators import Oscillator


@st.composite
def clouds(
    draw: st.DrawFn, dim: int, families: Sequence[str] = ALL, *, lifted: bool = False, largest: float | None = None
) -> Cloud:
    """Draw the neighbourhood of one evaluation point, of one to about three hundred particles.

    Parameters
    ----------
    dim
        2 or 3.
    families
        which of :data:`sphframe.testing.FAMILIES` to draw from.
    lifted
        whether the ghost lies away from the evaluation point, as for a method that extrapolates.
    largest
        the largest ratio of a third of the cut-off radius to the particle spacing, above 1; by default 3 in two
        dimensions and 1.4 in three.

    Notes
    -----
    The particle spacing lies between a micrometre and a kilometre.
    """
    family = draw(st.sampled_from(tuple(families)))
    seed = draw(st.integers(0, 2**32 - 1))
    most = largest or (3.0 if dim == 2 else 1.4)
    ratio = draw(st.sampled_from((1.0, 1.2, 1.3, 0.5 * (1.3 + most), most)))
    exponent = draw(st.integers(-6, 3))
    return build(family, dim, seed, spacing=10.0**exponent, ratio=ratio, lifted=lifted)


@st.composite
def flattened_clouds(draw: st.DrawFn, dim: int, *, degree: int = 1, lifted: bool = False) -> Cloud:
    """Draw a neighbourhood that nearly or exactly fails to determine a polynomial of ``degree`` 1 or 2.

    Its particles lie within 1e-2 to 1e-15 of its length from a line or plane, or of a circle or sphere for degree 2, or
    exactly there, in any direction. ``dim`` and ``lifted`` are those of :func:`clouds`.
    """
    shape = draw(st.sampled_from([*FLAT[: degree + 1], *(["line"] if dim == 3 else [])]))
    exponent = draw(st.integers(2, 16))
    thickness = 0.0 if exponent == 16 else 10.0**-exponent
    seed, turn = draw(st.integers(0, 2**32 - 1)), draw(st.integers(0, 2**32 - 1))
    spacing = 10.0 ** draw(st.integers(-6, 3))
    return flattened(shape, dim, seed, thickness, turn=turn, lifted=lifted, spacing=spacing)


def kernel_arguments(kernel: Kernel) -> st.SearchStrategy[float]:
    """Draw q = r/h from 0 to just below the support of ``kernel``, often near both ends."""
    support = kernel.support
    inside = np.nextafter(support, 0.0)
    return st.one_of(
        st.floats(0.0, float(inside)), st.floats(0.0, 1e-3 * support), st.floats(0.99 * support, float(inside))
    )


class State(NamedTuple):
    """Arguments of the functions of an equation of state: rho and rho0, kg/m^3, and c0, m/s."""

    density: float
    reference_density: float
    sound_speed: float


@st.composite
def states(draw: st.DrawFn, lowest: float = 0.7, highest: float = 1.5) -> State:
    """Draw densities between ``lowest`` and ``highest`` times rho0, of gases and liquids, often within 1 % of rho0."""
    rho0, c0 = draw(st.floats(0.1, 20000.0)), draw(st.floats(1.0, 5000.0))
    ratio = draw(st.one_of(st.just(1.0), st.floats(0.99, 1.01), st.floats(lowest, highest)))
    return State(ratio * rho0, rho0, c0)


def oscillators() -> "st.SearchStrategy[Oscillator]":
    """Draw oscillators at their start, with forces that depend on the time, and an exact solution."""
    from sphframe.testing.integrators import Oscillator

    return st.builds(Oscillator, forcing=st.floats(-1.0, 1.0), push=st.floats(-1.0, 1.0))


class BodyState(NamedTuple):
    """Arguments of :meth:`sphframe.RigidBody.motion`: time, s, position and velocity (3,), and load (3,) or (6,)."""

    time: float
    position: Array
    velocity: Array
    load: Array


@st.composite
def body_states(draw: st.DrawFn, dim: int = 2, latest: float = 60.0, reach: float = 1.0) -> BodyState:
    """Draw times up to ``latest``, coordinates up to ``reach``, velocities up to 10 ``reach``/s, and any load."""

    def vector(size: int, largest: float) -> Array:
        return np.array(draw(st.lists(st.floats(-largest, largest), min_size=size, max_size=size)))

    number = 3 if dim == 2 else 6
    load = vector(number, 1.0) * 10.0 ** draw(st.integers(-3, 7))
    return BodyState(draw(st.floats(0.0, latest)), vector(number, reach), vector(number, 10.0 * reach), load)


@st.composite
def basins(draw: st.DrawFn, dim: int = 2) -> dict[str, Any]:
    """Draw parameters of :class:`sphframe.cases.custom.Custom`: a basin of water of 6 to 14 spacings a side.

    Spacing, kernel, smoothing length, gravity, slip, fluid and sound speed differ; a
    ``wall_treatment`` is to be added. ``Simulation(Custom(**basin))`` makes its first evaluation at once.
    """
    spacing = 10.0 ** draw(st.integers(-3, 1))
    size = [draw(st.integers(6, 14 if dim == 2 else 7)) * spacing for _ in range(dim)]
    box = {"shape": "box", "lower": (0.0,) * dim, "upper": tuple(size)}
    gravity = draw(st.floats(0.0, 20.0))
    rho0 = draw(st.sampled_from((1.2, 870.0, 1000.0)))
    return {
        "dimension": dim,
        "particle_spacing": spacing,
        "kernel": draw(st.sampled_from(("gaussian", "wendland-c2"))),
        "smoothing_length_ratio": draw(st.sampled_from((1.2, 1.3, 1.5))),
        "gravity": gravity,
        "reference_density": rho0,
        "sound_speed": 10.0 * max(1.0, (gravity * max(size)) ** 0.5),
        "slip": draw(st.sampled_from(("free", "no"))),
        "kinematic_viscosity": draw(st.sampled_from((0.0, 1e-3))),
        "walls": [{**box, "open_faces": ["+y" if dim == 2 else "+z"]}],
        "fluid": [box],
        "until": 1.0,
        "frame_interval": 1.0,
        "probe_interval": 1.0,
    }
