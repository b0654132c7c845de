"""Testing: neighbourhoods of one evaluation point, constructed instead of filtered from random ones.

Each family is a recipe for one kind of difficult neighbourhood: a wall on one side, a thin sheet, spray, points on one
line, points that coincide, points at the cut-off. Lengths are in particle spacings; a cloud can be scaled to any
spacing.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from sphframe.arrays import Array, BoolArray

Recipe = Callable[[np.random.Generator, int, float], tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class Cloud:
    """The particles around one evaluation point.

    Attributes
    ----------
    offsets
        (n, dim), m: from the evaluation point, each shorter than ``support``.
    volumes
        (n,), m^dim.
    support
        cut-off radius R, m.
    lift
        (dim,), m: from the evaluation point to the ghost, for methods that extrapolate.
    """

    offsets: Array
    volumes: Array
    support: float
    lift: Array

    def __init__(
        self,
        offsets: Sequence[Sequence[float]] | Array,
        volumes: Sequence[float] | Array,
        support: float,
        lift: Sequence[float] | Array | None = None,
    ) -> None:
        object.__setattr__(self, "offsets", np.array(offsets, dtype=np.float64, order="C"))
        object.__setattr__(self, "volumes", np.array(volumes, dtype=np.float64))
        object.__setattr__(self, "support", float(support))
        dim = self.offsets.shape[1]
        object.__setattr__(self, "lift", np.zeros(dim) if lift is None else np.array(lift, dtype=np.float64))

    @property
    def dim(self) -> int:
        """2 or 3."""
        return int(self.offsets.shape[1])

    @cached_property
    def distances(self) -> Array:
        """(n,): lengths of the offsets, m."""
        lengths: Array = np.sqrt(np.sum(self.offsets**2, axis=1))
        return lengths

    def __len__(self) -> int:
        return len(self.volumes)

    def __repr__(self) -> str:
        """The cloud as code."""
        lift = f", lift={self.lift.tolist()}" if np.any(self.lift) else ""
        return f"Cloud({self.offsets.tolist()}, volumes={self.volumes.tolist()}, support={self.support!r}{lift})"

    def changed(self, offsets: Array | None = None, volumes: Array | None = None, lift: Array | None = None) -> "Cloud":
        """Return a copy with some parts replaced."""
        return Cloud(
            self.offsets if offsets is None else offsets,
            self.volumes if volumes is None else volumes,
            self.support,
            self.lift if lift is None else lift,
        )

    def members(self, index: NDArray[np.intp] | BoolArray) -> "Cloud":
        """Return the cloud that holds only the particles in ``index``, in that order."""
        return self.changed(self.offsets[index], self.volumes[index])

    def scaled(self, factor: float) -> "Cloud":
        """Return the cloud with all lengths multiplied by ``factor``."""
        return Cloud(
            self.offsets * factor, self.volumes * factor**self.dim, self.support * factor, self.lift * factor
        ).clear_of_cut_off(0.0)

    def clear_of_cut_off(self, margin: float) -> "Cloud":
        """Return the cloud without the particles beyond (1 - margin) R; the nearest particle is always kept."""
        r = self.distances
        keep = r < (1.0 - margin) * self.support
        if not keep.any():
            keep[np.argmin(r)] = True
        return self.members(keep)


def _ball(rng: np.random.Generator, dim: int, radius: float, jitter: float = 0.25) -> Array:
    """A jittered lattice around a random evaluation point, in a random orientation."""
    reach = int(radius) + 2
    axes = np.meshgrid(*[np.arange(-reach, reach + 1.0)] * dim, indexing="ij")
    lattice = np.stack(axes, axis=-1).reshape(-1, dim)
    points: Array = lattice + rng.uniform(-0.5, 0.5, dim) + rng.uniform(-jitter, jitter, lattice.shape)
    turned: Array = np.matmul(points, _rotation(rng, dim).T)
    return turned


def _rotation(rng: np.random.Generator, dim: int) -> Array:
    rotation: Array = np.linalg.qr(rng.normal(size=(dim, dim)))[0]
    return rotation


def _direction(rng: np.random.Generator, dim: int) -> Array:
    direction: Array = _rotation(rng, dim)[0]
    return direction


def _even(rng: np.random.Generator, points: Array) -> tuple[Array, Array]:
    """Volumes of a nearly even distribution."""
    return points, rng.uniform(0.8, 1.2, len(points))


def _full_support(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    return _even(rng, _ball(rng, dim, radius))


def _one_sided(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _ball(rng, dim, radius)
    return _even(rng, points[points @ _direction(rng, dim) > -rng.uniform(0.0, 1.0)])


def _corner(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _ball(rng, dim, radius)
    return _even(rng, points[np.all(points > -rng.uniform(0.2, 1.0, dim), axis=1)])


def _thin_sheet(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _ball(rng, dim, radius)
    heights = points @ _direction(rng, dim)
    return _even(rng, points[np.abs(heights - rng.uniform(-1.0, 1.0)) < rng.uniform(0.5, 1.2)])


def _spray(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    return _drops(rng, dim, radius, int(rng.integers(1, 7)))


def _drops(rng: np.random.Generator, dim: int, radius: float, count: int) -> tuple[Array, Array]:
    directions = rng.normal(size=(count, dim))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return _even(rng, directions * rng.uniform(0.1, 0.95, (count, 1)) * radius)


def _collinear(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    count = int(rng.integers(2, 10))
    inside = int(rng.integers(1, dim))  # a line, or in 3-D a plane
    points = np.zeros((count, dim))
    points[:, :inside] = rng.uniform(-0.6, 0.6, (count, inside)) * radius
    if rng.random() < 0.5:
        points[:, -1] = rng.uniform(0.1, 0.5) * radius
    if rng.random() < 0.7:  # otherwise along an axis
        points = points @ _rotation(rng, dim).T
    return _even(rng, points)


def _nearly_collinear(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    """Points close to a line (plane) beside the point; a fit that does not refuse them has very large weights."""
    points = rng.uniform(-0.5, 0.5, (int(rng.integers(dim + 1, 10)), dim)) * radius
    points[:, -1] = 0.3 * radius + 10.0 ** rng.uniform(-7.0, -1.0) * rng.normal(size=len(points))
    return _even(rng, points @ _rotation(rng, dim).T)


def _conic(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    directions = rng.normal(size=(int(rng.integers(6, 15)), dim))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    axes = rng.uniform(0.2, 0.6, dim) * radius
    return _even(rng, (directions * axes) @ _rotation(rng, dim).T + rng.uniform(-0.1, 0.1, dim) * radius)


def _coincident(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _at_particle(rng, dim, radius)[0] if rng.random() < 0.5 else _ball(rng, dim, radius)
    nearest = np.argsort(np.sum(points**2, axis=1))[: int(rng.integers(1, 4))]
    if rng.random() < 0.3:  # only coincident particles
        points = points[nearest]
        nearest = np.arange(len(points))
    return _even(rng, np.concatenate([points, points[nearest]]))


def _nearly_coincident(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _at_particle(rng, dim, radius)[0]
    copies = points[np.argsort(np.sum(points**2, axis=1))[:3]]
    gaps = 10.0 ** rng.uniform(-14.0, -3.0, (3, 1)) * rng.normal(size=copies.shape)
    return _even(rng, np.concatenate([points, copies + gaps]))


def _at_particle(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _ball(rng, dim, radius)
    return _even(rng, points - points[np.argmin(np.sum(points**2, axis=1))])


def _few_at_particle(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points, volumes = _drops(rng, dim, radius, int(rng.integers(1, dim + 3)))
    points[0] = 0.0
    return points, volumes


def _stretched(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    """A jittered lattice, up to twice as long along one axis as across."""
    points = _ball(rng, dim, 1.5 * radius)
    points[:, 0] *= rng.uniform(1.3, 2.0)
    return _even(rng, points @ _rotation(rng, dim).T)


def _lattice(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    reach = int(radius) + 2
    axes = np.meshgrid(*[np.arange(-reach, reach + 1.0)] * dim, indexing="ij")
    points = np.stack(axes, axis=-1).reshape(-1, dim) + 0.5 * rng.integers(0, 2, dim)
    return points, np.ones(len(points))


def _at_cut_off(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    count = int(rng.integers(1, 5))
    directions = rng.normal(size=(count, dim))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    gaps = rng.choice([1e-3, 1e-4, 1e-9, 1e-12, 3e-16], (count, 1))
    points = directions * (radius * (1.0 - gaps))
    if rng.random() < 0.3:
        points = np.concatenate([points, _ball(rng, dim, radius)])
    return _even(rng, points)


def _varied_volumes(rng: np.random.Generator, dim: int, radius: float) -> tuple[Array, Array]:
    points = _ball(rng, dim, radius)
    return points, 10.0 ** rng.uniform(-2.0, 2.0, len(points))


FAMILIES: dict[str, Recipe] = {
    "full support": _full_support,
    "one-sided": _one_sided,
    "corner": _corner,
    "thin sheet": _thin_sheet,
    "spray": _spray,
    "collinear": _collinear,
    "nearly collinear": _nearly_collinear,
    "conic": _conic,
    "coincident": _coincident,
    "nearly coincident": _nearly_coincident,
    "at a particle": _at_particle,
    "few at a particle": _few_at_particle,
    "stretched": _stretched,
    "lattice": _lattice,
    "at the cut-off": _at_cut_off,
    "varied volumes": _varied_volumes,
}
"""recipes by name, each (rng, dim, radius in spacings) -> offsets and volumes in spacings, beyond the radius too"""

ALL = tuple(FAMILIES)
REGULAR = ("full support", "one-sided", "corner", "stretched", "varied volumes")
"""well-conditioned for every method of the project"""
SPARSE = (*REGULAR, "thin sheet", "spray", "at a particle", "few at a particle")
"""also ill-conditioned ones, but without points that nearly coincide or lie at the cut-off"""


def build(family: str, dim: int, seed: int, *, spacing: float = 1.0, ratio: float = 1.3, lifted: bool = False) -> Cloud:
    """Build one cloud.

    Parameters
    ----------
    family
        a key of :data:`FAMILIES`.
    dim
        2 or 3.
    seed
        of the random numbers.
    spacing
        particle spacing, m.
    ratio
        a third of the cut-off radius over the spacing, the h/dx of a kernel with R = 3h.
    lifted
        whether the ghost lies away from the evaluation point.
    """
    rng = np.random.default_rng(seed)
    radius = 3.0 * ratio
    return _cut(*FAMILIES[family](rng, dim, radius), radius, rng, lifted).scaled(spacing)


def _cut(points: Array, volumes: Array, radius: float, rng: np.random.Generator, lifted: bool) -> Cloud:
    inside = np.sqrt(np.sum(points**2, axis=1)) < radius
    if not inside.any():  # a recipe may give an empty ball, but methods are only called with neighbours
        points, volumes = 0.5 * radius * _direction(rng, points.shape[1])[None, :], np.ones(1)
        inside = np.ones(1, dtype=np.bool_)
    lift = None
    if lifted:  # none, or up to that from the mirror point of the deepest ghost
        lift = 2.0 * radius * rng.uniform(0.0, 1.0) * (rng.random() < 0.8) * _direction(rng, points.shape[1])
    return Cloud(points[inside], volumes[inside], radius, lift)


FLAT = ("straight line or plane beside the point", "straight line or plane through the point", "circle or sphere")
"""what neighbours approach in :func:`flattened`; ``line`` is one in three dimensions"""


def flattened(
    shape: str, dim: int, seed: int, thickness: float, *, turn: int = 0, lifted: bool = False, spacing: float = 1.0
) -> Cloud:
    """Build a cloud whose particles lie within ``thickness`` of a set on which a polynomial vanishes.

    Parameters
    ----------
    shape
        one of :data:`FLAT`, or ``line``.
    dim
        2 or 3.
    seed
        of the places of the particles, before the cloud is rotated.
    thickness
        largest distance from the set, over its length; 0 for particles in it, within round-off.
    turn
        seed of the rotation, which is none for 0, and of the order of the particles.
    lifted
        whether the ghost lies away from the evaluation point.
    spacing
        particle spacing, m.
    """
    rng = np.random.default_rng(seed)
    radius = 3.9
    if shape == FLAT[2]:
        around = rng.normal(size=(5 * dim, dim))
        around /= np.linalg.norm(around, axis=1, keepdims=True)
        away = around * (1.0 + thickness * rng.uniform(-0.5, 0.5, (len(around), 1)))
        points = 1.5 * away + rng.uniform(-0.5, 0.5, dim) / np.sqrt(dim)
    else:
        free = 1 if shape == "line" else dim - 1
        side = 13 if free == 1 else 5
        axes = np.meshgrid(*[np.linspace(-2.0, 2.0, side)] * free, indexing="ij")
        along = np.stack(axes, axis=-1).reshape(-1, free) + rng.uniform(-0.1, 0.1, (side**free, free))
        across = 2.0 * thickness * rng.uniform(-0.5, 0.5, (len(along), dim - free))
        points = np.hstack([along, across + (0.8 if shape == FLAT[0] else 0.0)])
    volumes = rng.uniform(0.8, 1.2, len(points))
    lift = 0.5 * radius * _direction(rng, dim) if lifted else np.zeros(dim)
    if turn:
        turned = np.random.default_rng(turn)
        rotation, order = _rotation(turned, dim), turned.permutation(len(points))
        points, volumes, lift = points[order] @ rotation.T, volumes[order], rotation @ lift
    return Cloud(points, volumes, radius, lift).scaled(spacing)


@lru_cache(maxsize=64)
def catalogue(dim: int, families: tuple[str, ...] = ALL, *, lifted: bool = False) -> tuple[Cloud, ...]:
    """Return the fixed clouds with which every check begins: five of each family, and spray of 1 to 6 drops."""
    ratio = 1.3 if dim == 2 else 1.0
    ratios = (ratio, ratio, ratio, 2.0, 3.0) if dim == 2 else (ratio, ratio, ratio, 1.2, 1.4)
    found = [build(family, dim, s, ratio=r, lifted=lifted) for family in families for s, r in enumerate(ratios)]
    if "spray" in families:
        for count in range(1, 7):
            for seed in range(3):
                rng = np.random.default_rng(100 * count + seed)
                found.append(_cut(*_drops(rng, dim, 3.0 * ratio, count), 3.0 * ratio, rng, lifted))
    return tuple(found)


def condition(cloud: Cloud, degree: int) -> float:
    """Return the factor by which the geometry magnifies round-off in a method of the given degree.

    It is the largest condition number of the moment matrices, columns scaled, of the polynomial basis with unit and
    with Gaussian weights about the evaluation point and, without the constant, about the nearest particle; infinite
    where the cloud does not determine the polynomial. Degree 0 gives 1.
    """
    if degree == 0:
        return 1.0
    x, basis, weights = _polynomials(cloud, degree)
    worst = max(_squared(basis), _squared(basis * np.sqrt(weights)[:, None]))
    about = x - x[np.argmin(cloud.distances)]
    squares = np.sum(about**2, axis=1)
    away = squares > 0.0
    return max(worst, _squared(about[away] * np.sqrt(_gaussian(squares[away]) / squares[away])[:, None]))


def magnification(cloud: Cloud, degree: int, *, at_ghost: bool = False) -> float:
    """Return sum |w_j| of a least-squares fit of a polynomial to the neighbours, with Gaussian weights.

    It is the magnification of noise by extrapolation: 1 in the middle of a symmetric neighbourhood, large far outside a
    neighbourhood. The fit is evaluated at the point or, for methods that extrapolate, ``at_ghost``.
    """
    _, basis, weights = _polynomials(cloud, degree)
    roots = np.sqrt(weights)
    place = _monomials(cloud.lift[None, :] / cloud.support * at_ghost, degree)[0]
    return float(np.abs(place @ np.linalg.pinv(basis * roots[:, None]) * roots).sum())


def _polynomials(cloud: Cloud, degree: int) -> tuple[Array, Array, Array]:
    """Return offsets over the support (n, dim), monomials (n, terms) and Gaussian weights (n,) of the neighbours."""
    x = cloud.offsets / cloud.support
    return x, _monomials(x, degree), _gaussian(np.sum(x**2, axis=1)) * cloud.volumes / cloud.volumes.max()


def _monomials(x: Array, degree: int) -> Array:
    """Return those of degree 1, 0 and 2 at places (n, dim) as columns (n, terms)."""
    columns = [*x.T, np.ones(len(x))]
    if degree == 2:
        columns += [x[:, a] * x[:, b] for a in range(x.shape[1]) for b in range(a + 1)]
    return np.column_stack(columns)


def _gaussian(squares: Array) -> Array:
    """The Gaussian cut off at r = R = 3h, of (r/R)^2."""
    values: Array = np.maximum(np.exp(-9.0 * squares) - np.exp(-9.0), 0.0)
    return values


def _squared(basis: Array) -> float:
    if basis.shape[0] < basis.shape[1]:
        return np.inf
    lengths = np.sqrt(np.sum(basis**2, axis=0))
    if not lengths.all():
        return np.inf
    values = np.linalg.svd(basis / lengths, compute_uv=False)
    return float((values[0] / values[-1]) ** 2) if values[-1] > 0.0 else np.inf
