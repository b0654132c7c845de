"""Testing: hypothesis strategies."""

from collections.abc import Sequence

from hypothesis import strategies as st

from sphframe.testing.neighbourhoods import ALL, Cloud, build


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
