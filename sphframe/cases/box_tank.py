"""Cases: what the rectangular tanks have in common."""

from sphframe.geometry import BoxRegion, BoxWall


def with_width(dimension: int, x: float, width: float, z: float) -> tuple[float, ...]:
    """Return a point: (x, z) in 2-D, (x, width, z) in 3-D; the last coordinate points upwards."""
    return (x, z) if dimension == 2 else (x, width, z)


def box_tank(dimension: int, length: float, width: float, height: float) -> BoxWall:
    """Return the wall of a tank that stands on the origin and is open above."""
    return BoxWall(
        name="tank",
        lower=(0.0,) * dimension,
        upper=with_width(dimension, length, width, height),
        open_faces=("+y",) if dimension == 2 else ("+z",),
    )


def water_box(dimension: int, length: float, width: float, height: float) -> BoxRegion:
    """Return the water at the left end of a tank, up to ``length`` and ``height``."""
    return BoxRegion(lower=(0.0,) * dimension, upper=with_width(dimension, length, width, height))


def domain_above(tank: BoxWall, margin: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the box that no particle may leave: the tank with a margin around it, and as much air above it."""
    lower = tuple(low - margin for low in tank.lower)
    upper = tuple(high + margin for high in tank.upper)
    return lower, (*upper[:-1], 2.0 * tank.upper[-1])
